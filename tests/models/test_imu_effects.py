"""Each error effect by itself, against its closed form."""

import dataclasses
import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import butter, sosfreqz

from footfall.errors import InputError
from footfall.models.imu import EFFECTS, ImuSpec, TriadSpec, draw_unit, load_spec
from footfall.models.imu.effects import Channel, sensed, stages
from footfall.streams import stream

N = 400
RNG = np.random.default_rng(5)
TRUE = RNG.normal(size=(N, 3))
FORCE = RNG.normal([0, 0, 9.8], size=(N, 3))
ALL = TriadSpec(
    range=3.0, bandwidth=50.0, resolution=0.01, white=0.01, flicker=0.1, random_walk=0.1, turn_on_sigma=0.3,
    scale_sigma=0.01, misalignment_sigma=0.01, non_linearity_sigma=0.01, g_sigma=0.01, g2_sigma=1e-3,
    temperature_sigma=0.01, temperature2_sigma=1e-3,
)  # fmt: skip


def channel(spec: TriadSpec, true=TRUE, force=FORCE, warmth=None, interval=0.005, seed=0) -> Channel:
    return Channel(
        unit=draw_unit(ImuSpec("x", gyro=spec), 1).gyro,
        true=true,
        force=force,
        warmth=np.linspace(5, -20, len(true)) if warmth is None else warmth,
        interval=interval,
        stream=lambda name: stream(seed, name),
    )


def final(chan: Channel, without=()) -> np.ndarray:
    return sensed(chan, without)


def test_the_effects_come_in_the_order_of_the_sensor():
    assert EFFECTS == (
        "scale", "misalignment", "non_linearity", "g_sensitivity", "g2", "temperature", "turn_on", "flicker",
        "rate_random_walk", "bandwidth", "white", "saturation", "quantisation",
    )  # fmt: skip
    assert tuple(name for name, _ in stages(channel(ALL))) == EFFECTS


@pytest.mark.parametrize("spec", [TriadSpec(), ALL])
def test_no_error_in_no_error_out_bit_for_bit(spec):
    true = TRUE.copy()
    true[0] = -0.0
    without = EFFECTS if spec is ALL else ()
    assert final(channel(spec, true), without).tobytes() == true.tobytes()


@pytest.mark.parametrize("sensor", ["gyro", "accel"])
def test_every_effect_of_the_nimu_reaches_the_output(sensor):
    """Twice as loud an input saturates too; each effect must change the signal that it is given."""
    unit = draw_unit(load_spec("nimu"), 0)
    chan = dataclasses.replace(channel(ALL, 400 * TRUE), unit=getattr(unit, sensor))
    previous, silent = chan.true, set()
    for name, signal in stages(chan):
        if np.array_equal(signal, previous):
            silent.add(name)
        previous = signal
    not_published = {"non_linearity"}
    assert silent == not_published | (set() if sensor == "gyro" else {"g_sensitivity"})


@pytest.mark.parametrize("off", EFFECTS)
def test_switching_one_effect_off_leaves_the_other_draws_alone(off):
    """The additive effects add the same with and without it (to rounding)."""
    additive = (*EFFECTS[: EFFECTS.index("bandwidth")], "white")

    def added(without):
        signals = [("", TRUE), *stages(channel(ALL), without)]
        return {name: after - before for (_, before), (name, after) in pairwise(signals)}

    full, less = added(()), added((off,))
    assert not less[off].any()
    for name in set(additive) - {off}:
        assert full[name].any()
        np.testing.assert_allclose(less[name], full[name], rtol=0, atol=1e-13)


def test_longer_records_begin_with_the_same_noise():
    spec = TriadSpec(white=1.0, flicker=1.0, random_walk=1.0, turn_on_sigma=1.0)
    short = channel(spec, TRUE[:100], FORCE[:100])
    np.testing.assert_array_equal(final(short), final(channel(spec))[:100])


def test_an_unknown_effect_is_refused():
    with pytest.raises(InputError, match=r"'noise'.*white"):
        list(stages(channel(ALL), ("noise",)))


