"""What strangers' files did that was silent, or was told by a wrong name."""

import gzip
import io
import warnings
import zipfile

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.formats import read
from footfall.formats.clipping import clipped_runs
from footfall.hdr.tracking import track
from tests.footfall.test_text_tables import NAMES, foot, same, table

__all__ = ["foot"]

SCALED = {
    "rpm": (2 * np.pi / 60, "the gyros are probably in revolutions a minute"),
    "revolutions": (2 * np.pi, "the gyros are probably in revolutions a second"),
    "mdeg/s": (1e-3 * np.pi / 180, "they are probably in mdeg/s"),
    "mrad/s": (1e-3, "they are probably in mrad/s"),
}


@pytest.mark.parametrize("unit", SCALED)
def test_a_unit_of_the_gyros_is_told_by_its_name(foot, tmp_path, unit):
    size, why = SCALED[unit]
    (tmp_path / "a.csv").write_text(table(foot, size=(size, 1.0)))
    with pytest.raises(InputError, match=why):
        read(tmp_path / "a.csv")


@pytest.mark.parametrize(
    ("unit", "size"), [("g", GRAVITY), ("mg", GRAVITY / 1000), ("cm/s2", 0.01), ("mm/s2", 1e-3)]
)
def test_a_unit_of_the_accelerometers_is_the_nearest_one(foot, tmp_path, unit, size):
    (tmp_path / "a.csv").write_text(table(foot, size=(1.0, size)))
    findings = same(tmp_path / "a.csv", foot)
    assert findings.sentences() == [f"nothing states the accelerometers' unit: taken for {unit}"]


def test_raw_counts_are_told(foot, tmp_path):
    (tmp_path / "a.csv").write_text(table(foot, size=(1.0, GRAVITY / 2048)))
    with pytest.raises(InputError, match="probably the sensor's raw counts"):
        read(tmp_path / "a.csv")


@pytest.mark.parametrize(("unit", "size"), [("minutes", 60), ("hours", 3600), ("days", 86400)])
def test_stamps_in_a_long_unit_are_told(foot, tmp_path, unit, size):
    (tmp_path / "a.csv").write_text(table(foot, t=lambda s: f"{s / size:.12f}"))
    with pytest.raises(InputError, match=f"t is probably in {unit}"):
        read(tmp_path / "a.csv")


@pytest.mark.parametrize("column", range(1, 7))
def test_a_dead_axis_with_noise_is_told(foot, tmp_path, column):
    rng = np.random.default_rng(1)
    rows = [line.split(",") for line in table(foot).splitlines()]
    for row in rows[1:]:
        row[column] = f"{rng.normal(0, 0.003):.6f}"
    (tmp_path / "a.csv").write_text("\n".join(",".join(row) for row in rows))
    name = ("gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z")[column - 1]
    # Without the vertical there is no gravity.
    why = "accelerometers measure" if name == "accel_z" else f"{name} hardly says anything while"
    with pytest.raises(InputError, match=why):
        read(tmp_path / "a.csv")


def test_a_range_that_ends_in_noise_is_told(foot, tmp_path):
    noise = np.random.default_rng(2).normal(0, 0.002, foot.gyro.shape)
    limit = 0.9 * np.abs(foot.gyro[:, 1]).max()
    cut = np.clip(foot.gyro, -limit, limit) + noise
    (tmp_path / "a.csv").write_text(table(type(foot)(foot.t, cut, foot.accel)))
    _, findings = read(tmp_path / "a.csv")
    (found,) = findings.clipped
    assert found[0] == "gyro_y"
    assert found[1] == pytest.approx((np.abs(foot.gyro[:, 1]) > limit).sum(), rel=0.3)


def test_smooth_peaks_are_not_at_the_end_of_a_range():
    t = np.arange(4000) / 200
    for height in (20.0, 40.0):
        assert not len(clipped_runs(height * np.sin(2 * np.pi * t), 1 / 200, 15.0))
    held = np.clip(20 * np.sin(2 * np.pi * t), -18, 18) + np.random.default_rng(0).normal(0, 0.01, len(t))
    runs = clipped_runs(held, 1 / 200, 15.0)
    share = np.abs(np.sin(2 * np.pi * t)) >= 0.9
    assert np.diff(runs).sum() == pytest.approx(share.sum(), rel=0.1)
    assert not len(clipped_runs(held, 1 / 200, 30.0))


def test_lines_of_old_macs_are_read(foot, tmp_path):
    (tmp_path / "a.csv").write_bytes(table(foot).replace("\n", "\r").encode())
    same(tmp_path / "a.csv", foot)


@pytest.mark.parametrize("head", ["# " + "x" * 200_000 + "\n", "# more\n" * 20_000])
def test_a_long_preamble_is_passed(foot, tmp_path, head):
    (tmp_path / "a.csv").write_text(head + table(foot))
    same(tmp_path / "a.csv", foot)
    (tmp_path / "a.csv.gz").write_bytes(gzip.compress((head + table(foot)).encode()))
    same(tmp_path / "a.csv.gz", foot)


def zipped(**members):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return buffer.getvalue()


