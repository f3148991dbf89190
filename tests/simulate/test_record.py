"""Recordings of a walk, and the drift budget that explains them."""

import dataclasses
import math
import tracemalloc
from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from footfall.conventions import BIAS_TIME
from footfall.errors import InputError
from footfall.models.imu import EFFECTS, ImuSpec, ImuUnit, TemperatureProfile, TriadSpec, draw_unit, load_spec
from footfall.recording import Recording, read_recording, write_recording
from footfall.simulate._budget_kernels import compose
from footfall.simulate.budget import DriftBudget, drift_budget, write_budget
from footfall.simulate.record import record, record_with_budget
from footfall.simulate.walk import TrueFootfalls, Walk
from footfall.tables import read_table
from tests.helpers.synthetic import synthetic_walk

COLD = TemperatureProfile.step(20.0, -5.0)


@pytest.fixture(scope="module")
def walk() -> Walk:
    return synthetic_walk()


@pytest.fixture(scope="module")
def nimu() -> ImuUnit:
    return draw_unit(load_spec("nimu"), 11)


def gyro_unit(**spec: float) -> ImuUnit:
    return draw_unit(ImuSpec("x", gyro=TriadSpec(**spec)), 0)


def test_a_perfect_imu_says_what_the_walk_says_bit_for_bit(walk):
    recording = record(walk, draw_unit(load_spec("perfect"), 3), seed=9, temperature=COLD)
    for name in ("t", "gyro", "accel"):
        assert getattr(recording, name).tobytes() == getattr(walk, name).tobytes()
    assert recording.temperature is None


def test_switching_every_effect_off_makes_any_imu_perfect(walk, nimu):
    recording = record(walk, nimu, seed=9, temperature=COLD, without=EFFECTS)
    assert recording.gyro.tobytes() == walk.gyro.tobytes()
    assert recording.accel.tobytes() == walk.accel.tobytes()


def test_a_recording_shares_no_memory_with_its_walk(walk):
    recording = record(walk, draw_unit(load_spec("perfect"), 3), seed=9)
    assert not any(
        np.shares_memory(getattr(recording, name), getattr(walk, name)) for name in ("gyro", "accel")
    )


def test_same_seeds_same_bytes_other_seed_other_noise(walk, nimu, tmp_path):
    files = []
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        write_recording(record(walk, nimu, seed=seed, temperature=COLD), tmp_path / f"{name}.parquet")
        files.append((tmp_path / f"{name}.parquet").read_bytes())
    assert files[0] == files[1]
    assert files[0] != files[2]


def test_the_walk_itself_is_left_alone(walk, nimu):
    before = [getattr(walk, name).copy() for name in ("t", "gyro", "accel", "quaternion")]
    record_with_budget(walk, nimu, seed=1, temperature=COLD)
    for name, values in zip(("t", "gyro", "accel", "quaternion"), before, strict=True):
        np.testing.assert_array_equal(getattr(walk, name), values)


def test_the_reported_temperature_is_the_dies_in_the_sensors_steps(walk, nimu):
    recording = record(walk, nimu, seed=1, temperature=COLD)
    die = -5 + 25 * np.exp(-walk.t / 600)
    assert np.abs(recording.temperature - die).max() <= 0.018165 / 2 + 1e-9
    assert 5 < len(np.unique(recording.temperature)) < len(walk.t) / 10


def test_without_a_word_on_the_temperature_it_is_20_degrees_all_along(walk, nimu):
    reported = record(walk, nimu, seed=1).temperature
    assert np.ptp(reported) == 0
    assert reported[0] == pytest.approx(20.0, abs=0.018165 / 2)


@pytest.mark.parametrize("sensor", ["gyro", "accel"])
def test_temperature_errors_are_nought_at_the_sheets_reference_alone(walk, sensor):
    """The vertex of the nIMU's parabola is at 25 degC: 5 K below and above are alike, 10 K four times."""
    thermal = load_spec("nimu").thermal
    spec = ImuSpec("x", **{sensor: TriadSpec(temperature2_sigma=1e-5)}, thermal=thermal)
    unit, true = draw_unit(spec, 0), getattr(walk, sensor)

    def off(temperature: float) -> np.ndarray:
        steady = TemperatureProfile.steady(temperature)
        return getattr(record(walk, unit, seed=0, temperature=steady), sensor) - true

    assert not off(25.0).any()
    np.testing.assert_allclose(off(20.0), 25 * np.tile(getattr(unit, sensor).temperature2, (len(true), 1)))
    np.testing.assert_allclose(off(30.0), off(20.0))
    np.testing.assert_allclose(off(15.0), 4 * off(20.0), rtol=1e-6)


