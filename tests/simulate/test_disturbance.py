"""Pushes: an impulse is what was asked for, when it was asked for, and nothing else is."""

import numpy as np
import pytest

from footfall.models.body import build_body
from footfall.models.subject import Build, Habits
from footfall.simulate.plan import Disturbance
from footfall.simulate.walker.disturbance import PUSH_S, Pusher, pushes
from footfall.simulate.walker.walkers import N_ACTION, Walkers


def airborne() -> Walkers:
    """A body a metre above its stand, where nothing but gravity and its own joints act."""
    walkers = Walkers([build_body(Build(), timestep=0.001)], np.zeros(32), rng=np.random.default_rng(1))
    one = np.ones(1, dtype=bool)
    walkers.place(
        one,
        phase=np.zeros(1),
        speed=np.zeros(1),
        heading=np.zeros(1),
        position=np.array([[0.0, 0.0, 1.0]]),
        standing=one,
        variability=np.zeros(1),
        habits=[Habits()],
    )
    return walkers


def test_pushes_come_on_time_with_their_impulse() -> None:
    given = pushes(Disturbance(10.0, 7.0), first=30.0, until=60.0, rng=np.random.default_rng(3))
    assert [push.t for push in given] == [37.0, 44.0, 51.0, 58.0]
    np.testing.assert_allclose([np.hypot(*push.impulse) for push in given], 10.0)
    longer = pushes(Disturbance(10.0, 7.0), first=30.0, until=90.0, rng=np.random.default_rng(3))
    assert longer[:4] == given


def test_the_force_adds_up_to_the_impulse() -> None:
    given = pushes(Disturbance(10.0, 1.0), first=0.0, until=3.5, rng=np.random.default_rng(3))
    pusher = Pusher(given, start=2.0)
    forces = [pusher.force(k * 0.03, 0.5) for k in range(int(6 / 0.03))]
    pushed = [force for force in forces if force is not None]
    assert len(pushed) == 3 * round(PUSH_S / 0.03)
    total = np.sum(pushed, axis=0)[0] * 0.03
    np.testing.assert_allclose(total[:2], 0.5 * np.sum([push.impulse for push in given], axis=0))
    assert forces[int(2.9 / 0.03)] is None
    assert forces[int(3.0 / 0.03) + 1] is not None


def test_a_push_gives_the_body_its_impulse_and_leaves_nothing_behind() -> None:
    """Above the ground the momentum changes by force times time, and then no more."""
    walkers, still = airborne(), airborne()
    idle, force = np.zeros((1, N_ACTION)), np.array([[111.0, -60.0, 0.0]])
    mass = float(sum(walkers.models[0].body_mass))

    def momentum(w: Walkers) -> np.ndarray:
        import mujoco

        data = mujoco.MjData(w.models[0])
        data.qpos[:], data.qvel[:] = w.qpos[0], w.qvel[0]
        mujoco.mj_forward(w.models[0], data)
        mujoco.mj_subtreeVel(w.models[0], data)
        return mass * np.array(data.subtree_linvel[1])

    for k in range(5):
        walkers.step(idle, force if k == 1 else None)
        still.step(idle)
    np.testing.assert_allclose(momentum(walkers) - momentum(still), force[0] * 0.03, atol=0.02)
    walkers.close()
    still.close()


def test_a_push_of_nothing_is_no_push() -> None:
    walkers, still = airborne(), airborne()
    for _ in range(3):
        walkers.step(np.zeros((1, N_ACTION)), np.zeros((1, 3)))
        still.step(np.zeros((1, N_ACTION)))
    np.testing.assert_array_equal(walkers.qpos, still.qpos)


@pytest.mark.parametrize("every", [1.0, 10.0])
def test_pushes_go_anywhere(every: float) -> None:
    given = pushes(Disturbance(10.0, every), first=0.0, until=400 * every, rng=np.random.default_rng(1))
    angles = np.array([np.arctan2(*push.impulse[::-1]) for push in given])
    assert np.abs(np.exp(1j * angles).mean()) < 0.12
