"""Strides are read from a foot's IMU as they were walked: from made-up feet, simulated ones and real ones."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.models.mount import MOUNTS
from footfall.pdr.gait.statistics import bands, foot_figures, longest_still, quietest, rectified, stance_yaw
from footfall.pdr.gait.strides import (
    CROSSING_PHASE,
    SEAM_PHASE,
    STILL_RATE,
    Stride,
    aligned,
    matched,
    normalised,
    read_foot,
    strides_of,
)
from footfall.recording import Recording
from tests.helpers.straight import recorded, site


@pytest.fixture(scope="module")
def foot():
    """The right foot, seen from the instep."""
    return read_foot(recorded("instep"))


def physics_rows(foot, rows):
    """Rows of the physics record that rows of the matched signals stand on."""
    return (2 + np.asarray(rows) * 5).astype(int)


def sines(t, *terms):
    return np.column_stack([sum(a * np.sin(2 * np.pi * f * t) for a, f in terms)] * 3)


@pytest.mark.parametrize("rate", [200.0, 250.0, 397.0, 1000.0])
def test_matched_keeps_low_frequencies_halves_the_power_at_its_corner_and_delays_nothing(rate):
    t = np.arange(0, 20, 1 / rate)
    slow, corner = sines(t, (1.0, 5.0)), sines(t, (1.0, 50.0))
    signals = matched(Recording(t, slow, corner), 50.0)
    middle = slice(800, -800)
    expected = sines(np.arange(len(signals.gyro)) / 200.0, (1.0, 5.0))
    assert np.abs(signals.gyro - expected)[middle].max() < 2e-3
    assert np.sqrt(np.mean(signals.accel[middle] ** 2)) == pytest.approx(np.sqrt(0.5 * 0.5), rel=0.02)


def test_matched_bridges_dropped_samples():
    t = np.arange(0, 10, 1 / 400)
    kept = np.delete(np.arange(len(t)), [1000, 2000, 2001, 3000])
    whole, holed = (
        matched(Recording(t[rows], sines(t[rows], (1.0, 2.0)), sines(t[rows], (9.8, 1.0))))
        for rows in (np.arange(len(t)), kept)
    )
    assert np.abs(whole.gyro - holed.gyro).max() < 5e-3


@settings(max_examples=10)
@given(turn=st.tuples(*[st.floats(-3, 3)] * 3))
def test_a_foot_is_the_same_however_the_sensor_sits_on_it(foot, turn):
    """Axes are found from the signals: any mounting gives the same signals in the foot's axes."""
    level = recorded("instep")
    mounting = Rotation.from_rotvec(turn)
    gyro, accel = (mounting.apply(values.copy()) for values in (level.gyro, level.accel))
    turned = matched(Recording(level.t, gyro, accel))
    found = aligned(turned)
    assert np.abs(found.gyro - foot.signals.gyro).max() < 1e-6
    assert np.abs(found.accel - foot.signals.accel).max() < 1e-6


def test_a_hard_foot_slap_does_not_turn_the_foot_round(foot):
    """Faster than push-off, but by 11 deg only."""
    gyro, rows = foot.signals.gyro.copy(), np.arange(len(foot.signals.gyro))
    for stride in foot.strides:
        slap = stride.swing + np.argmax(foot.signals.gyro[stride.swing : stride.last, 1])
        gyro[:, 1] += 8.0 * np.exp(-0.5 * ((rows - slap) / 2) ** 2)
        assert gyro[slap, 1] > foot.signals.gyro[stride.push_off, 1]
    found = aligned(replace(foot.signals, gyro=gyro))
    assert np.corrcoef(found.gyro[:, 1], gyro[:, 1])[0, 1] > 0.99


def test_the_foots_axes_are_up_left_and_forward(foot):
    """Flat on the ground the force is g along z; push-off turns the toes down, about y to the left."""
    middle = [stride.last for stride in foot.strides]
    assert np.abs(np.median(foot.signals.accel[middle], axis=0) - [0, 0, GRAVITY]).max() < 0.7
    for stride in foot.strides:
        assert foot.signals.gyro[stride.push_off, 1] > 4 > -4 > foot.signals.gyro[stride.swing, 1]
        assert stride.step[0] > 1.0 > abs(stride.step[1])


def test_mirroring_makes_a_left_foot_a_right_one(foot):
    """What a mirror does to a walking foot: it steps the other way aside and turns the other way."""
    mirrored = strides_of(foot.signals, left=True)
    assert len(mirrored.strides) == len(foot.strides)
    for one, other in zip(foot.strides, mirrored.strides, strict=True):
        assert other.turn == pytest.approx(-one.turn, abs=1e-6)
        assert other.step == pytest.approx(one.step * [1, -1, 1], abs=1e-6)


@pytest.mark.parametrize("mount", ["instep", "heel", "medial"])
def test_strides_are_those_that_were_walked(mount):
    """Lengths and turns from the IMU alone against the simulator's truth."""
    foot = read_foot(recorded(mount))
    position, attitude = site(mount)
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


def true_up(foot, rows):
    """(n, 3) the vertical in the foot's axes at rows of its signals, by the simulator's attitude."""
    axes = np.linalg.lstsq(matched(recorded("instep")).accel, foot.signals.accel, rcond=None)[0]
    _, attitude = site("instep")
    attitude = attitude * Rotation.from_euler("ZYX", MOUNTS["instep"].euler_deg[::-1], degrees=True)
    return attitude[physics_rows(foot, rows)].as_matrix()[:, 2] @ axes


