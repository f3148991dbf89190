"""The gymnasium environments keep gymnasium's rules, follow a scenario's path, and can be looked at."""

import pickle
import re
import warnings
from dataclasses import replace
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import footfall
from footfall.errors import InputError
from footfall.models.policy import stock_policy
from footfall.models.subject import SUBJECTS, Subject
from footfall.scenarios.scenario import load_scenario
from footfall.simulate.learn.env import Difficulty, WalkVectorEnv
from footfall.simulate.learn.reward import WEIGHTS
from footfall.simulate.plan import Plan
from footfall.simulate.walker.observation import LAYOUT, N_OBSERVATION
from footfall.simulate.walker.walkers import N_ACTION
from tests.helpers.places import DOCS

ID = "footfall/Walk-v0"
STILL = np.zeros(N_ACTION, dtype=np.float32)


@pytest.fixture
def env():  # type: ignore[no-untyped-def]
    made = gym.make(ID)
    yield made
    made.close()


@pytest.fixture(scope="module")
def can_draw() -> bool:
    """Whether this machine has a screen or EGL."""
    made = gym.make(ID, render_mode="rgb_array")
    made.reset(seed=1)
    try:
        return made.render() is not None
    except InputError:
        return False
    finally:
        made.close()


@pytest.mark.parametrize("settings", [{}, {"scenario": "turning", "subject": "drawn"}])
def test_check_env_finds_nothing(settings: dict, can_draw: bool) -> None:
    made = gym.make(ID, **settings)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(made.unwrapped, skip_render_check=not can_draw)
    made.close()


@pytest.mark.parametrize("options", [None, {"scenario": "turning", "subject": "drawn"}])
def test_seeded_resets_and_steps_repeat(env: gym.Env, options: dict | None) -> None:
    def episode(seed: int) -> np.ndarray:
        observations = [env.reset(seed=seed, options=options)[0]]
        env.action_space.seed(3)
        for _ in range(40):
            observation, reward, *_ = env.step(0.1 * env.action_space.sample())
            observations.append(np.append(observation, reward))
        return np.concatenate(observations)

    np.testing.assert_array_equal(episode(7), episode(7))
    assert not np.array_equal(episode(7), episode(8))


def test_falls_terminate_and_time_truncates(env: gym.Env) -> None:
    env.reset(seed=1)
    steps = 0
    while steps < 400:
        _, reward, terminated, truncated, info = env.step(np.ones(N_ACTION, dtype=np.float32))
        assert isinstance(reward, float)
        assert isinstance(terminated, bool)
        steps += 1
        if terminated:
            break
    assert terminated
    assert not truncated
    assert steps * 0.03 < 10
    assert set(info) >= {"position", "yaw", "speed_command", "turn_command", "progress"}
    assert env.spec is not None
    assert env.spec.max_episode_steps == 333


def test_the_reward_is_the_weighted_sum_of_its_terms(env: gym.Env) -> None:
    env.reset(seed=2)
    _, reward, _, _, info = env.step(STILL)
    assert reward == pytest.approx(sum(WEIGHTS[name] * value for name, value in info["terms"].items()))


def test_the_spec_pickles_and_closing_twice_is_fine(env: gym.Env) -> None:
    assert pickle.loads(pickle.dumps(env.spec)).id == ID
    env.reset(seed=1)
    env.close()
    env.close()


# Scenarios and subjects


@pytest.mark.parametrize("where", ["name", "file", "plan"])
def test_it_starts_standing_where_the_scenarios_path_starts(
    env: gym.Env, where: str, short_plan: Plan, tmp_path: Path
) -> None:
    moved = replace(short_plan, route=replace(short_plan.route, x=short_plan.route.x + 5))
    stock = Path(footfall.__file__).parent / "scenarios" / "stock" / "turning.toml"
    (tmp_path / "mine.toml").write_text(stock.read_text())
    asked = {"name": "turning", "file": tmp_path / "mine.toml", "plan": moved}[where]
    _, info = env.reset(seed=1, options={"scenario": asked})
    start = moved.route if where == "plan" else load_scenario("turning").path.route
    np.testing.assert_allclose(info["position"][:2], [start.x[0], start.y[0]], atol=0.01)
    assert info["position"][2] == pytest.approx(0.95, abs=0.1)
    assert (info["progress"], info["arrived"]) == (0.0, False)
    observation, *_, info = env.step(STILL)
    assert observation[LAYOUT["gate"]].tolist() == [2.0, 1.0]
    assert info["speed_command"] == 0.0