def test_scale_and_misalignment_are_one_matrix():
    chan = channel(TriadSpec(scale_sigma=0.02, misalignment_sigma=0.03))
    matrix = np.eye(3) + np.diag(chan.unit.scale) + chan.unit.misalignment
    for row in (0, 17):
        np.testing.assert_allclose(final(chan)[row], matrix @ TRUE[row], rtol=0, atol=1e-14)


BENT = TriadSpec(range=40.0, non_linearity_sigma=0.002)


def bent(x) -> np.ndarray:
    """(n, 3) what non-linearity adds, as a share of the largest deviation, to the same input on each axis."""
    true = np.tile(np.asarray(x)[:, None], 3)
    chan = channel(BENT, true, np.zeros_like(true))
    signals = dict(stages(chan))
    return (signals["non_linearity"] - true) / (40.0 * chan.unit.non_linearity)


def test_non_linearity_is_chebyshevs_cubic_over_the_range():
    """T3(cos a) = cos 3a: nothing at rest, all of it at full scale, as much the other way at half."""
    angle = np.linspace(0, np.pi, N)
    found = bent(40 * np.cos(angle))
    np.testing.assert_allclose(found, np.tile(np.cos(3 * angle)[:, None], 3), rtol=0, atol=1e-9)
    at = bent([0.0, 40.0, -40.0, 20.0, -20.0])[:, 0]
    np.testing.assert_allclose(at, [0, 1, -1, -1, 1], rtol=0, atol=1e-9)
    assert np.abs(found).max() <= 1 + 1e-9


def test_no_straight_line_is_closer_to_it():
    """What a sheet calls non-linearity is the largest deviation from the best line: the scale has its own."""
    x = np.linspace(-40, 40, 2001)
    deviation = bent(x)[:, 0]
    for slope in (-0.1, -0.01, 0.01, 0.1):
        assert np.abs(deviation - slope * x / 40).max() > 1


def test_beyond_full_scale_it_grows_no_more_and_the_range_clips():
    np.testing.assert_allclose(bent([41.0, 4000.0, -41.0])[:, 0], [1, 1, -1], rtol=1e-6)
    wild = np.full((N, 3), 1e4)
    assert (final(channel(dataclasses.replace(BENT, non_linearity_sigma=0.1), wild)) == 40.0).all()


def test_each_axis_is_bent_in_its_own_way_and_hears_no_other():
    unit = channel(BENT).unit
    assert len(np.unique(unit.non_linearity)) == 3
    true = np.zeros((N, 3))
    true[:, 1] = 30.0
    added = final(channel(BENT, true)) - true
    assert (added[:, [0, 2]] == 0).all()
    assert added[0, 1] == pytest.approx(unit.non_linearity[1] * 40 * (4 * 0.75**3 - 3 * 0.75))


def test_a_non_linearity_needs_a_range():
    with pytest.raises(InputError, match=r"0\.001 of full scale, but no range"):
        TriadSpec(non_linearity_sigma=0.001)


def test_a_steady_force_makes_g_times_force():
    chan = channel(TriadSpec(g_sigma=0.01), np.zeros((N, 3)), np.tile([0.0, 0.0, 9.80665], (N, 1)))
    np.testing.assert_allclose(final(chan), np.tile(9.80665 * chan.unit.g[:, 2], (N, 1)), rtol=1e-14)


def test_g2_rectifies_vibration_of_zero_mean():
    """A sine of amplitude a along y leaves a mean of G2[:, y] a^2 / 2."""
    force = np.zeros((N, 3))
    force[:, 1] = 20 * np.sin(2 * np.pi * np.arange(N) / 40)
    chan = channel(TriadSpec(g2_sigma=1e-3), np.zeros((N, 3)), force)
    np.testing.assert_allclose(final(chan).mean(axis=0), chan.unit.g2[:, 1] * 200, rtol=1e-12)


