"""A real recording with another unit's drift: what is added is that, nothing else, and known."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.models.imu import EFFECTS, ImuSpec, TemperatureProfile, TriadSpec, draw_unit, load_spec
from footfall.models.imu.spec import ThermalSpec
from footfall.pdr.reckoning import PdrParams, dead_reckon
from footfall.recording import Recording, read_recording, write_recording
from footfall.simulate.from_recording import ADDED, add_errors
from tests.helpers.commands import expect_one_sentence
from tests.helpers.synthetic_foot import walk

COLD = TemperatureProfile.step(20.0, -5.0)
STILL = 5.0


@pytest.fixture(scope="module")
def real():
    truth = walk(np.zeros(61), still_s=STILL)
    return Recording(t=truth.t, gyro=truth.gyro, accel=truth.accel, meta={"made": "by hand"})


@pytest.fixture(scope="module")
def nimu():
    return draw_unit(load_spec("nimu"), 4)


def test_a_perfect_unit_or_no_effect_adds_nothing_bit_for_bit(real, nimu):
    for found in (
        add_errors(real, draw_unit(load_spec("perfect"), 3), seed=1, temperature=COLD),
        add_errors(real, nimu, seed=1, temperature=COLD, without=ADDED),
        add_errors(real, nimu, seed=1, temperature=COLD, without=EFFECTS),
    ):
        for name in ("t", "gyro", "accel"):
            assert getattr(found, name).tobytes() == getattr(real, name).tobytes()


def test_what_is_added_is_bias_temperature_and_g_sensitivity(real, nimu):
    without = ("flicker", "rate_random_walk")
    found = add_errors(real, nimu, seed=1, temperature=COLD, without=without)
    cooler = COLD.die(real.t, nimu.spec.thermal.time_constant) - nimu.spec.thermal.reference
    known = real.accel @ nimu.gyro.g.T + real.accel**2 @ nimu.gyro.g2.T
    known = known + nimu.gyro.temperature * cooler[:, None]
    added = found.gyro - real.gyro - known
    np.testing.assert_allclose(added, np.broadcast_to(added[0], added.shape), atol=1e-12)
    assert 0 < np.linalg.norm(added[0]) < 5 * np.sqrt(3) * nimu.spec.gyro.turn_on_sigma
    np.testing.assert_array_equal(found.temperature, cooler + nimu.spec.thermal.reference)
    # No noise a second time: what is added to a foot that rests hardly moves from sample to sample.
    whole = add_errors(real, nimu, seed=1, temperature=COLD)
    rest = slice(10, 900)
    jump = np.diff((whole.gyro - real.gyro)[rest], axis=0).std()
    assert jump < 0.3 * nimu.spec.gyro.white / np.sqrt(real.interval)


def test_known_drift_turns_the_track_by_as_much():
    """0.02 deg/s per degree about every axis, cooling by 10 degrees at once after the static bias."""
    spec = ImuSpec(
        "x", gyro=TriadSpec(temperature_sigma=np.radians(0.02)), thermal=ThermalSpec(reference=20.0)
    )
    unit = draw_unit(spec, 2)
    truth = walk(np.zeros(61), still_s=STILL, mount_pitch=0.0, rocking=0.0)
    recording = Recording(t=truth.t, gyro=truth.gyro, accel=truth.accel)
    air = TemperatureProfile(start=20.0, time=(0.0, STILL, STILL + 0.1), ambient=(20.0, 20.0, 10.0))
    params = PdrParams(bias_s=STILL - 0.5)
    before = dead_reckon(recording, params)
    after = dead_reckon(add_errors(recording, unit, seed=0, temperature=air), params)
    drift = (after.heading - before.heading)[-1] / (after.t[-1] - STILL)
    # What is added about the body's axes turns the heading by its mean vertical part.
    walking = (truth.t > STILL) & (truth.t <= after.t[-1])
    vertical = Rotation.from_quat(truth.quaternion[walking], scalar_first=True).as_matrix()[:, 2]
    assert drift == pytest.approx(vertical.mean(axis=0) @ (-10 * unit.gyro.temperature), rel=0.01)
    assert abs(drift) > np.radians(0.05)


def test_same_seed_same_bytes_and_provenance(real, nimu):
    one, same, other = (add_errors(real, nimu, seed=seed) for seed in (1, 1, 2))
    assert one.gyro.tobytes() == same.gyro.tobytes()
    assert one.gyro.tobytes() != other.gyro.tobytes()
    assert one.meta["made"] == "by hand"
    assert one.meta["added"]["unit_seed"] == 4
    assert one.meta["added"]["effects"] == list(ADDED)
    with pytest.raises(InputError, match="effect 'magic' does not exist"):
        add_errors(real, nimu, seed=1, without=("magic",))


def test_from_the_command_line(real, cli, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_recording(real, "real.parquet")
    line = "record --from-recording real.parquet --imu nimu --outdoors -5 -o rec.parquet"
    code, out, _ = cli(line)
    assert (code, out) == (0, "")
    found = read_recording("rec.parquet")
    assert found.meta["added"]["imu"].startswith("Memsense nIMU")
    assert cli("track rec.parquet --method hdr -o hdr.parquet")[0] == 0
    either = "expected either a walk or --from-recording"
    expect_one_sentence(*cli("record -o x.parquet"), either)
    expect_one_sentence(*cli("record real.parquet --from-recording real.parquet -o x.parquet"), either)
    expect_one_sentence(
        *cli("record --from-recording real.parquet -o real.parquet"), "would overwrite what it is made from"
    )


def test_a_recording_of_other_units_is_told_on_the_command_line(real, cli, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_recording(real, "real.parquet")
    columns = np.column_stack([np.degrees(real.gyro), real.accel / GRAVITY])
    names = ",".join(f"{sensor}_{axis}" for sensor in ("gyro", "accel") for axis in "xyz")
    np.savetxt("bare.csv", columns, delimiter=",", header=names, comments="")
    told = f"--unit gyro=deg/s --unit accel=g --rate {1 / (real.t[1] - real.t[0])}"
    assert cli(f"record --from-recording bare.csv --format csv {told} -o bare.parquet")[0] == 0
    assert cli("record --from-recording real.parquet -o rec.parquet")[0] == 0
    bare, rec = read_recording("bare.parquet"), read_recording("rec.parquet")
    np.testing.assert_allclose(bare.gyro, rec.gyro, atol=1e-6)
    np.testing.assert_allclose(bare.accel, rec.accel, atol=1e-6)
    for flag in ("--rate 200", "--format xio", "--unit gyro=deg/s"):
        expect_one_sentence(*cli(f"record walk.parquet {flag} -o x.parquet"), "tell how to read --from-rec")