def test_it_walks_a_path_to_its_end_and_stands_there(short_plan: Plan) -> None:
    """The shipped policy drives it round a corner, pursuing the path; the end truncates."""
    env, policy, route = gym.make(ID, max_episode_steps=4000), stock_policy(), short_plan.route
    observation, _ = env.reset(seed=3, options={"scenario": short_plan})
    ended = truncated = False
    places, progress = [], []
    while not (ended or truncated):
        action = np.clip(policy(observation[None])[0], -1, 1).astype(np.float32)
        observation, _, ended, truncated, info = env.step(action)
        places.append(info["position"][:2])
        progress.append(info["progress"])
    env.close()
    assert truncated
    assert info["arrived"]
    assert info["speed_command"] == pytest.approx(0, abs=0.05)
    assert np.all(np.diff(progress) >= 0)
    assert progress[-1] == pytest.approx(route.length, abs=1.0)
    line = np.column_stack([route.x, route.y])
    assert max(np.linalg.norm(line - place, axis=1).min() for place in places[::20]) < 0.6


def test_terrain_is_the_scenarios() -> None:
    """On a slope the grade is observed, and the walker stands on the ground's height."""
    env, plan = gym.make(ID), load_scenario("closed-loop").plan(0)
    route = plan.route
    uphill = int(np.argmax(np.gradient(route.z, route.s)))
    rows = slice(uphill, uphill + 200)
    names = ("s", "x", "y", "z", "heading", "curvature")
    columns = {name: getattr(route, name)[rows] for name in names}
    columns["s"] = columns["s"] - columns["s"][0]
    climbing = replace(plan, route=type(route)(**columns))
    observation, info = env.reset(seed=1, options={"scenario": climbing})
    env.close()
    assert info["position"][2] - columns["z"][0] == pytest.approx(0.95, abs=0.1)
    steepest = np.gradient(route.z, route.s).max()
    assert observation[LAYOUT["grade"]][0] / 10 == pytest.approx(steepest, abs=0.01)


def test_a_subject_is_dynamically_similar(env: gym.Env) -> None:
    """Half as tall again, in the same pose: heights scale with stature, speeds with its root."""
    tall, small = Subject("tall", height_m=1.92, mass_kg=90.0), Subject("small", height_m=1.55, mass_kg=58.7)
    found = {}
    for one in (tall, small):
        env.reset(seed=4, options={"scenario": "straight", "subject": one})
        for _ in range(60):
            *_, info = env.step(STILL)
        found[one.name] = info
    ratio = tall.height_m / small.height_m
    heights = [found[name]["position"][2] for name in ("tall", "small")]
    assert heights[0] / heights[1] == pytest.approx(ratio, rel=0.02)


def test_who_walks_is_up_to_the_caller(env: gym.Env) -> None:
    """Habits are observed: a stock subject's are its own, a drawn one's differ from episode to episode."""
    toe_out = LAYOUT["variability"].start + 3

    def observed(subject: object) -> float:
        observation, _ = env.reset(options={"subject": subject, "scenario": "straight"})
        return float(observation[toe_out]) / 8

    for name, subject in SUBJECTS.items():
        assert observed(name) == pytest.approx(np.radians(subject.toe_out_deg), abs=1e-6)
    assert len({observed("drawn") for _ in range(5)}) > 2


def test_what_make_is_told_holds_until_reset_is_told_otherwise() -> None:
    env = gym.make(ID, scenario="turning", subject="taller")
    assert env.reset(seed=1)[1]["progress"] == 0.0
    ordinary, _ = env.reset(seed=1, options={"scenario": None})
    again, _ = env.reset(seed=1)
    other, _ = gym.make(ID, subject="taller").reset(seed=1)
    env.close()
    np.testing.assert_array_equal(ordinary, other)
    assert not np.array_equal(ordinary, again)


@pytest.mark.parametrize(
    ("options", "culprit"),
    [
        ({"scenaro": "turning"}, r"option 'scenaro' is unknown, expected 'scenario' or 'subject'"),
        ({"scenario": "nowhere"}, r"scenario 'nowhere': neither a stock scenario nor .*turning"),
        ({"scenario": 3}, r"option scenario = 3: expected None or a Plan, or a scenario's name or file"),
        ({"subject": "giant"}, r"option subject = 'giant': expected 'reference'.*'drawn' or a Subject"),
        ({"subject": 1.9}, r"option subject = 1.9: expected"),
    ],
)
def test_bad_options_are_told_in_a_sentence(env: gym.Env, options: dict, culprit: str) -> None:
    bare = env.unwrapped  # gymnasium's checker takes no exception well
    with pytest.raises(InputError, match=culprit) as caught:
        bare.reset(seed=1, options=options)
    assert "\n" not in str(caught.value)
    bare.reset(seed=1)  # and the environment is still good
    bare.step(STILL)


@pytest.mark.parametrize(
    ("settings", "culprit"),
    [
        ({"scenario": "turnin"}, r"scenario 'turnin': neither a stock scenario nor .*turning"),
        ({"subject": "tallr"}, r"option subject = 'tallr': expected 'reference'"),
    ],
)
def test_make_refuses_what_is_unknown(settings: dict, culprit: str) -> None:
    with pytest.raises(InputError, match=culprit):
        gym.make(ID, **settings)


