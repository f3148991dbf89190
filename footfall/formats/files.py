"""What lies at a path: a file that can be read, or one that must be opened up first, within bounds.

An archive is unpacked into a private folder, under names of our own: those within it never become paths.
"""

from __future__ import annotations

import os
import shutil
import stat
import tempfile
import weakref
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from footfall.errors import InputError
from footfall.late import late

pa = late("pyarrow")

HEAD_BYTES = 1 << 16
MOST_TIMES = 200  # by which a recording may be compressed: real ones are by 3 to 50
MOST_BYTES = 8 << 30
MOST_MEMBERS = 200
_PIECE = 1 << 20

_ZIP = b"PK\x03\x04"
_COMPRESSED = {b"\x1f\x8b": "gzip", b"\x28\xb5\x2f\xfd": "zstd", b"BZh": "bz2", b"\x04\x22\x4d\x18": "lz4"}
_OTHERS = {
    b"\xd0\xcf\x11\xe0\xa1\xb1": "an Excel workbook or another Office file, expected text: save it as CSV",
    b"7z\xbc\xaf\x27\x1c": "a 7-Zip archive, expected a recording, plain or as gzip, zstd or zip",
    b"Rar!": "a RAR archive, expected a recording, plain or as gzip, zstd or zip",
    b"\xfd7zXZ": "an xz archive, expected a recording, plain or as gzip, zstd or zip",
    b"%PDF": "a PDF document, expected a recording",
    b"[{": "a JSON document, expected a table: save it as CSV",
    b"{": "a JSON document, expected a table: save it as CSV",
    b"<!DOCTYPE": "a page of HTML or XML, expected a recording",
    b"<html": "a page of HTML or XML, expected a recording",
    b"<?xml": "a page of HTML or XML, expected a recording",
    b"\x89PNG": "a picture, expected a recording",
    b"\xff\xd8\xff": "a picture, expected a recording",
    b"\x7fELF": "a program, expected a recording",
    b"\x93NUMPY": "a NumPy array, expected columns with names: save it as CSV or Parquet",
    b"ARROW1": "an Arrow or Feather file, expected CSV or Parquet: save it as Parquet",
    b"SQLite format 3": "a database; of a ROS 2 bag name the folder that it lies in",
    **{
        bytes([0x80, protocol]): "a Python pickle, which is never opened: it could run any code"
        for protocol in (2, 3, 4, 5)
    },
}


@dataclass(frozen=True)
class Content:
    """A file's content, unpacked where it was packed.

    Attributes
    ----------
    path : what was asked for, for messages
    at : where the bytes lie
    name : of the innermost file
    head : its first bytes
    """

    path: Path
    at: Path
    name: str
    head: bytes

    @property
    def size(self) -> int:
        """Bytes."""
        return self.at.stat().st_size


def require_file(path: Path) -> None:
    """Refuse what is no file that can be read, and say what it is.

    Raises
    ------
    InputError
        Nothing there, a link that leads nowhere or back to itself, a folder, a pipe, a device.
    """
    try:
        kind = os.stat(path).st_mode
    except OSError as error:
        if path.is_symlink():
            loops = "back to itself" if error.errno == 40 else "to a file that does not exist"
            raise InputError(f"a link that leads {loops}", path) from None
        if isinstance(error, FileNotFoundError | NotADirectoryError):
            raise InputError("no such file", path) from None
        raise InputError(f"cannot be read ({error.strerror})", path) from None
    except ValueError:  # a zero byte in the name
        raise InputError("no such file", path) from None
    for told, what in (
        (stat.S_ISDIR, "a folder"),
        (stat.S_ISFIFO, "a named pipe"),
        (stat.S_ISSOCK, "a socket"),
        (stat.S_ISCHR, "a device"),
        (stat.S_ISBLK, "a device"),
    ):
        if told(kind):
            raise InputError(f"{what}, expected a file", path)
    if not os.access(path, os.R_OK):
        raise InputError("cannot be read (permission denied)", path)