def test_a_recording_tells_its_origin(walk, nimu, tmp_path):
    write_recording(record(walk, nimu, seed=5, temperature=COLD, without=["white"]), tmp_path / "r.parquet")
    meta = read_recording(tmp_path / "r.parquet").meta
    assert meta["walk"] == walk.meta
    assert (meta["imu"], meta["unit_seed"], meta["noise_seed"]) == (nimu.spec.name, 11, 5)
    assert meta["without"] == ["white"]
    assert meta["temperature"] == {"start": 20.0, "time": [0.0], "ambient": [-5.0]}


def test_gyro_and_accelerometer_have_noises_of_their_own(walk):
    triad = TriadSpec(white=0.01)
    recording = record(walk, draw_unit(ImuSpec("x", gyro=triad, accel=triad), 0), seed=0)
    noises = np.hstack([recording.gyro - walk.gyro, recording.accel - walk.accel])
    assert np.abs(np.corrcoef(noises.T) - np.eye(6)).max() < 5 / math.sqrt(len(walk.t))


def test_gyro_and_accelerometer_of_one_bandwidth_have_one_delay(walk):
    triad = TriadSpec(bandwidth=50.0)
    twin = dataclasses.replace(walk, accel=walk.gyro)
    recording = record(twin, draw_unit(ImuSpec("x", gyro=triad, accel=triad), 0), seed=0)
    np.testing.assert_array_equal(recording.gyro, recording.accel)
    assert not np.array_equal(recording.gyro, walk.gyro)


@pytest.mark.parametrize(
    "arguments", [{"without": ["noise"], "seed": 0}, {"seed": -3}, {"seed": 0, "without": "white"}]
)
def test_bad_arguments_are_refused(walk, nimu, arguments):
    with pytest.raises(InputError):
        record(walk, nimu, **arguments)


# A bias that no rest can remove


@pytest.mark.parametrize("shift_deg_s", [0.2, -0.1])
def test_a_bias_shift_turns_the_heading_from_the_first_step_on(walk, shift_deg_s):
    """As the IMU stands it is about the vertical, and in no sample of the rest."""
    unit, shift = draw_unit(load_spec("perfect"), 0), np.radians(shift_deg_s)
    plain, shifted = record(walk, unit, seed=0), record(walk, unit, seed=0, bias_shift=shift)
    added = shifted.gyro - plain.gyro
    standing = plain.t <= walk.calibration_s + 1e-9
    assert not added[standing].any()
    up = Rotation.from_quat(walk.quaternion[0], scalar_first=True).apply(added[~standing])
    np.testing.assert_allclose(up, np.tile([0.0, 0.0, shift], (len(up), 1)), atol=1e-15)
    np.testing.assert_array_equal(shifted.accel, plain.accel)
    assert (plain.meta["bias_shift"], shifted.meta["bias_shift"]) == (0.0, shift)


def test_a_bias_shift_is_a_cause_of_drift(walk, nimu):
    shift = np.radians(0.2)
    recording, budget = record_with_budget(walk, nimu, seed=1, bias_shift=shift)
    assert recording.gyro.tobytes() == record(walk, nimu, seed=1, bias_shift=shift).gyro.tobytes()
    assert tuple(budget.causes) == (*EFFECTS, "bias_shift")
    # The foot pitches and rolls in swing: a body vector is about the vertical for most of a stride only.
    assert 0.7 * shift < np.median(budget.causes["bias_shift"]) <= shift


# The drift budget


def test_budget_comes_with_the_same_recording(walk, nimu):
    recording, _ = record_with_budget(walk, nimu, seed=4, temperature=COLD)
    plain = record(walk, nimu, seed=4, temperature=COLD)
    assert recording.gyro.tobytes() == plain.gyro.tobytes()
    assert recording.accel.tobytes() == plain.accel.tobytes()


def assert_explained(walk: Walk, recording: Recording, budget: DriftBudget) -> None:
    """The drift is what the recording alone shows, sample by sample, by scipy's rotations."""
    still = round(25 / walk.interval)  # T_bias of the HDR paper
    rate = recording.gyro - recording.gyro[:still].mean(axis=0)
    edges = np.rint(walk.footfalls.t / walk.interval).astype(int)
    for i, (a, b) in enumerate(pairwise(edges)):
        attitude = Rotation.from_quat(walk.quaternion[a], scalar_first=True)
        for step in Rotation.from_rotvec(rate[a + 1 : b + 1] * walk.interval):
            attitude = attitude * step
        truth = Rotation.from_quat(walk.quaternion[b], scalar_first=True)
        drift = (attitude * truth.inv()).as_rotvec()[2] / (walk.t[b] - walk.t[a])
        causes = sum(values[i] for values in budget.causes.values())
        assert abs(causes - drift) < 1e-12
        assert abs(causes - budget.total[i]) < 1e-15


