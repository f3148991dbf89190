"""Whatever makes strides not close is told by its own name, and a lag is put right."""

from dataclasses import replace

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.formats import diagnosis
from footfall.formats.closure import rests_of, strides_of
from footfall.formats.diagnosis import CHANGES, Fit, diagnose, told_lag, unlagged
from footfall.formats.options import Reading
from footfall.hdr.tracking import track
from footfall.recording import Recording
from tests.footfall.test_text_tables import NAMES, foot, table

__all__ = ["foot"]

AXES = np.eye(3)


def heard(recording, lag):
    """The gyros `lag` s after the accelerometers."""
    gyro = np.column_stack([np.interp(recording.t - lag, recording.t, axis) for axis in recording.gyro.T])
    return replace(recording, gyro=gyro)


def test_a_right_recording_closes(foot):
    found = diagnose(foot)
    assert found.misclosure < 0.01
    assert (found.cause, found.lag_s) == ("", 0.0)


@pytest.mark.parametrize("lag", [-0.1, -0.06, -0.03, -0.02, 0.02, 0.03, 0.06, 0.1])
def test_a_lag_is_told_to_milliseconds(foot, lag):
    found = diagnose(heard(foot, lag))
    assert found.lag_s == pytest.approx(lag, abs=0.002)
    late, other = ("gyros", "accelerometers")[:: 1 if lag > 0 else -1]
    assert found.cause == told_lag(found.lag_s)
    assert found.cause.startswith(f"the {late} are ")
    assert found.cause.endswith(f" ms later than the {other}")
    assert not found.swapped


def test_a_sensor_that_is_put_right_says_what_it_should(foot):
    mended = unlagged(heard(foot, 0.04), 0.04)
    inside = slice(20, -20)
    np.testing.assert_allclose(mended.gyro[inside], foot.gyro[: len(mended.t)][inside], atol=0.02)
    np.testing.assert_array_equal(mended.accel, foot.accel[: len(mended.t)])
    early = unlagged(heard(foot, -0.04), -0.04)
    np.testing.assert_array_equal(early.accel, foot.accel[-len(early.t) :])


@pytest.mark.parametrize("wrong", [0.5, 0.8, 0.9, 1.1, 1.25, 2.0])
def test_a_wrong_clock_is_told_with_the_right_rate(foot, wrong):
    """A wrong scale of the gyros looks the same."""
    for spoilt in (replace(foot, t=foot.t * wrong), replace(foot, gyro=foot.gyro * wrong)):
        found = diagnose(spoilt)
        rate = float(found.cause.partition("samples came at ")[2].partition(" Hz")[0])
        assert rate * spoilt.interval == pytest.approx(wrong, rel=0.02)
        times = float(found.cause.partition("the rates are ")[2].partition(" times")[0])
        assert times == pytest.approx(wrong, rel=0.02)
        assert "later" not in found.cause
        assert found.lag_s == 0.0


@pytest.mark.parametrize("cause", [name for name in CHANGES if " in " not in name])
def test_axes_that_are_turned_or_exchanged_are_told_as_what_they_are(foot, cause):
    """By doing it to the sensor that is named."""
    named = cause.split()[0] if "_" in cause else ""
    sensor = "accel" if "accel" in cause.partition(" probably ")[0] else "gyro"
    done = CHANGES[cause]
    if named:
        done = np.diag([-1.0 if named.endswith("xyz"[axis]) else 1.0 for axis in range(3)])
    elif sensor == "accel":
        done = -done
    elif "x, y, z" in cause:
        done = done.T
    values = getattr(foot, sensor) @ done.T
    found = diagnose(replace(foot, **{sensor: values}))
    assert (found.cause, found.swapped) == (cause, True)


def test_units_that_are_mistaken_are_told(foot):
    assert diagnose(replace(foot, gyro=np.degrees(foot.gyro))).cause == "the gyros are probably in deg/s"
    assert "taken for deg/s" in diagnose(replace(foot, gyro=np.radians(foot.gyro))).cause


def test_accelerometers_that_are_off_at_rest_are_told(foot):
    found = diagnose(replace(foot, accel=foot.accel * 0.93))
    assert found.cause == "the accelerometers are off: they measure 9.12 m/s2 at rest"
    assert not found.swapped


def test_clipped_samples_are_no_lag_and_no_clock(foot):
    assert diagnose(heard(foot, 0.04), clipped=True).cause == ""


def test_the_mirror_image_of_a_walk_closes_as_well(foot):
    """-f in place of f."""
    assert diagnose(replace(foot, accel=-foot.accel)).misclosure == pytest.approx(
        diagnose(foot).misclosure, abs=1e-6
    )


