"""Every detector says how unquiet the foot is by its own formula, at any rate, on any mount, past any gap."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from footfall.conventions import GRAVITY
from footfall.errors import InputError
from footfall.pdr.detectors import (
    DETECTORS,
    Adaptive,
    AngularRateEnergy,
    Magnitude,
    MovingVariance,
    Patient,
    Shoe,
    require_detector,
    summary,
)
from footfall.pdr.stance import ThresholdDetector, find_stances
from tests.helpers.synthetic_foot import walk

STRIDES = 12
by_name = pytest.mark.parametrize("name", DETECTORS)


def still(n=200, rate=200.0):
    return np.arange(n) / rate, np.zeros((n, 3)), np.tile([0.0, 0.0, GRAVITY], (n, 1))


def test_shoe_is_dengs_equation_19_over_its_threshold():
    """A steady turn at 30 deg/s under 1.02 g: 0.2 m/s2 off gravity."""
    t, gyro, accel = still()
    shoe = Shoe(sigma_accel=0.02, sigma_gyro=0.01, threshold=1000.0)
    score = shoe(t, gyro + np.array([0.0, math.radians(30), 0.0]), 1.02 * accel)
    expected = ((0.02 * GRAVITY / 0.02) ** 2 + (math.radians(30) / 0.01) ** 2) / 1000.0
    np.testing.assert_allclose(score, expected, rtol=1e-6)


def test_the_others_are_mean_squares_over_their_limits():
    t, gyro, accel = still(n=2000, rate=2000.0)
    wave = np.sin(2 * np.pi * 100 * t)  # whole periods in every window
    shaken = accel + np.outer(wave, [0.0, 0.0, 3.0])
    inner = slice(500, 1500)
    are = AngularRateEnergy(rate_max=0.5)(t, gyro + np.array([0.3, 0.0, 0.4]), shaken)
    np.testing.assert_allclose(are, 1 - 1e-9, atol=2e-9)
    mv = MovingVariance(sd_max=5.0, window_s=0.0995)(t, gyro, shaken)
    np.testing.assert_allclose(mv[inner], 4.5 / 25, rtol=1e-3)
    mag = Magnitude(off_max=5.0, window_s=0.0995)(t, gyro, shaken)
    np.testing.assert_allclose(mag[inner], 4.5 / 25, rtol=1e-3)


def brute(t, gyro, accel, window, statistic):
    """Overlapping windows, sample by sample: the twin of the vectorised ones."""
    rows = [np.flatnonzero((t >= now - 1e-6) & (t <= now + window + 1e-6)) for now in t]
    value = np.array([statistic(gyro[r], accel[r]) for r in rows])
    value = np.where(np.isnan(value), np.inf, value)
    about = value[[np.flatnonzero(t >= now - window / 2 - 1e-6)[0] for now in t]]
    rest = np.array([any(value[i] < 1 for i, r in enumerate(rows) if k in r) for k in range(len(t))])
    return np.where(rest, np.minimum(about, math.nextafter(1, 0)), about)


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1), st.floats(0.004, 0.08), st.booleans())
def test_windows_overlap_whatever_the_stamps(seed, window, holes):
    rng = np.random.default_rng(seed)
    t = np.cumsum(rng.uniform(0.003, 0.01, 60) + 0.2 * (rng.random(60) < 0.05))
    gyro, accel = rng.normal(size=(60, 3)), rng.normal([0.0, 0.0, GRAVITY], 1.0, (60, 3))
    if holes:
        gyro[rng.integers(60), rng.integers(3)] = np.nan
        accel[rng.integers(60), 0] = np.inf
    cases = {
        AngularRateEnergy(1.7, window): lambda w, f: np.mean((w**2).sum(axis=1)) / 1.7**2 + 0 * f.sum(),
        MovingVariance(1.7, window): lambda w, f: f.var(axis=0).sum() / 1.7**2 + 0 * w.sum(),
        Magnitude(1.0, window): lambda w, f: (
            np.mean((np.linalg.norm(f, axis=1) - GRAVITY) ** 2) + 0 * w.sum()
        ),
        Shoe(1.0, 1.0, 6.0, window): lambda w, f: (
            np.mean(
                ((f - GRAVITY * f.mean(axis=0) / np.linalg.norm(f.mean(axis=0))) ** 2).sum(axis=1)
                + (w**2).sum(axis=1)
            )
            / 6
        ),
    }
    for detector, statistic in cases.items():
        with np.errstate(invalid="ignore"):
            expected = brute(t, gyro, accel, window, statistic)
        np.testing.assert_allclose(detector(t, gyro, accel), expected, rtol=1e-9, atol=1e-9)


def footfalls(truth, detector, rows=slice(1, None), gyro=None, accel=None):
    t = truth.t[rows]
    gyro = truth.gyro[rows] if gyro is None else gyro
    accel = truth.accel[rows] if accel is None else accel
    found = find_stances(t, detector(t, gyro, accel))
    return t[found.resets[found.footfalls]]


@by_name
@pytest.mark.parametrize("rate", [100.0, 400.0, 5000.0])
def test_one_footfall_a_stance_at_any_rate(name, rate):
    strides = STRIDES if rate < 1000 else 5
    truth = walk(np.zeros(strides + 1), still_s=2.0, rate=rate)
    found = footfalls(truth, DETECTORS[name])
    assert len(found) == strides + 1
    assert np.abs(found[1:-1] - truth.mid_stance[1:-1]).max() < 0.2


@by_name
def test_gaps_and_the_records_ends(name):
    """Samples lost at random and a quarter of a second in a swing; the record ends at full swing."""
    truth = walk(np.zeros(STRIDES + 1), still_s=2.0, tail_s=0.0)
    keep = np.random.default_rng(1).random(len(truth.t)) > 0.03
    swing = truth.mid_stance[5] + 0.5
    keep &= np.abs(truth.t - swing) > 0.12
    keep &= (truth.t > 0) & (truth.t < truth.mid_stance[-1] - 0.4)
    assert len(footfalls(truth, DETECTORS[name], keep)) == STRIDES


@by_name
def test_a_sample_that_is_no_number_moves_and_disturbs_its_window_only(name):
    truth = walk(np.zeros(STRIDES + 1), still_s=2.0)
    t, gyro, accel = truth.t[1:], truth.gyro[1:].copy(), truth.accel[1:].copy()
    clean = DETECTORS[name](t, gyro, accel)
    assert np.isfinite(clean).all()
    lost, burst = truth.at(truth.mid_stance[[3, 6]] + 0.55)  # in full swing
    gyro[lost, 1], accel[burst, 2] = np.nan, np.inf
    score = DETECTORS[name](t, gyro, accel)
    assert (score >= 0).all()  # and no NaN
    assert score[lost] == score[burst] == np.inf
    far = np.abs(np.arange(len(t)) - np.array([[lost], [burst]])).min(axis=0) > 50
    np.testing.assert_allclose(score[far], clean[far], rtol=0.1, atol=1e-9)  # the adaptive one's level
    assert len(footfalls(truth, DETECTORS[name], gyro=gyro, accel=accel)) == STRIDES + 1


@by_name
@settings(max_examples=10)
@given(turn=st.integers(0, 2**32 - 1))
def test_the_mount_does_not_matter(name, turn):
    truth = walk(np.zeros(4), still_s=1.0)
    t, gyro, accel = truth.t[1:], truth.gyro[1:], truth.accel[1:]
    mount = Rotation.random(rng=np.random.default_rng(turn))
    np.testing.assert_allclose(
        DETECTORS[name](t, mount.apply(gyro), mount.apply(accel)),
        DETECTORS[name](t, gyro, accel),
        rtol=1e-6,
        atol=1e-9,
    )


@pytest.mark.parametrize("period", [0.6, 0.8, 1.1, 1.6, 2.4])
def test_the_adaptive_detector_needs_no_setting_for_a_pace(period):
    """From a run's cadence to a stroll, the foot rolling through stance as fast as it walks."""
    rocking = math.radians(8) * 1.1 / period
    truth = walk(
        np.zeros(STRIDES + 1),
        still_s=2.0,
        period=period,
        stride=1.6 / period**0.5,
        rocking=rocking,
        rate=400.0,
    )
    assert len(footfalls(truth, Adaptive())) == STRIDES + 1


