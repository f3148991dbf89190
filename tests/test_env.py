"""The gymnasium environments keep gymnasium's rules."""

import pickle
import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import footfall  # noqa: F401 - registers the environments
from footfall.simulate.env import WalkVectorEnv


@pytest.fixture
def env():  # type: ignore[no-untyped-def]
    made = gym.make("footfall/Walk-v0")
    yield made
    made.close()


def test_check_env_finds_nothing(env: gym.Env) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped)


def test_seeded_resets_and_steps_repeat(env: gym.Env) -> None:
    def episode() -> np.ndarray:
        observations = [env.reset(seed=7)[0]]
        env.action_space.seed(3)
        for _ in range(20):
            observation, reward, *_ = env.step(0.1 * env.action_space.sample())
            observations.append(np.append(observation, reward))
        return np.concatenate(observations)

    np.testing.assert_array_equal(episode(), episode())


def test_falls_terminate_and_time_truncates(env: gym.Env) -> None:
    env.reset(seed=1)
    steps = 0
    while steps < 400:
        _, reward, terminated, truncated, info = env.step(np.ones(15, dtype=np.float32))
        assert isinstance(reward, float)
        assert isinstance(terminated, bool)
        steps += 1
        if terminated:
            break
    assert terminated
    assert not truncated
    assert steps * 0.03 < 10
    assert set(info) >= {"position", "yaw", "speed_command", "turn_command"}
    assert env.spec is not None
    assert env.spec.max_episode_steps == 333


def test_the_spec_pickles_and_closing_twice_is_fine(env: gym.Env) -> None:
    assert pickle.loads(pickle.dumps(env.spec)).id == "footfall/Walk-v0"
    env.close()
    env.close()


def test_gymnasium_makes_vector_environments() -> None:
    envs = gym.make_vec("footfall/Walk-v0", num_envs=3, vectorization_mode="sync")
    observation, _ = envs.reset(seed=1)
    assert observation.shape == (3, 82)
    envs.step(envs.action_space.sample())
    envs.close()


def test_the_threaded_vector_environment_resets_what_fell() -> None:
    made = gym.make_vec("footfall/Walk-v0", num_envs=6, vectorization_mode="vector_entry_point")
    envs = made.unwrapped
    assert isinstance(envs, WalkVectorEnv)
    envs.reset(seed=4)
    ended = 0
    for _ in range(120):
        observation, reward, terminated, truncated, info = envs.step(np.full((6, 15), 0.5))
        assert observation.shape == (6, 82)
        assert np.isfinite(reward).all()
        done = terminated | truncated
        ended += done.sum()
        if done.any():
            assert (info["_final_obs"] == done).all()
            assert not np.array_equal(info["final_obs"][done], observation[done])
    assert ended > 0
    envs.close()
    envs.close()
