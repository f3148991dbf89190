"""Walks, recordings and tracks carry who they are, and are not mistaken for one another."""

import json
from dataclasses import dataclass, replace

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.hdr.methods import METHODS, Reckoning, tracks
from footfall.identity import WalkIdentity, digest_of, plain
from footfall.models.imu import draw_unit, load_spec
from footfall.models.imu.override import overridden
from footfall.models.mount import MOUNTS, Mount
from footfall.models.policy import stock_policy
from footfall.models.route import Ground
from footfall.models.subject import Subject
from footfall.pdr.detectors import DETECTORS
from footfall.pdr.reckoning import PdrParams
from footfall.pdr.track import read_track, write_track
from footfall.recording import read_recording, write_recording
from footfall.scenarios.judge.score import score
from footfall.scenarios.path import PathSpec, build_path
from footfall.scenarios.trial import start_pose
from footfall.simulate.cache import plan_key
from footfall.simulate.from_recording import add_errors
from footfall.simulate.identity import mount_name, walk_identity
from footfall.simulate.plan import Disturbance, Gait, Pace, Stop
from footfall.simulate.record import record
from footfall.simulate.walk import read_walk, write_walk


def straight(length):
    return build_path(PathSpec.model_validate({"elements": [{"kind": "straight", "length_m": length}]})).route


OTHERS = {
    "seed": {"seed": 6},
    "mount": {"mount": MOUNTS["heel"]},
    "mount's pose": {"mount": Mount(euler_deg=(0.0, 20.1, 0.0))},
    "path": {"route": straight(30.0)},
    "subject": {"subject": Subject(height_m=1.74)},
    "ground": {"ground": Ground(-9.0, -9.0, 1.0, np.zeros((60, 60), dtype=np.float32))},
    "ground's height": {"ground": Ground(-9.0, -9.0, 1.0, np.eye(60, dtype=np.float32))},
    "pace": {"gait": Gait(pace_m_s=1.31, wander_m=0.1)},
    "paces": {"paces": (Pace(9.0, 1.2),)},
    "stops": {"stops": (Stop(9.0, 4.0),)},
    "variability": {"gait": Gait(variability=0.9, wander_m=0.1)},
    "wander": {"gait": Gait(wander_m=0.2)},
    "calibration": {"calibration_s": 27.0},
    "push": {"disturbance": Disturbance(1.0)},
    "rate": {"rate_hz": 100.0},
}


def test_no_two_plans_are_the_same_walk(short_plan):
    policy = stock_policy()
    plans = [short_plan, *(replace(short_plan, **other) for other in OTHERS.values())]
    identities = [walk_identity(plan, policy) for plan in plans]
    for made in (
        {one.scenario_digest for one in identities},
        {one.digest for one in identities},
        {str(one) for one in identities},
        {plan.digest for plan in plans},
        {plan_key(plan, policy) for plan in plans},
    ):
        assert len(made) == len(plans)
    assert walk_identity(replace(short_plan), policy) == identities[0]
    assert walk_identity(short_plan, replace(policy, digest="other")) != identities[0]


def test_a_copy_of_a_scenario_is_the_same_walk(short_plan, short_walk, recording):
    policy, copy = stock_policy(), replace(short_plan, name="copy")
    ours, theirs = walk_identity(short_plan, policy), walk_identity(copy, policy)
    assert (theirs, theirs.digest, theirs.scenario) == (ours, ours.digest, "copy")
    assert plan_key(copy, policy) == plan_key(short_plan, policy)
    track = tracks(Reckoning(recording, start_pose(short_walk)), ["pdr"])["pdr"]
    named = replace(short_walk, meta=short_walk.meta | theirs.as_dict())
    assert score(track, named) == score(track, short_walk)


def test_mounts_have_their_names():
    assert [mount_name(mount) for mount in MOUNTS.values()] == list(MOUNTS)
    assert mount_name(replace(Mount())) == "instep"
    assert mount_name(Mount(euler_deg=(0.0, 20.1, 0.0))) == "custom"


@dataclass(frozen=True)
class One:
    a: tuple[float, ...] = (1.0, 2.0)


@dataclass(frozen=True)
class Two:
    a: tuple[float, ...] = (1.0, 2.0)


def test_a_digest_is_of_content_and_of_all_of_it():
    contents = [
        (1.0, 2.0), ((1.0,), 2.0), (1.0, (2.0,)), 12, "12", ("1", "2"), ("12", ""), b"12", 3132, (12, 3),
        (1, 23), None, True, 1, 1.0,
        np.zeros(2), np.zeros((2, 1)), np.zeros(2, dtype=np.float32), np.arange(3000), np.arange(3000) % 2999,
        {"a": 1}, {"b": 1}, {"a": (1.0, 2.0)}, One(), Two(), One((1.0, 2.5)), float("nan"), float("inf"),
    ]  # fmt: skip
    assert len({digest_of(content) for content in contents}) == len(contents)
    assert digest_of({"a": 1, "b": 2}) == digest_of({"b": 2, "a": 1})
    assert digest_of(np.float64(0.1), [1, 2]) == digest_of(0.1, (1, 2))
    assert digest_of("a", "b") != digest_of("ab")


