"""Dead reckoning against known truth, and the ways of ruining heading silently."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY, heading_of
from footfall.errors import InputError
from footfall.pdr import _kernels, _plain
from footfall.pdr.reckoning import PdrParams, StartPose, dead_reckon, level_attitude
from footfall.pdr.rest import static_bias
from footfall.pdr.stance import StanceParams
from footfall.recording import Recording
from tests.helpers.synthetic_foot import walk

DEG = np.pi / 180
# Straights and corners both ways, with the scatter of a person's stance yaw about the path.
CORNERS = np.repeat([0, 90, 180, 90, 0, -90, 0, 90], 25) * DEG
SCATTER = 2 * DEG * np.random.default_rng(0).standard_normal(len(CORNERS))


@pytest.fixture(scope="module")
def town():
    return walk(CORNERS + SCATTER)


def start_of(truth, t):
    row = truth.at(np.array([t]))
    return StartPose(tuple(truth.position[row[0]]), float(truth.heading(truth.t[row])[0]))


def reckoned(truth, params=None, **errors):
    recording = truth.recording(**errors)
    first = dead_reckon(recording, params).t[0]
    return dead_reckon(recording, params, start_of(truth, first))


def heading_error(truth, footfalls):
    return np.abs(footfalls.heading - truth.heading(footfalls.t))


def tilt_errors(truth, resets, gain, gyro_error=0.0):
    """Angle (rad) between true and estimated vertical at each reset."""
    attitudes = (
        _kernels.reckon(
            truth.t,
            truth.gyro + gyro_error,
            truth.accel,
            np.zeros(3),
            truth.quaternion[resets[0]],
            resets,
            gain,
        )[0],
        truth.quaternion[resets],
    )
    up = [Rotation.from_quat(q, scalar_first=True).inv().apply([0, 0, 1]) for q in attitudes]
    return np.linalg.norm(np.cross(*up), axis=1)


def test_a_perfect_imu_loses_nothing_but_the_rolling_foot(town):
    found = reckoned(town)
    assert len(found) == len(CORNERS)
    assert heading_error(town, found).max() < 0.01 * DEG
    walked = np.diff(town.position[town.at(found.t)], axis=0)
    assert abs(found.distance[1:].sum() / np.linalg.norm(walked[:, :2], axis=1).sum() - 1) < 0.005


def test_distance_error_is_the_velocity_that_zupt_calls_zero(town):
    """The IMU moves at v while the ball of the foot rests: a stride loses the mean v of its ends times T."""
    found = reckoned(town, PdrParams(tilt_gain=0.0))
    row = town.at(found.t)
    lost = np.diff(found.position, axis=0) - np.diff(town.position[row], axis=0)
    v = town.velocity[row]
    inner = slice(1, -1)  # the still start and the stop are reset more than once a stride
    expected = -(v[1:] + v[:-1]) / 2 * found.interval[1:, None]
    np.testing.assert_allclose(lost[inner], expected[inner], atol=1e-4)


def test_rows_belong_together(town):
    found = reckoned(town)
    assert found.t[0] == pytest.approx(25.0, abs=0.3)  # the end of the still start
    assert found.interval[0] == found.distance[0] == found.rate[0] == 0
    np.testing.assert_allclose(np.diff(found.t), found.interval[1:])
    np.testing.assert_allclose(
        np.cumsum(found.rate * found.interval), found.heading - found.heading[0], atol=1e-12
    )
    np.testing.assert_allclose(np.hypot(*np.diff(found.position[:, :2], axis=0).T), found.distance[1:])
    assert np.abs(np.diff(found.heading)).max() < 2 * np.pi / 3


def test_the_start_pose_moves_and_turns_the_whole_walk(town):
    recording = town.recording()
    plain = dead_reckon(recording)
    moved = dead_reckon(recording, start=StartPose((3.0, -2.0, 1.0), 0.7))
    assert moved.heading[0] == pytest.approx(0.7)
    np.testing.assert_allclose(moved.position[0], [3, -2, 1])
    turned = Rotation.from_rotvec([0, 0, 0.7 - plain.heading[0]]).apply(plain.position - plain.position[0])
    np.testing.assert_allclose(moved.position, turned + np.array([3, -2, 1]), atol=1e-9)
    np.testing.assert_allclose(moved.rate, plain.rate, atol=1e-12)


@pytest.mark.parametrize(
    "mount", [[180, 0, 0], [90, 0, 40], [0, 30, 200]], ids=["upside-down", "on its side", "behind"]
)
def test_any_mount_will_do(town, mount):
    """A turned IMU tells the same path; its x axis has another heading, which turns as much."""
    turn = Rotation.from_euler("xyz", mount, degrees=True)
    recording = town.recording()
    # scipy turns no array that is read-only.
    mounted = Recording(recording.t, turn.apply(recording.gyro.copy()), turn.apply(recording.accel.copy()))
    plain, found = dead_reckon(recording), dead_reckon(mounted)
    np.testing.assert_allclose(found.distance, plain.distance, atol=1e-3)
    # Two axes of a foot that does not stand flat have headings that differ by its tilt.
    assert np.abs(np.diff(found.heading - plain.heading)).max() < 1 * DEG


def test_compiled_equals_plain(town):
    rows = slice(0, 6000)
    t, gyro, accel = town.t[rows], town.gyro[rows] + 0.01, town.accel[rows] + 0.1
    bias, resets = np.array([0.004, -0.02, 0.03]), np.arange(10, 6000, 97)
    compiled = _kernels.reckon(t, gyro, accel, bias, town.quaternion[0], resets, 0.1)
    plain = _plain.reckon(t, gyro, accel, bias, town.quaternion[0], resets, 0.1)
    sign = np.sign(np.sum(compiled[0] * plain[0], axis=1))[:, None]
    np.testing.assert_allclose(compiled[0] * sign, plain[0], atol=1e-11)
    np.testing.assert_allclose(compiled[1], plain[1], atol=1e-9)
    np.testing.assert_allclose(compiled[2], plain[2], rtol=1e-9, atol=1e-9)


def test_trap_1_the_raw_rate_is_no_integral_of_a_rate(town):
    """Body gyro z and the vertical rate integrate to thousands of degrees; attitude's heading is right."""
    attitude = Rotation.from_quat(town.quaternion, scalar_first=True)
    dt = np.diff(town.t, prepend=0.0)
    true_change = town.heading(town.mid_stance)[-1] - town.heading(town.mid_stance)[0]
    body = np.sum(town.gyro[:, 2] * dt)
    vertical = np.sum(attitude.apply(town.gyro)[:, 2] * dt)
    found = reckoned(town)
    assert abs(body - true_change) > 500 * DEG
    assert abs(vertical - true_change) > 500 * DEG
    assert abs(np.sum(found.rate * found.interval) - true_change) < 0.1 * DEG


