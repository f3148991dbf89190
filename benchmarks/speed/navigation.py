"""How fast navigation is, beside plain Python in the same run: trust the ratios more than the times.

Processor time is told, so that a busy machine changes little.

python -m benchmarks.speed.navigation
"""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import product

import numpy as np

from footfall.conventions import GRAVITY
from footfall.hdr.hdr import HdrParams, headings, trace
from footfall.hdr.methods import Reckoning, tracks
from footfall.pdr import _kernels, _plain
from footfall.pdr.detectors import DETECTORS
from footfall.pdr.footfalls import Footfalls
from footfall.pdr.reckoning import PdrParams, dead_reckon, detect, level_attitude
from footfall.recording import Recording

RATE, STRIDE_S = 200, 1.1


def stepping(minutes: float) -> Recording:
    """25 s at rest, then bursts of motion and rest: the work of a walk, without its geometry."""
    t = np.arange(int((25 + 60 * minutes) * RATE)) / RATE
    phase = (t - 25) / STRIDE_S % 1
    swing = np.where((t > 25) & (phase > 0.3), np.sin(2 * np.pi * (phase - 0.3) / 0.7), 0.0)
    gyro = np.column_stack([0.3 * swing, 6.0 * swing, 0.2 * swing])
    accel = np.column_stack([15.0 * swing, 2.0 * swing, GRAVITY + 8.0 * swing])
    return Recording(t=t, gyro=gyro, accel=accel)


def random_walks(count: int, footfalls: int) -> list[Footfalls]:
    """Footfalls that sway and drift."""
    rng = np.random.default_rng(0)
    walks = []
    for _ in range(count):
        interval = rng.uniform(1.0, 1.2, footfalls)
        rate = rng.normal(0.002, 0.03, footfalls)
        interval[0] = rate[0] = 0.0
        zero = np.zeros((footfalls, 3))
        walks.append(
            Footfalls(np.cumsum(interval), interval, interval, rate, zero, np.cumsum(rate * interval))
        )
    return walks


def seconds(work: Callable[[], object], repeats: int = 5) -> float:
    """Least processor time of several runs; the first, which compiles, is not counted."""
    work()
    best = float("inf")
    for _ in range(repeats):
        start = time.process_time()
        work()
        best = min(best, time.process_time() - start)
    return best


def reckoning_shares(walk: Recording) -> None:
    """Print what detection and the rest of dead reckoning cost beside their kernel."""
    found = detect(walk, PdrParams())
    rest, resets = found.rest, found.stances.resets
    arguments = (walk.t, walk.gyro, walk.accel, rest.gyro_bias, level_attitude(rest.force), resets, 0.2)
    kernel = seconds(lambda: _kernels.reckon(*arguments), 15)
    shares = {
        "strapdown and ZUPT, compiled": kernel,
        "dead reckoning, stances known": seconds(lambda: dead_reckon(walk, found=found), 15),
        "dead reckoning, detection included": seconds(lambda: dead_reckon(walk), 15),
    }
    for name, detector in DETECTORS.items():
        params = PdrParams(detector=detector)
        shares[f"detection, {name}"] = seconds(lambda params=params: detect(walk, params))
    for name, spent in shares.items():
        print(f"{name:34} {spent / len(walk.t) * 1e9:8.1f} ns a sample, {spent / kernel:.2f} of the kernel's")


def main() -> None:
    """Print the table."""
    walk = stepping(20)
    whole = seconds(lambda: tracks(Reckoning(walk), ["pdr", "hdr"]))
    print(f"20 min at {RATE} Hz, PDR + HDR     {whole:8.3f} s  (target 1 s)")
    reckoning_shares(walk)

    # The kernel against its twin, on a minute of the walk.
    rows = slice(0, 85 * RATE)
    resets = np.arange(25 * RATE, 85 * RATE, int(STRIDE_S * RATE))
    level = np.array([1.0, 0.0, 0.0, 0.0])
    arguments = (walk.t[rows], walk.gyro[rows], walk.accel[rows], np.zeros(3), level, resets, 0.2)
    samples = resets[-1] - resets[0]
    compiled = seconds(lambda: _kernels.reckon(*arguments)) / samples
    plain = seconds(lambda: _plain.reckon(*arguments), 1) / samples
    print(f"strapdown, numpy {plain * 1e9:26.1f} ns a sample, {plain / compiled:.0f} times slower")

    walks = random_walks(20, 1100)
    sets = [
        HdrParams.from_degrees(tau_s=tau, i_c_deg_s=i_c, theta_w_deg_s=theta_w)
        for tau, i_c, theta_w in product((6.0, 8.0), np.linspace(0.002, 0.02, 10), np.linspace(0.1, 1.0, 10))
    ]
    footfalls = sum(len(one) - 1 for one in walks)
    batch = seconds(lambda: headings(walks, sets)) / (footfalls * len(sets))
    streamed = seconds(lambda: [trace(one, sets[0]) for one in walks], 1) / footfalls
    print(f"HDR, compiled batch            {batch * 1e9:8.1f} ns a walk x set x footfall (target 10)")
    print(f"HDR, streaming Python          {streamed * 1e9:8.1f} ns, {streamed / batch:.0f} times slower")


if __name__ == "__main__":
    main()