def test_without_a_screen_no_window_is_promised(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    assert gym.make(ID).metadata["render_modes"] == ["rgb_array"]
    monkeypatch.setenv("DISPLAY", ":0")
    assert gym.make(ID).metadata["render_modes"] == ["human", "rgb_array"]


@pytest.mark.parametrize("action", [np.full(N_ACTION, np.nan), np.zeros(N_ACTION - 1)])
def test_bad_actions_are_told_in_a_sentence(env: gym.Env, action: np.ndarray) -> None:
    env.reset(seed=1)
    with pytest.raises(InputError, match="action: expected 17 finite numbers"):
        env.unwrapped.step(action)


# Vectors


@pytest.mark.parametrize("settings", [{}, {"scenario": "turning", "subject": "drawn"}])
def test_sync_and_async_walk_alike(settings: dict) -> None:
    actions = np.random.default_rng(1).uniform(-0.2, 0.2, (12, 2, N_ACTION)).astype(np.float32)

    def episode(mode: str) -> list[np.ndarray]:
        envs = gym.make_vec(ID, num_envs=2, vectorization_mode=mode, **settings)
        observation, info = envs.reset(seed=[5, 6])
        found = [observation, info["position"]]
        for action in actions:
            observation, reward, terminated, truncated, info = envs.step(action)
            found += [observation, reward, terminated, truncated, info["position"], info["terms"]["torque"]]
        envs.close()
        return found

    together, apart = episode("sync"), episode("async")
    assert together[0].shape == (2, N_OBSERVATION)
    assert not np.array_equal(together[0][0], together[0][1])
    for one, other in zip(together, apart, strict=True):
        np.testing.assert_array_equal(one, other)


def test_options_reach_every_walker_of_a_vector() -> None:
    envs = gym.make_vec(ID, num_envs=2, vectorization_mode="sync")
    _, info = envs.reset(seed=1, options={"scenario": "straight"})
    np.testing.assert_allclose(info["position"][:, :2], 0, atol=0.01)
    with pytest.raises(InputError, match="subject = 'giant'"):
        envs.reset(options={"subject": "giant"})
    envs.close()


def test_the_threaded_vector_environment_resets_what_fell() -> None:
    made = gym.make_vec(ID, num_envs=6)
    envs = made.unwrapped
    assert isinstance(envs, WalkVectorEnv)
    envs.reset(seed=4)
    ended = 0
    for _ in range(120):
        observation, reward, terminated, truncated, info = envs.step(np.full((6, N_ACTION), 0.5))
        assert observation.shape == (6, N_OBSERVATION)
        assert np.isfinite(reward).all()
        done = terminated | truncated
        ended += done.sum()
        if done.any():
            assert (info["_final_obs"] == done).all()
            assert not np.array_equal(info["final_obs"][done], observation[done])
    assert ended > 0
    with pytest.raises(InputError, match="option 'scenario': the threaded environment"):
        envs.reset(options={"scenario": "turning"})
    envs.close()
    envs.close()


# What is written about it


def table_rows(heading: str) -> list[list[str]]:
    """Cells of the table under a heading of docs/environment.md."""
    page = DOCS / "environment.md"
    if not page.is_file():
        pytest.skip("no docs beside these tests")
    _, _, rest = page.read_text(encoding="utf-8").partition(f"## {heading}\n")
    rows = re.findall(r"^\|(.*)\|$", rest.partition("\n## ")[0], flags=re.MULTILINE)
    return [[cell.strip() for cell in row.split("|")] for row in rows[2:]]


def test_the_documented_observation_is_the_one_that_is_seen() -> None:
    documented = {row[1].strip("`"): row[0] for row in table_rows("Observation")}
    for name, place in LAYOUT.items():
        first, last = str(place.start), f"-{place.stop - 1}"
        assert documented.pop(name) == (first if place.stop == place.start + 1 else first + last)
    assert not documented


def test_every_term_of_the_reward_is_documented() -> None:
    assert {row[0].strip("`") for row in table_rows("Reward")} == set(WEIGHTS)


def test_the_layout_names_what_moves() -> None:
    """What is commanded is where the table says."""
    env = gym.make(ID, difficulty=Difficulty(level=0.0))
    observation, info = env.reset(seed=5)
    env.close()
    speed = observation[LAYOUT["speed_command"]][0] / 3 + 1.2
    assert speed == pytest.approx(info["speed_command"], abs=1e-6)
    sine, cosine = observation[LAYOUT["step_phase"]]
    assert sine**2 + cosine**2 == pytest.approx(1, abs=1e-6)
    assert np.linalg.norm(observation[LAYOUT["gravity"]]) == pytest.approx(2, abs=1e-6)
