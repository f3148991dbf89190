"""Fixtures that every room's tests share."""

from pathlib import Path

import pytest
from hypothesis import settings

# Compilation and a busy machine make single examples slow; no test judges by the clock.
settings.register_profile("footfall", deadline=None)
settings.load_profile("footfall")


@pytest.fixture(scope="session")
def real_data() -> Path:
    """The folder of real recordings, which only developers have beside their checkout."""
    folder = Path(__file__).resolve().parents[2] / "shared" / "data"
    if not folder.is_dir():
        pytest.skip("no real recordings beside this checkout")
    return folder


@pytest.fixture(scope="session")
def short_plan():  # type: ignore[no-untyped-def]
    """A 40 m walk with one 90 degree corner, people's variability, 26 s of calibration."""
    from footfall.scenarios.path import PathSpec, build_path
    from footfall.simulate.journey import Plan

    elements = [
        {"kind": "straight", "length_m": 20.0},
        {"kind": "corner", "turn_deg": 90.0, "radius_m": 2.5},
        {"kind": "straight", "length_m": 20.0},
    ]
    path = build_path(PathSpec.model_validate({"elements": elements}))
    return Plan(name="short", route=path.route, pace=1.3, calibration=26.0, wander=0.1, seed=5)


@pytest.fixture(scope="session")
def short_walk(short_plan):  # type: ignore[no-untyped-def]
    """The walk of `short_plan`."""
    from footfall.simulate.journey import walk

    return walk(short_plan)
