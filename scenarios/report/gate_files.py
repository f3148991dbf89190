"""Files that gates write."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from footfall.errors import InputError
from footfall.scenarios.studies.baseline import write_baseline
from footfall.scenarios.studies.gate import Judged
from footfall.tables import replacing


def write_gate(judged: Judged, document: Mapping[str, Any], folder: Path) -> None:
    """gate.json and cases.parquet, which is a baseline, into the existing `folder`.

    Raises
    ------
    InputError
        A file cannot be written.
    """
    write_baseline(judged.rows, folder / "cases.parquet")
    write_bytes((json.dumps(document, indent=2, allow_nan=False) + "\n").encode(), folder / "gate.json")


def write_bytes(content: bytes, file: Path) -> None:
    """A whole file or none.

    Raises
    ------
    InputError
        It cannot be written.
    """
    with replacing(file) as temporary:
        temporary.write_bytes(content)


def append_text(text: str, file: Path) -> None:
    """To the end of a file, which may not be there yet.

    Raises
    ------
    InputError
        It cannot be written.
    """
    try:
        with file.open("a", encoding="utf-8") as out:
            out.write(text)
    except OSError as error:
        raise InputError(f"cannot be written ({error.strerror})", file) from None
