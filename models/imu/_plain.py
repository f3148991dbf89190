"""The error effects in numpy and scipy, signal by signal: a second implementation that checks effects.py.

Written independently from the same equations, with the same streams of normal numbers.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from scipy.signal import butter, lfilter, sosfilt, sosfilt_zi

from footfall.models.imu.effects import FLICKER_SHARE, FLICKER_TIMES, Channel


def sensed(channel: Channel, without: Collection[str] = ()) -> np.ndarray:
    """What the triad measures, (n, 3)."""
    unit, spec = channel.unit, channel.unit.spec
    true, force, warmth = channel.true, channel.force, channel.warmth[:, None]
    rate = 1 / channel.interval

    def has(name: str, number: float = 1.0) -> bool:
        return name not in without and number > 0

    def drawn(name: str) -> np.ndarray:
        return channel.stream(name).standard_normal(true.shape)

    x = true.copy()
    if has("scale"):
        x = x + true * unit.scale
    if has("misalignment"):
        x = x + true @ unit.misalignment.T
    if has("non_linearity", spec.non_linearity_sigma):
        u = np.clip(true / spec.range, -1, 1)
        x = x + unit.non_linearity * spec.range * (4 * u**3 - 3 * u)
    if has("g_sensitivity"):
        x = x + force @ unit.g.T
    if has("g2"):
        x = x + force**2 @ unit.g2.T
    if has("temperature"):
        x = x + unit.temperature * warmth + unit.temperature2 * warmth**2
    if has("turn_on"):
        x = x + spec.turn_on_sigma * channel.stream("turn_on").standard_normal(3)
    if has("flicker", spec.flicker):
        for tau in FLICKER_TIMES:
            steps = channel.interval / tau
            drive = np.sqrt(-np.expm1(-2 * steps)) * (normals := drawn(f"flicker.{tau:g}"))
            drive[0] = normals[0]
            x = x + FLICKER_SHARE * spec.flicker * lfilter([1.0], [1.0, -np.exp(-steps)], drive, axis=0)
    if has("rate_random_walk", spec.random_walk):
        x = x + spec.random_walk * np.cumsum(drawn("rate_random_walk"), axis=0) / np.sqrt(rate)
    if has("bandwidth") and spec.bandwidth < rate / 2:
        sos = butter(2, spec.bandwidth, fs=rate, output="sos")
        x, _ = sosfilt(sos, x, axis=0, zi=sosfilt_zi(sos)[:, :, None] * x[0])
    if has("white", spec.white):
        x = x + spec.white * np.sqrt(rate) * drawn("white")
    if has("saturation"):
        x = np.clip(x, -spec.range, spec.range)
    if has("quantisation", spec.resolution):
        x = np.round(x / spec.resolution) * spec.resolution
    return x
