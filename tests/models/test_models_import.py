"""What importing the room costs."""

import json
import subprocess
import sys


def modules_after(statement: str) -> set[str]:
    source = f"{statement}\nimport json, sys\nprint(json.dumps(sorted(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", source], capture_output=True, text=True, check=True)
    return set(json.loads(done.stdout))


def test_a_sheet_and_a_unit_need_no_compiler_and_a_recording_no_signal_processing():
    assert "numba" not in modules_after("from footfall.models.imu.unit import draw_unit")
    assert "scipy.signal" not in modules_after(
        "import footfall.simulate.record, footfall.models.imu._kernels"
    )
