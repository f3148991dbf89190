"""Navigation knows recordings only: it runs unchanged on a real one."""

import subprocess
import sys

# The physics, the learner and the pictures, and the rooms that hold the truth. (The package itself loads
# gymnasium, to register its environment.)
STRANGERS = (
    "mujoco",
    "torch",
    "matplotlib",
    "footfall.models",
    "footfall.simulate",
    "footfall.scenarios",
)


def test_navigation_loads_nothing_simulated():
    code = (
        "import sys, footfall.hdr.methods, footfall.pdr.reckoning\n"
        f"print([name for name in sys.modules if name.startswith({STRANGERS!r})])"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"
