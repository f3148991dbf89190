"""The benchmark of real recordings, on recordings made here: what it prints is what it says."""

import json

import numpy as np
import pytest

from benchmarks.speed import long_recording
from benchmarks.validation import closing, real_recordings
from benchmarks.validation._real import find
from tests.helpers.commands import write_csv
from tests.helpers.synthetic_foot import walk

G, STRIDES = 9.80665, 8


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Eight strides straight ahead as x-io and SensorConnect would log them, the latter with footprints."""
    folder = tmp_path_factory.mktemp("data")
    truth = walk(np.zeros(STRIDES + 1), still_s=3.0)
    noise = np.random.default_rng(0).normal(0, 1e-3, (2, *truth.gyro.shape))
    gyro, accel = (truth.gyro + noise[0])[1:], (truth.accel + noise[1])[1:]
    t = truth.t[1:] - truth.t[1]
    for name in ("xio", "gdin"):
        (folder / name).mkdir()
    columns = {"Time (s)": t}
    columns |= {f"Gyroscope {a} (deg/s)": np.degrees(gyro[:, i]) for i, a in enumerate("XYZ")}
    write_csv(
        folder / "xio" / "long_walk.csv",
        columns | {f"Accelerometer {a} (g)": accel[:, i] / G for i, a in enumerate("XYZ")},
    )
    columns = {"Time": t} | {f"inertial-1:scaledGyro{a}": gyro[:, i] for i, a in enumerate("XYZ")}
    write_csv(
        folder / "gdin" / "SensorConnectData_32.csv",
        columns | {f"inertial-1:scaledAccel{a}": accel[:, i] / G for i, a in enumerate("XYZ")},
    )
    # Measured in another frame, turned by 90 degrees, z down, and one print 0.3 m off.
    place = 1.5 * np.arange(STRIDES + 1.0)
    stamps = np.concatenate([[3.0], truth.mid_stance[1:-1], t[-1:]])
    prints = {"strideIndex": np.arange(STRIDES + 1), "timestamp": stamps}
    off = np.where(np.arange(STRIDES + 1) == 4, 0.3, 0.0)
    write_csv(
        folder / "gdin" / "SensorConnectData_32_strideIndex_timestamp_gcpX_gcpY.csv",
        prints | {"gcpX": off + 2.0, "gcpY": -place},
    )
    return folder


def test_recordings_are_found_with_their_footprints(folder):
    gdin, xio = find(folder)
    assert (gdin.name, xio.name) == ("gdin 32", "xio long")
    assert xio.footprints is None
    np.testing.assert_allclose(gdin.footprints.position[:, 1], 1.5 * np.arange(STRIDES + 1))


def test_it_measures_prints_and_fills_its_page(folder, tmp_path, capsys, monkeypatch):
    kept = {name: real_recordings.METHODS[name] for name in ("pdr", "hdr", "iez")}
    monkeypatch.setattr(real_recordings, "METHODS", kept)
    few = {name: real_recordings.DETECTORS[name] for name in ("threshold", "shoe", "patient")}
    monkeypatch.setattr(real_recordings, "DETECTORS", few)
    page, figure, out = tmp_path / "page.md", tmp_path / "tracks.png", tmp_path / "out.json"
    marks = ("recordings", "targets", "methods", "detectors pdr", "detectors iez", "strides")
    marks += ("bias", "clipped", "drift")
    page.write_text("".join(f"# {mark}\n<!-- table {mark} -->\noutdated\n<!-- end -->\n" for mark in marks))
    monkeypatch.setattr(real_recordings, "STRIDES", {"xio long": STRIDES})
    arguments = ["--data", folder, "--page", page, "--figure", figure, "--json", out, "--units", 2]
    real_recordings.main([str(argument) for argument in arguments])
    text = page.read_text()
    assert "outdated" not in text
    assert all(f"# {mark}\n" in text for mark in marks)
    assert figure.stat().st_size > 10_000
    tracks = json.loads(out.read_text())["tracks"]
    by = {(one["recording"], one["detector"], one["method"]): one for one in tracks}
    assert by["xio long", "threshold", "pdr"]["strides_off"] == 0
    assert by["xio long", "threshold", "pdr"]["return_m"] == pytest.approx(1.5 * STRIDES, rel=0.01)
    # One of nine prints 0.3 m aside: the best fit leaves nearly all of it.
    assert by["gdin 32", "threshold", "pdr"]["rmse_m"] == pytest.approx(0.3 * np.sqrt(8) / 9, abs=0.01)
    assert "lost" not in text
    assert "Strides found less true" in capsys.readouterr().out


def test_how_strides_close_is_printed_and_fills_its_page(folder, tmp_path):
    page = tmp_path / "page.md"
    page.write_text("<!-- table mechanics -->\n<!-- end -->\n\n<!-- table late -->\n<!-- end -->\n")
    closing.main(["--data", str(folder), "--page", str(page)])
    rows = [line.strip("| ").split(" | ") for line in page.read_text().splitlines() if line.startswith("|")]
    told = {row[0]: row[1:] for row in rows}
    assert told["gyros 40 ms later"] == ["late 40 ms"] * 2
    assert told["stamps +10 %"] == ["rate 1.10"] * 2 or "either" in told["stamps +10 %"]
    assert told["-f"] == ["-", "-"]
    assert max(map(float, told["as they are"])) < 0.01
    assert min(map(float, told["the gyros probably turn the other way about every axis"])) > 0.1


def test_an_empty_folder_is_told(tmp_path):
    with pytest.raises(SystemExit, match="no recordings here"):
        real_recordings.main(["--data", str(tmp_path)])


@pytest.mark.parametrize("format", ["parquet", "csv"])
def test_a_long_recording_is_written_tracked_and_weighed(tmp_path, format):
    out = tmp_path / "long.json"
    long_recording.main(["--hours", "0.02", "--format", format, "--json", str(out)])
    headings, nothing, row = json.loads(out.read_text())["long_recordings"]
    told, bare = (dict(zip(headings, map(float, cells), strict=True)) for cells in (row, nothing))
    assert told["footfalls"] == told["strides"] + long_recording.BEGIN == 76
    assert told["rows"] > 0.02 * 3600 * long_recording.RATE
    assert told["MiB"] >= bare["MiB"] > 50
