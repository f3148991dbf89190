#!/usr/bin/env bash
# After the walker has changed (weights, laws, body, shoes): measure anew whatever depends on it. Writes what the
# benchmarks print to OUT, fills the tables and figures of docs/ and the five units of closed-loop.toml; what is
# said about them in words, and the tables of results.md, sweeps.md, tuning.md, which_property.md and
# which_parameter.md, are left to you. Three hours or more on two cores.
#
#     benchmarks/remeasure.sh [OUT]          (in an environment with .[test]; OUT: out/measured)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
out=${1:-out/measured}
mkdir -p "$out"

measure() { # name, command
    local name=$1
    shift
    printf '%s  %s\n' "$(date +%T)" "$name"
    "$@" >"$out/$name.txt"
}

measure gait python -m benchmarks.validation.gait_realism --docs docs
measure stops python -m benchmarks.validation.stops
measure starts python -m benchmarks.validation.starts
measure turning_stops python -m benchmarks.validation.turning_stops
measure scatter python -m benchmarks.validation.scatter
measure courses python -m benchmarks.validation.courses
measure units python -m benchmarks.validation.stock_units
units=$(grep '^units = ' "$out/units.txt")
fit=$(sed -nE 's/^([0-9]+) of ([0-9]+) units fit.*/\1 of the \2 drawn fit./p' "$out/units.txt")
sed -i "s/^units = .*/$units/; s/^# at)\. .*/# at). $fit/" scenarios/stock/closed-loop.toml
measure closed-loop footfall run closed-loop --out "$out/closed-loop"
cp "$out"/closed-loop/{maps,heading_error,controller,drift_budget}.png docs/images/
measure gentle footfall run closed-loop-gentle --walks 2 --units 20 --out "$out/gentle"
measure perfect footfall run closed-loop --imu perfect --units 0 --noises 0 --methods pdr,hdr,iez --out "$out/perfect"
measure hdr_table2 python -m benchmarks.papers.hdr_table2 --mounts instep --figure docs/images/hdr_table2.png --page docs/results.md
measure swaying python -m benchmarks.papers.swaying --page docs/swaying.md --figure docs/images/swaying.png
measure iez python -m benchmarks.papers.iez_false_bias --page docs/iez.md --figures docs/images
measure ways python -m benchmarks.papers.iez_ways --page docs/iez.md
measure ihde python -m benchmarks.papers.ihde_table2 --page docs/ihde.md --figures docs/images
measure perfect_imu python -m benchmarks.validation.perfect_imu
measure truth python -m benchmarks.validation.imu_truth
measure speed python -m benchmarks.speed.walker
measure robustness python -m benchmarks.validation.robustness --seeds 20
measure pushes python -m benchmarks.validation.robustness straight --metres 400 --push 10 --seeds 4
measure studies python -m benchmarks.studies.pages --docs docs --out "$out/studies"
measure shank python -m benchmarks.validation.shank --page docs/studies/mounts.md
measure strides python -m benchmarks.validation.strides --page docs/real_recordings.md
measure without_hdr python -m benchmarks.validation.without_hdr --figure docs/images/without_hdr.png --page docs/without_hdr.md
measure hypotheses python -m benchmarks.validation.hypotheses --page docs/hypotheses.md
measure directions python -m benchmarks.papers.ihde_hypotheses --page docs/hypotheses.md
measure tried python -m benchmarks.papers.ihde_hypotheses --tried --page docs/hypotheses.md
measure rooms python -m benchmarks.validation.hypotheses --scenarios rooms corridors --units 24
measure wander python -m benchmarks.validation.hypotheses_wander --seeds 4 --page docs/hypotheses.md
measure beliefs python -m benchmarks.validation.hypotheses_ways --page docs/hypotheses.md
measure figures python -m benchmarks.validation.hypotheses_figures --figures docs/images
for study in hdr-threshold rates; do
    measure "$study" footfall sweep "$study" --out "$out/$study"
done
for study in nimu-heading nimu-correctors hdr-parameters hde-2010-parameters ihde-parameters ihde-plus-parameters \
    hypotheses-parameters; do
    measure "$study" footfall sensitivity "$study" --out "$out/$study"
done
measure hdr-closed-loop footfall tune hdr-closed-loop --out "$out/hdr-closed-loop"
measure tutorial python docs/examples/spare_torque.py --seed 1 --out "$out/residual.npz" --page docs/tutorial_environment.md
measure render footfall render straight -o docs/images/walker.png