def test_temperature_is_a_parabola_about_the_reference():
    chan = channel(TriadSpec(temperature_sigma=0.01, temperature2_sigma=0.001), np.zeros((N, 3)))
    fit = np.polynomial.polynomial.polyfit(chan.warmth, final(chan), 2)
    np.testing.assert_allclose(fit, [np.zeros(3), chan.unit.temperature, chan.unit.temperature2], atol=1e-12)


def test_the_turn_on_bias_is_one_constant_a_recording():
    spec = TriadSpec(turn_on_sigma=0.3)
    first, second = (final(channel(spec, np.zeros((N, 3)), seed=seed)) for seed in (0, 1))
    assert (first == first[0]).all()
    assert not np.isclose(first[0], second[0]).any()


def tone(frequency: float, rate: float, spec: TriadSpec) -> complex:
    """Gain of the sensor at one frequency, settled: 20 s, of which the last 10 are read."""
    t = np.arange(int(20 * rate)) / rate
    wave = np.column_stack([np.sin(2 * np.pi * frequency * t)] * 3)
    out = final(channel(spec, wave, np.zeros_like(wave), interval=1 / rate))[len(t) // 2 :, 0]
    carrier = np.exp(-2j * np.pi * frequency * t[len(t) // 2 :])
    return complex((out * carrier).sum() / (wave[len(t) // 2 :, 0] * carrier).sum())


@pytest.mark.parametrize("rate", [150.0, 200.0, 1000.0])
def test_the_bandwidth_is_3_db_down_at_its_frequency(rate):
    spec = TriadSpec(bandwidth=50.0)
    assert abs(tone(50.0, rate, spec)) == pytest.approx(math.sqrt(0.5), rel=1e-6)
    assert abs(tone(5.0, rate, spec)) == pytest.approx(1, rel=1e-3)
    _, response = sosfreqz(butter(2, 50.0, fs=rate, output="sos"), [30.0], fs=rate)
    assert tone(30.0, rate, spec) == pytest.approx(response[0], rel=1e-6)


def test_the_low_pass_delays_by_three_and_a_half_milliseconds_at_200_hz():
    ramp = np.column_stack([np.arange(N) * 0.005] * 3)
    delay = ramp - final(channel(TriadSpec(bandwidth=50.0), ramp))
    assert delay[-1] == pytest.approx(math.sqrt(2) / 400, rel=1e-9)  # sqrt(2) / (2 rate tan(pi f / rate))


def test_the_low_pass_starts_settled():
    still = np.tile([0.3, -0.1, 9.8], (N, 1))
    np.testing.assert_allclose(final(channel(TriadSpec(bandwidth=50.0), still)), still, rtol=1e-12)


def test_a_bandwidth_beyond_nyquist_cuts_nothing():
    assert final(channel(TriadSpec(bandwidth=100.0))).tobytes() == TRUE.tobytes()


@given(st.lists(st.floats(-1e3, 1e3), min_size=3, max_size=3), st.floats(0.1, 100))
def test_saturation_clips_and_leaves_the_rest(row, limit):
    x = np.array([row])
    out = final(channel(TriadSpec(range=limit), x, np.zeros((1, 3))))
    assert (np.abs(out) <= limit).all()
    inside = np.abs(x) <= limit
    np.testing.assert_array_equal(out[inside], x[inside])
    np.testing.assert_array_equal(np.sign(out), np.sign(x))


@given(st.lists(st.floats(-1e3, 1e3), min_size=3, max_size=3), st.floats(1e-4, 1.0))
def test_quantisation_rounds_to_the_nearest_step_once(row, step):
    x, zero = np.array([row]), np.zeros((1, 3))
    spec = TriadSpec(resolution=step)
    out = final(channel(spec, x, zero))
    assert (np.abs(out - x) <= step / 2 * (1 + 1e-9)).all()
    np.testing.assert_allclose(out / step, np.round(out / step), rtol=0, atol=1e-6)
    np.testing.assert_array_equal(final(channel(spec, out, zero)), out)