@pytest.mark.parametrize(("imu", "seed"), [("nimu", 0), ("nimu", 1), ("nimu", 2), ("mtig710", 3)])
def test_causes_sum_to_what_the_recording_itself_shows(walk, imu, seed):
    recording, budget = record_with_budget(walk, draw_unit(load_spec(imu), seed), seed=seed, temperature=COLD)
    assert tuple(budget.causes) == EFFECTS
    assert_explained(walk, recording, budget)


def test_strides_of_different_length_have_each_their_own_drift(walk, nimu):
    """Footfalls left out: strides of one, two, three and six times the length, for each its own time."""
    kept = np.array([0, 1, 3, 4, 7, 13, 14])
    falls = walk.footfalls
    uneven = dataclasses.replace(
        walk, footfalls=TrueFootfalls(falls.t[kept], falls.position[kept], falls.heading[kept])
    )
    recording, budget = record_with_budget(uneven, nimu, seed=2, temperature=COLD)
    np.testing.assert_allclose(budget.interval, np.diff(kept) * 1.1, atol=0.006)
    assert_explained(uneven, recording, budget)


def test_the_static_bias_is_that_of_25_seconds(walk):
    """A bias that begins after 24 s: one of 25 seconds is averaged in and taken off, of 20 none."""
    unit = gyro_unit(temperature_sigma=1e-6)
    warm = TemperatureProfile(25.0, (24.0, 24.0 + 1e-6), (25.0, 35.0))
    _, found = record_with_budget(walk, unit, seed=0, temperature=warm)
    _, whole = record_with_budget(walk, unit, seed=0, temperature=warm, bias_time=20.0)
    np.testing.assert_allclose(found.total / whole.total, 1 - 1 / 25, rtol=1e-3)


def test_non_linearity_has_its_share_of_the_budget(walk):
    """Of an axis that swings both ways about zero, what is left over a stride: its mean, turned upright."""
    unit = gyro_unit(range=math.radians(1000), non_linearity_sigma=1e-4)
    _, budget = record_with_budget(walk, unit, seed=0)
    u = walk.gyro[1:] / math.radians(1000)
    error = unit.gyro.non_linearity * math.radians(1000) * (4 * u**3 - 3 * u)
    expected = stride_means(walk, (body_to_world(walk) * error).sum(axis=1))
    found = budget.causes["non_linearity"]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-3 * np.abs(expected).max())
    np.testing.assert_array_equal(found, budget.total)


def test_budget_has_a_row_for_each_stride(walk, nimu):
    _, budget = record_with_budget(walk, nimu, seed=0)
    np.testing.assert_allclose(budget.t, walk.footfalls.t[1:])
    np.testing.assert_allclose(budget.interval, np.diff(walk.footfalls.t))
    assert all(values.shape == budget.t.shape for values in [budget.total, *budget.causes.values()])


def test_an_effect_that_is_off_costs_nothing_and_changes_no_other_draw(walk, nimu):
    _, full = record_with_budget(walk, nimu, seed=0, temperature=COLD)
    _, less = record_with_budget(walk, nimu, seed=0, temperature=COLD, without=["flicker"])
    assert full.causes["flicker"].any()
    assert not less.causes["flicker"].any()
    for name in ("scale", "misalignment", "non_linearity", "g_sensitivity", "g2", "temperature"):
        np.testing.assert_array_equal(full.causes[name], less.causes[name])


def test_a_constant_bias_is_gone_with_the_static_estimate(walk):
    _, budget = record_with_budget(walk, gyro_unit(turn_on_sigma=0.1), seed=0)
    assert np.abs(budget.total).max() < 1e-14


def test_budget_of_a_perfect_imu_is_zero(walk):
    _, budget = record_with_budget(walk, draw_unit(load_spec("perfect"), 0), seed=0)
    assert not budget.total.any()


def body_to_world(walk: Walk) -> np.ndarray:
    """(n - 1, 3) rows z of C in the middle of each interval."""
    start = Rotation.from_quat(walk.quaternion[:-1], scalar_first=True)
    return (start * Rotation.from_rotvec(walk.gyro[1:] * walk.interval / 2)).as_matrix()[:, 2]


def stride_means(walk: Walk, x: np.ndarray) -> np.ndarray:
    edges = np.rint(walk.footfalls.t / walk.interval).astype(int)
    return np.array([x[a:b].mean(axis=0) for a, b in pairwise(edges)])


