"""The command as a program of its own: exit codes, streams, workers, and what importing it loads."""

import json
import os
import shlex
import signal
import subprocess
import sys
import time
from importlib.metadata import version
from pathlib import Path

import pytest

from tests.helpers.commands import SCORES, expect_one_sentence, one_document


def shell(line, folder, **options):
    command = [sys.executable, "-m", "footfall", *shlex.split(line)]
    return subprocess.Popen(
        command, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options
    )


def test_the_program_prints_one_document_and_ends_well(here):
    process = shell("score hdr.parquet walk.parquet --json", here)
    out, err = process.communicate()
    assert (process.returncode, err) == (0, "")
    assert set(one_document(out)) == {"align", *SCORES}


def test_the_program_ends_with_code_2_and_one_sentence(here):
    process = shell("track walk.csv -o t.parquet", here)
    out, err = process.communicate()
    expect_one_sentence(process.returncode, out, err, "walk.csv: no such file")


def test_a_shell_completes_commands(tmp_path):
    asked = {"_FOOTFALL_COMPLETE": "complete_bash", "COMP_WORDS": "footfall sco", "COMP_CWORD": "1"}
    process = shell("", tmp_path, env=os.environ | asked)
    out, err = process.communicate()
    assert (process.returncode, out.split(), err) == (0, ["score"], "")


def members(session):
    """Processes of a session, but for the dead that are not yet buried."""
    found = []
    for process in filter(str.isdigit, os.listdir("/proc")):
        try:
            stat = Path(f"/proc/{process}/stat").read_text()
        except OSError:  # gone meanwhile
            continue
        state, _, _, of = stat.rpartition(")")[2].split()[:4]
        if int(of) == session and state != "Z":
            found.append(int(process))
    return found


def wait_until(condition):
    """Give up after a minute, which is no judgement of speed."""
    for _ in range(600):
        if condition():
            return
        time.sleep(0.1)
    pytest.fail("it never happened")


@pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="needs /proc")
@pytest.mark.parametrize("ending", ["ctrl-c", "kill"])
def test_workers_end_with_their_parent(here, ending):
    """Ctrl-C goes to all processes of the terminal, a kill to the parent alone; neither may leave workers."""
    if len(os.sched_getaffinity(0)) < 2:
        pytest.skip("on one core there are no workers")
    # A suite in the background of a shell ignores Ctrl-C, and so would what it starts.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        process = shell("run straight --walks 4 --no-cache --out new", here, start_new_session=True)
    finally:
        signal.signal(signal.SIGINT, before)
    wait_until(lambda: len(members(process.pid)) >= 3 or process.poll() is not None)
    assert process.poll() is None
    if ending == "ctrl-c":
        os.killpg(process.pid, signal.SIGINT)
        _, err = process.communicate()
        assert (process.returncode, err) == (130, "footfall: interrupted\n")
        assert not (here / "new").exists()
    else:
        process.kill()
        process.communicate()
    wait_until(lambda: not members(process.pid))


def loaded(code, folder):
    """Modules that a fresh process has loaded at the end."""
    code += "\nimport json, sys\nprint(json.dumps(sorted(sys.modules)))"
    found = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True)
    assert found.returncode == 0, found.stderr
    return json.loads(found.stdout.splitlines()[-1])


def of(packages, modules):
    """Those of `modules` that belong to these packages."""
    return [name for name in modules if any(f"{name}.".startswith(f"{package}.") for package in packages)]


# What takes a tenth of a second or more to import.
HEAVY = {"numba", "scipy", "mujoco", "gymnasium", "matplotlib", "torch", "pandas", "plotly", "pyarrow"}
# Arrow before 26 asks pandas, where it is installed, whether an array is one of its own.
PANDAS = {"pandas"} if int(version("pyarrow").split(".")[0]) < 26 else set()


def test_importing_the_command_line_loads_nothing_heavy(tmp_path):
    """Nor a room, by whichever name."""
    rooms = {"models", "simulate", "pdr", "hdr", "scenarios"}
    modules = loaded("import footfall.cli.app", tmp_path)
    assert of(HEAVY | {"numpy", "pydantic"} | rooms | {f"footfall.{room}" for room in rooms}, modules) == []


@pytest.mark.parametrize(
    ("line", "needed"),
    [
        ("list", set()),
        ("list --json", set()),
        ("parameters", {"scipy"}),
        ("score hdr.parquet walk.parquet", {"pyarrow"}),
        ("export hdr.parquet -o hdr.tum", {"pyarrow"}),
        ("track rec.parquet -o again.parquet", {"numba", "pyarrow", "scipy"}),
    ],
)
def test_a_short_command_loads_only_what_it_needs(here, line, needed):
    modules = loaded(f"from footfall.cli.app import main\nassert main({shlex.split(line)!r}) == 0", here)
    assert of(HEAVY - needed - (PANDAS if "pyarrow" in needed else set()), modules) == []
    assert of({"scipy.signal", "scipy.stats", "scipy.optimize", "scipy.interpolate"}, modules) == []


def test_no_module_imports_a_room_by_its_bare_name_nor_pictures_nor_the_learner():
    """Every module but those of the training."""
    code = """
import importlib, pkgutil, sys, footfall
for module in pkgutil.walk_packages(footfall.__path__, "footfall."):
    if module.name not in ("footfall.simulate.learn.ppo", "footfall.simulate.learn.train"):
        importlib.import_module(module.name)
strangers = {"models", "simulate", "pdr", "hdr", "scenarios", "torch", "matplotlib"}
print(sorted(strangers & {name.split(".")[0] for name in sys.modules}))
"""
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"
