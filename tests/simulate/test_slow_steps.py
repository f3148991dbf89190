"""How a walker slows down and comes to stand: slopes, drift, narrow habits, and when a stand may begin."""

import numpy as np
import pytest

from footfall.models import gait
from footfall.models.gait import INDEX
from footfall.simulate.walker import _gait_kernels
from footfall.simulate.walker._balance_kernels import Balance, Stand, balance_of, decide, feedback
from footfall.simulate.walker._posture_kernels import wanted
from footfall.simulate.walker.feedback import Gains
from footfall.simulate.walker.state import BEND, TWIST, WALKER, WIDTH, Columns

NO_GAINS = Gains(*[0.0] * len(Gains._fields))
N_SERVOS = len(INDEX)


def offsets(climb: float = 0.0, aslant: float = 0.0, speed: float = 0.0) -> dict[str, float]:
    """What a slope adds to the targets in right stance, late in the step; by servo."""
    out = np.zeros((2, N_SERVOS))
    for row, share in zip(out, (1.0, 0.0), strict=True):
        level = Balance(**dict.fromkeys(Balance._fields, 0.0))
        feedback(
            NO_GAINS,
            level._replace(step_phase=0.7, speed=speed, climb=share * climb, aslant=share * aslant),
            row,
        )
    return dict(zip(INDEX, out[0] - out[1], strict=True))


@pytest.mark.parametrize("grade", [0.08, -0.05])
def test_slow_steps_lean_on_the_slope_and_quick_ones_do_not(grade: float) -> None:
    slow = offsets(climb=grade)
    for servo in ("hip_flexion_r", "knee_r", "ankle_r", "hip_flexion_l", "knee_l", "lumbar_pitch"):
        assert slow[servo] * grade > 0, servo
    half = offsets(climb=grade, speed=0.4)
    assert half == pytest.approx({servo: offset / 2 for servo, offset in slow.items()})
    assert not any(offsets(climb=grade, aslant=grade, speed=0.8).values())


@pytest.mark.parametrize("grade", [0.08, 0.02])
def test_across_a_slope_the_uphill_knee_bends_and_the_other_stretches(grade: float) -> None:
    """Aslant is positive where the swinging leg is the higher one."""
    for aslant in (grade, -grade):
        found = offsets(aslant=aslant)
        assert found["knee_l"] * aslant > 0
        assert found["knee_r"] == pytest.approx(-found["knee_l"])
        for side, bend in (("r", found["knee_r"]), ("l", found["knee_l"])):
            assert found[f"hip_flexion_{side}"] == pytest.approx(bend / 2)
        assert found["ankle_r"] == pytest.approx(found["knee_r"] / 2)


GOOD = Stand(
    forward=0.01,
    left=0.0,
    forward_velocity=0.1,
    left_velocity=0.0,
    capture_forward=0.041,
    capture_left=0.03,
    trunk_roll=0.0,
    stagger=0.1,
    width=0.18,
    loaded=True,
)


@pytest.mark.parametrize(
    ("change", "grade", "stands"),
    [
        ({}, 0.0, True),
        ({"capture_forward": 0.06}, 0.0, False),
        ({"capture_forward": -0.029}, 0.0, True),
        ({"capture_forward": -0.031}, 0.0, False),
        ({"capture_left": 0.05}, 0.0, False),
        ({"capture_left": -0.05}, 0.0, False),
        ({"forward_velocity": 0.3}, 0.0, False),
        ({"width": 0.125, "capture_left": 0.0}, 0.0, False),
        ({"stagger": 0.13}, 0.0, False),
        ({"stagger": 0.13}, 0.08, True),
        ({"stagger": 0.15}, 0.08, False),
        ({"loaded": False}, 0.0, False),
    ],
)
def test_a_stand_begins_when_the_body_can_be_caught(
    change: dict[str, float], grade: float, stands: bool
) -> None:
    state = np.zeros(1, WALKER)
    state["gate"], state["grade_left"] = 1.0, grade
    body = GOOD._replace(**change)
    decide(Columns(state), body, np.array([0.1]))
    assert bool(state["closing"][0]) == stands
    assert state["capture"][0] == body.capture_forward


