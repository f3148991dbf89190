"""A method that is a program of its own: it reads a file with the recording and writes one with the track."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np

from footfall.columns import ACCEL, GYRO
from footfall.errors import InputError
from footfall.hdr.method import Method, require_name
from footfall.hdr.sound import require_sound
from footfall.hdr.tracks import Reckoning
from footfall.identity import plain
from footfall.late import late
from footfall.pdr.track import Track, read_track
from footfall.recording import Recording, write_recording

pa, pa_csv = late("pyarrow"), late("pyarrow.csv")

RecordingFormat = Literal["f64", "csv", "parquet"]
PLACES = ("recording", "track", "start", "params", "rate")
_LAST_BYTES = 1 << 16  # of standard error


@dataclass(frozen=True)
class Command:
    """Runs a program on a recording.

    Attributes
    ----------
    words : of the command line, with places in braces: {recording}, {track}, {start} and {params} are files,
        {rate} the samples per second
    format : of the recording: "f64" is rows of t, gyro x y z, accel x y z as little-endian doubles
    timeout_s : s, after which it is ended
    """

    words: tuple[str, ...]
    format: RecordingFormat = "f64"
    timeout_s: float = 60.0

    @property
    def culprit(self) -> str:
        """What it is called in messages."""
        return _called(self.words)

    def __call__(self, reckoning: Reckoning, params: Any) -> Track:
        """The track that it writes.

        Raises
        ------
        InputError
            It cannot be started, fails, is not done in time, writes nothing, or what is no track.
        """
        recording = reckoning.recording
        with tempfile.TemporaryDirectory(prefix="footfall-") as folder:
            paths = {name: Path(folder) / f"{name}.json" for name in ("start", "params")}
            paths |= {
                "recording": Path(folder) / f"recording.{self.format}",
                "track": Path(folder) / "track.csv",
            }
            _write(recording, paths["recording"], self.format)
            paths["start"].write_text(json.dumps(reckoning.start.as_dict()), encoding="utf-8")
            paths["params"].write_text(json.dumps(plain(params or {})), encoding="utf-8")
            told = {name: str(path) for name, path in paths.items()} | {
                "rate": f"{1 / recording.interval:.6g}"
            }
            said = self._run([_PLACE.sub(lambda place: told[place[1]], word) for word in self.words], folder)
            track = self._read(paths["track"], said)
        require_sound(track, recording.t, self.culprit)
        return track

    def _run(self, words: list[str], folder: str) -> str:
        """Run to the end; the last line of standard error."""
        with open(Path(folder) / "stderr", "w+b") as errors:
            try:
                # Files, not pipes, and a group of its own: a child that it leaves behind holds nothing up.
                process = subprocess.Popen(
                    words,
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=errors,
                    start_new_session=True,
                )
            except (OSError, ValueError) as error:
                reason = getattr(error, "strerror", None) or error
                raise InputError(f"cannot be started ({reason})", self.culprit) from None
            try:
                code = process.wait(self.timeout_s)
            except subprocess.TimeoutExpired:
                _end(process)
                said = _last_line(errors)
                raise InputError(
                    f"still running after {self.timeout_s:g} s{_after(said)}", self.culprit
                ) from None
            except BaseException:  # interrupted
                _end(process)
                raise
            said = _last_line(errors)
        if code:
            how = f"ended with {code}" if code > 0 else f"was ended by signal {-code}"
            raise InputError(how + _after(said or "it said nothing"), self.culprit)
        return said

    def _read(self, path: Path, said: str) -> Track:
        if not path.is_file() or path.stat().st_size == 0:
            raise InputError(f"wrote no track{_after(said)}", self.culprit)
        with open(path, "rb") as file:
            parquet = file.read(4) == b"PAR1"
        if parquet:
            path = path.rename(path.with_suffix(".parquet"))
        try:
            return read_track(path)
        except InputError as error:
            raise InputError(f"wrote no track: {error.message}{_after(said)}", self.culprit) from None


_PLACE = re.compile(r"\{(\w*)\}")


def command_method(
    words: Sequence[str], *, name: str | None = None, format: str = "f64", timeout_s: float = 60.0
) -> Method:
    """A program as a method. Its params are any that it is told, as JSON.

    Parameters
    ----------
    words, format, timeout_s : as of `Command`
    name : of the method; None for the program's

    Raises
    ------
    InputError
        No such program or format, no place for the recording or the track, or one that is unknown.
    """
    if isinstance(words, str) or not words or not all(isinstance(word, str) for word in words):
        raise InputError("expected a list of words, the program first", "command")
    culprit = _called(words)
    places = {place for word in words for place in _PLACE.findall(word)}
    for place in sorted(places - set(PLACES)):
        raise InputError(f"{{{place}}} is unknown, expected some of {{{'}, {'.join(PLACES)}}}", culprit)
    for place in ("recording", "track"):
        if place not in places:
            raise InputError(f"{{{place}}} is missing in {' '.join(words)!r}", culprit)
    if format not in get_args(RecordingFormat):
        raise InputError(f"format {format!r}, expected {', '.join(get_args(RecordingFormat))}", culprit)
    if not 0 < timeout_s < float("inf"):
        raise InputError(f"timeout_s = {timeout_s}, expected a positive number", culprit)
    program = shutil.which(words[0])
    if program is None:
        raise InputError(f"there is no such program: {words[0]}", culprit)
    program = os.path.abspath(program)
    made = Command((program, *words[1:]), format, timeout_s)  # type: ignore[arg-type]
    return Method(
        name=require_name(name or re.sub(r"[^0-9A-Za-z_-]+", "-", Path(culprit.split()[-1]).stem)),
        description=" ".join(words),
        run=made,
        params={},
        version=_content(made.words),
    )


def _called(words: Sequence[str]) -> str:
    """The program, and the script that it runs."""
    script = [word for word in words[1:2] if Path(word).is_file()]
    return " ".join(Path(word).name for word in [words[0], *script])


def _content(words: Sequence[str]) -> str:
    """Hash (16 hex digits) of the words and of every file among them: the program, and its script."""
    digest = hashlib.sha256(json.dumps(list(words[1:])).encode())
    for word in words:
        with contextlib.suppress(OSError, ValueError):
            if Path(word).is_file():
                digest.update(Path(word).read_bytes())
    return digest.hexdigest()[:16]


def _write(recording: Recording, path: Path, format: str) -> None:
    if format == "parquet":
        write_recording(recording, path)
        return
    columns = np.column_stack([recording.t, recording.gyro, recording.accel])
    if format == "f64":
        columns.astype("<f8").tofile(path)
        return
    names = ("t", *GYRO, *ACCEL)
    table = pa.table(dict(zip(names, columns.T.copy(), strict=True)))
    if recording.temperature is not None:
        table = table.append_column("temperature", pa.array(recording.temperature))
    pa_csv.write_csv(table, path)


def _last_line(errors: Any) -> str:
    size = errors.seek(0, os.SEEK_END)
    errors.seek(max(size - _LAST_BYTES, 0))
    lines = [line.strip() for line in errors.read().decode("utf-8", "replace").splitlines() if line.strip()]
    return lines[-1] if lines else ""


def _after(said: str) -> str:
    return f": {said}" if said else ""


def _end(process: subprocess.Popen[bytes]) -> None:
    """End it and all that it has started."""
    with contextlib.suppress(OSError):
        if sys.platform == "win32":  # has no groups of processes
            subprocess.run(["taskkill", "/F", "/T", "/PID", str(process.pid)], capture_output=True)
        else:
            os.killpg(process.pid, signal.SIGKILL)
    process.kill()
    process.wait()
