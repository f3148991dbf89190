"""Walks are kept by content, walked by one process alone, listed and thrown out."""

import os
import threading
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.models.mount import MOUNTS
from footfall.models.policy import stock_policy
from footfall.models.subject import SUBJECTS
from footfall.simulate import cache
from footfall.simulate.cache import cached_walk, cached_walks, plan_key, prune
from footfall.simulate.plan import Disturbance, Pace, Stop
from footfall.simulate.walk import footfalls_path
from tests.helpers.commands import one_document


@pytest.fixture
def walked(monkeypatch, short_walk):
    """The plans that were walked at once, by a walker who always makes the short walk."""
    plans = []

    def walks(given, policy, on_progress):
        plans.append([*given])
        for plan in given:
            told = {"scenario": plan.name, "seed": plan.seed, "rate_hz": plan.rate_hz}
            yield replace(short_walk, meta=short_walk.meta | told)

    monkeypatch.setattr(cache, "walks", walks)
    return plans


def at(folder: Path, plan) -> Path:
    return folder / f"{plan_key(plan, stock_policy())}.parquet"


def test_a_plan_is_walked_once(tmp_path, walked, short_plan, short_walk):
    folder = tmp_path / "new" / "cache"
    cached_walk(short_plan, folder=folder)
    found = cached_walk(short_plan, folder=folder)
    assert len(walked) == 1
    assert found.sha == short_walk.sha
    cached_walk(replace(short_plan, seed=6), folder=folder)
    assert len(walked) == 2
    assert not [file for file in folder.iterdir() if file.suffix != ".parquet"]


def test_other_truths_of_the_same_steps_are_kept_too(tmp_path, walked, short_plan):
    heel = replace(short_plan, mount=MOUNTS["heel"])
    coarse = replace(short_plan, rate_hz=100.0, name="coarse")
    cached_walk(heel, folder=tmp_path)
    all_three = [heel, short_plan, coarse]
    first = cached_walk(short_plan, also=all_three, folder=tmp_path)
    assert [[plan.name, plan.mount, plan.rate_hz] for plan in walked[1]] == [
        [plan.name, plan.mount, plan.rate_hz] for plan in (short_plan, coarse)
    ]
    assert first.meta["rate_hz"] == 200.0
    assert all(at(tmp_path, plan).is_file() for plan in all_three)
    second = cached_walk(coarse, also=all_three, folder=tmp_path)
    assert (len(walked), second.meta["rate_hz"], second.meta["scenario"]) == (2, 100.0, "coarse")


def test_another_truth_that_cannot_be_told_costs_only_itself(tmp_path, monkeypatch, short_plan, short_walk):
    def walks(*_):
        yield short_walk
        raise InputError("short: the walker made 2 footfalls, expected at least 3")

    monkeypatch.setattr(cache, "walks", walks)
    heel = replace(short_plan, mount=MOUNTS["heel"])
    assert cached_walk(short_plan, also=[heel], folder=tmp_path).sha == short_walk.sha
    assert at(tmp_path, short_plan).is_file()
    assert not at(tmp_path, heel).exists()


@pytest.mark.parametrize("part", ["walk", "footfalls"])
@pytest.mark.parametrize("damage", ["torn", "gone"])
def test_what_is_damaged_is_walked_again(tmp_path, walked, short_plan, short_walk, part, damage):
    cached_walk(short_plan, folder=tmp_path)
    file = at(tmp_path, short_plan)
    file = file if part == "walk" else footfalls_path(file)
    file.write_bytes(b"PAR1 torn") if damage == "torn" else file.unlink()
    assert cached_walk(short_plan, folder=tmp_path).sha == short_walk.sha
    assert len(walked) == 2
    cached_walk(short_plan, folder=tmp_path)
    assert len(walked) == 2


