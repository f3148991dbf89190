"""Compiled HDR for many parameter sets at once. Its plain twin is hdr.step; faces are in hdr.py.

No fast-math and the twin's order of operations: the controller takes the sign of a number that may be tiny.
numpy's error model, because Python's checks every division for zero, which keeps the loops from vectorising;
the faces refuse the zeros.
"""

from __future__ import annotations

import numpy as np

from footfall.compiled import kernel


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
            before = w[j]
            attenuator = max(0.0, 1.0 - abs(before) / theta_w[j])
            sign = 1.0 if before > 0.0 else (-1.0 if before < 0.0 else 0.0)
            integrator[j] -= attenuator * sign * i_c[j]
            now = twice[i] + integrator[j]
            star = now + lag * (now - before)
            delagged = star + lag * (star - ws[j])
            psi[i, j] = psi[i - 1, j] + delagged * interval[i]
            w[j] = now
            ws[j] = star
    return psi
