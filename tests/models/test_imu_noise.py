"""Every noise term against its Allan deviation or its stationary law.

The bounds are statistical: an overlapping Allan variance with `edf` equivalent degrees of freedom (Greenhall,
from allantools) is the true one times chi2(edf) / edf. Seeds are fixed; the bounds are two-sided 1e-4.
"""

import math

import allantools
import numpy as np
import pytest
from numpy.typing import ArrayLike
from scipy.stats import chi2

from footfall.models.imu import ImuSpec, TriadSpec, draw_unit
from footfall.models.imu.effects import FLICKER_SHARE, FLICKER_TIMES, Channel, gauss_markov, sensed
from footfall.streams import stream

SLOPE = {"white": 0, "flicker": -1, "random_walk": -2}  # alpha of the power law of the rate's spectrum


def noise(n: int, interval: float, seed: int = 0, **spec: float) -> np.ndarray:
    """What a motionless triad says, (n, 3)."""
    zeros = np.zeros((n, 3))
    unit = draw_unit(ImuSpec("x", gyro=TriadSpec(**spec)), 0).gyro
    chan = Channel(unit, zeros, zeros, np.zeros(n), interval, lambda name: stream(seed, name))
    return sensed(chan)


def gauss_markov_variance(tau: np.ndarray, sigma: float, time: float) -> np.ndarray:
    """Allan variance of a first-order Gauss-Markov process (IEEE Std 952, annex C)."""
    x = tau / time
    return 2 * sigma**2 / x * (1 - (3 - 4 * np.exp(-x) + np.exp(-2 * x)) / (2 * x))


def flicker_variance(tau: np.ndarray, b: float) -> np.ndarray:
    return sum(gauss_markov_variance(tau, FLICKER_SHARE * b, time) for time in FLICKER_TIMES)


def sampled_variance(m: int, interval: float, sigma: float, time: float) -> float:
    """Allan variance of averages over m samples of a Gauss-Markov process, from its autocorrelation r^k."""
    r = math.exp(-interval / time)
    within = m * (1 + r) / (1 - r) - 2 * r * (1 - r**m) / (1 - r) ** 2
    between = r * (1 - r**m) ** 2 / (1 - r) ** 2
    return sigma**2 * (within - between) / m**2


def assert_allan(x: np.ndarray, interval: float, samples: list[int], expected: ArrayLike, alpha: int) -> None:
    """The mean Allan variance of the three axes lies where three independent estimates of `expected` may."""
    for m, truth in zip(samples, expected, strict=True):
        deviations = [
            allantools.oadev(axis, rate=1 / interval, data_type="freq", taus=[m * interval])[1][0]
            for axis in x.T
        ]
        edf = 3 * allantools.edf_greenhall(alpha, 2, m, len(x) + 1, overlapping=True)
        low, high = chi2.ppf([5e-5, 1 - 5e-5], edf) / edf
        assert low < np.mean(np.square(deviations)) / truth < high, f"tau = {m * interval:g} s"


def test_white_noise_falls_with_the_root_of_time():
    interval, density = 0.005, math.radians(4.4) / 60
    x = noise(400_000, interval, white=density)
    samples = [1, 10, 100, 1000, 10_000]
    assert_allan(x, interval, samples, density**2 / (np.array(samples) * interval), SLOPE["white"])


def test_rate_random_walk_rises_with_the_root_of_time():
    interval, k = 0.1, 0.02
    samples = [10, 100, 1000, 5000]
    tau = np.array(samples) * interval
    x = noise(100_000, interval, random_walk=k)
    # K sqrt(tau/3) of a continuous walk; a sampled one adds 1/(2 m^2), half a percent at the first point.
    expected = k**2 * tau / 3 * (1 + 0.5 / np.array(samples) ** 2)
    assert_allan(x, interval, samples, expected, SLOPE["random_walk"])


def test_flicker_is_flat_at_two_thirds_of_its_coefficient():
    interval, b = 0.1, math.radians(80) / 3600
    samples = [10, 30, 100, 300, 1000, 5000]
    x = noise(100_000, interval, flicker=b)
    # The fastest of the processes is as short as the sampling interval here: expect what samples of it show.
    expected = [
        sum(sampled_variance(m, interval, FLICKER_SHARE * b, time) for time in FLICKER_TIMES) for m in samples
    ]
    np.testing.assert_allclose(expected[2:], flicker_variance(np.array(samples[2:]) * interval, b), rtol=0.01)
    assert_allan(x, interval, samples, expected, SLOPE["flicker"])


def test_the_sum_of_gauss_markov_processes_is_a_flicker_floor():
    tau = np.geomspace(1, 3000, 300)
    np.testing.assert_allclose(np.sqrt(flicker_variance(tau, 1.0)), 0.664, rtol=0.03)


def test_one_gauss_markov_process_peaks_where_theory_says():
    tau = np.geomspace(0.1, 100, 100_001)
    deviation = np.sqrt(gauss_markov_variance(tau, 1.0, 1.0))
    assert deviation.max() == pytest.approx(0.618, abs=1e-3)
    assert tau[np.argmax(deviation)] == pytest.approx(1.89, abs=0.01)


@pytest.mark.parametrize("time", [0.1, 10.0, 1e4])
def test_gauss_markov_is_stationary_from_its_first_sample(time):
    """Over 3,999 processes the variance is the same at the start, in the middle and at the end."""
    n, runs, sigma = 60, 3999, 0.7
    x, generator = np.zeros((runs // 3, n, 3)), stream(0, f"gauss-markov {time}")
    for three in x:
        gauss_markov(three, sigma, time, 0.05, generator)
    x = np.concatenate(list(x), axis=1)
    low, high = sigma**2 * chi2.ppf([5e-5, 1 - 5e-5], runs) / runs
    for row in (0, n // 2, n - 1):
        assert low < np.mean(x[row] ** 2) < high
    # The correlation over k steps is exp(-k dt / time); its estimate scatters by 1 / sqrt(runs) at most.
    for k in (1, 20):
        correlation = np.corrcoef(x[10], x[10 + k])[0, 1]
        assert abs(correlation - math.exp(-k * 0.05 / time)) < 4 / math.sqrt(runs)


def test_the_turn_on_bias_scatters_from_recording_to_recording():
    biases = np.array([noise(2, 0.005, seed, turn_on_sigma=0.4)[0] for seed in range(300)])
    low, high = chi2.ppf([5e-5, 1 - 5e-5], biases.size)
    assert low < np.sum((biases / 0.4) ** 2) < high


def test_the_turn_on_bias_of_an_axis_says_nothing_of_another():
    biases = np.array([noise(2, 0.005, seed, turn_on_sigma=0.4)[0] for seed in range(300)])
    off = np.corrcoef(biases.T)[~np.eye(3, dtype=bool)]
    assert np.abs(off).max() < 4 / math.sqrt(len(biases))


def test_noises_of_three_axes_and_two_seeds_are_uncorrelated():
    for name in ("white", "flicker"):
        x = np.hstack([noise(20_000, 10.0, seed, **{name: 1.0}) for seed in (0, 1)])
        lag = np.diff(x, axis=0)  # takes out the slow parts, whose correlation is badly determined
        off = np.corrcoef(lag.T)[~np.eye(6, dtype=bool)]
        assert np.abs(off).max() < 5 / math.sqrt(len(lag))