def test_a_copy_of_a_scenario_does_not_walk_again_and_keeps_its_name(tmp_path, walked, short_plan):
    cached_walk(short_plan, folder=tmp_path)
    copy = cached_walk(replace(short_plan, name="copy"), folder=tmp_path)
    assert (len(walked), copy.meta["scenario"]) == (1, "copy")
    assert cached_walk(short_plan, folder=tmp_path).meta["scenario"] == "short"


def test_the_key_knows_everything_that_matters(short_plan):
    gait, policy = short_plan.gait, stock_policy()
    gaits = ({"pace_m_s": 1.2}, {"variability": 0.9}, {"placement_variability": 0.9},
             {"cadence_variability": 0.9}, {"toe_out_variability": 0.9}, {"action_noise": 0.1},
             {"wander_m": 0.11}, {"wander_time_s": 5.0})  # fmt: skip
    plans = [
        short_plan,
        *(replace(short_plan, gait=replace(gait, **changed)) for changed in gaits),
        replace(short_plan, seed=6),
        replace(short_plan, rate_hz=100.0),
        replace(short_plan, calibration_s=27.0),
        replace(short_plan, mount=MOUNTS["heel"]),
        replace(short_plan, subject=SUBJECTS["taller"]),
        replace(short_plan, stops=(Stop(9.0, 4.0),)),
        replace(short_plan, paces=(Pace(9.0, 1.2),)),
        replace(short_plan, disturbance=Disturbance(1.0)),
        replace(short_plan, route=replace(short_plan.route, x=short_plan.route.x + 1e-9)),
    ]
    keys = {plan_key(plan, policy) for plan in plans}
    assert len(keys) == len(plans)
    assert plan_key(short_plan, replace(policy, digest="other")) not in keys


def test_two_at_once_walk_once_and_the_second_is_told_to_wait(tmp_path, monkeypatch, short_plan, short_walk):
    walks, waits, found = [], [], []
    begun, go = threading.Event(), threading.Event()

    def walk(*_):
        walks.append(1)
        begun.set()
        assert go.wait(20)
        yield short_walk

    def get():
        found.append(cached_walk(short_plan, folder=tmp_path, on_wait=wait))

    def wait():
        waits.append(1)
        go.set()  # only now does the first come to its end

    monkeypatch.setattr(cache, "walks", walk)
    first, second = threading.Thread(target=get), threading.Thread(target=get)
    first.start()
    assert begun.wait(20)
    second.start()
    second.join(20)
    first.join(20)
    assert (len(walks), len(waits), len(found)) == (1, 1, 2)
    assert {walk.sha for walk in found} == {short_walk.sha}


def test_a_lock_that_a_dead_process_left_is_no_obstacle(tmp_path, walked, short_plan):
    at(tmp_path, short_plan).with_suffix(".lock").touch()
    waits = []
    cached_walk(short_plan, folder=tmp_path, on_wait=lambda: waits.append(1))
    assert (len(walked), waits) == (1, [])


def test_whoever_fell_leaves_no_lock_and_no_file(tmp_path, monkeypatch, short_plan):
    def fall(*_):
        raise InputError("short: the walker fell")

    monkeypatch.setattr(cache, "walks", fall)
    for _ in range(2):
        with pytest.raises(InputError, match="fell"):
            cached_walk(short_plan, folder=tmp_path)
    assert not list(tmp_path.iterdir())


def test_a_folder_that_cannot_be_written_is_named_before_walking(tmp_path, walked, short_plan):
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match=r"file/cache: walks cannot be kept there \(Not a directory\)$"):
        cached_walk(short_plan, folder=tmp_path / "file" / "cache")
    assert not walked


@pytest.fixture
def three(tmp_path, walked, short_plan):
    """A cache of three walks, last used 3, 2 and 1 hours ago, and their sizes."""
    plans = [replace(short_plan, seed=seed) for seed in (1, 2, 3)]
    for hours, plan in zip((3, 2, 1), plans, strict=True):
        cached_walk(plan, folder=tmp_path)
        os.utime(at(tmp_path, plan), (time.time() - 3600 * hours,) * 2)
    return plans