def test_trap_2_swing_pitches_through_the_vertical_and_heading_survives(town):
    down = Rotation.from_quat(town.quaternion, scalar_first=True).apply([1, 0, 0])[:, 2]
    assert np.degrees(np.arcsin(-down)).max() > 85
    # Sample by sample that heading leaps; from stance to stance it does not.
    assert np.abs(np.diff(heading_of(town.quaternion))).max() > 20 * DEG
    assert heading_error(town, reckoned(town)).max() < 0.01 * DEG


def test_trap_5_no_correction_turns_the_heading():
    """At rest with a wrong tilt, the tilt is mended and the correction has no vertical part."""
    t = np.arange(0, 60, 0.01)
    still, up = np.zeros((len(t), 3)), np.tile([0, 0, GRAVITY], (len(t), 1))
    true = Rotation.from_euler("ZYX", [50, 12, -7], degrees=True)
    wrong = Rotation.from_rotvec([0.03, -0.05, 0]) * true
    resets, force = np.arange(0, len(t), 30), np.ascontiguousarray(true.inv().apply(up))
    quaternion, *_ = _kernels.reckon(
        t, still, force, np.zeros(3), wrong.as_quat(scalar_first=True), resets, 0.1
    )
    final = Rotation.from_quat(quaternion[-1], scalar_first=True)
    assert (final * true.inv()).magnitude() < 1e-4
    assert abs((final * wrong.inv()).as_rotvec()[2]) < 1e-9


