"""What `import footfall` gives, when it loads it, and gymnasium's environment beside it."""

import subprocess
import sys

import pytest

import footfall
import footfall.studies

HEAVY = (
    "numpy",
    "scipy",
    "gymnasium",
    "numba",
    "mujoco",
    "pyarrow",
    "pydantic",
    "typer",
    "matplotlib",
    "torch",
)


def told(code):
    """What a fresh process prints."""
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert found.returncode == 0, found.stderr
    return found.stdout.strip()


def test_importing_footfall_loads_nothing_else():
    loaded = f"print([name for name in sys.modules if name.split('.')[0] in {HEAVY!r}])"
    assert told(f"import sys, footfall; {loaded}") == "[]"


def test_every_public_name_is_there():
    missing = (
        "[name for name in footfall.__all__ if name not in dir(footfall) or not hasattr(footfall, name)]"
    )
    assert told(f"import footfall; print({missing})") == "[]"
    assert told("from footfall import *; print(METHODS['hdr'].name, read.__name__)") == "hdr read"


def test_the_door_to_studies_loads_nothing_before_it_is_used():
    loaded = f"print([name for name in sys.modules if name.split('.')[0] in {HEAVY!r}])"
    assert told(f"import sys, footfall.studies; {loaded}") == "[]"
    names = "from footfall.studies import *; print(Study.__name__, sweep.__name__, parameters.__name__)"
    assert told(names) == "Study sweep parameters"
    with pytest.raises(AttributeError, match=r"module 'footfall\.studies' has no attribute 'Stduy'"):
        footfall.studies.Stduy  # noqa: B018


def test_an_unknown_name_is_refused_as_of_any_module():
    with pytest.raises(AttributeError, match="module 'footfall' has no attribute 'lod_scenario'"):
        footfall.lod_scenario  # noqa: B018


@pytest.mark.parametrize("imports", ["import footfall, gymnasium", "import gymnasium, footfall"])
def test_gymnasium_makes_the_environment(imports):
    code = f"""
{imports}
env = gymnasium.make("footfall/Walk-v0")
print(env.spec.id, env.spec.max_episode_steps, "WalkVectorEnv" in env.spec.vector_entry_point)
env.close()
"""
    assert told(code) == "footfall/Walk-v0 333 True"
