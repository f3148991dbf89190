"""Real feet: strides counted, footprints and ends met. Bounds are about twice what was measured."""

import numpy as np
import pytest

from benchmarks.validation._real import find
from footfall.formats import read
from footfall.hdr.methods import METHODS, Reckoning, tracks
from footfall.hdr.tracks import pdr_track
from footfall.pdr.reckoning import PdrParams, dead_reckon
from footfall.pdr.rest import still_time
from footfall.scenarios.judge.reference import score_footprints


@pytest.fixture(scope="module")
def real(real_data):
    """Recordings by name."""
    return {one.name: one for one in find(real_data)}


def reckoned(one):
    return dead_reckon(one.recording, PdrParams(bias_s=still_time(one.recording)))


def return_error(found):
    """Horizontal distance from end to start (m)."""
    return np.hypot(*(found.position[-1] - found.position[0])[:2])


@pytest.mark.parametrize(
    ("name", "format", "rate", "said"),
    [
        ("openshoe 31", "openshoe", 249.76, "cut short"),
        ("openshoe 44", "openshoe", 249.76, None),
        ("gdin 32", "sensorconnect", 200.0, None),
        ("gdin 45", "sensorconnect", 250.1, None),
        ("xio long", "xio", 398.6, "252 doubled rows.*308 lost samples"),
    ],
)
def test_real_files_are_recognised_and_their_flaws_told(real, name, format, rate, said):
    findings = real[name].findings
    assert findings.format == format
    assert findings.rate_hz == pytest.approx(rate, rel=1e-3)
    told = " ".join(findings.sentences())
    if said is None:
        assert told == ""
    else:
        assert all(part in told for part in said.split(".*"))


def test_openshoes_clock_is_its_computers_clock(real):
    """4.004 ms a sample by the sensor's timer; the recorder's own stamps say the same over a minute."""
    path = real["openshoe 44"].path
    stamps = np.loadtxt(path, skiprows=4, usecols=[10])
    t = read(path)[0].t
    assert t[-1] == pytest.approx(stamps[-1] - stamps[0], rel=4e-4)


@pytest.mark.parametrize(("name", "strides"), [("xio short", 16), ("xio long", 37)])
def test_xio_walks_return_to_their_start(real, name, strides):
    found = reckoned(real[name])
    assert len(found) - 1 == strides
    assert return_error(found) < 0.01 * found.distance.sum()


@pytest.mark.parametrize(("name", "strides"), [("openshoe 31", 50), ("openshoe 44", 44)])
def test_openshoe_figures_of_eight_close(real, name, strides):
    """The 50 strides at 5 km/h are the recorder's count, the 44 at 7 km/h are what was found."""
    found = reckoned(real[name])
    assert len(found) - 1 == strides
    assert found.distance.sum() == pytest.approx(78.0, rel=0.015)
    assert return_error(found) < 0.01 * found.distance.sum()


@pytest.mark.parametrize("name", ["gdin 32", "gdin 36", "gdin 45"])
def test_gdin_footprints_are_met(real, name):
    prints = real[name].footprints
    found = reckoned(real[name])
    assert len(found) == len(prints)  # one footfall a footprint
    assert np.abs(found.t - prints.t)[1:-1].max() < 0.5

    walked = np.hypot(*np.diff(prints.position, axis=0).T).sum()
    assert found.distance.sum() == pytest.approx(walked, rel=0.02)  # the paper: 1-2 % of the distance
    assert score_footprints(pdr_track(found), prints).footprint_rmse_m < 0.8


def test_every_method_runs_on_a_real_recording(real):
    recording = real["xio long"].recording
    found = tracks(Reckoning(recording, pdr=PdrParams(bias_s=still_time(recording))), METHODS)
    for track in found.values():
        assert np.isfinite(track.position).all()
        assert len(track) == 38


def test_the_command_line_tracks_them_all_without_a_word_from_us(real, cli, tmp_path):
    for number, one in enumerate(real.values()):
        code, out, err = cli(f"track {one.path} --method pdr -o {tmp_path}/{number}.parquet")
        assert (code, out) == (0, "")
        assert "static bias from the" in err