def test_trap_5_heading_does_not_hear_the_accelerometers():
    truth = walk(CORNERS + SCATTER, mount_pitch=0.0)
    deaf = reckoned(truth, PdrParams(tilt_gain=0.0))
    hearing = reckoned(truth, accel_error=np.array([0.08, -0.05, 0.1]))
    assert np.abs(hearing.heading - deaf.heading).max() < 0.2 * DEG


def test_trap_6_long_still_runs_are_reset_again_and_again():
    """A minute's stand with a drifting tilt: metres with one reset, a centimetre with one every 0.3 s."""
    truth = walk(np.zeros(41), pauses={20: 60.0})
    drift = np.where(truth.t[:, None] > 25, [0.0, 0.05 * DEG, 0.0], 0.0)

    def across(reset_s):
        found = reckoned(truth, PdrParams(stance=StanceParams(reset_s=reset_s)), gyro_error=drift)
        moved = np.linalg.norm(np.diff(found.position - truth.position[truth.at(found.t)], axis=0), axis=1)
        return moved.max()

    assert across(0.3) < 0.03
    assert across(1e9) > 10.0


def test_trap_7_what_25_seconds_leave_of_white_noise():
    """ARW N leaves N / sqrt(T_bias) in the static bias: 0.0147 deg/s for the nIMU's 4.4 deg/rt-h."""
    n_deg, rate, bias = 4.4, 50.0, np.array([0.3, -0.2, 0.1]) * DEG
    t = np.arange(int(26 * rate)) / rate
    force = np.tile([0, 0, GRAVITY], (len(t), 1))
    rng = np.random.default_rng(7)
    left = []
    for _ in range(300):
        gyro = bias + n_deg / 60 * DEG * np.sqrt(rate) * rng.standard_normal((len(t), 3))
        left.append(static_bias(Recording(t, gyro, force), 25.0).gyro_bias - bias)
    sigma = np.std(left) / DEG
    assert sigma == pytest.approx(n_deg / 60 / np.sqrt(25), rel=0.08)  # 900 draws: 2.4 % at one sigma
    assert sigma == pytest.approx(0.0147, rel=0.1)


def test_trap_8_tilt_from_a_whole_stride_not_from_a_moment_of_stance(town):
    """Around a footfall the foot moves: its accelerometers are degrees off, a stride's mean is not."""
    row = town.at(reckoned(town).t)
    force = np.mean([town.accel[row[1:-1] + k] for k in range(-10, 11)], axis=0)  # 100 ms
    off = Rotation.from_quat(town.quaternion[row[1:-1]], scalar_first=True).apply(force)
    assert np.median(np.hypot(off[:, 0], off[:, 1]) / GRAVITY) > 1 * DEG
    assert tilt_errors(town, row, 0.1).max() < 0.01 * DEG


def test_trap_8_tilt_is_bounded_when_the_gyro_drifts(town):
    """A drift w about a level axis tilts by w T a stride; the gain takes its share: w T / gain."""
    drift = np.where(town.t[:, None] > 25, [0.1 * DEG, 0.1 * DEG, 0.0], 0.0)
    row = town.at(reckoned(town).t)
    bound = 0.1 * DEG * np.sqrt(2) * 1.1 / 0.1
    assert (
        tilt_errors(town, row, 0.1, drift).max()
        < bound
        < 5 * bound
        < tilt_errors(town, row, 0.0, drift).max()
    )


