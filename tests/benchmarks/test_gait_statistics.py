"""The gait comparison reads what it says it reads: from made-up feet, simulated ones and real ones."""

import json
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from benchmarks.validation import (
    _gait_kinetics,
    _gait_rows,
    _gait_statistics,
    _gait_strides,
    _gait_walks,
    gait_realism,
)
from footfall.conventions import GRAVITY
from footfall.models.body import MOUNTS


@pytest.fixture(scope="module")
def motion():
    """Some twenty strides straight ahead."""
    return _gait_walks.walk_straight(_gait_walks.Case("reference", 1.3), 34.0)


@pytest.fixture(scope="module")
def foot(motion):
    """Its right foot, seen from the instep."""
    return _gait_strides.read_foot(_gait_strides.matched(*_gait_walks.samples(motion, "instep")))


def site(motion, mount):
    """Where the IMU at a mount is, and its attitude."""
    attitude = Rotation.from_quat(motion.foot[:, 3:], scalar_first=True)
    position = motion.foot[:, :3] + attitude.apply(np.array(MOUNTS[mount].position) * motion.scale)
    return position, attitude


def physics_rows(foot, rows):
    """Rows of the physics record that rows of the matched signals stand on."""
    return (2 + np.asarray(rows) * 5).astype(int)


def sines(t, *terms):
    return np.column_stack([sum(a * np.sin(2 * np.pi * f * t) for a, f in terms)] * 3)


@pytest.mark.parametrize("rate", [200.0, 250.0, 397.0, 1000.0])
def test_matched_keeps_low_frequencies_halves_the_power_at_its_corner_and_delays_nothing(rate):
    t = np.arange(0, 20, 1 / rate)
    slow, corner = sines(t, (1.0, 5.0)), sines(t, (1.0, 50.0))
    signals = _gait_strides.matched(t, slow, corner, 50.0)
    middle = slice(800, -800)
    expected = sines(np.arange(len(signals.gyro)) / 200.0, (1.0, 5.0))
    assert np.abs(signals.gyro - expected)[middle].max() < 2e-3
    assert np.sqrt(np.mean(signals.accel[middle] ** 2)) == pytest.approx(np.sqrt(0.5 * 0.5), rel=0.02)


def test_matched_bridges_dropped_samples():
    t = np.arange(0, 10, 1 / 400)
    kept = np.delete(np.arange(len(t)), [1000, 2000, 2001, 3000])
    whole, holed = (
        _gait_strides.matched(t[rows], sines(t[rows], (1.0, 2.0)), sines(t[rows], (9.8, 1.0)))
        for rows in (np.arange(len(t)), kept)
    )
    assert np.abs(whole.gyro - holed.gyro).max() < 5e-3


@settings(max_examples=10)
@given(turn=st.tuples(*[st.floats(-3, 3)] * 3))
def test_a_foot_is_the_same_however_the_sensor_sits_on_it(motion, foot, turn):
    """Axes are found from the signals: any mounting gives the same signals in the foot's axes."""
    t, gyro, accel = _gait_walks.samples(motion, "instep")
    mounting = Rotation.from_rotvec(turn)
    turned = _gait_strides.matched(t, mounting.apply(gyro), mounting.apply(accel))
    found = _gait_strides.aligned(turned)
    assert np.abs(found.gyro - foot.signals.gyro).max() < 1e-6
    assert np.abs(found.accel - foot.signals.accel).max() < 1e-6


def test_a_hard_foot_slap_does_not_turn_the_foot_round(foot):
    """Faster than push-off, but by 11 deg only."""
    gyro, rows = foot.signals.gyro.copy(), np.arange(len(foot.signals.gyro))
    for stride in foot.strides:
        slap = stride.swing + np.argmax(foot.signals.gyro[stride.swing : stride.last, 1])
        gyro[:, 1] += 8.0 * np.exp(-0.5 * ((rows - slap) / 2) ** 2)
        assert gyro[slap, 1] > foot.signals.gyro[stride.push, 1]
    found = _gait_strides.aligned(replace(foot.signals, gyro=gyro))
    assert np.corrcoef(found.gyro[:, 1], gyro[:, 1])[0, 1] > 0.99


def test_the_foots_axes_are_up_left_and_forward(motion, foot):
    """Flat on the ground the force is g along z; push-off turns the toes down, about y to the left."""
    middle = [stride.last for stride in foot.strides]
    assert np.abs(np.median(foot.signals.accel[middle], axis=0) - [0, 0, GRAVITY]).max() < 0.7
    for stride in foot.strides:
        assert foot.signals.gyro[stride.push, 1] > 4 > -4 > foot.signals.gyro[stride.swing, 1]
        assert stride.step[0] > 1.0 > abs(stride.step[1])


