"""Files of every format come back as the recording that was written, whatever their loggers did to them."""

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.io import savemat

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.formats import parse_units, read
from footfall.formats.condition import condition
from footfall.formats.layout import Header, csv
from footfall.formats.samples import Samples
from footfall.recording import Recording, write_recording
from footfall.tables import write_table
from tests.helpers.commands import write_csv
from tests.helpers.synthetic_foot import walk

RATE = 200.0
AXES = "xyz"


def named(gyro, accel, t="t", values=None):
    """Columns of `values` (t, gyro, accel) under these names, each with {} for the axis."""
    stamps, rates, forces = values
    columns = {t: stamps} if t else {}
    columns |= {gyro.format(axis): rates[:, i] for i, axis in enumerate(AXES)}
    return columns | {accel.format(axis): forces[:, i] for i, axis in enumerate(AXES)}


@pytest.fixture(scope="module")
def foot():
    """Ten strides as an IMU tells them."""
    truth = walk(np.zeros(11), still_s=2.0, rate=RATE)
    return Recording(t=truth.t[1:] - truth.t[1], gyro=truth.gyro[1:], accel=truth.accel[1:])


def si(foot, gyro=1.0, accel=1.0, t=1.0):
    """The samples of `foot` in units of these sizes."""
    return foot.t / t, foot.gyro / gyro, foot.accel / accel


def same(found, foot, atol=1e-6):
    np.testing.assert_allclose(found.t, foot.t, atol=1e-6)
    np.testing.assert_allclose(found.gyro, foot.gyro, atol=atol)
    np.testing.assert_allclose(found.accel, foot.accel, atol=10 * atol)


DEG = np.pi / 180


@pytest.mark.parametrize(
    ("format", "names", "sizes"),
    [
        ("footfall", ("gyro_{}", "accel_{}"), (1.0, 1.0)),
        ("xio", ("Gyroscope {} (deg/s)", "Accelerometer {} (g)", "Time (s)"), (DEG, GRAVITY)),
        (
            "sensorconnect",
            ("inertial-1.2:scaledGyro{}", "inertial-1.2:scaledAccel{}", "Time"),
            (1.0, GRAVITY),
        ),
        (
            "sensorconnect",
            ("inertial-7:estAngularRate{}", "inertial-7:estCompensatedAccel{}", "Time"),
            (1.0, 1.0),
        ),
        ("csv", ("gyro_{}_deg_s", "accel_{}_g", "time_ms"), (DEG, GRAVITY, 1e-3)),
        ("csv", ("Gyr {} [dps]", "Acc {} [m/s^2]", "timestamp (us)"), (DEG, 1.0, 1e-6)),
        ("csv", ("w{}", "f{}", "time"), (1.0, 1.0)),
    ],
)
def test_a_table_says_its_units_by_its_names(foot, tmp_path, format, names, sizes):
    upper = format in ("xio", "sensorconnect")
    columns = named(*names, values=si(foot, *sizes))
    if upper:
        columns = {
            re.sub(r"(?<=[ a-z])[xyz](?=$| )", lambda m: m[0].upper(), k): v for k, v in columns.items()
        }
    write_csv(tmp_path / "a.csv", columns | {"note": np.zeros(len(foot.t))})
    write_table(tmp_path / "a.parquet", columns, {}, {"by": "hand"})
    for file in ("a.csv", "a.parquet"):
        for asked in ("auto", format):
            found, findings = read(tmp_path / file, asked)
            assert findings.format == format
            assert findings.sentences() == []
            same(found, foot)
    assert found.meta["by"] == "hand"


def test_flags_say_what_names_do_not(foot, tmp_path):
    write_csv(tmp_path / "a.csv", named("g{}", "a{}", None, si(foot, DEG, GRAVITY)))
    found, _ = read(tmp_path / "a.csv", sizes=parse_units(["gyro=deg/s", "accel=g"]), rate_hz=RATE)
    same(found, foot)
    with pytest.raises(InputError, match="no column of time, and no rate"):
        read(tmp_path / "a.csv", sizes=parse_units(["gyro=deg/s", "accel=g"]))


@pytest.mark.parametrize("flag", ["gyro", "gyro=", "gyro=m/s2", "mass=kg", "=g", ""])
def test_a_flag_that_is_no_unit_is_refused(flag):
    with pytest.raises(InputError, match="unit"):
        parse_units([flag])


