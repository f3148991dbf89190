"""Courses for choosing among walkers: where they lead, who falls, and which checkpoint is kept."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from footfall.models.body import SENSOR_FOOT_RATE, SENSOR_TOUCH
from footfall.models.policy import Policy, stock_policy
from footfall.simulate.learn.courses import CHOICE, JUDGEMENT, Course, Verdict, attempt, course_route
from footfall.simulate.learn.reward import restless
from footfall.simulate.learn.still_feet import Moved
from footfall.simulate.learn.stops import StopVerdict, attempt_stops, verdict


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


@pytest.mark.parametrize(
    ("worst", "chosen"),
    [({}, "policy_090.npz"), ({"falls": 13}, "policy_100.npz"), ({"twist": 15.1}, "policy_100.npz")],
)
def test_falls_and_feet_that_twist_decide_what_is_kept(tmp_path, monkeypatch, worst, chosen) -> None:  # type: ignore[no-untyped-def]
    """Of equals the one that has learnt longest; the kept one is judged on the other courses.

    One fall in ten minutes is six an hour, as much as 6 % of stops and 12 deg too much.
    """
    for name in ("torch", "cma"):
        pytest.importorskip(name, reason=f"training needs {name}: pip install footfall[train]")
    from footfall.simulate.learn import train

    falls = {"policy_060.npz": 3, "policy_080.npz": 1, "policy_090.npz": 0, "policy_100.npz": 1}
    # The one that never falls on the courses does so at stops, another one's feet twist.
    stopped = {name: StopVerdict(200, 0, 1.0, 2.0) for name in falls}
    stopped["policy_090.npz"] = StopVerdict(200, worst.get("falls", 0), worst.get("twist", 1.0), 2.0)
    asked = []

    def pretend(policy, courses, **_):  # type: ignore[no-untyped-def]
        asked.append((policy, courses))
        return Verdict({"course": falls[policy]}, 10.0)

    for name in falls:
        (tmp_path / name).write_bytes(name.encode())
    monkeypatch.setattr(train, "load_policy", lambda path: path.name)
    monkeypatch.setattr(train, "attempt", pretend)
    monkeypatch.setattr(train, "attempt_stops", lambda policy, **_: stopped[policy])
    train.choose(tmp_path, threads=1)
    told = json.loads((tmp_path / "choice.json").read_text())
    assert told["chosen"] == chosen
    assert (tmp_path / "walker.npz").read_bytes() == chosen.encode()
    assert asked[-1] == (chosen, JUDGEMENT)
    assert told["choice"]["policy_060.npz"]["stops"] == {"stops": 200, "falls": 0, "twist": 1.0, "pitch": 2.0}


def test_the_worse_foot_of_the_worse_kind_counts() -> None:
    """Nine of ten of a group stay below what is told; a degree too much is one beyond 2 and 3 deg."""
    still = [
        Moved(kind, "r", first, 0.1, 0.2, 0.3) for kind in ("stop", "restart") for first in (True, False)
    ]
    turned = [Moved("restart", "l", False, float(i), 0.0, 0.5 * i) for i in range(11)]
    found = verdict(40, 2, still * 11 + turned)
    assert found.falls_percent == 5.0
    assert 0.1 < found.twist < 9.0  # the still ones of its own kind count with it
    found = verdict(40, 2, [one for one in still if one.kind == "stop"] * 11 + turned)
    assert (found.twist, found.pitch) == (9.0, 4.5)
    alone = verdict(40, 0, turned)
    assert (alone.twist, alone.pitch) == (9.0, 4.5)
    assert alone.excess_deg == pytest.approx(7.0 + 1.5)
    assert StopVerdict(1, 0, 1.9, 2.9).excess_deg == 0


def test_a_loaded_foot_that_turns_or_tips_costs() -> None:
    """While the walker is steady; only the foot that the gait stands on may not tip, of a stand neither."""
    k, n = 3, 6
    sensor = np.zeros((n, k, 24))
    touch = sensor[:, :, SENSOR_TOUCH].reshape(n, k, 2, 3)
    touch[:, :, :, 1] = 300.0
    touch[1, :, 0] = touch[1, :, 1] = 40.0  # not loaded
    rate = sensor[:, :, SENSOR_FOOT_RATE].reshape(n, k, 2, 3)
    rate[:, :, 0, 2] = -0.3  # the right foot turns
    rate[:, :, 1, 0], rate[:, :, 1, 1] = -0.4, 0.3  # the left one tips about an axis that heads to the left
    sensor[:, :, SENSOR_TOUCH], sensor[:, :, SENSOR_FOOT_RATE] = touch.reshape(n, k, 6), rate.reshape(n, k, 6)
    yaw = np.arctan2(0.4, 0.3)
    steady = np.array([True, True, False, True, True, True])
    walkers = SimpleNamespace(
        n=n,
        substeps=k,
        sin=np.full(n, np.sin(yaw)),
        cos=np.full(n, np.cos(yaw)),
        left_stance=np.array([True, True, True, False, False, True]),
        gate=SimpleNamespace(closing=np.array([False, False, False, False, True, True])),
        steady=steady,
    )
    trace = SimpleNamespace(sensor=sensor)
    np.testing.assert_allclose(restless(walkers, trace), [0.8, 0.0, 0.0, 0.3, 0.8, 0.8])  # type: ignore[arg-type]


def test_stops_are_tried_on_slopes() -> None:
    """Who cannot walk falls at every stop; the shipped walker stops twice on level ground."""
    shipped = stock_policy()
    weights = tuple(0 * weight for weight in shipped.weights)
    lame = Policy(weights, tuple(0 * bias for bias in shipped.biases), np.zeros(32), "lame")
    assert attempt_stops(lame, seed=1, people=2, threads=1, slopes=((0.08, 0.0),)).falls == 2
    found = attempt_stops(shipped, seed=1, people=3, threads=1, slopes=((0.0, 0.0),))
    assert (found.stops, found.falls) == (6, 0)
    assert 0 < found.twist < 8
    assert 0 < found.pitch < 12
