"""The gait comparison judges as it says: simulated feet and walks beside real ones."""

import json

import numpy as np
import pytest

from benchmarks.validation import _gait_kinetics, _gait_rows, _gait_walks, gait_realism
from benchmarks.validation._gait_distances import distance, distances
from footfall.models.mount import MOUNTS
from tests.helpers.straight import recorded, walked


def test_a_mount_sees_what_an_imu_there_records():
    """One walk serves all mounts: the same as walking with the IMU at that mount."""
    from footfall.scenarios.path import PathSpec, build_path
    from footfall.simulate.plan import Gait, Plan
    from footfall.simulate.walking import walk

    spec = PathSpec.model_validate({"elements": [{"kind": "straight", "length_m": 34.0}]})
    plan = Plan(
        "there",
        build_path(spec).route,
        mount=MOUNTS["heel"],
        gait=Gait(wander_m=_gait_walks.WANDER_M),
        calibration_s=_gait_walks.REST_S,
        rate_hz=1000,
    )
    there = walk(plan)
    seen = recorded("heel")
    assert np.abs(there.gyro - seen.gyro[: len(there.gyro)]).max() < 1e-6
    assert np.abs(there.accel - seen.accel[: len(there.accel)]).max() < 1e-4


def test_distance_counts_in_standard_deviations_between_the_others():
    base = np.random.default_rng(1).standard_normal((200, 8))
    others = base + np.array([-1.0, 0.0, 1.0])[:, None, None] * 0.5  # SD 0.5 everywhere
    far, within = distance(base + 0.75, others)
    assert far == pytest.approx(np.full(8, 1.5))
    assert within == pytest.approx(np.ones(8))
    far, within = distance(base + 1.25, others)
    assert far == pytest.approx(np.full(8, 2.5))
    assert within == pytest.approx(np.zeros(8))


def test_a_real_foot_is_compared_with_the_others_only():
    means = {
        name: np.full((200, 8), value) for name, value in (("a", 0.0), ("b", 2.0), ("c", 10.0), ("s", 1.0))
    }
    found = distances(means, ["a", "b", "c"])
    assert found["c"]["distance gyro x"] == pytest.approx(9 / np.sqrt(2))
    assert found["s"]["distance gyro x"] == pytest.approx(3 / np.std([0, 2, 10], ddof=1))
    assert found["s"]["within gyro x"] == 100.0


def test_ground_force_tells_humps_valley_and_spike():
    at = np.linspace(0, 1, 650)
    load = np.sin(np.pi * at) * (1.3 + 0.5 * np.cos(4 * np.pi * at - np.pi))
    spiked = load.copy()
    spiked[10:20] += 0.9
    found = _gait_kinetics.ground_force(spiked)
    assert found["first_hump_bw"] == pytest.approx(load[:325].max(), rel=0.03)
    assert found["second_hump_bw"] == pytest.approx(load[325:].max(), rel=0.03)
    assert found["valley_bw"] == pytest.approx(load[325], rel=0.03)
    assert found["spike_bw"] == pytest.approx(spiked[:50].max())


def test_stances_bridge_gaps_and_leave_out_scuffs():
    load = np.zeros(3000)
    load[500:1100] = 1.0
    load[700:740] = 0.0  # a short gap
    load[2000:2100] = 0.5  # a scuff
    load[2500:] = 1.0  # to the end
    assert _gait_kinetics.stances(load).tolist() == [[500, 1100], [2500, 3000]]
    assert len(_gait_kinetics.stances(np.zeros(100))) == 0


def test_step_width_is_seen_across_a_slanting_walk():
    """Feet 10 cm apart on a walk that drifts aside: the drift does not count."""
    times = np.arange(12.0)
    left = times % 2 == 1
    y = 0.03 * times + np.where(left, 0.05, -0.05)
    assert _gait_kinetics.step_widths(times, y, left) == pytest.approx(np.full(10, 0.10))


def test_walk_figures_hold_together():
    found = _gait_kinetics.walk_figures(walked())
    assert found["speed_m_s"] == pytest.approx(found["stride_length_m"] * found["cadence_steps_min"] / 120)
    # Two feet on the ground for twice the stance less the whole stride, as long as no one flies.
    assert found["double_support_pct"] == pytest.approx(2 * found["stance_pct"] - 100, abs=4)
    assert found["valley_bw"] < min(found["first_hump_bw"], found["second_hump_bw"])


def test_verdicts():
    rows, row = _gait_rows, _gait_rows.Row("x", "x", 1)
    assert rows.verdict(row, [1.0, 2.0], 1.0, 2.0) == "inside"
    assert rows.verdict(row, [0.96, 2.04], 1.0, 2.0) == "inside"  # as far as its decimals go
    assert rows.verdict(row, [0.9, 1.5, 3.0], 1.0, 2.0) == "1 of 3"
    assert rows.verdict(row, [0.9, 3.0], 1.0, 2.0) == "outside"
    assert rows.verdict(row, [float("nan")], 1.0, 2.0) == ""
    assert rows.spread(rows.Row("distance x", ""), [0.5, 2.0]) == (0.0, 2.0)
    assert rows.spread(rows.Row("within x", ""), [50.0, 90.0, float("nan")]) == (50.0, 100.0)


def test_the_command_writes_tables_figure_and_figures(real_data, tmp_path, capsys):
    page = tmp_path / "gait.md"
    page.write_text(
        "".join(
            f"<!-- table {name} -->\n<!-- end -->\n" for name in ("counts", "feet", "walks", "recordings")
        )
    )
    target = tmp_path / "gait.json"
    few = {name: gait_realism.FEET[name] for name in ("1.3", "heel")}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(gait_realism, "FEET", few)
        patch.setattr(gait_realism, "WALKS", {"1.3": few["1.3"][0]})
        gait_realism.main(
            f"--data {real_data} --metres 30 --processes 1 --docs {tmp_path} --json {target}".split()
        )
    assert (tmp_path / "images" / "gait_strides.png").stat().st_size > 50_000
    found = json.loads(target.read_text(encoding="utf-8"))
    assert set(found["simulated"]) == set(few)
    assert len(found["real"]) >= 3
    assert {row.key for row in _gait_rows.judged()} == set(found["verdicts"])
    assert "stride time SD" in page.read_text(encoding="utf-8")
    assert "heel-strike peak" in capsys.readouterr().out


def test_too_few_recordings_are_told(tmp_path):
    with pytest.raises(SystemExit, match="0 recordings, expected 3 or more"):
        gait_realism.main(["--data", str(tmp_path)])