def test_rectified_g_sensitivity_is_first_order_theory(walk):
    """Mean of C_zi G_ij f_j over the stride less the standing value of the body vector G f."""
    unit = gyro_unit(g_sigma=1e-6)
    _, budget = record_with_budget(walk, unit, seed=0)
    error = (walk.accel[1:] - walk.accel[0]) @ unit.gyro.g.T
    expected = stride_means(walk, (body_to_world(walk) * error).sum(axis=1))
    np.testing.assert_allclose(
        budget.causes["g_sensitivity"], expected, rtol=0, atol=1e-3 * np.abs(expected).max()
    )


def test_temperature_drift_is_first_order_theory(walk):
    unit = gyro_unit(temperature_sigma=1e-6)
    unit = dataclasses.replace(unit, spec=dataclasses.replace(unit.spec, thermal=load_spec("nimu").thermal))
    _, budget = record_with_budget(walk, unit, seed=0, temperature=COLD)
    cooled = 25 * np.exp(-walk.t / 600)
    change = (cooled - cooled[: round(BIAS_TIME / walk.interval)].mean())[1:, None] * unit.gyro.temperature
    expected = stride_means(walk, (body_to_world(walk) * change).sum(axis=1))
    np.testing.assert_allclose(
        budget.causes["temperature"], expected, rtol=0, atol=1e-3 * np.abs(expected).max()
    )


def test_a_pure_delay_is_no_drift(walk):
    """Two samples late, a foot at rest at both footfalls has turned as far; a plain mean disagrees."""
    late = np.vstack([walk.gyro[:2], walk.gyro[:-2]])
    budget = drift_budget(walk, [("delay", late)], BIAS_TIME)
    assert np.abs(budget.total).max() < 1e-13
    plain = stride_means(walk, (body_to_world(walk) * (late - walk.gyro)[1:]).sum(axis=1))
    assert np.abs(plain).mean() > 1e-4  # rad/s: 7 deg in 20 minutes


def test_budget_refuses_a_start_shorter_than_the_bias_time(walk, nimu):
    for bias_time in (0.0, 26.5):
        with pytest.raises(InputError, match=r"bias_time.*26 s"):
            record_with_budget(walk, nimu, seed=0, bias_time=bias_time)


def test_budget_file_holds_every_cause(walk, nimu, tmp_path):
    recording, budget = record_with_budget(walk, nimu, seed=0, temperature=COLD)
    write_budget(budget, tmp_path / "b.parquet", recording.meta)
    columns, meta = read_table(tmp_path / "b.parquet")
    assert tuple(columns) == ("t", "interval", *EFFECTS, "total")
    np.testing.assert_array_equal(columns["temperature"], budget.causes["temperature"])
    assert meta["noise_seed"] == 0


def test_kernel_composes_as_scipy_does():
    rate = np.random.default_rng(0).normal(scale=5.0, size=(40, 3))
    rate[10:12] = 0.0
    edges = np.array([0, 7, 8, 39])
    ours = compose(rate, 0.005, edges)
    for i, (a, b) in enumerate(pairwise(edges)):
        product = Rotation.identity()
        for step in Rotation.from_rotvec(rate[a + 1 : b + 1] * 0.005):
            product = product * step
        np.testing.assert_allclose(
            (product.inv() * Rotation.from_quat(ours[i], scalar_first=True)).magnitude(), 0, atol=1e-14
        )
        assert np.linalg.norm(ours[i]) == pytest.approx(1, abs=1e-14)


def test_what_is_handed_out_cannot_be_written_into(walk, nimu):
    for recording in (record(walk, nimu, seed=0), record_with_budget(walk, nimu, seed=0)[0]):
        for name in ("t", "gyro", "accel", "temperature"):
            assert not getattr(recording, name).flags.writeable
    perfect = draw_unit(load_spec("perfect"), 0)
    recording, _ = record_with_budget(walk, perfect, seed=0)
    assert not np.shares_memory(recording.gyro, walk.gyro)
    assert walk.gyro.flags.writeable


@pytest.mark.parametrize("make", [record, record_with_budget])
def test_a_recording_needs_little_memory_beside_its_own(walk, nimu, make):
    """64 bytes a sample are the recording; the budget is made of one signal after the other."""
    make(walk, nimu, seed=0, temperature=COLD)  # compiles
    tracemalloc.start()
    make(walk, nimu, seed=0, temperature=COLD)
    most = tracemalloc.get_traced_memory()[1] / len(walk.t)
    tracemalloc.stop()
    assert most < (90 if make is record else 110)