def test_semicolons_a_byte_order_mark_and_quotes(foot, tmp_path):
    columns = named("gyro_{}_rad_s", "accel_{}_m_s2", "t_s", si(foot))
    lines = [";".join(f'"{name}"' for name in columns)]
    lines += [";".join(map(repr, map(float, row))) for row in zip(*columns.values(), strict=True)]
    (tmp_path / "a.csv").write_text("\ufeff" + "\r\n".join(lines) + "\r\n", encoding="utf-8")
    same(read(tmp_path / "a.csv")[0], foot)


def openshoe_lines(foot, first=1):
    """The recorder's text; its timer starts anew every second."""
    step = round(19_660_800 / RATE)
    head = ["", "Inertial data.", "", "Header:      a_x [g]:      a_y [g]: ..."]
    for i, (w, f) in enumerate(zip(foot.gyro, foot.accel, strict=True)):
        numbers = " ".join(f"{x:+.12f}" for x in (*(f / GRAVITY), *w))
        head.append(
            f"   0xcb {numbers} {(i * step) % 19_660_800} 0x14ce {first + i} 12.5 12.5 12.5 200.0 0 0 0"
        )
    return head


def test_openshoes_text(foot, tmp_path):
    file = tmp_path / "inert.txt"
    file.write_text("\r\n".join(openshoe_lines(foot)))
    found, findings = read(file)
    same(found, foot)
    assert findings.format == "openshoe"
    lines = openshoe_lines(foot)
    file.write_text("\r\n".join([*lines[:-1], lines[-1][:60]]))
    found, findings = read(file)
    assert len(found.t) == len(foot.t) - 1
    assert "the last row is cut short" in findings.sentences()[0]
    lines[300] = "   0xcb +0.1 nonsense"
    file.write_text("\r\n".join(lines))
    with pytest.raises(InputError, match="a_y is no number in row 296"):
        read(file)


@pytest.mark.parametrize("across", [False, True])
@pytest.mark.parametrize("scalar", [False, True])
def test_matlab(foot, tmp_path, across, scalar):
    imu = np.column_stack([foot.accel, foot.gyro])
    file = tmp_path / "a.mat"
    savemat(file, {"imu": imu.T if across else imu, "ts": 1 / RATE if scalar else foot.t})
    found, findings = read(file)
    assert findings.format == "matlab"
    same(found, foot)


@pytest.mark.parametrize(
    ("held", "culprit"),
    [
        ({"imu": np.zeros((9, 6))}, "no variables 'imu' and 'ts'"),
        ({"imu": np.zeros((9, 5)), "ts": 0.1}, r"shape \(9, 5\), expected numbers, n x 6"),
        ({"imu": np.zeros((9, 6)), "ts": np.zeros(4)}, "ts has 4 values for 9 samples"),
        ({"imu": "abc", "ts": 0.1}, "imu is"),
    ],
)
def test_a_matlab_file_without_them_is_refused(tmp_path, held, culprit):
    savemat(tmp_path / "a.mat", held)
    with pytest.raises(InputError, match=culprit):
        read(tmp_path / "a.mat")


