"""The last step before a stand: who comes to rest, and how still and flat the feet lie."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.validation.starts import PLACES
from footfall.models.body import N_SERVOS, SENSOR_TOUCH, build_body
from footfall.models.gait import INDEX
from footfall.models.subject import Subject, draw_subject
from footfall.simulate.learn import still_feet
from footfall.simulate.walker._balance_kernels import act_all
from footfall.simulate.walker._gait_kernels import REFERENCE, targets
from footfall.simulate.walker._stop_kernels import hold_stopping
from footfall.simulate.walker.feedback import GAIN_START, gain_records
from footfall.simulate.walker.state import WALKER, Columns
from tests.helpers.standing import STEP, Person, assert_held, held_state, stand, walk_on


@pytest.fixture(scope="module")
def stops() -> list:
    """Six drawn people at each place stop, stand and set out again: how their feet moved."""
    rng = np.random.default_rng(12)
    people = [Person(draw_subject(rng), grade) for grade, _ in product(PLACES.values(), range(6))]
    group = stand(people)
    walk_on(group, 0.5)
    group.speed_goal[:] = rng.uniform(0.8, 1.4, len(people))
    walk_on(group, 3.0)
    group.speed_goal[:] = 0.0
    stopping, loads = walk_on(group, 9.0)
    assert (group.gate.value == 0).all()
    group.speed_goal[:] = 1.2
    again, loads_again = walk_on(group, 2.0)
    moved = []
    for i, model in enumerate(group.models):
        angles = still_feet.feet(model, np.concatenate([stopping[i], again[i]])[::2])
        rest = stopping.shape[1] // 2
        last, first = angles[:, :, :rest], angles[:, :, rest:]
        moved += still_feet.last_step(*(last - last[:, :, -1:]).swapaxes(0, 1), loads[i, ::2].T)
        yaw, pitch = (first - last[:, :, -1:]).swapaxes(0, 1)
        moved += still_feet.set_out("restart", yaw, pitch, loads_again[i, ::2].T, 2 * STEP)
    return moved


@pytest.mark.parametrize("kind", ["stop", "restart"])
def test_loaded_feet_hardly_move_at_the_last_step_and_when_setting_out_again(stops: list, kind: str) -> None:
    """Nine of ten twist, tip toes-up and toes-down (deg) by less than 0.7, 3.0, 3.0; restarts 0.4, 2.4, 0.1.

    At most by 1.5, 3.6, 4.8 and 0.6, 3.3, 0.7. With ankles that brake as they like nine of ten tip toes-up by
    4.0 and one by 7.0, with no bounds they twist by 1.0, and without those of setting out they tip by 8.5.
    """
    found = np.array([(one.twist, one.up, one.down) for one in stops if one.kind == kind])
    assert len(found) == 60
    assert (found.max(axis=0) < {"stop": (2.0, 5.0, 6.0), "restart": (1.3, 5.0, 1.3)}[kind]).all()
    nine_of_ten = np.percentile(found, 90, axis=0)
    assert (nine_of_ten < {"stop": (0.9, 3.4, 3.4), "restart": (0.6, 3.0, 0.3)}[kind]).all()


def test_who_is_slow_and_wishes_to_stand_comes_to_rest_except_on_steep_slopes() -> None:
    cases = [  # speed, speed to go to, along and across the slope
        (0.3, 0.0, 0.05, 0.0, True),
        (0.3, 0.0, 0.0, -0.05, True),
        (0.3, 0.0, 0.05, 0.05, False),
        (0.3, 0.0, -0.07, 0.0, False),
        (0.4, 0.0, 0.0, 0.0, False),
        (0.3, 0.5, 0.0, 0.0, False),
    ]
    n = len(cases)
    group = stand([Person() for _ in range(n)])
    walk_on(group, 0.3)
    state = group._state
    columns = np.array(cases).T
    for name, column in zip(("speed", "speed_goal", "grade_forward", "grade_left"), columns[:4], strict=True):
        state[name] = column
    state["closing"], state["gate"] = False, 1.0
    act_all(state, gain_records(group.gains), np.zeros((n, N_SERVOS)))
    assert state["stopping"].tolist() == [rests for *_, rests in cases]


@settings(max_examples=50)
@given(st.integers(0, 2**32 - 1))
def test_torques_of_a_foot_that_comes_to_rest_leave_it_flat(seed: int) -> None:
    """Of the foot that the gait stands on once it is flat, of the other one until it leaves, in a stand both.

    The twist is bounded, and the ankle, but while stepping only of a body that moves forwards and is not
    far behind its feet: the pressure stays at most 3 cm behind the ankle, 1 cm late in the step, of a leaving
    foot and in a stand. There it is more where the capture point is more than 4 cm behind. Before the ankle
    it is 9.5 cm at most, more where that point is more than 2 cm ahead.
    """
    rng, n = np.random.default_rng(seed), 16
    state, load = held_state(rng, n)
    state["stopping"], state["closing"] = rng.random((2, n)) < [[0.7], [0.4]]
    state["capture"], state["mean_velocity"][:, 0] = rng.normal(0, 0.1, (2, n))
    capture, step = state["capture"], (2 * state["phase"]) % 1
    stands = state["stopping"] & state["closing"]
    steps = state["stopping"] & ~state["closing"]
    moves = steps & (state["mean_velocity"][:, 0] > 0.05) & (capture > -0.115)
    behind, ahead = 0.01 + np.maximum(-0.04 - capture, 0), 0.095 + np.maximum(capture - 0.02, 0)
    turn = 0.01 + 0.12 * np.hypot(state["grade_forward"], state["grade_left"])
    bounds = []
    for foot, side in enumerate("rl"):
        stance = state["left_stance"] == (side == "l")
        flat, leaves = stance & (load[:, foot] > 140) & (step > 0.15), ~stance & (step < 0.25)
        bounds += [
            (f"ankle_{side}", moves & flat & (step <= 0.68), -9.0, 0.03),
            (f"ankle_{side}", moves & flat & (step > 0.68), -9.0, 0.01),
            (f"ankle_{side}", moves & leaves, -9.0, 0.01),
            (f"ankle_{side}", stands, -ahead, behind),
            (f"hip_rotation_{side}", stands | (steps & (flat | leaves)), -turn, turn),
        ]
    assert_held(hold_stopping, rng, state, bounds)


def test_a_body_that_sways_forwards_in_a_stand_can_be_held() -> None:
    """The pressure may come before the capture point, wherever it lies.

    That point is counted from the standing point, which is 4 mm behind the feet's centres of mass.
    """
    capture = np.linspace(-0.04, 0.08, 25)
    state = np.zeros(len(capture), WALKER)
    state["stopping"] = state["closing"] = True
    state["capture"], state["weight"] = capture, 700.0
    state["sensor"][:, SENSOR_TOUCH.start + 1] = 700.0
    found = np.full((1, N_SERVOS, len(capture)), -1.0)
    hold_stopping(Columns(state), REFERENCE.view(np.recarray)[0], found)
    ankle = INDEX["ankle_r"]
    before_the_ankle = -REFERENCE["kp"][0, ankle] * found[0, ankle] / 700.0
    standing_point = build_body(Subject().build, timestep=STEP).body("foot_r").ipos[0] - 0.004
    assert (before_the_ankle > capture + standing_point + 0.02).all()


def closing(gate: float, n: int = 4) -> np.ndarray:
    """Walkers whose gates close, in either stance; the latter two are not about to come to rest."""
    state = np.zeros(n, WALKER)
    state["gate"], state["gate_before"], state["dt"], state["weight"] = gate, gate, 0.03, 700.0
    state["closing"], state["stopping"] = True, np.arange(n) < 2
    state["left_stance"] = np.arange(n) % 2 == 0
    state["phase"], state["stagger"], state["speed"] = 0.3, 0.1, 0.1
    state["up"][:, 2] = 1.0
    return state


def of_leg(side: str, *joints: str) -> list[int]:
    """Servos of a leg."""
    return [INDEX[f"{joint}_{side}"] for joint in joints]


def test_the_leg_that_the_last_step_is_taken_from_takes_the_stands_pose_at_once() -> None:
    """Its gate closes twelve times as fast, that of other servos, and on steep slopes, as fast as ever."""

    def angles(gate: float) -> np.ndarray:
        out = np.empty((1, N_SERVOS, 4))
        state = closing(gate)
        targets(Columns(state), REFERENCE.view(np.recarray)[0], np.empty((1, 4), int), out)
        return out[0].T

    walks, stands = angles(1.0), angles(0.0)
    for gate in (0.98, 0.95, 0.5):
        found = angles(gate)
        for row, leaves in enumerate("rlrl"):
            for side in "rl":
                share = max(0.0, 1 - 12 * (1 - gate)) if row < 2 and side == leaves else gate
                leg = of_leg(side, "hip_flexion", "hip_adduction", "knee", "subtalar")
                expected = share * walks[row] + (1 - share) * stands[row]
                np.testing.assert_allclose(found[row, leg], expected[leg], atol=1e-12)
            trunk = [INDEX["lumbar_roll"], INDEX["shoulder_r"]]
            expected = gate * walks[row] + (1 - gate) * stands[row]
            np.testing.assert_allclose(found[row, trunk], expected[trunk], atol=1e-12)
    assert np.abs(walks - stands)[:, of_leg("r", "hip_flexion")].min() > 0.1


def test_that_leg_is_held_by_the_stand_twice_as_fast() -> None:
    """Feedback, policy and the stand's hold blend likewise."""

    def residual(gate: float) -> np.ndarray:
        state = closing(gate)
        act_all(state, gain_records(np.array([GAIN_START])), np.full((4, N_SERVOS), 0.3))
        assert (state["closing"] & state["stopping"]).all()
        return state["next_residual"]

    walks, gentle, half, stands = (residual(gate) for gate in (1.0, 0.9, 0.5, 0.4))
    for row, leaves in enumerate("rl"):
        for side in "rl":
            leg = of_leg(side, "hip_flexion", "hip_adduction", "knee")
            if side == leaves:
                np.testing.assert_array_equal(half[row, leg], stands[row, leg])
                expected = 0.8 * walks[row] + 0.2 * stands[row]
            else:
                expected = 0.8 * walks[row] + 0.2 * half[row]
            np.testing.assert_allclose(gentle[row, leg], expected[leg], atol=1e-12)
            assert np.abs(walks[row, leg] - stands[row, leg]).max() > 0.1
