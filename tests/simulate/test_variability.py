"""The gait's variability: as wide as people's about their habits, and in parts that do not mix."""

import numpy as np
import pytest

from footfall.models.subject import Habits
from footfall.simulate.walker.state import AMPLITUDE, BEND, CADENCE, N_VARIED, TWIST, WALKER, WIDTH
from footfall.simulate.walker.variability import Variability


def test_variability_has_the_stated_spread() -> None:
    """Targets drawn over many steps scatter as docs/walker.md states; level 0 is a metronome."""
    n = 4000
    everyone, rng = np.ones(n, dtype=bool), np.random.default_rng(1)
    habits = Habits(cadence=1.03, step_width=0.01, toe_out=0.1, asymmetry=0.0)
    state = np.zeros((2, n), WALKER)
    state["speed"] = state["speed_goal"] = 1.3  # the usual speed
    lively, still = Variability(state[0]), Variability(state[1])
    lively.place(everyone, np.ones(n), [habits] * n)
    still.place(everyone, np.zeros(n), [habits] * n)
    for half in np.arange(40) % 2:
        state["next_phase"] = half / 2
        for group in (lively, still):
            group.draw(np.arange(n), rng)
    assert lively.target[:, 0].std() == pytest.approx(np.hypot(0.0247, 0.0126), rel=0.05)
    assert lively.target[:, 0].mean() == pytest.approx(0.03, abs=0.003)
    assert lively.target[:, 3].std() == pytest.approx(np.radians(1.0), rel=0.05)
    bounded = np.clip(rng.normal(0, np.radians(11.5), 100_000), -0.4, 0.4)
    assert lively.target[:, TWIST].std() == pytest.approx(bounded.std(), rel=0.05)
    assert lively.target[:, TWIST].mean() == pytest.approx(0, abs=0.01)
    assert lively.target[:, BEND].std() == pytest.approx(0.054, rel=0.03)
    assert lively.target[:, AMPLITUDE].std() == pytest.approx(0.0215, rel=0.03)
    assert lively.target[:, WIDTH].std() == pytest.approx(0.0045 / np.sqrt(1 - 0.5**2), rel=0.03)
    np.testing.assert_allclose(still.target, np.tile([0.03, 0, 0.01, 0.1, 0.1, 0, 0], (n, 1)), atol=1e-12)


def test_asymmetry_makes_one_step_quicker_than_the_other() -> None:
    state = np.zeros(1, WALKER)
    one = Variability(state)
    one.place(np.ones(1, dtype=bool), np.zeros(1), [Habits(asymmetry=0.02)])
    rng, cadence = np.random.default_rng(0), []
    for half in (0, 1):
        state["next_phase"] = half / 2
        one.draw(np.arange(1), rng)
        cadence.append(one.target[0, 0])
    assert cadence == pytest.approx([0.02, -0.02])


@pytest.mark.parametrize(("part", "moved"), [(0, [1, 2, 6]), (1, [0]), (2, [3, 4, 5])])
def test_a_part_of_variability_leaves_the_draws_of_the_others_as_they_are(
    part: int, moved: list[int]
) -> None:
    """To the last bit, over many steps; its own are halved about the habits."""
    n, habits, found = 50, Habits(cadence=1.02, step_width=0.01, toe_out=0.1, asymmetry=0.0), []
    for level in (0.5, 0.25):
        state, rng = np.zeros(n, WALKER), np.random.default_rng(2)
        people = Variability(state)
        levels = np.full((n, 3), 0.5)
        levels[:, part] = level
        people.place(np.ones(n, dtype=bool), levels, [habits] * n)
        for half in (0.0, 0.5, 0.0, 0.5):
            state["next_phase"] = half
            people.draw(np.arange(n), rng)
        found.append(people.target - people.mean)
    others = [i for i in range(N_VARIED) if i not in moved]
    np.testing.assert_array_equal(found[0][:, others], found[1][:, others])
    np.testing.assert_allclose(found[1][:, moved], found[0][:, moved] / 2, rtol=0, atol=1e-12)
    assert found[0][:, moved].any(axis=0).all()


def test_one_level_of_variability_is_that_of_all_its_parts() -> None:
    one, three = (Variability(np.zeros(2, WALKER)) for _ in range(2))
    one.place(np.ones(2, dtype=bool), np.array([0.7, 0.2]), [Habits()] * 2)
    three.place(np.ones(2, dtype=bool), np.array([[0.7] * 3, [0.2] * 3]), [Habits()] * 2)
    np.testing.assert_array_equal(one.level, three.level)


LITTLE = 0.3


def scatter(speed: float, goal: float) -> np.ndarray:
    """(7,) SD of many people's targets, who vary so little that no bound shows."""
    n = 4000
    state, rng = np.zeros(n, WALKER), np.random.default_rng(3)
    state["speed"], state["speed_goal"] = speed, goal
    people = Variability(state)
    people.place(np.ones(n, dtype=bool), np.full(n, LITTLE), [Habits()] * n)
    for half in np.arange(40) % 2:
        state["next_phase"] = half / 2
        people.draw(np.arange(n), rng)
    return people.target.std(axis=0)


def test_slow_strides_scatter_more_as_peoples_do() -> None:
    """By (1.3 / v)^1.4 from 1.3 m/s down to 1.0 m/s, and no more below."""
    usual, slow, slower = scatter(1.3, 1.3), scatter(1.0, 1.0), scatter(0.5, 0.5)
    for part in (AMPLITUDE, BEND):
        assert slow[part] / usual[part] == pytest.approx(1.3**1.4, rel=0.02)
        assert slower[part] == pytest.approx(slow[part])
    np.testing.assert_allclose(slow[[CADENCE, WIDTH, TWIST]], usual[[CADENCE, WIDTH, TWIST]])


def test_who_is_to_stand_steps_with_care_and_only_the_width_scatters_on() -> None:
    walking, stopping = scatter(1.0, 1.0), scatter(1.0, 0.0)
    calm = stopping / walking
    assert calm[WIDTH] == pytest.approx(1)
    assert stopping[WIDTH] == pytest.approx(LITTLE * 0.0045 / np.sqrt(1 - 0.5**2), rel=0.05)
    np.testing.assert_allclose(np.delete(calm, WIDTH), 0.3, rtol=0.02)
