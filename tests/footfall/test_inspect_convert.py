"""`footfall inspect` and `footfall convert`: what a recording holds, and the same in Footfall's own form."""

import io
import sys

import numpy as np
import pytest

from footfall.cli.app import main
from footfall.formats import read
from footfall.formats.inspect import bars, inspect
from footfall.recording import read_recording
from tests.footfall.test_text_tables import DEG, NAMES, foot, table
from tests.helpers.commands import expect_one_sentence, one_document

__all__ = ["foot"]


@pytest.fixture
def file(foot, tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(
        table(foot, ("Time (s)", "gx (deg/s)", "gy (deg/s)", "gz (deg/s)", *NAMES[4:]), size=(DEG, 1.0))
    )
    return path


def test_a_recording_is_looked_into(foot, file):
    found = inspect(file)
    assert (found.format, found.rows) == ("csv", len(foot.t))
    assert found.rate_hz == pytest.approx(200.0, abs=0.1)
    # Its noise is known: 2e-3 rad/s and 2e-2 m/s2 on each axis.
    assert found.gyro_noise_rad_s == pytest.approx(2e-3, rel=0.15)
    assert found.accel_noise_m_s2 == pytest.approx(2e-2, rel=0.15)
    assert found.rests[0][0] < 0.1
    assert found.rests[0][1] == pytest.approx(1.5, abs=0.2)
    assert found.refused == ""
    assert found.turning[:10].strip() == ""
    assert "█" in found.turning


@pytest.mark.parametrize("encoding", ["cp1252", "ascii", "utf-8"])
def test_a_file_or_pipe_of_another_encoding_gets_what_it_can_hold(file, encoding, monkeypatch):
    """As where standard output of Windows goes into a file."""
    with io.TextIOWrapper(io.BytesIO(), encoding=encoding) as out:
        monkeypatch.setattr(sys, "stdout", out)
        assert main(["inspect", str(file)]) == 0
        out.flush()
        lines = out.buffer.getvalue().decode(encoding).splitlines()
    (turns,) = [line for line in lines if line.startswith("turns")]
    assert ("█" if encoding == "utf-8" else "?") in turns


def test_the_command_shows_it(cli, file):
    code, out, _ = cli(f"inspect {file}")
    assert code == 0
    for told in ("gx (deg/s)", "its unit is stated", "200 Hz", "noise at rest", "turns  |"):
        assert told in out
    code, out, _ = cli(f"inspect {file} --json")
    assert one_document(out)["refused"] == ""


def test_what_would_be_refused_is_told(foot, file, cli):
    file.write_text(table(foot, ("t", "gx_rad_s", "gy_rad_s", "gz_rad_s", *NAMES[4:]), size=(-1.0, 1.0)))
    code, out, _ = cli(f"inspect {file}")
    assert code == 0
    assert "would be refused: turned by its gyros" in out


def test_a_file_that_is_not_understood_is_shown_all_the_same(foot, file, cli):
    file.write_text(table(foot, tuple("abcdefg")))
    code, out, err = cli(f"inspect {file}")
    sentence, _, more = err.partition("\n\n")
    expect_one_sentence(code, out, sentence + "\n", "column 'gyro_x' is missing")
    assert "taken for" in more


@pytest.mark.parametrize("ending", ["parquet", "csv"])
def test_a_converted_recording_is_the_same(cli, file, tmp_path, ending):
    code, _, err = cli(f"convert {file} -o {tmp_path}/b.{ending}")
    assert code == 0, err
    whole, _ = read(file)
    for found in (read_recording(tmp_path / f"b.{ending}"), read(tmp_path / f"b.{ending}")[0]):
        np.testing.assert_array_equal(found.t, whole.t)
        np.testing.assert_array_equal(found.gyro, whole.gyro)
        np.testing.assert_array_equal(found.accel, whole.accel)


def test_a_recording_is_not_overwritten_by_itself(cli, file):
    expect_one_sentence(*cli(f"convert {file} -o {file}"), "would overwrite what it is made from")
    expect_one_sentence(*cli(f"convert {file} -o b.txt"), "ends in .parquet or .csv")


def test_bars_stand_where_the_largest_is():
    t = np.arange(100) / 10.0
    size = np.zeros(100)
    size[55] = 3.0
    assert bars(t, size, 10) == "     █    "
