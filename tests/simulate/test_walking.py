"""Walking a route: what the truth of a walk must be, and what must never come out."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from benchmarks.validation import scatter
from footfall.errors import InputError
from footfall.models.mount import MOUNTS
from footfall.models.policy import Policy, stock_policy
from footfall.models.route import Ground, Route
from footfall.models.subject import Subject
from footfall.pdr.strapdown import integrate
from footfall.runs import runs
from footfall.simulate.episode import STAND_S, Episode, FallError
from footfall.simulate.plan import Disturbance, Gait, Pace, Plan, Stop
from footfall.simulate.walk import Walk, footfalls_path, read_walk, write_walk
from footfall.simulate.walking import walk, walks


def test_it_goes_where_the_route_goes(short_plan: Plan, short_walk: Walk) -> None:
    route, line = short_plan.route, np.column_stack([short_plan.route.x, short_plan.route.y])
    places = short_walk.footfalls.position[:, :2]
    off = np.array([np.linalg.norm(line - place, axis=1).min() for place in places])
    assert off[:-3].max() < 0.6
    assert off.max() < 1.2  # it may take a step more to stop
    assert np.linalg.norm(places[0] - line[0]) < 2.0
    assert np.linalg.norm(places[-1] - line[-1]) < 2.0
    walked = np.hypot(*np.diff(places, axis=0).T).sum()
    assert walked == pytest.approx(route.length, abs=2.5)


def test_it_walks_at_a_human_gait(short_walk: Walk) -> None:
    falls = short_walk.footfalls
    stride_time = np.diff(falls.t)[2:-2]
    assert 0.9 < np.median(stride_time) < 1.3
    stride_length = np.hypot(*np.diff(falls.position[:, :2], axis=0).T)
    speed = stride_length.sum() / (falls.t[-1] - falls.t[0])
    assert 0.9 < speed < 1.5
    walking = (short_walk.t > falls.t[2]) & (short_walk.t < falls.t[-3])
    assert 0.2 < short_walk.stance[walking].mean() < 0.5
    swing = np.degrees(np.linalg.norm(short_walk.gyro[walking], axis=1)).max()
    assert 350 < swing < 900


def test_it_stands_before_and_after(short_plan: Plan, short_walk: Walk) -> None:
    """A static bias may be taken before the first step: the foot turns by less than 0.1 deg/s."""
    waited = short_walk.t < short_plan.calibration_s - 0.1
    assert np.degrees(np.linalg.norm(short_walk.gyro[waited], axis=1)).max() < 0.1
    # What is left of it must not be taken for a bias: less than 0.2 deg over 20 minutes.
    attitude = Rotation.from_quat(short_walk.quaternion[waited][[0, -1]], scalar_first=True)
    turned = (attitude[0].inv() * attitude[1]).magnitude() / short_plan.calibration_s
    assert np.degrees(turned) * 1200 < 0.2
    np.testing.assert_allclose(np.linalg.norm(short_walk.accel[waited], axis=1), 9.80665, atol=0.05)
    assert short_walk.footfalls.t[0] == pytest.approx(short_plan.calibration_s, abs=0.02)
    end = short_walk.t > short_walk.t[-1] - 1.0
    assert short_walk.stance[end][:-5].all()
    assert np.degrees(np.linalg.norm(short_walk.gyro[end], axis=1)).max() < 0.5
    assert np.linalg.norm(short_walk.position[-1, :2] - short_walk.position[end][0, :2]) < 0.005


def test_it_pauses_where_it_is_asked_to(short_plan: Plan) -> None:
    rates = []
    for seed in (8, 9, 10):
        paused = walk(replace(short_plan, stops=(Stop(12.0, 6.0),), calibration_s=1.0, seed=seed))
        stances = runs(paused.stance) * (paused.t[1] - paused.t[0])
        long = stances[np.diff(stances, axis=1)[:, 0] > 3.0]
        assert len(long) == 2  # the pause and the end
        assert 5.5 < long[0, 1] - long[0, 0] < 10
        middle = paused.t.searchsorted(long[0].mean())
        line = np.column_stack([short_plan.route.x, short_plan.route.y])
        nearest = np.linalg.norm(line - paused.position[middle, :2], axis=1).argmin()
        assert short_plan.route.s[nearest] == pytest.approx(12.0, abs=1.2)
        still = slice(middle, middle + 200)
        rates.append(np.degrees(np.linalg.norm(paused.gyro[still], axis=1)).max())
    # Now and then (seed 8) a stand rocks for some seconds.
    assert np.median(rates) < 0.1
    assert max(rates) < 5.0


def test_the_parts_of_variability_are_each_times_the_whole(short_plan: Plan) -> None:
    """Placement, cadence and toe-out, in this order."""
    gait = Gait(variability=0.5, placement_variability=0.2, toe_out_variability=1.6)
    plan = replace(short_plan, gait=gait)
    level = Episode(plan, stock_policy().feedback_gains, stand=1.0).walkers.variability.level
    np.testing.assert_allclose(level, [[0.1, 0.5, 0.8]])
    level = Episode(
        replace(plan, gait=replace(gait, cadence_variability=0.0)), stock_policy().feedback_gains, stand=1.0
    )
    np.testing.assert_allclose(level.walkers.variability.level, [[0.1, 0.0, 0.8]])


def test_strides_on_long_straights_scatter_as_peoples_do() -> None:
    """Real feet there: course 0.6 to 1.4 deg, stance yaw 1.3 to 2.6 (SD about the straight line)."""
    # The taller one's scatter most.
    found = [scatter.measure(("taller", 1.3, 0.0, seed)) for seed in (901, 902, 903)]
    assert 0.6 < np.mean([one.course_sd_deg for one in found]) < 1.4
    assert 1.3 < np.mean([one.stance_yaw_sd_deg for one in found]) < 2.6


def test_it_changes_its_pace_where_it_is_asked_to(short_plan: Plan) -> None:
    n = 1201
    s, nil = np.arange(n) * 0.05, np.zeros(n)
    plan = replace(
        short_plan,
        route=Route(s, s, nil, nil, nil, nil),
        gait=replace(short_plan.gait, pace_m_s=0.9),
        paces=(Pace(25.0, 1.5),),
        calibration_s=1.0,
    )
    falls = walk(plan).footfalls
    x = falls.position[:, 0]
    for begin, end, pace in ((6.0, 23.0, 0.9), (32.0, 55.0, 1.5)):
        there = (x > begin) & (x < end)
        assert np.ptp(x[there]) / np.ptp(falls.t[there]) == pytest.approx(pace, rel=0.06)


def test_a_fall_after_the_path_spoils_the_stand_and_not_the_walk(short_plan: Plan, short_walk: Walk) -> None:
    class Clumsy(Policy):
        """Walks as it should and loses its head at the end."""

        calls = 0

        def __call__(self, observation: np.ndarray) -> np.ndarray:
            Clumsy.calls += 1
            action = super().__call__(observation)
            return (
                action if Clumsy.calls < last else np.where(np.arange(action.shape[1]) % 2, 1.0, -1.0)[None]
            )

    assert short_walk.meta["ends"] == "standing"
    stances = runs(short_walk.stance)
    last = int((STAND_S + short_walk.t[stances[-1, 0]] - 0.5) / 0.03)
    policy = stock_policy()
    clumsy = walk(short_plan, Clumsy(policy.weights, policy.biases, policy.feedback_gains, "clumsy"))
    assert clumsy.meta["ends"] == "in mid-gait"
    n = len(clumsy.t)
    np.testing.assert_array_equal(clumsy.gyro[: n - 5], short_walk.gyro[: n - 5])
    assert clumsy.stance[-10:].any()
    assert np.linalg.norm(clumsy.footfalls.position[-1, :2] - short_walk.footfalls.position[-1, :2]) < 4


def test_a_pushed_walk_says_so(short_plan: Plan, short_walk: Walk) -> None:
    pushed = walk(replace(short_plan, disturbance=Disturbance(10.0, 5.0)))
    told = np.array(pushed.meta["pushes_s_Ns_Ns"])
    assert len(told) >= 4
    np.testing.assert_allclose(np.hypot(told[:, 1], told[:, 2]), 10.0)
    assert told[0, 0] == short_plan.calibration_s + 5.0
    assert "pushes_s_Ns_Ns" not in short_walk.meta
    before = slice(0, int((told[0, 0] - 0.1) * short_plan.rate_hz))
    np.testing.assert_array_equal(pushed.position[before], short_walk.position[before])
    after = int((told[0, 0] + 1.0) * short_plan.rate_hz)
    assert np.linalg.norm(pushed.position[after] - short_walk.position[after]) > 0.01


@pytest.mark.parametrize(("height", "mass"), [(1.52, 52.0), (1.93, 98.0)])
def test_people_walk_to_scale(short_plan: Plan, short_walk: Walk, height: float, mass: float) -> None:
    """The same Froude number: strides as long and as slow as the legs."""
    person = Subject("somebody", height_m=height, mass_kg=mass)
    pace = short_plan.gait.pace_m_s * person.time_scale
    other = walk(replace(short_plan, subject=person, gait=replace(short_plan.gait, pace_m_s=pace)))

    def stride(truth: Walk) -> tuple[float, float]:
        length = np.hypot(*np.diff(truth.footfalls.position[:, :2], axis=0).T)
        return float(np.median(np.diff(truth.footfalls.t))), float(np.median(length))

    (time, length), (reference_time, reference_length) = stride(other), stride(short_walk)
    assert time / reference_time == pytest.approx(person.time_scale, rel=0.05)
    assert length / reference_length == pytest.approx(person.scale, rel=0.08)
    # Every control step takes 30 ms of the person's own time: they stand as long as they are asked to.
    waited = other.t < short_plan.calibration_s - 0.1
    assert np.degrees(np.linalg.norm(other.gyro[waited], axis=1)).max() < 0.1
    still = other.t < 20
    assert np.linalg.norm(other.accel[still], axis=1).mean() == pytest.approx(9.80665, abs=0.02)


@pytest.mark.parametrize("rate", [1000.0, 200.0])
def test_integrating_the_perfect_imu_returns_the_walk(short_plan: Plan, rate: float) -> None:
    truth = walk(replace(short_plan, rate_hz=rate))
    out = integrate(
        truth.t,
        truth.gyro,
        truth.accel,
        quaternion=truth.quaternion[0],
        velocity=truth.velocity[0],
        position=truth.position[0],
    )
    assert np.linalg.norm(out.position - truth.position, axis=1).max() < 1e-3


def test_the_same_plan_gives_the_same_bytes(short_plan: Plan, short_walk: Walk) -> None:
    again = walk(short_plan)
    for name in ("t", "position", "quaternion", "gyro", "accel", "contact", "stance"):
        np.testing.assert_array_equal(getattr(again, name), getattr(short_walk, name))
    other = walk(replace(short_plan, seed=6))
    assert not np.array_equal(other.footfalls.position[5], short_walk.footfalls.position[5])


@pytest.fixture(scope="module")
def seen(short_plan: Plan) -> dict[str, Walk]:
    """One walk from several places and, as "coarse", at another rate."""
    plans = {name: replace(short_plan, mount=MOUNTS[name]) for name in ("shank", "instep", "medial")}
    plans["coarse"] = replace(short_plan, rate_hz=100.0)
    return dict(zip(plans, walks(list(plans.values())), strict=True))


def test_several_truths_of_one_walk_have_the_bits_of_each_alone(
    short_plan: Plan, short_walk: Walk, seen: dict[str, Walk]
) -> None:
    assert seen["instep"].sha == short_walk.sha
    assert seen["instep"].meta == short_walk.meta
    assert seen["medial"].sha == walk(replace(short_plan, mount=MOUNTS["medial"])).sha
    assert seen["medial"].meta["mount"]["name"] == "medial"
    coarse = seen["coarse"]
    assert (coarse.interval, coarse.meta["rate_hz"]) == (pytest.approx(0.01), 100.0)
    fine = np.searchsorted(short_walk.footfalls.t, coarse.footfalls.t[5])
    apart = short_walk.footfalls.position - coarse.footfalls.position[5]
    assert np.linalg.norm(apart, axis=1).min() < 0.005
    assert abs(fine - 5) <= 1


def test_only_plans_of_the_same_steps_are_walked_at_once(short_plan: Plan) -> None:
    with pytest.raises(ValueError, match="mount and rate alone"):
        next(walks([short_plan, replace(short_plan, seed=6)]))
    with pytest.raises(InputError, match="rate = 300 Hz"):
        next(walks([short_plan, replace(short_plan, rate_hz=300.0)]))


def test_a_mount_turns_the_measurement_and_not_the_walk(short_plan: Plan, seen: dict[str, Walk]) -> None:
    """Two IMUs on one foot: the turning rates differ by their constant relative attitude."""
    medial, instep = seen["medial"], seen["instep"]
    still = int(25 * short_plan.rate_hz)
    relative = _attitude(instep, 0).inv() * _attitude(medial, 0)
    assert np.degrees(relative.magnitude()) == pytest.approx(20.0, abs=2.0)
    peak = np.percentile(np.linalg.norm(medial.gyro[still:], axis=1), [50, 90, 99])
    same = np.percentile(np.linalg.norm(instep.gyro[still:], axis=1), [50, 90, 99])
    np.testing.assert_allclose(peak, same, rtol=0.03)


def test_a_shank_meets_its_foot_at_the_ankle_and_shares_its_stances(seen: dict[str, Walk]) -> None:
    shank, instep = seen["shank"], seen["instep"]
    ankles = []
    for name, one in (("shank", shank), ("instep", instep)):
        mount = MOUNTS[name]
        segment = _attitude(one) * Rotation.from_euler("ZYX", mount.euler_deg[::-1], degrees=True).inv()
        ankles.append(one.position - segment.apply(mount.position))
    np.testing.assert_allclose(ankles[0], ankles[1], atol=1e-6)
    for name in ("t", "contact", "stance"):
        np.testing.assert_array_equal(getattr(shank, name), getattr(instep, name))
    np.testing.assert_array_equal(shank.footfalls.t, instep.footfalls.t)
    # It is no place for zero velocity: in mid-stance it turns about the ankle and travels forwards.
    middle = np.searchsorted(shank.t, shank.footfalls.t[3:-2])
    speed, rate = (
        [float(np.median(np.linalg.norm(part[middle], axis=1))) for part in parts]
        for parts in ((shank.velocity, instep.velocity), (shank.gyro, instep.gyro))
    )
    assert speed[0] > 5 * speed[1]
    assert rate[0] > 2 * rate[1]
    assert np.median(shank.velocity[middle[:8], 0]) > 0.04
    assert shank.footfalls.heading[3] == pytest.approx(instep.footfalls.heading[3], abs=0.2)


def _attitude(one: Walk, rows: int | slice = slice(None)) -> Rotation:
    return Rotation.from_quat(one.quaternion[rows], scalar_first=True)


def test_it_climbs_what_the_ground_climbs(short_plan: Plan) -> None:
    """On a 4 % grade the IMU gains the height of the ground and the feet stay on it."""
    grade = 0.04
    x = np.arange(-12.0, 40.0, 0.5)
    ground = Ground(-12.0, -12.0, 0.5, np.tile(grade * x, (90, 1)).astype(np.float32))
    climbing = walk(replace(short_plan, ground=ground))
    falls = climbing.footfalls.position
    above = falls[:, 2] - grade * falls[:, 0]
    np.testing.assert_allclose(above, np.median(above), atol=0.012)
    assert falls[-1, 2] - falls[0, 2] > 0.6


def test_a_fall_ends_the_walk_with_a_sentence(short_plan: Plan) -> None:
    policy = stock_policy()
    lame = Policy(policy.weights, policy.biases, np.zeros(32), "lame")
    with pytest.raises(
        FallError,
        match=r"short: the walker fell at -?\d+ m \(\d+ s, subject reference, seed 5, pace 1\.3 m/s\)",
    ):
        walk(short_plan, lame)


def test_a_rate_that_does_not_divide_is_refused_before_walking(short_plan: Plan) -> None:
    with pytest.raises(InputError, match="rate = 300 Hz"):
        walk(replace(short_plan, rate_hz=300.0))


def test_walks_survive_their_files(tmp_path, short_walk: Walk) -> None:  # type: ignore[no-untyped-def]
    path = tmp_path / "walk.parquet"
    write_walk(short_walk, path)
    back = read_walk(path)
    assert back.sha == short_walk.sha
    # Of 8 bytes a float: what is kept of them.
    assert path.stat().st_size < 0.8 * 17 * 8 * len(short_walk.t)
    np.testing.assert_array_equal(back.quaternion, short_walk.quaternion)
    np.testing.assert_array_equal(back.footfalls.heading, short_walk.footfalls.heading)
    assert back.meta == short_walk.meta
    footfalls_path(path).unlink()
    with pytest.raises(InputError, match=r"walk\.footfalls\.parquet: no such file"):
        read_walk(path)
