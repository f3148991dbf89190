"""The tutorial's script learns what its page says, and the page shows the script's own code."""

import importlib.util
import re

import numpy as np
import pytest

from footfall.models.policy import stock_policy
from tests.helpers.places import DOCS


@pytest.fixture
def script(monkeypatch):  # type: ignore[no-untyped-def]
    """The tutorial's script as a module, its episodes cut short."""
    file = DOCS / "examples" / "spare_torque.py"
    if not file.is_file():
        pytest.skip("no docs beside these tests")
    spec = importlib.util.spec_from_file_location("spare_torque", file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setattr(module, "STEPS", 40)
    monkeypatch.setattr(module, "LONG", 40)
    return module


def test_it_learns_and_the_same_seed_learns_the_same(script, capsys) -> None:
    policy = stock_policy()
    first, again, other = (script.learn(policy, seed, 2, 8) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert first.shape == (17, 3)
    assert np.abs(first).max() > 0
    assert not np.array_equal(first, other)


def test_its_judgement_tells_a_waste_of_torque(script) -> None:
    residual = np.zeros((17, 3))
    residual[:, 0] = 0.3
    plain = script.judge(stock_policy(), np.zeros((17, 3)), 5)
    offset = script.judge(stock_policy(), residual, 5)
    assert plain[0] > offset[0]
    assert plain[1] < offset[1]


def test_the_page_shows_the_scripts_code() -> None:
    page, file = DOCS / "tutorial_environment.md", DOCS / "examples" / "spare_torque.py"
    if not page.is_file():
        pytest.skip("no docs beside these tests")
    squeezed = re.sub(r"\s+", "", file.read_text(encoding="utf-8"))
    for line in (
        "directions = rng.standard_normal((walkers, N_ACTION, 3))",
        "better = one[:, 0] - other[:, 0]",
        "momentum = 0.7 * momentum + 0.3 * climb",
        "residual = residual + GO * momentum",
        "features = np.concatenate([np.ones((len(wave), 1)), wave], axis=1)",
    ):
        assert re.sub(r"\s+", "", line) in squeezed
        assert line.replace("walkers, N_ACTION", "48, 17") in page.read_text(encoding="utf-8")