def test_without_sensors_the_capture_point_is_taken_for_the_standing_point() -> None:
    state = np.zeros(2, WALKER)
    state["fresh"] = [True, False]
    decide(Columns(state), GOOD, np.array([0.1]))
    assert state["capture"].tolist() == [0.0, GOOD.capture_forward]


@pytest.mark.parametrize(
    ("change", "grade", "seconds"),
    [
        ({"capture_forward": 0.06}, 0.0, 2.25),
        ({"capture_forward": -0.036}, 0.0, 2.25),
        ({"capture_forward": -0.043}, 0.0, None),
        ({"capture_forward": 0.069}, 0.0, 2.925),
        ({"capture_forward": 0.071}, 0.0, None),
        ({"capture_left": 0.0585}, 0.0, 2.25),
        ({"capture_left": 0.073}, 0.0, None),
        ({"stagger": 0.125}, 0.0, 2.25),
        ({"stagger": 0.125}, 0.02, 2.25),
        ({"stagger": 0.125}, 0.05, None),
        ({"capture_forward": 0.06}, 0.05, None),
        ({"stagger": 0.145}, 0.08, None),
        ({"forward_velocity": 0.3}, 0.0, None),
    ],
)
def test_who_steps_on_the_spot_for_long_may_stand_less_well(
    change: dict[str, float], grade: float, seconds: float | None
) -> None:
    """The bounds widen from 1.5 to 3 s on gentle ground; while walking and in a stand nothing adds up."""
    state = np.zeros(1, WALKER)
    state["gate"], state["grade_left"], state["dt"], state["speed"] = 1.0, grade, 0.03, 0.3
    stand, step = GOOD._replace(**change), np.array([0.1])
    state["speed_goal"] = 1.0
    for _ in range(200):
        decide(Columns(state), stand, step)
    assert state["waiting"][0] == 0
    state["speed_goal"] = 0.0
    count = 0
    while not state["closing"][0] and count < 200:
        decide(Columns(state), stand, step)
        count += 1
    closed = bool(state["closing"][0])
    assert closed == (seconds is not None)
    if seconds is not None:
        assert 0.03 * count == pytest.approx(seconds, abs=0.1)
        decide(Columns(state), stand, step)
        assert state["waiting"][0] == 0


def test_a_walker_that_is_to_stand_and_drifts_backwards_creeps_on() -> None:
    """At up to 0.3 m/s; in a stand not at all, nor against a drift forwards."""
    cases = [  # drift, speed asked for, closing, speed wanted
        (-0.1, 0.0, False, 0.2),
        (-0.4, 0.0, False, 0.3),
        (-0.1, 0.5, False, 0.5),
        (0.2, 0.0, False, 0.0),
        (0.2, 0.5, False, 0.5),
        (-0.1, 0.0, True, 0.0),
    ]
    state = np.zeros(len(cases), WALKER)
    drift, goal, closing, expected = np.array(cases).T
    state["mean_velocity"][:, 0], state["speed_goal"] = drift, goal
    state["closing"] = closing.astype(bool)
    np.testing.assert_allclose(wanted(Columns(state)), expected, atol=1e-12)


def test_narrow_steps_widen_before_a_stop_as_far_as_all_others() -> None:
    """Three centimetres a leg beyond the usual width; who is wide anyway keeps that too."""
    state = np.zeros(4, WALKER)
    habits = np.array([-0.02, 0.0, 0.02, -0.02])
    state["varied_mean"][:, WIDTH] = state["varied_goal"][:, WIDTH] = habits
    state["speed"], state["speed_goal"], state["dt"] = 0.3, [0.0, 0.0, 0.0, 0.3], 0.03
    for _ in range(400):
        _gait_kernels.slew(Columns(state))
    np.testing.assert_allclose(state["varied"][:, WIDTH], [0.03, 0.03, 0.05, -0.02], atol=1e-6)