def test_a_damaged_matlab_file_is_refused(foot, tmp_path):
    savemat(tmp_path / "a.mat", {"imu": np.column_stack([foot.accel, foot.gyro]), "ts": foot.t})
    whole = (tmp_path / "a.mat").read_bytes()
    for size in (10, 130, 200, 1000, len(whole) // 2):
        (tmp_path / "b.mat").write_bytes(whole[:size])
        with pytest.raises(InputError, match=r"b\.mat"):
            read(tmp_path / "b.mat")


@pytest.mark.parametrize(
    "name",
    ["gyro_x_furlong", "gyro_xy", "mag_x", "gyro", "accelerate_x", "accel_x_deg_s", "grax", "t_parsec"],
)
def test_a_name_that_says_something_else_is_no_channel(name):
    names = [*(f"{kind}_{axis}" for kind in ("gyr", "acc") for axis in AXES), name]
    (found,) = csv(Header(names))
    assert name not in found.columns.values()


# What loggers do


def block(foot, **changed):
    return Samples(
        0, changed.get("t", foot.t), changed.get("gyro", foot.gyro), changed.get("accel", foot.accel)
    )


def test_clean_samples_pass_bit_for_bit(foot):
    found, findings = condition(block(foot), "csv")
    for name in ("t", "gyro", "accel"):
        assert getattr(found, name).tobytes() == getattr(foot, name).tobytes()
    assert findings.sentences() == []


@given(st.data())
def test_doubled_rows_are_left_out(foot, data):
    rows = data.draw(st.lists(st.integers(1, len(foot.t) - 1), min_size=1, max_size=50, unique=True))
    twice = np.sort(np.concatenate([np.arange(len(foot.t)), rows]))
    found, findings = condition(block(foot).take(twice), "csv")
    assert findings.doubled == len(rows)
    assert found.gyro.tobytes() == foot.gyro.tobytes()


@given(st.data())
def test_lost_samples_are_filled_in_and_told(foot, data):
    lost = data.draw(st.lists(st.integers(2, len(foot.t) - 2), min_size=1, max_size=30, unique=True))
    kept = np.setdiff1d(np.arange(len(foot.t)), lost)
    found, findings = condition(block(foot).take(kept), "csv")
    assert findings.filled == len(lost)
    np.testing.assert_allclose(found.t, foot.t, atol=1e-9)
    np.testing.assert_array_equal(found.gyro[kept], foot.gyro[kept])
    between = np.interp(foot.t[lost], foot.t[kept], foot.gyro[kept, 1])
    np.testing.assert_allclose(found.gyro[lost, 1], between, atol=1e-9)


def test_a_long_hole_stays_for_dead_reckoning_to_refuse(foot):
    hole = (foot.t < 5.0) | (foot.t > 5.5)
    found, findings = condition(block(foot).take(hole), "csv")
    assert findings.filled == 0
    assert findings.longest_gap_s == pytest.approx(0.5, abs=0.02)
    assert np.diff(found.t).max() > 0.5


def test_jittering_stamps_of_a_steady_sampler_are_spaced_evenly(foot):
    rng = np.random.default_rng(3)
    found, findings = condition(block(foot, t=foot.t + rng.uniform(-0.4, 0.4, len(foot.t)) / RATE), "csv")
    assert findings.restamped
    assert np.abs(found.t - foot.t).max() < 0.1 / RATE
    # A rate that really changes is no jitter: those stamps are kept.
    slowing = foot.t + 0.3 * np.sin(foot.t / 2) + rng.uniform(-0.2, 0.2, len(foot.t)) / RATE
    found, findings = condition(block(foot, t=slowing), "csv")
    assert not findings.restamped
    np.testing.assert_array_equal(found.t, slowing)
    assert "were kept" in findings.sentences()[0]


def test_stamps_too_coarse_for_the_samples_are_spread(foot):
    found, findings = condition(block(foot, t=np.floor(foot.t * 100 + 1e-6) / 100), "csv")
    assert findings.doubled == 0
    np.testing.assert_allclose(found.t, foot.t, atol=1e-9)


@pytest.mark.parametrize(("share", "clipped"), [(1.01, False), (0.9, True), (0.5, True)])
def test_clipping_is_told_and_nothing_else_is_taken_for_it(foot, share, clipped):
    limit = share * np.abs(foot.gyro[:, 1]).max()
    gyro = foot.gyro.copy()
    gyro[:, 1] = np.clip(gyro[:, 1], -limit, limit)
    found, findings = condition(block(foot, gyro=gyro), "csv")
    assert [name for name, _ in findings.clipped] == (["gyro_y"] if clipped else [])
    np.testing.assert_array_equal(found.gyro[:, [0, 2]], foot.gyro[:, [0, 2]])
    if clipped:
        assert dict(findings.clipped)["gyro_y"] == np.count_nonzero(np.abs(gyro[:, 1]) == limit)
        # The peaks come back at least half as well as they are lost.
        lost, left = (np.abs(x[:, 1] - foot.gyro[:, 1]).sum() for x in (gyro, found.gyro))
        assert left < lost / 2
    else:
        np.testing.assert_array_equal(found.gyro, foot.gyro)


def test_rows_without_samples_are_left_out_and_a_lone_nan_is_a_lost_sample(foot):
    gyro, accel = foot.gyro.copy(), foot.accel.copy()
    gyro[50:60] = accel[50:60] = np.nan
    found, findings = condition(block(foot, gyro=gyro, accel=accel), "csv")
    assert findings.empty == findings.filled == 10
    assert len(found) == len(foot.t)
    gyro[500, 1] = np.nan
    found, findings = condition(block(foot, gyro=gyro, accel=accel), "csv")
    assert (findings.empty, findings.filled) == (10, 11)
    np.testing.assert_allclose(found.gyro[500, 1], foot.gyro[[499, 501], 1].mean(), atol=1e-12)


def test_samples_that_the_sensor_distrusts_are_left_out(foot, tmp_path):
    columns = named("inertial-7:estAngularRate{}", "inertial-7:estCompensatedAccel{}", "Time", si(foot))
    columns = {re.sub("[xyz]$", lambda m: m[0].upper(), name): values for name, values in columns.items()}
    valid = np.ones(len(foot.t))
    valid[700:703] = 0
    columns["inertial-7:estAngularRateY"] = np.where(valid == 0, 99.0, columns["inertial-7:estAngularRateY"])
    write_csv(tmp_path / "a.csv", columns | {"inertial-7:estAngularRateY:valid": valid})
    found, findings = read(tmp_path / "a.csv")
    assert findings.empty == findings.filled == 3
    assert np.abs(found.gyro).max() < 20


# Physics


def written(foot, tmp_path, gyro=None, accel=None, t=None):
    changed = Recording(
        t=foot.t if t is None else t,
        gyro=foot.gyro if gyro is None else gyro,
        accel=foot.accel if accel is None else accel,
    )
    write_recording(changed, tmp_path / "a.parquet")
    return tmp_path / "a.parquet"


FLIP = np.array([1.0, 1.0, -1.0])
REFUSED = [
    ({"gyro": lambda f: f.gyro / DEG}, "gyros.*probably in deg/s"),
    ({"gyro": lambda f: f.gyro * DEG}, "probably in rad/s, and were taken for deg/s"),
    ({"gyro": lambda f: -f.gyro}, "the other way about every axis"),
    ({"gyro": lambda f: f.gyro * [1, -1, 1]}, "gravity does not stay vertical"),
    ({"gyro": lambda f: f.gyro[:, [1, 0, 2]]}, "gravity does not stay vertical: the gyros' x and y"),
    ({"gyro": lambda f: np.ones_like(f.gyro)}, "the gyros say the same in every row"),
    ({"accel": lambda f: f.accel / GRAVITY}, "measure 1 at rest, expected 9.81 .*probably in g"),
    ({"accel": lambda f: f.accel / GRAVITY * 1000}, "probably in mg"),
    ({"accel": lambda f: f.accel - f.accel[:100].mean(axis=0)}, "gravity was probably removed"),
    ({"accel": lambda f: np.clip(f.accel, -0.5, 0.5)}, "measure"),
    ({"t": lambda f: f.t * 1000}, "5 s apart.* t is probably in ms"),
    ({"gyro": lambda f: np.clip(f.gyro, -2.0, 2.0)}, "at the end of its range in"),
]


@pytest.mark.parametrize(("change", "cause"), REFUSED, ids=[cause for _, cause in REFUSED])
def test_what_no_foot_can_measure_is_refused_with_its_cause(foot, tmp_path, change, cause):
    file = written(foot, tmp_path, **{name: make(foot) for name, make in change.items()})
    with pytest.raises(InputError, match=cause) as caught:
        read(file)
    assert str(caught.value).startswith(f"{file}: ")


@settings(max_examples=30)
@given(angles=st.tuples(*[st.floats(-np.pi, np.pi)] * 3), error=st.floats(-0.05, 0.05))
def test_a_right_recording_passes_however_it_is_mounted(tmp_path_factory, foot, angles, error):
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_euler("zyx", angles)
    file = written(
        foot,
        tmp_path_factory.getbasetemp(),
        gyro=turn.apply(foot.gyro.copy()) * (1 + error) + error / 5,
        accel=turn.apply(foot.accel.copy()) + error,
    )
    found, _ = read(file)
    assert len(found.t) == len(foot.t)


def test_a_sensor_at_rest_is_read_for_its_noise_alone(tmp_path):
    rng = np.random.default_rng(0)
    still = Recording(
        t=np.arange(2000) / 10.0,
        gyro=1e-3 * rng.standard_normal((2000, 3)),
        accel=[0, 0, GRAVITY] + 1e-2 * rng.standard_normal((2000, 3)),
    )
    write_recording(still, tmp_path / "a.parquet")
    assert len(read(tmp_path / "a.parquet", walk=False)[0].t) == 2000
    with pytest.raises(InputError, match="10 Hz, a walking foot needs"):
        read(tmp_path / "a.parquet")
