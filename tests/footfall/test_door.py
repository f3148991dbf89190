"""The shared recordings as people bring them: what is right of each, as their README says."""

import numpy as np
import pytest

from benchmarks.validation._real import find
from benchmarks.validation.real_recordings import TARGETS
from footfall.errors import InputError
from footfall.formats.options import Reading
from footfall.hdr.tracking import track
from footfall.scenarios.judge.reference import score_closure, score_footprints

HEADERLESS = Reading(columns=("ax", "ay", "az", "gx", "gy", "gz"), rate_hz=200.0)

# File -> how to read it; what is refused and why; or what is told, and by how much (m) the track may be off.
ALIKE = {
    "decimal_comma.csv": (Reading(), "", 0.01),
    "deg_per_sec.csv": (Reading(), "", 0.01),
    "euroc_imu0.csv": (Reading(), "", 0.01),
    "iso_time.csv": (Reading(), "", 0.01),
    "movella_dot.csv": (Reading(), "", 0.01),
    "units_in_second_line.csv": (Reading(), "", 0.01),
    "xsens_mt_manager.txt": (Reading(), "", 0.01),
    "headerless.txt": (HEADERLESS, "", 0.01),
    "no_time_200hz.csv": (Reading(rate_hz=200.0), "", 0.01),
    "one_empty_cell.csv": (Reading(), "1 lost samples filled in", 0.01),
    "spike_one_row.csv": (Reading(), "1 impossible rows left out", 0.01),
    "outer_join.csv": (Reading(), "the accelerometers speak at 100 Hz", 0.1),
    "held_4x.csv": (Reading(), "samples at 50 Hz were logged more often", 0.2),
    "zeros_150ms.csv": (Reading(), "30 rows of zeros in every channel: lost samples", 0.2),
}
REFUSED = {
    "dead_gyro_z.csv": (Reading(), "gyro_z says the same in every row"),
    "frozen_1s.csv": (Reading(), "no samples for 1 s after t = 8.*frozen"),
    "headerless.txt": (Reading(), "no line of names .*--columns"),
    "no_time_200hz.csv": (Reading(), r"no column of time.*--rate"),
    "two_sensors_interleaved.csv": (Reading(), "2 sensors by its column 'sensor', .*: 1, 2"),
}


@pytest.fixture(scope="module")
def door(real_data):
    return real_data / "door"


@pytest.fixture(scope="module")
def intact(door):
    return track(door / "intact.csv")


def test_the_intact_one_has_ten_strides_and_nothing_to_tell(intact):
    assert len(intact.track) == 11
    assert intact.findings.sentences() == list(intact.warnings) == []
    length = np.hypot(*np.diff(intact.track.position[:, :2], axis=0).T).sum()
    assert length == pytest.approx(12.0, abs=0.2)


@pytest.mark.parametrize("name", ALIKE)
def test_what_can_be_read_has_the_track_of_the_intact_one(door, intact, name):
    reading, told, off = ALIKE[name]
    found = track(door / name, reading=reading)
    np.testing.assert_allclose(found.track.position, intact.track.position, atol=off)
    said = " ".join(found.findings.sentences())
    assert told in said
    assert bool(told) == bool(said)


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_read_is_told_why(door, name):
    reading, why = REFUSED[name]
    with pytest.raises(InputError, match=why):
        track(door / name, reading=reading)


def test_one_of_two_sensors_is_navigated(door, intact):
    found = track(door / "two_sensors_interleaved.csv", reading=Reading(sensor="1")).track
    np.testing.assert_allclose(found.position, intact.track.position[: len(found)], atol=0.01)


def test_an_upright_axis_has_another_tell_the_heading(door, intact):
    found = track(door / "x_axis_up.csv")
    assert found.notes[-1] == "the IMU's x axis is upright: headings are those of its y axis"
    distances = [np.linalg.norm(one.track.position, axis=1) for one in (found, intact)]
    np.testing.assert_allclose(*distances, atol=0.01)


def test_a_hole_in_a_swing_is_told_as_doubtful(door):
    found = track(door / "hole_240ms_in_swing.csv")
    assert "0.24 s of a swing are lost after t = 10.14 s: that stride is doubtful" in " ".join(
        found.findings.sentences()
    )
    assert "1 strides are doubtful" in " ".join(found.warnings)
    np.testing.assert_array_equal(np.flatnonzero(found.track.evidence["doubtful"]), [6])


def test_a_short_rest_is_enough(door):
    found = track(door / "short_rest.csv")
    assert len(found.track) == 14
    assert not found.warnings


def test_every_stride_of_a_fast_walk_is_found(door):
    found = track(door / "fast_walk.csv")
    assert len(found.track) == 21
    assert not found.warnings


@pytest.mark.parametrize("rate", [250.0, 400.0])
def test_a_wrong_rate_is_warned_of(door, rate):
    told = " ".join(track(door / "no_time_200hz.csv", rate_hz=rate).warnings)
    assert float(told.partition("samples came at ")[2].partition(" Hz")[0]) == pytest.approx(200, rel=0.02)


def test_a_rate_with_which_legs_would_be_too_long_is_refused(door):
    with pytest.raises(InputError, match="the rate, the units or the axes are probably wrong"):
        track(door / "no_time_200hz.csv", rate_hz=150.0)


NAMES = ("openshoe 31", "openshoe 44", "gdin 32", "gdin 36", "gdin 45", "xio long", "xio short")


@pytest.mark.parametrize("name", NAMES)
def test_real_walks_meet_their_targets_with_the_defaults(real_data, name):
    """OpenShoe returns within .15 % of its way, gdin meets its footprints to .22 m, x-io returns to .16 m."""
    (real,) = [one for one in find(real_data) if one.name == name]
    found = track(real.path)
    assert not found.warnings
    closed, prints = score_closure(found.track), real.footprints
    if prints is not None:
        laid = score_footprints(found.track, prints)
        assert laid.matched == laid.footprints
        error = laid.footprint_rmse_m
    else:
        error = closed.return_error_pct if real.group == "openshoe" else closed.return_error_m
    assert TARGETS == {"openshoe": 0.15, "gdin": 0.22, "xio": 0.16}
    assert error <= TARGETS[real.group]
