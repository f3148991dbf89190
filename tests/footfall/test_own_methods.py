"""Methods of others and parameters by address on the command line of `track`."""

import re

import numpy as np
import pytest

from footfall.hdr.tracking import track
from footfall.recording import write_recording
from footfall.tables import read_table
from tests.helpers.synthetic_foot import walk

MINE = """
from dataclasses import dataclass
import numpy as np
from footfall import Track

@dataclass(frozen=True)
class Compass:
    '''The gyro alone.'''
    gain: float = 1.0

    def __call__(self, recording, start):
        t = recording.t[::100]
        return Track(t=t, position=np.zeros((len(t), 3)), heading=start.heading + self.gain * 0.01 * t)

def broken(recording, start):
    return recording.t[7.5]
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("own")
    write_recording(walk(np.repeat([0.0, 0.5], 9), still_s=6.0).recording(), folder / "rec.parquet")
    (folder / "nav.py").write_text(MINE)
    return folder


@pytest.fixture
def here(folder, monkeypatch):
    monkeypatch.chdir(folder)
    return folder


def test_a_method_of_a_file_makes_a_track(cli, here):
    code, out, _ = cli("track rec.parquet --method nav.py:Compass --heading 90 -o t.parquet")
    assert (code, out) == (0, "")
    columns, meta = read_table("t.parquet")
    np.testing.assert_allclose(columns["heading"], np.pi / 2 + 0.01 * columns["t"])
    assert (meta["method"], meta["use"], meta["params"]) == ("Compass", "nav.py:Compass", {"gain": 1.0})
    assert cli("track rec.parquet --method nav.py:Compass --set Compass.gain=3 -o u.parquet")[0] == 0
    assert read_table("u.parquet")[0]["heading"][-1] == pytest.approx(0.03 * columns["t"][-1])


def test_addresses_reach_every_stage_of_a_track(cli, here):
    def made(*settings):
        told = " ".join(f"--set {setting}" for setting in settings)
        assert cli(f"track rec.parquet --method hdr-filter {told} -o t.parquet")[0] == 0
        return read_table("t.parquet")

    _, plain = made()
    _, meta = made("pdr.bias_s=4", "pdr.detector=shoe", "pdr.detector.threshold=1e5", "filter.tilt_sd_deg=1")
    assert plain["pdr"]["bias_s"] != meta["pdr"]["bias_s"] == 4
    assert meta["pdr"]["detector"] == {"kind": "Shoe", **meta["pdr"]["detector"], "threshold": 1e5}
    assert meta["filter"]["tilt_sd"] == pytest.approx(np.radians(1))
    assert made("hdr-filter.gate_deg=9")[1]["params"]["gate"] == pytest.approx(np.radians(9))


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("--method nav.py:broken", r"rec\.parquet: nav\.py:broken: IndexError: .* \(nav\.py, line 16\)"),
        ("--method nav.py:Kompass", r"nav\.py: there is no 'Kompass' in it; did you mean Compass\?"),
        ("--method nav.py", r"nav\.py: say which of its names: nav\.py:NAME"),
        ("--method nav.py:Compass --set Compass.gian=1", r"Compass\.gian: unknown; did you mean gain\?"),
        ("--method hdr --set hdr.theta_w_deg_s=-1", r"hdr\.theta_w_deg_s = -1: expected a positive number"),
        ("--set pdr.tilt_gain=2", r"pdr\.tilt_gain = 2: expected a number, 0 to 1"),
        ("--set filter.tilt=2", r"filter\.tilt: unknown; did you mean tilt_sd_deg"),
        (
            "--set scenario.gait.pace_m_s=2",
            r"scenario\.gait\.pace_m_s: unknown area; expected one of pdr, filter, iez",
        ),
        ("--set pdr.detector=eyes", r"detector 'eyes' is unknown"),
        ("--set hdr.tau_s", r"--set hdr\.tau_s: expected ADDRESS=VALUE"),
    ],
)
def test_what_cannot_be_is_told_and_nothing_is_written(cli, here, line, sentence):
    code, out, err = cli(f"track rec.parquet {line} -o no.parquet")
    assert (code, out) == (2, "")
    assert re.match(f"footfall: {sentence}", err), err
    assert err.count("\n") == 1
    assert not (here / "no.parquet").exists()


def test_in_python_a_function_will_do(here):
    from footfall import Track

    def north(recording, start):
        return Track(t=recording.t[:2], position=np.zeros((2, 3)), heading=np.zeros(2))

    assert track("rec.parquet", north).track.meta["method"] == "north"


def test_footfalls_are_enough_for_a_recording_too_long_to_be_held(here, monkeypatch):
    from footfall import Track
    from footfall.hdr import tracking
    from footfall.hdr.methods import find_method

    def turned(footfalls, start):
        return Track(t=footfalls.t, position=footfalls.position, heading=footfalls.heading + 1)

    monkeypatch.setattr(tracking, "WHOLE_ROWS", 100)
    found = track("rec.parquet", find_method(turned, needs="footfalls"), bias_s=5.0)
    np.testing.assert_allclose(found.track.heading, track("rec.parquet", "pdr", bias_s=5.0).track.heading + 1)
