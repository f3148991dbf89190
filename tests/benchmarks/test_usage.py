"""What a benchmark's processes took, and that it runs where the system does not tell."""

import math
import subprocess
import sys

import numpy as np
import pytest

from benchmarks import _usage

MB = 1e6


def test_a_child_that_works_is_told_when_it_has_ended():
    work = "import time\nheld = bytearray(200_000_000)\nwhile time.process_time() < 0.3: pass"
    before = _usage.children_cpu_s()
    subprocess.run([sys.executable, "-c", work], check=True)
    assert 0.3 <= _usage.children_cpu_s() - before < 30
    assert 200 * MB < _usage.children_peak_bytes() < 64e9


def test_memory_of_this_process():
    held = np.ones(25_000_000)  # 200 MB, every page written
    assert held.nbytes < _usage.peak_bytes() < 64e9
    there = _usage.resident_bytes()
    if not math.isnan(there):
        assert held.nbytes < there < _usage.peak_bytes() * 1.1
        del held
        assert there - _usage.resident_bytes() > 150 * MB


@pytest.mark.parametrize("told", [_usage.children_cpu_s, _usage.peak_bytes, _usage.children_peak_bytes])
def test_windows_does_not_tell(told, monkeypatch):
    monkeypatch.setattr(_usage, "resource", None)
    assert math.isnan(told())


def test_other_systems_than_linux_do_not_tell_what_is_resident(monkeypatch, tmp_path):
    monkeypatch.setattr(_usage, "Path", lambda name: tmp_path / name.strip("/"))
    assert math.isnan(_usage.resident_bytes())