def test_the_adaptive_detector_follows_a_pace_that_changes():
    slow = walk(np.zeros(STRIDES + 1), still_s=2.0, period=2.0, rocking=math.radians(3))
    fast = walk(np.zeros(STRIDES + 1), still_s=2.0, period=0.7, rocking=math.radians(20))
    gyro, accel = (np.concatenate([getattr(x, key)[1:] for x in (slow, fast)]) for key in ("gyro", "accel"))
    t = np.concatenate([slow.t[1:], slow.t[-1] + fast.t[1:]])
    found = find_stances(t, Adaptive()(t, gyro, accel))
    # The stand in between is one footfall of both.
    assert len(found.footfalls) == 2 * STRIDES + 1


@by_name
def test_a_foot_that_only_stands_is_at_rest_throughout(name):
    rng = np.random.default_rng(0)
    t, gyro, accel = still(4000)
    noise = rng.standard_normal((2, 4000, 3))
    score = DETECTORS[name](t, gyro + 0.01 * noise[0], accel + 0.05 * noise[1])
    assert (score < 1).all()


def test_a_record_shorter_than_a_window_is_scored():
    t, gyro, accel = still(2)
    for detector in DETECTORS.values():
        assert (detector(t, gyro, accel) < 1).all()


def test_each_has_a_name_and_a_line_for_people():
    for name, detector in DETECTORS.items():
        assert require_detector(name) is detector
        assert 20 < len(summary(detector)) < 120
        if hasattr(detector, "window_s"):
            detector = replace(detector, window_s=0.03)  # type: ignore[type-var]
        assert detector(*still(50)).shape == (50,)
    with pytest.raises(InputError, match="detector 'glrt' is unknown, expected one of threshold, shoe"):
        require_detector("glrt")


def test_patience_changes_nothing_where_the_thresholds_find_every_stance():
    truth = walk(np.zeros(STRIDES + 1), still_s=2.0)
    samples = truth.t[1:], truth.gyro[1:], truth.accel[1:]
    np.testing.assert_array_equal(Patient()(*samples), ThresholdDetector()(*samples))


def test_patience_finds_the_stances_that_are_too_fast_for_the_thresholds():
    """Feet that never turn by less than 80 deg/s: the thresholds see none at rest but at the ends."""
    truth = walk(np.zeros(STRIDES + 1), still_s=2.0)
    t, gyro, accel = truth.t[1:], truth.gyro[1:].copy(), truth.accel[1:]
    gyro[(t > 2.0) & (t < t[-1] - 2.0), 0] += np.radians(80.0)
    found = [len(find_stances(t, one(t, gyro, accel)).footfalls) for one in (ThresholdDetector(), Patient())]
    assert found[0] < 4
    assert found[1] >= STRIDES