def test_the_pelvis_sinks_further_over_the_standing_leg_in_steady_walking_only() -> None:
    phase = np.array([0.2, 0.3, 0.4, 0.55, 0.7, 0.9])
    right = INDEX["hip_adduction_r"]
    slow, steady, quick = (
        gait.reference_angles(phase, np.full(len(phase), speed))[:, right] for speed in (0.4, 1.0, 1.6)
    )
    sinking = np.degrees(steady - slow)
    assert (sinking[:3] > 1.2).all()
    assert np.abs(sinking[3:]).max() < 0.6
    np.testing.assert_array_equal(steady, quick)


def test_a_pelvis_that_sinks_does_so_straight_on_and_not_in_sharp_turns() -> None:
    turns = np.array([-0.9, -0.5, -0.3, -0.1, 0.0, 0.1, 0.3, 0.5])
    found = gait.steadiness(np.full(len(turns), 1.3), turns)
    np.testing.assert_allclose(found, [0, 0, 0.5, 1, 1, 1, 0.5, 0], atol=1e-12)


@pytest.mark.parametrize("side", ["r", "l"])
def test_only_a_swinging_foot_turns_out_further_and_it_lands_as_before(side: str) -> None:
    """Targets with and without a drawn turn: the hip's, outwards (negative), from toe-off to landing."""
    state = np.zeros(2, WALKER)
    state["gate"] = state["gate_before"] = 1.0
    state["speed"] = 1.3
    state["varied"][1, TWIST] = 0.1
    turn, others = [], 0.0
    for step in range(100):
        state["phase"] = state["next_phase"] = step / 100
        out = _gait_kernels.reference_all(state, _gait_kernels.REFERENCE, 0.0)
        difference = out[1] - out[0]
        turn.append(difference[INDEX[f"hip_rotation_{side}"]])
        others = max(others, *(abs(difference[j]) for name, j in INDEX.items() if "hip_rotation" not in name))
    own = np.roll(turn, 0 if side == "r" else -50)
    assert others == 0
    assert own.min() == pytest.approx(-0.1, abs=1e-3)
    assert own.max() <= 0
    np.testing.assert_allclose(own[:60], 0, atol=1e-12)
    np.testing.assert_allclose(own[92:], 0, atol=1e-12)


@pytest.mark.parametrize("left_stance", [False, True])
@pytest.mark.parametrize("left_up", [0.05, -0.05])
def test_aslant_is_how_far_the_ground_rises_to_the_swinging_leg(left_stance: bool, left_up: float) -> None:
    state = np.zeros(1, WALKER)
    state["left_stance"], state["grade_left"], state["grade_forward"] = left_stance, left_up, 0.02
    found = balance_of(Columns(state))
    assert found.aslant == pytest.approx(-left_up if left_stance else left_up)
    assert found.climb == pytest.approx(0.02)


@pytest.mark.parametrize("share", [0.1, -0.1])
def test_a_drawn_bend_is_of_knees_and_ankles_alone(share: float) -> None:
    """Their excursion grows by that share; every other servo does as before."""
    state = np.zeros(2, WALKER)
    state["gate"] = state["gate_before"] = 1.0
    state["speed"] = 1.3
    state["varied"][1, BEND] = share
    for phase in (0.1, 0.35, 0.6, 0.85):
        state["phase"] = state["next_phase"] = phase
        usual, bent = _gait_kernels.reference_all(state, _gait_kernels.REFERENCE, 0.0)
        for name, j in INDEX.items():
            factor = 1 + share if name.startswith(("knee", "ankle")) else 1.0
            assert bent[j] == pytest.approx(usual[j] * factor, abs=1e-12), name
