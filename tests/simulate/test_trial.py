"""Courses for choosing among walkers: where they lead, who falls, and which checkpoint is kept."""

import json

import numpy as np
import pytest

from footfall.models.policy import Policy, stock_policy
from footfall.simulate.learn.courses import CHOICE, JUDGEMENT, Course, Verdict, attempt, course_route


def test_a_block_closes() -> None:
    route = course_route(Course("block", ((10.0, 0.0), (0.0, 90.0)) * 4))
    assert np.degrees(route.heading[-1]) == pytest.approx(360.0)
    assert np.hypot(route.x[-1], route.y[-1]) < 0.3
    assert route.length == pytest.approx(40.0, abs=0.3)


def test_an_arc_has_its_radius() -> None:
    route = course_route(Course("bend", ((np.pi * 2.5 / 2, 90.0),)))
    np.testing.assert_allclose(route.curvature[1:], 1 / 2.5, rtol=1e-6)
    assert (route.x[-1], route.y[-1]) == pytest.approx((2.5, 2.5), abs=0.06)


def test_the_judge_asks_for_other_courses_than_the_choice() -> None:
    def asked(courses: tuple[Course, ...]) -> set[tuple[object, ...]]:
        return {(course.parts, course.pace, course.grade, course.stops) for course in courses}

    assert not asked(CHOICE) & asked(JUDGEMENT)


def test_a_walker_that_cannot_walk_falls_on_every_course() -> None:
    """Without balance feedback and with a policy of nothing there is nobody who walks."""
    shipped = stock_policy()
    weights = tuple(0 * weight for weight in shipped.weights)
    lame = Policy(weights, tuple(0 * bias for bias in shipped.biases), np.zeros(32), "lame")
    courses = (Course("flat", ((50.0, 0.0),)), Course("hill", ((50.0, 0.0),), grade=(0.08, 0.0)))
    verdict = attempt(lame, courses, seed=1, people=2, seconds=6.0, threads=1)
    assert all(count >= 1 for count in verdict.falls.values())
    assert verdict.minutes == pytest.approx(4 * 6.0 / 60)
    assert verdict.falls_per_hour == pytest.approx(60 * sum(verdict.falls.values()) / verdict.minutes)


def test_the_shipped_walker_walks_a_plain_course() -> None:
    verdict = attempt(stock_policy(), (Course("flat", ((50.0, 0.0),)),), seed=1, people=3, seconds=15.0)
    assert verdict.falls == {"flat": 0}


def test_of_equals_the_one_that_learnt_longest_is_kept(tmp_path, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    """Falls decide; the kept one is judged on the other courses."""
    for name in ("torch", "cma"):
        pytest.importorskip(name, reason=f"training needs {name}: pip install footfall[train]")
    from footfall.simulate.learn import train

    falls = {"policy_060.npz": 3, "policy_080.npz": 1, "policy_100.npz": 1}
    asked = []

    def pretend(policy, courses, **_):  # type: ignore[no-untyped-def]
        asked.append((policy, courses))
        return Verdict({"course": falls[policy]}, 10.0)

    for name in falls:
        (tmp_path / name).write_bytes(name.encode())
    monkeypatch.setattr(train, "load_policy", lambda path: path.name)
    monkeypatch.setattr(train, "attempt", pretend)
    train.choose(tmp_path, threads=1)
    told = json.loads((tmp_path / "choice.json").read_text())
    assert told["chosen"] == "policy_100.npz"
    assert (tmp_path / "walker.npz").read_bytes() == b"policy_100.npz"
    assert asked[-1] == ("policy_100.npz", JUDGEMENT)
