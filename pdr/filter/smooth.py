"""Smoothing over a whole record: what the later updates say about the earlier states."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from footfall.pdr.filter.ins import InertialFilter


@dataclass(frozen=True)
class Node:
    """One update of the filter.

    Attributes
    ----------
    after : the filter after it
    before : (n, n) covariance before it
    transition : (n, n) from the node before to this one's `before`
    put_right : (n,) error that the update injected into the state
    """

    after: InertialFilter
    before: np.ndarray
    transition: np.ndarray
    put_right: np.ndarray

    @classmethod
    def first(cls, start: InertialFilter) -> Node:
        """The node that a smoothed stretch starts with."""
        n = start.settings.states
        return cls(start.snapshot(), start.covariance, np.eye(n), np.zeros(n))

    def with_also(self, put_right: np.ndarray, after: InertialFilter) -> Node:
        """The same node after one more update at the same instant."""
        return replace(self, after=after.snapshot(), put_right=self.put_right + put_right)


def smoothed(nodes: Sequence[Node]) -> list[InertialFilter]:
    """The filters of `nodes`, smoothed (Rauch, Tung, Striebel 1965).

    The filter puts every error right at once, so that the errors which it predicts are zero. What the next
    node says about this one is then what it put right itself, and what was said about it:

        s_k = C_k (put_right_k+1 + s_k+1),   C_k = P_k F' (P_k+1 before)^-1
        S_k = P_k + C_k (S_k+1 - P_k+1 before) C_k'

    States that were frozen have no variance: they are left out, not inverted.
    """
    found = [nodes[-1].after.snapshot()]
    error, covariance = np.zeros_like(nodes[-1].put_right), nodes[-1].after.covariance
    for node, later in zip(reversed(nodes[:-1]), reversed(nodes[1:]), strict=True):
        p, known = node.after.covariance, later.before
        live = np.flatnonzero(np.diag(known) > 0)
        # Scaled to unit variances: metres and rad/s differ by orders of magnitude.
        scale = np.sqrt(np.diag(known)[live])
        inner = known[np.ix_(live, live)] / np.outer(scale, scale)
        outer = (p @ later.transition.T)[:, live] / scale
        gain = np.zeros_like(p)
        gain[:, live] = np.linalg.lstsq(inner, outer.T, rcond=1e-13)[0].T / scale
        error = gain @ (later.put_right + error)
        covariance = p + gain @ (covariance - known) @ gain.T
        found.append(node.after.moved(error, covariance))
    return found[::-1]