def test_mirroring_makes_a_left_foot_a_right_one(foot):
    """What a mirror does to a walking foot: it steps the other way aside and turns the other way."""
    mirrored = _gait_strides.read_foot(foot.signals, left=True)
    assert len(mirrored.strides) == len(foot.strides)
    for one, other in zip(foot.strides, mirrored.strides, strict=True):
        assert other.turn == pytest.approx(-one.turn, abs=1e-6)
        assert other.step == pytest.approx(one.step * [1, -1, 1], abs=1e-6)


@pytest.mark.parametrize("mount", ["instep", "heel", "medial"])
def test_strides_are_those_that_were_walked(motion, mount):
    """Lengths and turns from the IMU alone against the simulator's truth."""
    foot = _gait_strides.read_foot(_gait_strides.matched(*_gait_walks.samples(motion, mount)))
    position, attitude = site(motion, mount)
    heading = attitude.as_matrix()[:, :, 0]
    heading = np.unwrap(np.arctan2(heading[:, 1], heading[:, 0]))
    assert len(foot.strides) > 10
    errors = []
    for stride in foot.strides:
        first, last = physics_rows(foot, (stride.first, stride.last))
        moved = position[last] - position[first]
        errors.append(abs(np.hypot(*stride.step[:2]) - np.hypot(*moved[:2])))
        assert stride.step[2] == pytest.approx(moved[2], abs=0.02)
        assert stride.turn == pytest.approx(heading[last] - heading[first], abs=np.radians(0.5))
    assert np.median(errors) < 0.01
    assert max(errors) < 0.03


def test_a_mount_sees_what_an_imu_there_records(motion):
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
    _, gyro, accel = _gait_walks.samples(motion, "heel")
    assert np.abs(there.gyro - gyro[: len(there.gyro)]).max() < 1e-6
    assert np.abs(there.accel - accel[: len(there.accel)]).max() < 1e-4


def test_rectified_force_is_that_of_the_true_attitude(motion, foot):
    """mean(C_zi f_j) - mean(C_zi) f_j,standing with the simulator's attitude."""
    t, gyro, accel = _gait_walks.samples(motion, "instep")
    raw = _gait_strides.matched(t, gyro, accel)
    axes = np.linalg.lstsq(raw.accel, foot.signals.accel, rcond=None)[0]
    _, attitude = site(motion, "instep")
    attitude = attitude * Rotation.from_euler("ZYX", MOUNTS["instep"].euler_deg[::-1], degrees=True)
    product, vertical, count = np.zeros((3, 3)), np.zeros(3), 0
    for stride in foot.strides:
        rows = np.arange(stride.first, stride.last)
        up = attitude[physics_rows(foot, rows)].as_matrix()[:, 2] @ axes
        product += up.T @ foot.signals.accel[rows] / GRAVITY
        vertical += up.sum(axis=0)
        count += len(rows)
    expected = product / count - np.outer(vertical / count, [0, 0, 1])
    assert np.abs(_gait_statistics.rectified(foot) - expected).max() < 0.01


def test_normalised_strides_cross_where_they_should(foot):
    strides = _gait_strides.normalised(foot)
    phases = strides.shape[1]
    crossing = round(_gait_strides.CROSSING_PHASE * phases)
    pitch = strides[:, :, 1]
    assert (pitch[:, crossing - 4] > 0.5).all()
    assert (pitch[:, crossing + 4] < -0.5).all()
    assert np.abs(pitch[:, crossing]).max() < 0.3
    seam = round(_gait_strides.SEAM_PHASE * phases)
    assert np.abs(np.diff(strides.mean(axis=0), axis=0)[seam - 1, :3]).max() < 0.1  # mid-stance
    assert (np.abs(strides[:, :, :3]).max(axis=2) <= strides[:, :, 3] + 0.05).all()