def open_content(path: Path, member: str | None = None) -> list[Content]:
    """What a file holds: itself, or what is packed into it.

    Parameters
    ----------
    member : of an archive, the only one that is wanted

    Raises
    ------
    InputError
        As `require_file`; empty; a file of a kind that is no recording; an archive that is damaged, or that
        holds more than a recording can shrink to.
    """
    require_file(path)
    with open(path, "rb") as file:
        head = file.read(HEAD_BYTES)
    if not head:
        raise InputError("empty", path)
    if head.startswith((_ZIP, b"PK\x05\x06")):
        return _unzipped(path, member)
    for mark, kind in _COMPRESSED.items():
        if head.startswith(mark):
            return [_unpacked(path, kind)]
    _refuse_others(path, head)
    return [Content(path, path, path.name, head)]


def _refuse_others(path: Path, head: bytes) -> None:
    for mark, what in _OTHERS.items():
        if head.startswith(mark):
            raise InputError(what, path)


def _unpacked(path: Path, kind: str) -> Content:
    most = _most(path.stat().st_size)
    with _private() as at:
        try:
            with pa.OSFile(os.fspath(path)) as raw, pa.CompressedInputStream(raw, kind) as packed:
                _copy(packed, at, most, path)
        except (pa.ArrowException, OSError) as error:
            raise InputError(f"not a readable {kind} file ({_first_line(error)})", path) from None
        return _held(path, at, path.stem)


def _unzipped(path: Path, member: str | None) -> list[Content]:
    found = []
    try:
        with zipfile.ZipFile(path) as archive:
            infos = [info for info in archive.infolist() if not info.is_dir() and _is_data(info.filename)]
            names = [info.filename for info in infos]
            if any(name.startswith("xl/") for name in names):
                raise InputError("an Excel workbook, expected text: save it as CSV", path)
            if len(infos) > MOST_MEMBERS:
                raise InputError(f"an archive of {len(infos)} files, expected a recording", path)
            if member is not None and member in names:
                infos = [info for info in infos if info.filename == member]
            if not infos:
                raise InputError("an archive without files", path)
            most = _most(path.stat().st_size)
            for info in infos:
                with _private() as at:
                    with archive.open(info) as packed:
                        most -= _copy(packed, at, most, path)
                    if at.stat().st_size:
                        found.append(_held(path, at, info.filename))
    except InputError:
        raise
    except Exception as error:  # zipfile raises whatever a damaged archive makes it stumble over
        raise InputError(f"not a readable zip archive ({_first_line(error)})", path) from None
    if not found:
        raise InputError("an archive of empty files", path)
    return found


def _is_data(name: str) -> bool:
    parts = name.split("/")
    return "__MACOSX" not in parts and not parts[-1].startswith(".")


def _most(packed: int) -> int:
    return min(max(MOST_TIMES * packed, 1 << 20), MOST_BYTES)


def _copy(packed: IO[bytes] | Any, at: Path, most: int, path: Path) -> int:
    written = 0
    with open(at, "wb") as plain:
        while piece := packed.read(_PIECE):
            written += len(piece)
            if written > most:
                raise InputError(
                    f"expands to more than {most >> 20} MiB, which no recording of its size does", path
                )
            plain.write(piece)
    return written


@contextmanager
def _private() -> Iterator[Path]:
    """A file in a folder of its own, which goes at once where it was in vain; else `_held` says when."""
    folder = Path(tempfile.mkdtemp(prefix="footfall-"))
    try:
        yield folder / "content"
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise


def _held(path: Path, at: Path, name: str) -> Content:
    with open(at, "rb") as file:
        head = file.read(HEAD_BYTES)
    _refuse_others(path, head)
    if head.startswith((_ZIP, *_COMPRESSED)):
        raise InputError("an archive within an archive, expected a recording", path)
    content = Content(path, at, name, head)
    weakref.finalize(content, shutil.rmtree, at.parent, ignore_errors=True)
    return content


def _first_line(error: BaseException) -> str:
    return (str(error) or type(error).__name__).splitlines()[0]
