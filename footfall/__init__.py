"""Footfall: a physics-simulated gait testbed for pedestrian dead reckoning.

Data flows one way: scenario -> walk (truth) -> recording -> footfalls -> track -> score.
"""

from gymnasium.envs.registration import register as _register

__version__ = "0.1.0"

# Strings only: nothing of the simulator is imported before an environment is made.
_register(
    id="footfall/Walk-v0",
    entry_point="footfall.scenarios.environment:walk_env",
    vector_entry_point="footfall.simulate.learn.env:WalkVectorEnv",
    max_episode_steps=333,
)