def test_the_list_says_what_and_when_and_how_much(tmp_path, three):
    walks = cached_walks(tmp_path)
    assert [(one.scenario, one.subject, one.seed) for one in walks] == [
        ("short", "reference", seed) for seed in (3, 2, 1)
    ]
    assert sum(one.size for one in walks) == sum(file.stat().st_size for file in tmp_path.iterdir())
    assert walks[0].used == pytest.approx(time.time() - 3600, abs=60)
    walks[1].file.write_bytes(b"PAR1 torn")
    damaged = cached_walks(tmp_path)[0]
    assert (damaged.scenario, damaged.seed) == (None, None)
    assert cached_walks(tmp_path / "nowhere") == []


def test_what_was_not_used_for_longest_goes_first(tmp_path, three):
    sizes = {one.seed: one.size for one in cached_walks(tmp_path)}
    cached_walk(three[0], folder=tmp_path)  # now the last used
    assert prune(sum(sizes.values()), tmp_path) == []
    removed = prune(sizes[1] + sizes[3], tmp_path)
    assert [one.seed for one in removed] == [2]
    assert [one.seed for one in cached_walks(tmp_path)] == [1, 3]
    assert [one.seed for one in prune(sizes[1] + sizes[3] - 1, tmp_path)] == [3]
    assert [one.seed for one in prune(0, tmp_path)] == [1]
    assert not list(tmp_path.iterdir())


def test_what_killed_processes_left_goes_too(tmp_path, three):
    (tmp_path / "abc.lock").touch()
    old, new = tmp_path / ".a.parquet.1.tmp", tmp_path / ".b.parquet.2.tmp"
    for file in (old, new):
        file.touch()
    os.utime(old, (time.time() - 7200,) * 2)
    assert prune(10**12, tmp_path) == []
    assert {file.name for file in tmp_path.iterdir() if file.suffix != ".parquet"} == {new.name}


def test_the_command_lists_and_prunes(cli, tmp_path, monkeypatch, three):
    monkeypatch.setattr(cache, "cache_folder", lambda: tmp_path)
    code, out, err = cli("cache")
    assert (code, err) == (0, f"3 walks, {sum(f.stat().st_size for f in tmp_path.iterdir()) / 1e6:.0f} MB "
                              f"in {tmp_path}\n")  # fmt: skip
    assert out.count("short") == out.count("reference") == 3
    assert cli("cache list")[1] == out
    listed = one_document(cli("cache list --json")[1])
    assert [walk["seed"] for walk in listed["walks"]] == [3, 2, 1]
    assert listed["bytes"] == sum(walk["bytes"] for walk in listed["walks"])
    code, out, err = cli(f"cache prune --keep {listed['bytes'] - 1} --json")
    told = one_document(out)
    assert (code, err, [walk["seed"] for walk in told["removed"]]) == (0, "", [1])
    assert told["bytes"] + told["bytes_removed"] == listed["bytes"]
    code, out, err = cli("cache prune --keep 0.5kB")
    assert (code, out, err) == (0, "", f"2 removed, {told['bytes'] / 1e6:.0f} MB; 0 left, 0 MB\n")
    for size in ("much", "-5GB", "5 furlongs"):
        code, out, err = cli(f"cache prune --keep '{size}'")
        assert (code, out) == (2, "")
        assert err == f"footfall: --keep '{size}': expected a size such as 500MB or 10GB\n"


def test_a_walk_from_the_cache_is_the_walk_to_the_last_bit(tmp_path, walked, short_plan, short_walk):
    cached_walk(short_plan, folder=tmp_path)
    found = cached_walk(short_plan, folder=tmp_path)
    for name in ("t", "position", "quaternion", "velocity", "gyro", "accel", "contact", "stance"):
        np.testing.assert_array_equal(getattr(found, name), getattr(short_walk, name))
    assert found.meta == short_walk.meta
