"""Training learns, writes a policy that the walker can use, and resumes. Needs the extra `train`."""

import json
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="training needs torch: pip install footfall[train]")
pytest.importorskip("cma", reason="training needs cma: pip install footfall[train]")

from footfall.models.policy import load_policy
from footfall.simulate.learn.ppo import HORIZON
from footfall.simulate.learn.train import ENVS, schedule, train
from footfall.simulate.walker.observation import N_OBSERVATION
from footfall.simulate.walker.walkers import N_ACTION

BATCH = HORIZON * ENVS


@pytest.fixture(scope="module")
def trained(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("training")
    train(out, seed=3, samples=2 * BATCH, generations=2, threads=0)
    return out


def samples(out: Path) -> list[int]:
    return [json.loads(line)["samples"] for line in (out / "log.jsonl").read_text().splitlines()]


def test_it_writes_a_policy_that_acts(trained: Path) -> None:
    policy = load_policy(trained / "policy.npz")
    action = policy(np.random.default_rng(0).standard_normal((5, N_OBSERVATION)))
    assert action.shape == (5, N_ACTION)
    assert np.isfinite(action).all()
    assert action.std() > 0
    assert policy.meta["samples"] == 2 * BATCH
    np.testing.assert_array_equal(policy.feedback_gains, np.load(trained / "gains.npy"))


def test_it_resumes_where_it_stopped(trained: Path) -> None:
    before = load_policy(trained / "policy.npz")
    train(trained, seed=3, samples=3 * BATCH, generations=2, threads=0)
    assert samples(trained)[-1] == 3 * BATCH
    after = load_policy(trained / "policy.npz")
    assert after.digest != before.digest
    moved = max(np.abs(a - b).max() for a, b in zip(after.weights, before.weights, strict=True))
    assert 0 < moved < 0.05  # one update from where it was, not a new beginning


def test_the_same_seed_learns_the_same(tmp_path: Path, trained: Path) -> None:
    train(tmp_path, seed=3, samples=2 * BATCH, generations=2, threads=0)
    np.testing.assert_array_equal(np.load(tmp_path / "gains.npy"), np.load(trained / "gains.npy"))
    assert samples(tmp_path) == [2 * BATCH]


def test_difficulty_only_rises_and_exploration_only_falls() -> None:
    points = [schedule(int(done), 7_000_000) for done in np.linspace(0, 7e6, 50)]
    levels, bounds = zip(*points, strict=True)
    assert levels[0] == 0
    assert levels[-1] == 1
    assert (np.diff(levels) >= 0).all()
    assert (np.diff([bound.log_sd_max for bound in bounds]) <= 0).all()