@pytest.mark.parametrize(
    ("content", "why"),
    [
        (gzip.compress(gzip.compress(b"t,gx\n")), "an archive within an archive"),
        (zipped(a=zipped(b=b"t,gx\n")), "an archive within an archive"),
        (zipped(), "an archive without files"),
        (np.random.default_rng(3).bytes(100_000), "no table of numbers"),
    ],
    ids=["gzip of gzip", "zip of zip", "empty zip", "noise"],  # the archives hold the time of day
)
def test_what_is_no_recording_is_told_as_what_it_is(tmp_path, content, why):
    (tmp_path / "a.csv").write_bytes(content)
    with pytest.raises(InputError, match=why):
        read(tmp_path / "a.csv")


def test_a_damaged_log_prints_nothing(tmp_path, capsys):
    pytest.importorskip("pyulog")
    (tmp_path / "a.ulg").write_bytes(b"ULog\x01\x12\x35" + np.random.default_rng(4).bytes(20_000))
    with pytest.raises(InputError, match="not a readable ULog"):
        read(tmp_path / "a.ulg")
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("column", [0, 2, 5])
def test_numbers_beyond_all_bounds_are_lost_samples_without_a_warning_of_numpys(foot, tmp_path, column):
    rows = [line.split(",") for line in table(foot).splitlines()]
    rows[900][column] = "1e400"
    rows[1200][column] = "-1e300"
    (tmp_path / "a.csv").write_text("\n".join(",".join(row) for row in rows))
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        found = track(tmp_path / "a.csv")
    assert "lost samples filled in" in " ".join(found.findings.sentences())
    assert len(found.track) == 9
    assert len(NAMES) == 7


def test_gyros_that_drift_from_rest_to_rest_are_warned_of(foot, tmp_path):
    drift = np.radians(3.0) * foot.t[:, None] / foot.t[-1]
    still = 4 * 200
    end = [np.tile(values[-1:], (still, 1)) for values in (foot.gyro + drift, foot.accel)]
    noise = np.random.default_rng(5).normal(0, 2e-3, end[0].shape)
    whole = type(foot)(
        np.arange(len(foot.t) + still) / 200,
        np.vstack([foot.gyro + drift, end[0] + noise]),
        np.vstack([foot.accel, end[1] + noise]),
    )
    (tmp_path / "a.csv").write_text(table(whole))
    told = " ".join(track(tmp_path / "a.csv").warnings)
    assert "bias changes by" in told
    assert "deg/s between rests" in told


@pytest.mark.parametrize("column", [2, 4])
def test_an_axis_that_is_stuck_for_a_fifth_of_a_second_is_lost(foot, tmp_path, column):
    turning = np.linalg.norm(foot.gyro, axis=1) > 1.5
    first = next(i for i in range(1000, 2000) if turning[i : i + 40].all())
    rows = [line.split(",") for line in table(foot).splitlines()]
    for row in rows[first + 1 : first + 41]:
        row[column] = rows[first + 1][column]
    (tmp_path / "a.csv").write_text("\n".join(",".join(row) for row in rows))
    _, findings = read(tmp_path / "a.csv")
    name = {2: "gyro_y", 4: "accel_x"}[column]
    assert f"{name} stays as it is for 39 rows while the foot moves" in " ".join(findings.sentences())


def held(foot, **changed):
    values = dict(zip(NAMES, [foot.t, *foot.gyro.T, *foot.accel.T], strict=True))
    return values | changed


TYPES = {
    "text": lambda t: pa.array([f"2024-05-01T12:00:{s:09.6f}" for s in t]),
    "durations": lambda t: pa.array(np.round(1e9 * t).astype(np.int64), pa.duration("ns")),
    "milliseconds": lambda t: pa.array(np.round(1e3 * t).astype(np.int64), pa.timestamp("ms", "UTC")),
    "decimals": lambda t: pa.array([f"{s:.4f}" for s in t]).cast(pa.decimal128(12, 4)),
}


@pytest.mark.parametrize("kind", TYPES)
def test_stamps_of_any_type_in_parquet(foot, tmp_path, kind):
    pq.write_table(pa.table(held(foot, t=TYPES[kind](foot.t))), tmp_path / "a.parquet")
    same(tmp_path / "a.parquet", foot)


def test_the_index_of_a_data_frame_is_its_time(foot, tmp_path):
    pd = pytest.importorskip("pandas")
    values = held(foot)
    index = pd.to_datetime(values.pop("t"), unit="s")
    pd.DataFrame(values).set_index(index).to_parquet(tmp_path / "a.parquet")
    same(tmp_path / "a.parquet", foot)


def test_gyros_in_the_place_of_accelerometers_are_told(foot, tmp_path):
    (tmp_path / "a.csv").write_text(table(foot, (*NAMES[:1], *NAMES[4:], *NAMES[1:4])))
    with pytest.raises(InputError, match="gyros and accelerometers are probably exchanged"):
        read(tmp_path / "a.csv")


def test_a_feather_is_told_as_one(tmp_path):
    (tmp_path / "a.feather").write_bytes(b"ARROW1\x00\x00" + bytes(100))
    with pytest.raises(InputError, match="an Arrow or Feather file, expected CSV or Parquet"):
        read(tmp_path / "a.feather")


def test_hdf5_that_lies_across(foot, tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        group = file.create_group("Sensors/1")
        group["Time"] = (1e6 * foot.t).round().astype(np.uint64)
        group["Accelerometer"], group["Gyroscope"] = foot.accel.T, foot.gyro.T
    same(tmp_path / "a.h5", foot)