def test_the_vertical_in_the_foot_is_the_true_one(foot):
    """All through the swing, where half a sample of delay would tilt it by a degree."""
    off = []
    for stride in foot.strides:
        true = true_up(foot, np.arange(stride.first, stride.last + 1))
        off.append(np.degrees(np.arccos(np.clip((true * stride.up).sum(axis=1), -1, 1))).max())
    assert np.median(off) < 0.4


def test_rectified_force_is_that_of_the_true_attitude(foot):
    """mean(C_zi f_j) - mean(C_zi) f_j,standing with the simulator's attitude."""
    product, vertical, count = np.zeros((3, 3)), np.zeros(3), 0
    for stride in foot.strides:
        rows = np.arange(stride.first, stride.last)
        up = true_up(foot, rows)
        product += up.T @ foot.signals.accel[rows] / GRAVITY
        vertical += up.sum(axis=0)
        count += len(rows)
    expected = product / count - np.outer(vertical / count, [0, 0, 1])
    assert np.abs(rectified(foot) - expected).max() < 0.01


def test_normalised_strides_cross_where_they_should(foot):
    strides = normalised(foot)
    phases = strides.shape[1]
    crossing = round(CROSSING_PHASE * phases)
    pitch = strides[:, :, 1]
    assert (pitch[:, crossing - 4] > 0.5).all()
    assert (pitch[:, crossing + 4] < -0.5).all()
    assert np.abs(pitch[:, crossing]).max() < 0.3
    seam = round(SEAM_PHASE * phases)
    assert np.abs(np.diff(strides.mean(axis=0), axis=0)[seam - 1, :3]).max() < 0.1  # mid-stance
    assert (np.abs(strides[:, :, :3]).max(axis=2) <= strides[:, :, 3] + 0.05).all()


def test_stance_yaw_is_the_foots_heading_about_its_path():
    """A foot that walks straight, turned out by 5 deg and back by 3 at every second footfall."""
    headings = np.radians([-5.0, 3.0] * 8)
    strides = []
    for number, (one, other) in enumerate(pairwise(headings)):
        step = np.array([1.3 * np.cos(one), -1.3 * np.sin(one), 0.0])  # 1.3 m ahead, in the foot's frame
        strides.append(
            Stride(
                first=number,
                last=number + 1,
                crossing=0.0,
                push_off=0,
                swing=0,
                duration=1.0,
                turn=other - one,
                step=step,
                up=np.zeros((2, 3)),
            )
        )
    assert stance_yaw(strides) == pytest.approx(headings[1:-1])
    assert len(stance_yaw(strides[::2])) == 0  # no two in a row


def test_bands_are_the_scatter_between_strides():
    rng = np.random.default_rng(2)
    strides = rng.standard_normal((400, 50, 8)) * np.linspace(0.5, 1.5, 8) + rng.standard_normal((50, 8)) * 9
    found = bands(strides)
    assert found["band gyro x"] == pytest.approx(np.degrees(0.5), rel=0.03)
    assert found["band accel norm"] == pytest.approx(1.5, rel=0.03)
    assert np.isnan(bands(strides[:3])["band gyro x"])


@given(
    st.lists(st.floats(0, 3), min_size=1, max_size=200),
)
def test_the_longest_still_run_is_still_and_the_longest(rates):
    rates = np.array(rates)
    run = longest_still(rates)
    still = rates < STILL_RATE
    assert still[run].all()
    text = "".join("1" if one else "0" for one in still)
    assert run.stop - run.start == max(map(len, text.split("0")))


def test_the_quietest_tenth_of_a_second_is_found():
    rate = np.full(200, 0.5)
    rate[90:110] = 0.1
    assert quietest(rate, slice(50, 150)) == slice(90, 110)
    assert quietest(rate[:10], slice(0, 10)) == slice(0, 0)


def test_real_feet_show_what_is_known_of_them(real_data):
    """The recordings' own facts: their speeds, right feet, and figures read by others from the same files."""
    from benchmarks.validation._real import find

    feet = {}
    for one in find(real_data):
        feet[one.name] = read_foot(one.recording)
    figures = {name: foot_figures(foot) for name, foot in feet.items()}
    assert figures["openshoe 31"]["speed_m_s"] == pytest.approx(5 / 3.6, rel=0.06)
    assert figures["openshoe 44"]["speed_m_s"] == pytest.approx(7 / 3.6, rel=0.06)
    # Middle of the stance and share of the stride, unfiltered, as the recordings are described.
    assert figures["openshoe 44"]["mid_gyro_sd_deg_s"] == pytest.approx(1.9, rel=0.15)
    assert figures["xio long"]["mid_gyro_sd_deg_s"] == pytest.approx(3.1, rel=0.15)
    assert figures["xio long"]["still_pct"] == pytest.approx(29, abs=2)
    rolls = np.array([normalised(foot).mean(axis=0)[:, 0] for foot in feet.values()])
    for number, roll in enumerate(rolls):  # a left foot's roll would run against the others'
        assert np.corrcoef(roll, np.delete(rolls, number, axis=0).mean(axis=0))[0, 1] > 0


def test_a_recording_without_a_walk_is_refused():
    rest = Recording(np.arange(2000) / 200, np.zeros((2000, 3)), np.tile([0, 0, GRAVITY], (2000, 1)))
    with pytest.raises(InputError, match="stances found, expected a walk"):
        read_foot(rest)
