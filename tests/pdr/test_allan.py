"""Allan deviation, and the averaging time that it suggests."""

import math

import allantools
import numpy as np
import pytest

from footfall.errors import InputError
from footfall.models.imu import ROOM, ImuSpec, TriadSpec, draw_unit, load_spec
from footfall.models.imu.effects import Channel, sensed
from footfall.pdr.allan import AllanFit, allan_deviation, fit_allan, suggest_bias_time
from footfall.streams import stream


def at_rest(spec: ImuSpec, duration: float, interval: float, seed: int = 0) -> np.ndarray:
    """Gyro of a unit that lies still at room temperature."""
    n = round(duration / interval)
    zeros, warmth = np.zeros((n, 3)), np.full(n, ROOM.start - spec.thermal.reference)
    chan = Channel(
        draw_unit(spec, seed).gyro, zeros, zeros, warmth, interval, lambda name: stream(seed, name)
    )
    return sensed(chan)


def test_it_is_allantools_overlapping_deviation():
    x = np.cumsum(stream(0, "allan").standard_normal((5000, 2)), axis=0) + 40.0
    tau = np.array([0.02, 0.2, 1.0, 13.0, 50.0])
    ours = allan_deviation(x, 0.02, tau)
    assert ours.shape == (5, 2)
    for axis in range(2):
        used, theirs, _, _ = allantools.oadev(x[:, axis], rate=50.0, data_type="freq", taus=tau[:-1])
        np.testing.assert_allclose(used, tau[:-1])
        np.testing.assert_allclose(ours[:-1, axis], theirs, rtol=1e-9)
    np.testing.assert_allclose(allan_deviation(x[:, 0], 0.02, tau), ours[:, 0], rtol=1e-12)


def test_a_constant_rate_has_none_and_a_ramp_has_slope_tau_over_root_two():
    t = np.arange(1000) * 0.1
    assert allan_deviation(np.full(1000, 0.3), 0.1, [1.0]) == pytest.approx(0, abs=1e-15)
    np.testing.assert_allclose(
        allan_deviation(0.2 * t, 0.1, [0.1, 1.0, 20.0]),
        np.array([0.1, 1, 20]) * 0.2 / math.sqrt(2),
        rtol=1e-9,
    )


@pytest.mark.parametrize("tau", [0.01, 60.0])
def test_an_averaging_time_that_the_record_cannot_give_is_refused(tau):
    with pytest.raises(InputError, match=f"tau = {tau:g} s"):
        allan_deviation(np.zeros(1000), 0.1, [tau])


def test_the_nimu_wants_the_papers_25_seconds():
    """N / sqrt(T) = .664 B at 24.7 s. Over 20 seeds an hour's estimates lay between 21.9 and 29.0 s."""
    fits = [fit_allan(at_rest(load_spec("nimu"), 3600, 0.02, seed), 0.02) for seed in range(5)]
    assert np.median([fit.knee for fit in fits]) == pytest.approx(24.7, rel=0.15)
    assert np.median([fit.floor for fit in fits]) == pytest.approx(math.radians(53.1) / 3600, rel=0.15)
    assert np.median([fit.white for fit in fits]) == pytest.approx(math.radians(4.4) / 60, rel=0.02)


def test_pure_white_noise_is_averaged_as_long_as_the_record_allows():
    spec = ImuSpec("white", gyro=TriadSpec(white=1e-3))
    assert 0.5 * 100 < suggest_bias_time(at_rest(spec, 900, 0.01), 0.01) <= 100


def test_a_drifting_gyro_is_averaged_briefly():
    """White noise N against a random walk K: N^2 / T = K^2 T / 3."""
    n, k = 1e-3, 1e-4
    spec = ImuSpec("walk", gyro=TriadSpec(white=n, random_walk=k))
    assert suggest_bias_time(at_rest(spec, 3600, 0.02), 0.02) == pytest.approx(math.sqrt(3) * n / k, rel=0.2)


@pytest.mark.parametrize(
    ("fit", "knee"),
    [((2.0, 0.5, 0.0), 16.0), ((2.0, 0.0, 0.3), math.sqrt(3) * 2 / 0.3), ((2.0, 0.0, 0.0), 99.0),
     ((2.0, 0.1, 0.0), 99.0), ((2.0, 0.5, 0.3), None)],
)  # fmt: skip
def test_the_knee_is_where_white_noise_is_half_of_the_variance(fit, knee):
    found = AllanFit(*fit, longest=99.0).knee
    if knee is None:
        white, floor, walk = np.square(fit)
        assert white / found == pytest.approx(floor + walk * found / 3)
    else:
        assert found == pytest.approx(knee)


def test_what_tells_nothing_is_refused():
    with pytest.raises(InputError, match="10 s"):
        suggest_bias_time(np.zeros((100, 3)), 0.01)
    with pytest.raises(InputError, match="constant"):
        suggest_bias_time(np.zeros((10_000, 3)), 0.01)
