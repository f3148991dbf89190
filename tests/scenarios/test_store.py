"""Footfalls that are kept, and the room that they share with walks."""

import os

import numpy as np
import pytest

from footfall.pdr.footfalls import Footfalls
from footfall.scenarios.store import (
    Reckoned,
    footfalls_folder,
    kept_footfalls,
    prune,
    read_footfalls,
    write_footfalls,
)
from footfall.simulate.cache import cached_walks
from footfall.simulate.walk import write_walk
from tests.helpers.commands import one_document
from tests.helpers.synthetic import synthetic_walk


def reckoned(strides=50):
    t = np.arange(float(strides))
    return Reckoned(Footfalls(t, t, t, t, t, np.zeros((strides, 3))), "sha")


@pytest.fixture
def kept(tmp_path, monkeypatch):
    """Two walks and two cases, used at 1, 3 and at 2, 4 s."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    folder = footfalls_folder()
    folder.parent.mkdir(parents=True)
    walk = synthetic_walk(strides=3)
    for name, used in (("a", 1), ("b", 3)):
        write_walk(walk, folder.parent / f"{name}.parquet")
        os.utime(folder.parent / f"{name}.parquet", (used, used))
    for name, used in (("c", 2), ("d", 4)):
        write_footfalls(folder / name / f"{name}.npz", reckoned())
        os.utime(folder / name / f"{name}.npz", (used, used))
    return folder


def names():
    return {one.file.stem for one in (*cached_walks(), *kept_footfalls())}


def sizes():
    return {one.file.stem: one.size for one in (*cached_walks(), *kept_footfalls())}


def test_what_was_not_used_for_longest_goes_first(kept):
    size = sizes()
    assert [one.file.stem for one in kept_footfalls()] == ["d", "c"]
    assert prune(sum(size.values())) == ([], [])
    walks, footfalls = prune(sum(size.values()) - 1)
    assert [one.file.stem for one in walks] == ["a"]
    assert not footfalls
    walks, footfalls = prune(size["d"] + size["b"])
    assert not walks
    assert [one.file.stem for one in footfalls] == ["c"]
    assert names() == {"b", "d"}
    assert prune(size["d"] + size["b"] - 1)[0][0].file.stem == "b"
    assert names() == {"d"}
    assert len(prune(0)[1]) == 1
    assert names() == set()


def test_reading_is_use(kept):
    assert read_footfalls(kept / "c" / "c.npz").recording_sha == "sha"
    assert [one.file.stem for one in kept_footfalls()] == ["c", "d"]
    assert read_footfalls(kept / "none.npz") is None


def test_the_command_tells_of_both(kept, cli):
    size = sizes()
    code, _, err = cli("cache list")
    assert code == 0
    assert "and the footfalls of 2 cases of studies" in err
    told = one_document(cli("cache list --json")[1])
    assert told["footfalls"] == {"cases": 2, "bytes": size["c"] + size["d"]}
    code, _, err = cli(f"cache prune --keep {size['d']}")
    assert code == 0
    assert "footfalls: 1 removed" in err
    assert names() == {"d"}
    assert one_document(cli("cache prune --keep 0 --json")[1])["footfalls"]["cases_removed"] == 1
