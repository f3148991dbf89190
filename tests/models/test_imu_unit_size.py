"""Draws at unit size, scaled by the sheet: one seed is one individual. And the chain's plain twin."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import butter

from footfall.models.imu import EFFECTS, ImuSpec, TriadSpec, _kernels, _plain, draw_unit
from footfall.models.imu.effects import Channel, butterworth, sensed, stages
from footfall.streams import stream

N = 300
RNG = np.random.default_rng(8)
TRUE = RNG.normal(scale=2.0, size=(N, 3))
FORCE = RNG.normal([0, 0, 9.8], 5.0, size=(N, 3))
WARMTH = np.linspace(5, -20, N)
ZERO = np.zeros((N, 3))

NOISES = ("white", "flicker", "random_walk", "turn_on_sigma")
CONSTANTS = {
    "scale": "scale_sigma",
    "misalignment": "misalignment_sigma",
    "non_linearity": "non_linearity_sigma",
    "g": "g_sigma",
    "g2": "g2_sigma",
    "temperature": "temperature_sigma",
    "temperature2": "temperature2_sigma",
}
ALL = TriadSpec(
    range=4.0, bandwidth=30.0, resolution=0.01, white=0.01, flicker=0.1, random_walk=0.1, turn_on_sigma=0.3,
    scale_sigma=0.01, misalignment_sigma=0.02, non_linearity_sigma=0.01, g_sigma=0.01, g2_sigma=1e-3,
    temperature_sigma=0.01, temperature2_sigma=1e-3,
)  # fmt: skip

sizes = st.floats(1e-6, 1e3)
seeds = st.integers(0, 2**64)


def channel(spec: TriadSpec, seed: int = 7, true=TRUE, interval: float = 0.005, sensor="gyro") -> Channel:
    return Channel(
        unit=getattr(draw_unit(ImuSpec("x", gyro=spec, accel=spec), 7), sensor),
        true=true,
        force=FORCE,
        warmth=WARMTH,
        interval=interval,
        stream=lambda name: stream(seed, name),
    )


# One seed, one individual


@pytest.mark.parametrize("constant", CONSTANTS)
@given(seeds, sizes, sizes)
@settings(max_examples=20)
def test_a_constant_of_one_unit_differs_between_two_sheets_by_the_scale_alone(constant, seed, one, two):
    sheets = [ImuSpec("x", gyro=TriadSpec(range=1.0, **{CONSTANTS[constant]: size})) for size in (one, two)]
    first, second = (getattr(draw_unit(sheet, seed).gyro, constant) for sheet in sheets)
    assert first.any()
    np.testing.assert_allclose(first / one, second / two, rtol=1e-12)


@pytest.mark.parametrize("noise", NOISES)
@given(seeds, sizes, sizes)
@settings(max_examples=20)
def test_a_noise_of_one_seed_differs_between_two_sheets_by_the_scale_alone(noise, seed, one, two):
    first, second = (sensed(channel(TriadSpec(**{noise: size}), seed, ZERO)) for size in (one, two))
    assert first.any()
    # Six processes add up to flicker: where they cancel, rounding is of their size and not of their sum's.
    np.testing.assert_allclose(first / one, second / two, rtol=1e-12, atol=1e-14)


def test_half_the_angle_random_walk_is_half_that_noise_to_the_bit():
    """And leaves everything before it as it was."""
    half = dataclasses.replace(ALL, white=ALL.white / 2)
    whole, halved = (dict(stages(channel(spec))) for spec in (ALL, half))
    np.testing.assert_array_equal(whole["bandwidth"], halved["bandwidth"])
    noise = whole["white"] - whole["bandwidth"]
    np.testing.assert_allclose(halved["white"] - halved["bandwidth"], noise / 2, rtol=0, atol=1e-15)
    loud, quiet = (sensed(channel(TriadSpec(white=size), true=ZERO)) for size in (0.02, 0.01))
    np.testing.assert_array_equal(loud, 2 * quiet)


@given(st.sets(st.sampled_from(NOISES), min_size=1))
def test_any_subset_of_the_noises_is_the_sum_of_each_alone(names):
    together = sensed(channel(TriadSpec(**dict.fromkeys(names, 0.1)), true=ZERO))
    alone = sum(sensed(channel(TriadSpec(**{name: 0.1}), true=ZERO)) for name in names)
    np.testing.assert_allclose(together, alone, rtol=0, atol=1e-13)


def test_a_sheet_with_more_errors_draws_the_same_unit():
    bare = draw_unit(ImuSpec("bare", gyro=TriadSpec(g_sigma=0.1)), 7)
    full = draw_unit(ImuSpec("full", gyro=dataclasses.replace(ALL, g_sigma=0.2)), 7)
    np.testing.assert_allclose(2 * bare.gyro.g, full.gyro.g, rtol=1e-15)


# The normals


@pytest.mark.parametrize("name", ["white", "flicker.0.1", "rate_random_walk"])
def test_the_normals_are_numpys_bit_for_bit(name):
    drawn = np.zeros((100_000, 3))
    _kernels.add_noise(drawn, 1.0, 1.0, 0.0, 1.0, stream(3, name))
    np.testing.assert_array_equal(drawn, stream(3, name).standard_normal(drawn.shape))


def test_each_noise_has_a_stream_of_its_own():
    asked = []
    chan = channel(ALL)
    sensed(dataclasses.replace(chan, stream=lambda name: (asked.append(name), stream(0, name))[1]))
    assert asked == ["turn_on", *(f"flicker.{t}" for t in ("0.1", "1", "10", "100", "1000", "10000")),
                     "rate_random_walk", "white"]  # fmt: skip


# The twin


@pytest.mark.parametrize("sensor", ["gyro", "accel"])
@given(without=st.sets(st.sampled_from([name for name in EFFECTS if name != "quantisation"])))
@settings(max_examples=60)
def test_any_chain_is_what_numpy_and_scipy_say(sensor, without):
    chan = channel(ALL, sensor=sensor)
    without = {*without, "quantisation"}  # which would show a rounding error as a whole step
    np.testing.assert_allclose(sensed(chan, without), _plain.sensed(chan, without), rtol=0, atol=1e-13)


@pytest.mark.parametrize("sensor", ["gyro", "accel"])
def test_a_quantised_recording_is_the_twins_to_the_bit(sensor):
    chan = channel(ALL, sensor=sensor)
    np.testing.assert_array_equal(sensed(chan), _plain.sensed(chan))


@given(st.floats(1e-4, 0.4999))
def test_the_low_pass_is_scipys(cutoff):
    b, a = butter(2, cutoff, fs=1.0)
    np.testing.assert_allclose(butterworth(cutoff), [*b, *a[1:]], rtol=1e-9, atol=1e-12)


def test_the_low_pass_at_50_of_200_hz_is_known_in_closed_form():
    """tan(pi/4) = 1: gain 1 / (2 + sqrt 2), no first-order feedback."""
    gain = 1 / (2 + math.sqrt(2))
    expected = [gain, 2 * gain, gain, 0.0, (2 - math.sqrt(2)) * gain]
    np.testing.assert_allclose(butterworth(0.25), expected, rtol=0, atol=1e-15)


# What is whose


def test_the_last_stage_is_what_is_sensed_bit_for_bit():
    for without in ((), ("flicker", "saturation"), ("quantisation",), EFFECTS):
        chan = channel(ALL)
        assert list(stages(chan, without))[-1][1].tobytes() == sensed(chan, without).tobytes()


def test_truth_and_force_stay_as_they_were():
    true, force, warmth = TRUE.copy(), FORCE.copy(), WARMTH.copy()
    chan = channel(ALL)
    out = sensed(chan)
    for signal in (out, *(signal for _, signal in stages(chan) if signal is not chan.true)):
        assert not np.shares_memory(signal, TRUE)
    assert not np.shares_memory(sensed(chan, EFFECTS), TRUE)
    for before, after in ((true, TRUE), (force, FORCE), (warmth, WARMTH)):
        np.testing.assert_array_equal(before, after)


def test_stages_hand_out_arrays_that_stay_as_they_are():
    kept = [(signal, signal.copy()) for _, signal in stages(channel(ALL))]
    for signal, copy in kept:
        np.testing.assert_array_equal(signal, copy)
    untouched = dict(stages(channel(ALL, sensor="accel"), ("white",)))
    assert untouched["white"] is untouched["bandwidth"]
    assert untouched["saturation"] is not untouched["white"]
