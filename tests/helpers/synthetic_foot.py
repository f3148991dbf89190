"""A foot whose every truth is known (`footfall.pdr.synthetic`), and what dead reckoning would make of it."""

import numpy as np

from footfall.pdr.footfalls import Footfalls
from footfall.pdr.synthetic import SyntheticWalk, increments, walk

__all__ = ["SyntheticWalk", "footfalls", "increments", "walk"]


def footfalls(rate: np.ndarray, interval: np.ndarray | float = 1.1, speed: float = 1.4) -> Footfalls:
    """Footfalls of strides with these raw rates (rad/s), walked as dead reckoning would see them."""
    raw = np.concatenate([[0.0], rate])
    t_i = np.concatenate([[0.0], np.broadcast_to(interval, np.shape(rate))])
    heading = np.cumsum(raw * t_i)
    middle = heading - raw * t_i / 2
    steps = speed * t_i[:, None] * np.column_stack([np.cos(middle), np.sin(middle), np.zeros_like(raw)])
    return Footfalls(
        t=np.cumsum(t_i),
        interval=t_i,
        distance=speed * t_i,
        rate=raw,
        position=np.cumsum(steps, axis=0),
        heading=heading,
    )
