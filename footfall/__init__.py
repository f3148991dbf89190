"""Footfall: a physics-simulated gait testbed for pedestrian dead reckoning.

Data flows one way: scenario -> walk (truth) -> recording -> footfalls -> track -> score.
"""

__version__ = "0.1.0"
