"""What importing the room costs, and that its compiled kernels are never stale."""

import json
import os
import subprocess
import sys
from pathlib import Path

from footfall.models.imu import effects


def modules_after(statement: str) -> set[str]:
    source = f"{statement}\nimport json, sys\nprint(json.dumps(sorted(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", source], capture_output=True, text=True, check=True)
    return set(json.loads(done.stdout))


def test_a_sheet_and_a_unit_need_no_compiler_and_a_recording_no_signal_processing():
    assert "numba" not in modules_after("from footfall.models.imu.unit import draw_unit")
    recording = modules_after("import footfall.simulate.record")
    assert "numba" in recording
    assert "scipy.signal" not in recording


def test_a_stale_kernel_is_forgotten_on_import():
    cache = Path(effects.__file__).parent / "__pycache__"
    cache.mkdir(exist_ok=True)
    stale = cache / "_kernels.no_such_kernel-1.py311.nbi"
    stale.write_bytes(b"")
    os.utime(stale, (0, 0))
    try:
        modules_after("import footfall.models.imu")
        assert not stale.exists()
    finally:
        stale.unlink(missing_ok=True)
