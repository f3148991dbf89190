#!/usr/bin/env bash
# After the walker has changed (weights, laws, body, shoes): measure anew whatever depends on it. Writes what the
# benchmarks print to OUT, fills the tables and figures of docs/ and the five units of closed-loop.toml; what is
# said about them in words (README, results.md, gait.md, iez.md, ihde.md) is left to you. One and a half hours or
# more on two cores.
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

measure gait python benchmarks/gait_realism.py --docs docs
measure stops python benchmarks/stops.py
measure starts python benchmarks/starts.py
measure scatter python benchmarks/scatter.py
measure courses python benchmarks/courses.py
measure units python benchmarks/stock_units.py
units=$(grep '^units = ' "$out/units.txt")
fit=$(sed -nE 's/^([0-9]+) of ([0-9]+) units fit.*/\1 of the \2 drawn fit./p' "$out/units.txt")
sed -i "s/^units = .*/$units/; s/^# at)\. .*/# at). $fit/" scenarios/stock/closed-loop.toml
measure closed-loop footfall run closed-loop --out "$out/closed-loop"
cp "$out"/closed-loop/{maps,heading_error,controller,drift_budget}.png docs/images/
measure gentle footfall run closed-loop-gentle --walks 2 --units 20 --out "$out/gentle"
measure perfect footfall run closed-loop --imu perfect --units 0 --noises 0 --methods pdr,hdr,iez --out "$out/perfect"
measure hdr_table2 python benchmarks/hdr_table2.py --mounts instep --figure docs/images/hdr_table2.png --page docs/results.md
measure swaying python benchmarks/swaying.py --page docs/swaying.md --figure docs/images/swaying.png
measure iez python benchmarks/iez_false_bias.py --page docs/iez.md --figures docs/images
measure ihde python benchmarks/ihde_table2.py --page docs/ihde.md --figures docs/images
measure perfect_imu python benchmarks/perfect_imu.py
measure truth python benchmarks/imu_truth.py
measure speed python benchmarks/walker_speed.py
measure robustness python benchmarks/robustness.py --seeds 20
measure pushes python benchmarks/robustness.py straight --metres 400 --push 10 --seeds 4
measure tutorial python docs/examples/spare_torque.py --seed 1 --out "$out/residual.npz" --page docs/tutorial_environment.md
measure render footfall render straight -o docs/images/walker.png