def test_stance_yaw_is_the_foots_heading_about_its_path():
    """A foot that walks straight, turned out by 5 deg and back by 3 at every second footfall."""
    headings = np.radians([-5.0, 3.0] * 8)
    strides = []
    for number, (one, other) in enumerate(pairwise(headings)):
        step = np.array([1.3 * np.cos(one), -1.3 * np.sin(one), 0.0])  # 1.3 m ahead, in the foot's frame
        strides.append(
            _gait_strides.Stride(
                first=number,
                last=number + 1,
                crossing=0.0,
                push=0,
                swing=0,
                duration=1.0,
                turn=other - one,
                step=step,
                up=np.zeros((2, 3)),
            )
        )
    assert _gait_statistics.stance_yaw(strides) == pytest.approx(headings[1:-1])
    assert len(_gait_statistics.stance_yaw(strides[::2])) == 0  # no two in a row


def test_distance_counts_in_standard_deviations_between_the_others():
    base = np.random.default_rng(1).standard_normal((200, 8))
    others = base + np.array([-1.0, 0.0, 1.0])[:, None, None] * 0.5  # SD 0.5 everywhere
    far, within = _gait_statistics.distance(base + 0.75, others)
    assert far == pytest.approx(np.full(8, 1.5))
    assert within == pytest.approx(np.ones(8))
    far, within = _gait_statistics.distance(base + 1.25, others)
    assert far == pytest.approx(np.full(8, 2.5))
    assert within == pytest.approx(np.zeros(8))


def test_bands_are_the_scatter_between_strides():
    rng = np.random.default_rng(2)
    strides = rng.standard_normal((400, 50, 8)) * np.linspace(0.5, 1.5, 8) + rng.standard_normal((50, 8)) * 9
    found = _gait_statistics.bands(strides)
    assert found["band gyro x"] == pytest.approx(np.degrees(0.5), rel=0.03)
    assert found["band accel norm"] == pytest.approx(1.5, rel=0.03)
    assert np.isnan(_gait_statistics.bands(strides[:3])["band gyro x"])


def test_a_real_foot_is_compared_with_the_others_only():
    means = {
        name: np.full((200, 8), value) for name, value in (("a", 0.0), ("b", 2.0), ("c", 10.0), ("s", 1.0))
    }
    found = _gait_statistics.distances(means, ["a", "b", "c"])
    assert found["c"]["distance gyro x"] == pytest.approx(9 / np.sqrt(2))
    assert found["s"]["distance gyro x"] == pytest.approx(3 / np.std([0, 2, 10], ddof=1))
    assert found["s"]["within gyro x"] == 100.0


@given(
    st.lists(st.floats(0, 3), min_size=1, max_size=200),
)
def test_the_longest_still_run_is_still_and_the_longest(rates):
    rates = np.array(rates)
    run = _gait_statistics.longest_still(rates)
    still = rates < _gait_strides.STILL_RATE
    assert still[run].all()
    text = "".join("1" if one else "0" for one in still)
    assert run.stop - run.start == max(map(len, text.split("0")))


def test_the_quietest_tenth_of_a_second_is_found():
    rate = np.full(200, 0.5)
    rate[90:110] = 0.1
    assert _gait_statistics.quietest(rate, slice(50, 150)) == slice(90, 110)
    assert _gait_statistics.quietest(rate[:10], slice(0, 10)) == slice(0, 0)


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


def test_walk_figures_hold_together(motion):
    found = _gait_kinetics.walk_figures(motion)
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


def test_real_feet_show_what_is_known_of_them(real_data):
    """The recordings' own facts: their speeds, right feet, and figures read by others from the same files."""
    from benchmarks.validation._real import find

    feet = {}
    for one in find(real_data):
        raw = one.recording
        feet[one.name] = _gait_strides.read_foot(_gait_strides.matched(raw.t, raw.gyro, raw.accel))
    figures = {name: _gait_statistics.foot_figures(foot) for name, foot in feet.items()}
    assert figures["openshoe 31"]["speed_m_s"] == pytest.approx(5 / 3.6, rel=0.06)
    assert figures["openshoe 44"]["speed_m_s"] == pytest.approx(7 / 3.6, rel=0.06)
    # Middle of the stance and share of the stride, unfiltered, as the recordings are described.
    assert figures["openshoe 44"]["mid_gyro_sd_deg_s"] == pytest.approx(1.9, rel=0.15)
    assert figures["xio long"]["mid_gyro_sd_deg_s"] == pytest.approx(3.1, rel=0.15)
    assert figures["xio long"]["still_pct"] == pytest.approx(29, abs=2)
    rolls = np.array([_gait_strides.normalised(foot).mean(axis=0)[:, 0] for foot in feet.values()])
    for number, roll in enumerate(rolls):  # a left foot's roll would run against the others'
        assert np.corrcoef(roll, np.delete(rolls, number, axis=0).mean(axis=0))[0, 1] > 0


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
