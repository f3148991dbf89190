"""Fixtures that every room's tests share."""

import contextlib
import shlex
import shutil
from pathlib import Path

import pytest
from hypothesis import settings

from tests.helpers.places import ROOT

# Compilation and a busy machine make single examples slow; no test judges by the clock.
settings.register_profile("footfall", deadline=None)
settings.load_profile("footfall")


@pytest.fixture(scope="session")
def real_data() -> Path:
    """The folder of real recordings, which only developers have beside their checkout."""
    folder = ROOT.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip("no real recordings beside this checkout")
    return folder


@pytest.fixture(scope="session")
def short_plan():  # type: ignore[no-untyped-def]
    """A 40 m walk with one 90 degree corner, people's variability, 26 s of calibration."""
    from footfall.scenarios.path import PathSpec, build_path
    from footfall.simulate.plan import Gait, Plan

    elements = [
        {"kind": "straight", "length_m": 20.0},
        {"kind": "corner", "turn_deg": 90.0, "radius_m": 2.5},
        {"kind": "straight", "length_m": 20.0},
    ]
    path = build_path(PathSpec.model_validate({"elements": elements}))
    return Plan(name="short", route=path.route, gait=Gait(wander_m=0.1), calibration_s=26.0, seed=5)


@pytest.fixture(scope="session")
def short_walk(short_plan):  # type: ignore[no-untyped-def]
    """The walk of `short_plan`."""
    from footfall.simulate.walking import walk

    return walk(short_plan)


@pytest.fixture(scope="session", autouse=True)
def cache(tmp_path_factory):  # type: ignore[no-untyped-def]
    """Walks that the command line makes are cached for these tests alone, not for their user."""
    folder = tmp_path_factory.mktemp("cache")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(folder))
        yield folder


@pytest.fixture
def cli(capsys):  # type: ignore[no-untyped-def]
    """Run a command line in this process: `cli("list --json")` gives exit code, standard output and error."""
    from footfall.cli.app import main

    def run(line: str) -> tuple[int, str, str]:
        capsys.readouterr()
        code = main(shlex.split(line))
        return code, *capsys.readouterr()

    return run


@pytest.fixture(scope="session")
def workshop(tmp_path_factory):  # type: ignore[no-untyped-def]
    """A folder with short.toml and what the commands made of it: walk, rec, pdr and hdr .parquet."""
    from footfall.cli.app import main

    folder = tmp_path_factory.mktemp("workshop")
    (folder / "short.toml").write_text(SHORT, encoding="utf-8")
    for line in (
        "walk short.toml -o walk.parquet",
        "record walk.parquet --unit-seed 7 -o rec.parquet",
        "track rec.parquet --method pdr -o pdr.parquet",
        "track rec.parquet -o hdr.parquet",
    ):
        with contextlib.chdir(folder):
            assert main(line.split()) == 0
    return folder


@pytest.fixture
def here(workshop, tmp_path, monkeypatch):  # type: ignore[no-untyped-def]
    """A copy of the workshop, which is the working folder."""
    folder = tmp_path / "here"
    shutil.copytree(workshop, folder)
    monkeypatch.chdir(folder)
    return folder


SHORT = """
description = "thirty metres round one corner"
subjects = ["reference", "shorter"]

[path]
elements = [
  { kind = "straight", length_m = 16.0 },
  { kind = "corner", turn_deg = 90.0, radius_m = 2.5 },
  { kind = "straight", length_m = 16.0 },
]

[gait]
pace_m_s = 1.3

[temperature]
indoors_degC = 20.0
outdoors_degC = 20.0

[sensor]
imu = "nimu"
calibration_s = 26.0

[seeds]
base = 3
walks = 2
"""
