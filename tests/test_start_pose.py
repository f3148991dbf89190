"""The start pose is the foot's at rest: what it does from there to its first footfall is navigated."""

import numpy as np
import pytest
from synthetic_foot import walk

from footfall.pdr.filtering import run_filter
from footfall.pdr.ins import FilterSettings, frozen
from footfall.pdr.pdr import PdrParams, StartPose, dead_reckon, detect
from footfall.pdr.stream import dead_reckon_blocks
from footfall.recording import Recording

DEG = np.pi / 180
STILL = 26.0
# Turns of the foot on the ground, all below the 60 deg/s of the detector: it calls the foot at rest.
PIVOTS = (10 * DEG, -10 * DEG, 0.0)


def blocks(recording):
    for part in np.split(np.arange(len(recording.t)), range(500, len(recording.t), 500)):
        yield Recording(recording.t[part], recording.gyro[part], recording.accel[part])


def batch(recording, start):
    return dead_reckon(recording, start=start)


def streamed(recording, start):
    return dead_reckon_blocks(blocks(recording), start=start)[0]


def stances(recording, start):
    return run_filter(recording, start=start).footfalls


def samples(recording, start):
    return run_filter(recording, frozen(FilterSettings(update="sample")), start=start).footfalls


def smoothed(recording, start):
    return run_filter(recording, start=start, smooth=True).footfalls


def pivoted(pivot, **more):
    """A walk whose foot turns by `pivot` before its first stride, and its pose at the end of T_bias."""
    truth = walk(np.linspace(0.4, 1.4, 9), still_s=STILL, rocking=0.0, pivot=pivot, **more)
    row = detect(truth.recording(), PdrParams()).rest.last
    heading = float(truth.heading(truth.t[[row]])[0])
    return truth, StartPose(tuple(truth.position[row]), heading)


@pytest.mark.parametrize("navigate", [batch, streamed, stances, samples, smoothed])
@pytest.mark.parametrize("pivot", PIVOTS)
def test_a_foot_that_turns_on_the_ground_has_turned_at_its_first_footfall(pivot, navigate):
    """The IMU moves by 1 cm in the turn, of which zero velocity on the way takes a part."""
    truth, start = pivoted(pivot)
    assert start.heading == pytest.approx(0.4 - pivot, abs=1e-6)
    found = navigate(truth.recording(), start)
    assert found.t[0] == pytest.approx(STILL, abs=0.3)
    error = np.abs(found.heading - truth.heading(found.t))
    off = np.linalg.norm(found.position - truth.position[truth.at(found.t)], axis=1)
    assert error[0] < 0.05 * DEG
    assert off[0] < 0.011
    # An update at every sample takes the end of the swing for rest too: its later rows are worth less.
    assert error.max() < (0.3 if navigate is samples else 0.05) * DEG
    assert off.max() < 0.011 or navigate is samples


def test_the_heading_is_as_uncertain_at_the_first_footfall_as_the_gyro_has_made_it():
    """Known at the rest, to `heading_sd`; from there on it grows, and the place with it."""
    truth, start = pivoted(0.0)
    recording = truth.recording()
    since = dead_reckon(recording).t[0] - 25.0
    for sd in (0.0, 2 * DEG):
        settings = frozen(FilterSettings(heading_sd=sd))
        noise = settings.gyro_noise * np.sqrt(since)
        for smooth in (False, True):
            first = run_filter(recording, settings, start=start, smooth=smooth).heading_sd[0]
            assert first == pytest.approx(np.hypot(sd, noise), rel=0.15)  # and by the tilt
