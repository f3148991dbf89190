"""A method that is a program: what it is told, what it writes, and how its failures are told."""

import os
import pickle
import stat
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.hdr import command
from footfall.hdr.methods import Reckoning, find_method, tracks
from footfall.pdr.reckoning import PdrParams, StartPose
from footfall.recording import Recording
from tests.helpers.synthetic_foot import walk

# Reads each format, and says in the track what it was told.
PROGRAM = """
import json, sys
import numpy as np
recording, track, start, params, rate = sys.argv[1:6]
if recording.endswith(".f64"):
    rows = np.fromfile(recording, "<f8").reshape(-1, 7)
elif recording.endswith(".csv"):
    head = open(recording).readline().replace('"', "").strip().split(",")
    assert head[:7] == ["t", "gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"]
    rows = np.genfromtxt(recording, delimiter=",", skip_header=1)[:, :7]
else:
    import pyarrow.parquet as pq
    table = pq.read_table(recording)
    rows = np.column_stack([table[name] for name in table.column_names[:7]])
start, params = json.load(open(start)), json.load(open(params))
x, y, z = start["position_m"]
with open(track, "w") as file:
    file.write("t,x,y,z,heading,gyro_x,accel_z,rate,gain\\n")
    for row in rows[[100, -1]].tolist():
        told = [row[0], x, y, z, start["heading_rad"], row[1], row[6], float(rate), params.get("gain", 1.0)]
        file.write(",".join(map(repr, told)) + "\\n")
"""


@pytest.fixture(scope="module")
def reckoning():
    recording = walk(np.zeros(5), still_s=5.5, rate=100.0).recording(accel_error=0.123)
    return Reckoning(recording, StartPose((1.0, 2.0, 3.0), 0.25), PdrParams(bias_s=5.0))


@pytest.fixture
def program(tmp_path):
    def write(text, *words):
        (tmp_path / "nav.py").write_text(text)
        return [sys.executable, str(tmp_path / "nav.py"), *words]

    return write


EVERY = ("{recording}", "{track}", "{start}", "{params}", "{rate}")


@pytest.mark.parametrize("form", ["f64", "csv", "parquet"])
def test_a_program_is_told_everything_and_its_track_is_read(reckoning, program, form):
    method = find_method(command=program(PROGRAM, *EVERY), name="mine", format=form, params={"gain": 2.5})
    track, recording = tracks(reckoning, [method])["mine"], reckoning.recording
    np.testing.assert_array_equal(track.t, recording.t[[100, -1]])
    np.testing.assert_array_equal(track.position, [(1.0, 2.0, 3.0)] * 2)
    np.testing.assert_array_equal(track.heading, 0.25)
    np.testing.assert_array_equal(track.evidence["gyro_x"], recording.gyro[[100, -1], 0])
    np.testing.assert_array_equal(track.evidence["accel_z"], recording.accel[[100, -1], 2])
    np.testing.assert_allclose(track.evidence["rate"], 100.0)
    np.testing.assert_array_equal(track.evidence["gain"], 2.5)
    assert track.meta["method"] == "mine"
    assert track.meta["params"] == {"gain": 2.5}


def test_temperature_is_there_for_who_reads_it(reckoning, program):
    warm = Recording(
        reckoning.recording.t,
        reckoning.recording.gyro,
        reckoning.recording.accel,
        np.full(len(reckoning.recording.t), 21.5),
    )
    text = PROGRAM.replace("skip_header=1)[:, :7]", "skip_header=1); rows[:, 1] = rows[:, 7]")
    method = find_method(command=program(text, *EVERY), format="csv")
    np.testing.assert_array_equal(method.track(Reckoning(warm)).evidence["gyro_x"], 21.5)


def test_a_track_in_parquet_is_read_too(reckoning, program):
    text = (
        "import sys, pyarrow as pa, pyarrow.parquet as pq\n"
        "t = [1.0, 2.0]\n"
        "pq.write_table(pa.table({'t': t, 'x': t, 'y': t, 'z': t, 'heading': t}), sys.argv[2])\n"
    )
    method = find_method(command=program(text, "{recording}", "{track}"))
    assert method.track(reckoning).heading.tolist() == [1.0, 2.0]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("import sys; sys.exit('no bias\\nfound')", "ended with 1: found"),
        ("raise SystemExit(7)", "ended with 7: it said nothing"),
        ("import os; os.abort()", "was ended by signal 6"),
        ("import sys; print('nothing to do', file=sys.stderr)", "wrote no track: nothing to do"),
        ("pass", "wrote no track"),
        ("import sys; open(sys.argv[2], 'w')", "wrote no track"),
        ("import sys; open(sys.argv[2], 'w').write('t,x\\n1,2\\n')", "wrote no track: column 'y' is missing"),
        (
            "import sys; open(sys.argv[2], 'wb').write(bytes(range(256)))",
            "wrote no track: not a readable CSV",
        ),
        ("import sys; open(sys.argv[2], 'wb').write(b'PAR1' * 9)", "wrote no track: not a readable Parquet"),
        (
            "import sys; open(sys.argv[2], 'w').write('t,x,y,z,heading\\n1,0,0,0,nan\\n2,0,0,0,0\\n')",
            "wrote no track: heading is not finite at row 0",
        ),
        (
            "import sys; open(sys.argv[2], 'w').write('t,x,y,z,heading\\n1,0,0,0,0\\n999,0,0,0,0\\n')",
            "returned a track from t = 1 to 999 s of a recording",
        ),
    ],
)
def test_a_program_that_fails_is_told(reckoning, program, text, sentence):
    method = find_method(command=program(text, "{recording}", "{track}"))
    with pytest.raises(InputError) as refused:
        method.track(reckoning)
    assert str(refused.value).startswith(f"{Path(sys.executable).name} nav.py: {sentence}")


@pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="needs /proc")
def test_a_program_that_hangs_is_ended_with_all_that_it_started(reckoning, program, tmp_path):
    """A child of its own, which would hold a pipe open, and go on for ever."""
    text = (
        "import subprocess, sys, time\n"
        "child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(600)'])\n"
        f"open({str(tmp_path / 'child')!r}, 'w').write(str(child.pid))\n"
        "print('still thinking', file=sys.stderr, flush=True)\n"
        "time.sleep(600)\n"
    )
    method = find_method(command=program(text, "{recording}", "{track}"), timeout_s=2.0)
    with pytest.raises(InputError, match=r"still running after 2 s: still thinking$"):
        method.track(reckoning)
    child = int((tmp_path / "child").read_text())
    for _ in range(100):  # until whoever adopts orphans has reaped it
        try:
            state = Path(f"/proc/{child}/stat").read_text().split(")")[1].split()[0]
        except FileNotFoundError:
            break
        if state == "Z":
            break
        time.sleep(0.05)
    else:
        pytest.fail("the child goes on")


TASKKILL = """#!{python}
import os, signal, sys
open({told!r}, "w").write(" ".join(sys.argv[1:]))
os.kill(int(sys.argv[-1]), signal.SIGTERM)
"""


@pytest.mark.parametrize("tool", ["taskkill", None])
def test_a_program_that_hangs_is_ended_where_there_are_no_groups(
    reckoning, program, tmp_path, monkeypatch, tool
):
    """On Windows a tool ends what a program has started; without it the program itself is ended."""
    if tool is not None:
        (tmp_path / "bin").mkdir()
        file = tmp_path / "bin" / tool
        file.write_text(TASKKILL.format(python=sys.executable, told=str(tmp_path / "told")))
        file.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    monkeypatch.setattr(command, "sys", SimpleNamespace(platform="win32"))
    monkeypatch.delattr(command.os, "killpg", raising=False)
    text = f"import os, time\nopen({str(tmp_path / 'pid')!r}, 'w').write(str(os.getpid()))\ntime.sleep(600)\n"
    method = find_method(command=program(text, "{recording}", "{track}"), timeout_s=2.0)
    with pytest.raises(InputError, match=r"still running after 2 s$"):
        method.track(reckoning)
    pid = (tmp_path / "pid").read_text()
    with pytest.raises(ProcessLookupError):
        os.kill(int(pid), 0)
    if tool is not None:
        assert (tmp_path / "told").read_text() == f"/F /T /PID {pid}"


def test_a_program_leaves_no_files(reckoning, program, tmp_path, monkeypatch):
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(scratch))
    find_method(command=program(PROGRAM, *EVERY)).track(reckoning)
    with pytest.raises(InputError):
        find_method(command=program("1 / 0", *EVERY)).track(reckoning)
    assert list(scratch.iterdir()) == []


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({"command": []}, "command: expected a list of words, the program first"),
        ({"command": "true {recording} {track}"}, "command: expected a list of words, the program first"),
        (
            {"command": ["no-such-program", "{recording}", "{track}"]},
            "no-such-program: there is no such program",
        ),
        ({"command": ["true", "{recording}"]}, "true: {track} is missing in 'true {recording}'"),
        ({"command": ["true", "{track}"]}, "true: {recording} is missing in"),
        (
            {"command": ["true", "{recording}", "{track}", "{seed}"]},
            "true: {seed} is unknown, expected some of {rec",
        ),
        ({"format": "mat"}, "true: format 'mat', expected f64, csv, parquet"),
        ({"timeout_s": 0.0}, "true: timeout_s = 0.0, expected a positive number"),
        ({"use": "pdr", "name": "mine"}, "mine: a method has either a command or a use, not both"),
        ({"name": "a.b"}, "method name 'a.b': expected letters"),
    ],
)
def test_a_command_that_cannot_be_is_told(keys, sentence):
    with pytest.raises(InputError) as refused:
        find_method(**({"command": ["true", "{recording}", "{track}"]} | keys))
    assert str(refused.value).startswith(sentence)


def test_a_program_that_cannot_be_started_is_told(reckoning, tmp_path):
    file = tmp_path / "nav"
    file.write_bytes(b"\x7fELF, or so it says")
    file.chmod(file.stat().st_mode | stat.S_IXUSR)
    method = find_method(command=[str(file), "{recording}", "{track}"])
    with pytest.raises(InputError, match=r"^nav: cannot be started \(Exec format error\)$"):
        method.track(reckoning)


def test_its_content_is_that_of_the_program_its_script_and_its_words(program):
    def version(text, *more):
        return find_method(command=program(text, "{recording}", "{track}", *more)).version

    assert version("1") == version("1")
    assert len({version("1"), version("2"), version("1", "--fast")}) == 3


def test_a_command_goes_to_another_process(program):
    method = find_method(command=program(PROGRAM, *EVERY), name="mine", params={"gain": 2})
    assert pickle.loads(pickle.dumps(method)) == method


def test_braces_in_its_words_are_places_and_nothing_else(reckoning, program):
    text = PROGRAM.replace("sys.argv[1:6]", "[one.partition('=')[2] for one in sys.argv[1:6]]")
    method = find_method(command=program(text, *(f"--x={place}" for place in EVERY), "100%", "{}"[:1]))
    assert len(method.track(reckoning)) == 2