def test_settings_are_plain():
    settings = plain({"one": One((float("inf"), np.float32(0.5))), "two": (1, None, True), "three": len})
    assert json.loads(json.dumps(settings)) == settings
    assert settings == {
        "one": {"a": [None, 0.5]},
        "two": [1, None, True],
        "three": "builtin_function_or_method",
    }


@pytest.fixture
def recording(short_walk):
    unit = draw_unit(load_spec("nimu"), 7)
    return record(short_walk, unit, seed=9, without=["white"])


WITHOUT_FILTER = ("pdr", "hdr", "hdr-basic", "hde-2010", "hypotheses", "hypotheses-smooth")


def test_the_way_from_walk_to_track_is_told(short_walk, short_plan, recording, tmp_path):
    identity = walk_identity(short_plan, stock_policy())
    write_walk(short_walk, tmp_path / "walk.parquet")
    write_recording(recording, tmp_path / "rec.parquet")
    walk, back = read_walk(tmp_path / "walk.parquet"), read_recording(tmp_path / "rec.parquet")
    assert WalkIdentity.of(walk.meta) == WalkIdentity.of(back.meta) == identity
    assert walk.meta["mount"] == {
        "name": "instep", "foot": "right", "position": [0.075, 0.0, -0.01], "euler_deg": [0.0, 20.0, 0.0],
        "segment": "foot",
    }  # fmt: skip
    assert (back.meta["unit_seed"], back.meta["noise_seed"], back.meta["without"]) == (7, 9, ["white"])
    params = PdrParams(detector=DETECTORS["shoe"], tilt_gain=0.1)
    for name, track in tracks(Reckoning(back, start_pose(walk), params), METHODS).items():
        write_track(track, tmp_path / "track.parquet")
        meta = read_track(tmp_path / "track.parquet").meta
        assert WalkIdentity.of(meta) == identity
        assert (meta["method"], meta["unit_seed"], meta["noise_seed"]) == (name, 7, 9)
        assert (meta["pdr"]["tilt_gain"], meta["pdr"]["bias_s"]) == (0.1, 25.0)
        assert meta["pdr"]["detector"]["kind"] == type(params.detector).__name__
        assert len(meta["pdr"]["detector"]) > 1
        assert meta["start"]["heading_rad"] == start_pose(walk).heading
        assert "filter" in meta or name in WITHOUT_FILTER
        assert "params" in meta or name in ("pdr", "iez", "iez-paper")


def test_two_sheets_of_one_name_differ(short_walk, recording):
    unit = draw_unit(load_spec("nimu"), 7)
    louder = replace(unit, spec=replace(unit.spec, gyro=replace(unit.spec.gyro, white=1.0)))
    other = record(short_walk, louder, seed=9)
    assert other.meta["imu"] == recording.meta["imu"]
    assert other.meta["imu_digest"] != recording.meta["imu_digest"]


def test_another_imu_on_top_leaves_the_walk_what_it_is(recording):
    worse = add_errors(recording, draw_unit(load_spec("nimu"), 4), seed=2)
    assert WalkIdentity.of(worse.meta) == WalkIdentity.of(recording.meta)
    assert (worse.meta["added"]["unit_seed"], worse.meta["added"]["noise_seed"]) == (4, 2)


def test_a_track_of_another_walk_is_not_judged(short_walk, short_plan, recording):
    track = tracks(Reckoning(recording, start_pose(short_walk)), ["pdr"])["pdr"]
    score(track, short_walk)
    policy = stock_policy()
    for key in ("seed", "mount", "path", "subject"):
        other = walk_identity(replace(short_plan, **OTHERS[key]), policy)
        with pytest.raises(InputError, match=r"^track: [^.]*$") as refusal:
            score(track, replace(short_walk, meta=other.as_dict()))
        assert str(WalkIdentity.of(short_walk.meta)) in str(refusal.value)
        assert str(other) in str(refusal.value)
    # Nobody knows what these were made of.
    assert score(replace(track, meta={}), short_walk) == score(track, short_walk)
    assert score(track, replace(short_walk, meta={})) == score(track, short_walk)


def test_a_unit_given_by_hand_is_not_the_one_that_its_seed_draws(short_walk):
    unit = draw_unit(load_spec("nimu"), 7)
    drawn = record(short_walk, unit, seed=9).meta
    given = record(short_walk, overridden(unit, {"gyro.scale": [0.0, 0.0, 0.01]}), seed=9).meta
    assert drawn["unit_digest"] == record(short_walk, unit, seed=10).meta["unit_digest"]
    assert (drawn["unit_seed"], drawn["imu_digest"]) == (given["unit_seed"], given["imu_digest"])
    assert drawn["unit_digest"] != given["unit_digest"]