def test_a_static_bias_is_removed_as_a_body_vector(town):
    perfect = reckoned(town)
    biased = reckoned(town, gyro_error=np.array([0.5, -0.8, 0.3]) * DEG)
    np.testing.assert_allclose(biased.heading, perfect.heading, atol=1e-6)
    np.testing.assert_allclose(biased.position, perfect.position, atol=1e-4)


def test_drift_about_the_vertical_is_heading_error_and_nothing_else(town):
    """Uncorrected dead reckoning integrates drift: 0.1 deg/s for t seconds is 0.1 t degrees."""
    up = Rotation.from_quat(town.quaternion, scalar_first=True).inv().apply([0, 0, 1])
    drift = np.where(town.t[:, None] > 25, 0.1 * DEG * up, 0.0)
    found = reckoned(town, gyro_error=drift)
    error = found.heading - town.heading(found.t)
    np.testing.assert_allclose(error, 0.1 * DEG * (found.t - 25).clip(0), atol=0.1 * DEG)


def test_dropped_samples_are_bridged_and_long_holes_refused(town):
    recording = town.recording()
    keep = np.random.default_rng(5).random(len(town.t)) > 0.01
    keep[:2] = keep[-2:] = True
    thinned = Recording(recording.t[keep], recording.gyro[keep], recording.accel[keep])
    found = dead_reckon(thinned)
    assert len(found) == len(CORNERS)
    hole = (recording.t < 60.2025) | (recording.t > 60.9)
    holed = Recording(recording.t[hole], recording.gyro[hole], recording.accel[hole])
    with pytest.raises(InputError, match=r"no samples for 0\.7\d* s after t = 60\.2 s"):
        dead_reckon(holed)
    assert len(dead_reckon(holed, PdrParams(max_gap_s=1.0))) == len(CORNERS)


def refused(truth, match, params=None, **errors):
    with pytest.raises(InputError, match=match) as caught:
        dead_reckon(truth.recording(**errors), params)
    assert "\n" not in str(caught.value)


def test_a_start_that_is_too_short_or_moves_is_refused():
    short = walk(np.zeros(20), still_s=10.0)
    refused(short, r"moves at t = 10 s .* first 25 s at rest")
    refused(short, "shorter than the 60 s at rest", PdrParams(bias_s=60.0))
    assert len(dead_reckon(short.recording(), PdrParams(bias_s=10.0))) == 20


def test_wrong_units_and_mounts_without_heading_are_refused():
    truth = walk(np.zeros(5))
    recording = truth.recording()
    with pytest.raises(InputError, match=r"measure 1 at rest, expected 9.81"):
        dead_reckon(Recording(recording.t, recording.gyro, recording.accel / GRAVITY))
    with pytest.raises(InputError, match=r"x axis is 5\.0 deg from vertical"):
        dead_reckon(walk(np.zeros(5), mount_pitch=85 * DEG).recording())


def test_a_recording_without_a_stride_is_refused():
    t = np.arange(0, 40, 0.01)
    force = np.tile([0, 0, GRAVITY], (len(t), 1))
    with pytest.raises(InputError, match="no stride found"):
        dead_reckon(Recording(t, np.zeros((len(t), 3)), force))


def test_settings_that_make_no_sense_are_refused():
    with pytest.raises(InputError, match="bias_s = 0"):
        PdrParams(bias_s=0.0)
    with pytest.raises(InputError, match="tilt_gain = 2"):
        PdrParams(tilt_gain=2.0)


def test_level_attitude_has_no_tilt_and_heading_zero():
    force = np.array([-3.0, 1.0, -8.9])
    attitude = level_attitude(force)
    up = Rotation.from_quat(attitude, scalar_first=True).apply(force)
    np.testing.assert_allclose(up, [0, 0, np.linalg.norm(force)], atol=1e-12)
    assert heading_of(attitude) == pytest.approx(0.0, abs=1e-12)