def test_a_bias_may_be_what_a_small_misfit_comes_from(foot):
    found = diagnose(replace(foot, accel=foot.accel + np.array([0.0, 0.0, 0.45])))
    assert found.cause == "" or found.cause.endswith("or a sensor is biased")


def written(path, foot, **how):
    path.write_text(table(foot, **how))
    return path


@pytest.mark.parametrize("lag", [-0.04, 0.04])
def test_a_lag_is_put_right_before_navigating(foot, tmp_path, lag):
    right = track(written(tmp_path / "a.csv", foot)).track
    found = track(written(tmp_path / "b.csv", heard(foot, lag)))
    (said,) = found.findings.sentences()
    assert said.endswith("ms later than the " + ("accelerometers" if lag > 0 else "gyros") + ": put right")
    assert not found.warnings
    assert found.track.meta["read"]["lag_s"] == pytest.approx(lag, abs=0.002)
    np.testing.assert_allclose(found.track.position[-1], right.position[-1], atol=0.05)


def test_a_wrong_clock_is_warned_of(foot, tmp_path):
    for wrong in (0.9, 1.1):
        found = track(written(tmp_path / "a.csv", replace(foot, t=wrong * foot.t)))
        (said,) = [one for one in found.warnings if "samples came at" in one]
        assert said.startswith("turned by its gyros, gravity does not stay vertical: probably ")


def test_what_no_lag_explains_is_refused_with_its_cause(foot, tmp_path):
    with pytest.raises(InputError, match="samples came at 200 Hz, not 100, or the rates are 2"):
        track(written(tmp_path / "a.csv", foot, names=NAMES), reading=Reading(rate_hz=100.0))


def test_a_long_recording_is_warned_of_its_lag(foot, tmp_path, monkeypatch):
    monkeypatch.setattr("footfall.formats.reader.WHOLE_ROWS", 1000)
    monkeypatch.setattr("footfall.hdr.tracking.WHOLE_ROWS", 1000)
    found = track(written(tmp_path / "a.csv", heard(foot, 0.04)))
    assert any("the gyros are 40 ms later" in said for said in found.warnings)
    assert found.findings.lag_s == 0.0


def test_few_strides_are_not_judged(foot):
    short = Recording(foot.t[:900], foot.gyro[:900], foot.accel[:900])
    assert diagnose(short) is None
    assert diagnosis.MISCLOSURE[0] < diagnosis.MISCLOSURE[1]


LATE = 0.04  # s, with which the recordings of the next tests are spoilt


def decided(monkeypatch, foot, lag=(LATE, 0.001), scale=(1.1, 0.001), late=LATE):
    """What is told where these are the best lag and the best scale, each with the rise that it leaves."""
    fits = Fit(*lag, 0.01), Fit(*scale, 0.01)
    monkeypatch.setattr(diagnosis, "_fits", lambda part, strides: fits)
    return diagnose(heard(foot, late))


def rise_of(recording):
    return Fit.of(0.0, recording, strides_of(recording, rests_of(recording))).rise


@pytest.mark.parametrize(("left", "both"), [(0.0017, True), (0.0018, False)])
def test_a_cause_is_named_alone_where_it_closes_half_as_much_again(foot, monkeypatch, left, both):
    assert ("samples came at" in decided(monkeypatch, foot, scale=(1.1, left)).cause) == both
    assert ("later than" in decided(monkeypatch, foot, lag=(LATE, left)).cause) == both


@pytest.mark.parametrize(("lag", "told"), [(0.0149, False), (0.0151, True), (-0.0151, True)])
def test_smaller_lags_are_not_told(foot, monkeypatch, lag, told):
    assert ("later than" in decided(monkeypatch, foot, lag=(lag, 0.001), scale=(1.1, 0.004)).cause) == told


@pytest.mark.parametrize(("scale", "told"), [(1.044, False), (1.046, True), (0.954, True)])
def test_clocks_that_are_nearly_right_are_not_told(foot, monkeypatch, scale, told):
    assert ("came at" in decided(monkeypatch, foot, lag=(LATE, 0.004), scale=(scale, 0.001)).cause) == told


def lag_with_rise(foot, low, high):
    lags = np.arange(0.008, 0.12, 0.0002)
    return next(lag for lag in lags if low < rise_of(heard(foot, lag)) < high)


def test_a_large_misfit_is_no_bias(foot, monkeypatch):
    for low, high, biased in ((0.027, 0.03, True), (0.03, 0.033, False)):
        found = decided(monkeypatch, foot, lag=(LATE, 0.004), late=lag_with_rise(foot, low, high))
        assert ("a sensor is biased" in found.cause) == biased
