"""Compiled HDR for many parameter sets at once. Its plain twin is hdr.step; faces are in hdr.py.

No fast-math and the twin's order of operations: the controller takes the sign of a number that may be tiny.
numpy's error model, because Python's checks every division for zero, which keeps the loops from vectorising;
the faces refuse the zeros.
"""

from __future__ import annotations

import numpy as np

from footfall.compiled import kernel

BLOCK = 128  # points whose states stay in the first cache together


@kernel(error_model="numpy")
def filter_twice(raw, interval, tau):  # type: ignore[no-untyped-def]
    """w2 of HDR Eq. 6a-6b, (n,); row 0 is the start."""
    n = len(raw)
    twice = np.zeros(n)
    w1 = 0.0
    w2 = 0.0
    for i in range(1, n):
        w1 = (raw[i] * interval[i] + tau * w1) / (interval[i] + tau)
        w2 = (w1 * interval[i] + tau * w2) / (interval[i] + tau)
        twice[i] = w2
    return twice


@kernel(error_model="numpy")
def _controlled(twice, lag, before, star_before, integrator, i_c, theta_w):  # type: ignore[no-untyped-def]
    """Eq. 7-10 of one footfall: I, w, w* and the delagged rate."""
    attenuator = max(0.0, 1.0 - abs(before) / theta_w)
    sign = 1.0 if before > 0.0 else (-1.0 if before < 0.0 else 0.0)
    integrator = integrator - attenuator * sign * i_c
    now = twice + integrator
    star = now + lag * (now - before)
    return integrator, now, star, star + lag * (star - star_before)


@kernel(error_model="numpy")
def control(twice, interval, heading, tau, i_c, theta_w):  # type: ignore[no-untyped-def]
    """Headings (n, sets) of HDR Eq. 7-11 for parameter sets that share tau.

    The sets are the inner loop: neighbours in memory, independent of each other, so it vectorises.
    """
    n, sets = len(twice), len(i_c)
    psi = np.empty((n, sets))
    psi[0] = heading
    integrator, w, ws = np.zeros(sets), np.zeros(sets), np.zeros(sets)
    for i in range(1, n):
        lag = tau / interval[i]
        for j in range(sets):
            integrator[j], w[j], ws[j], delagged = _controlled(
                twice[i], lag, w[j], ws[j], integrator[j], i_c[j], theta_w[j]
            )
            psi[i, j] = psi[i - 1, j] + delagged * interval[i]
    return psi


@kernel(error_model="numpy")
def heading_errors(rest, causes, weights, interval, true, start, tau, i_c, theta_w):  # type: ignore[no-untyped-def]
    """Mean and final absolute heading error (points, 2) of HDR, each point with a raw rate of its own.

    The raw rate of footfall i at point j is rest[i] + sum over c of weights[c, j] causes[c, i]; true (n,) are
    the headings that are judged against, start is the first one of HDR. The rest is as in `control`.
    Block by block, so that a block's states stay in the first cache.
    """
    n, (parts, points) = len(rest), weights.shape
    out = np.empty((points, 2))
    for first in range(0, points, BLOCK):
        size = min(BLOCK, points - first)
        own = weights[:, first : first + size].copy()
        t, c, theta = tau[first : first + size], i_c[first : first + size], theta_w[first : first + size]
        raw, once, twice = np.zeros(size), np.zeros(size), np.zeros(size)
        integrator, w, ws = np.zeros(size), np.zeros(size), np.zeros(size)
        psi = np.full(size, start)
        total = np.full(size, abs(start - true[0]))
        for i in range(1, n):
            length = interval[i]
            raw[:] = rest[i]
            for k in range(parts):
                share = causes[k, i]
                for j in range(size):
                    raw[j] += own[k, j] * share
            for j in range(size):
                once[j] = (raw[j] * length + t[j] * once[j]) / (length + t[j])
                twice[j] = (once[j] * length + t[j] * twice[j]) / (length + t[j])
                integrator[j], w[j], ws[j], delagged = _controlled(
                    twice[j], t[j] / length, w[j], ws[j], integrator[j], c[j], theta[j]
                )
                psi[j] += delagged * length
                total[j] += abs(psi[j] - true[i])
        for j in range(size):
            out[first + j, 0] = total[j] / n
            out[first + j, 1] = abs(psi[j] - true[n - 1])
    return out
