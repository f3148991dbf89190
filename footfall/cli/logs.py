"""What a command does, as a log: `footfall -v --log FILE COMMAND`, by Python's own logging.

Everything of Footfall's logs below the name "footfall"; a program that imports it sets that up as it likes.
"""

from __future__ import annotations

import logging
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from footfall.errors import InputError

SAID = "footfall.said"  # what is on standard error anyway
_LAYOUT = "%(asctime)s %(levelname)s %(message)s"


class _Error(logging.StreamHandler[Any]):
    """To standard error as it is at the time: bars of progress take its place while they are shown."""

    def __init__(self) -> None:
        super().__init__()
        self.addFilter(lambda record: record.name != SAID)

    @property
    def stream(self) -> Any:
        return sys.stderr

    @stream.setter
    def stream(self, value: Any) -> None:
        pass


def start_log(verbose: bool, file: Path | None) -> Callable[[], None]:
    """Log to standard error, to the end of a file, to both, or not at all; returns what ends it.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    handlers: list[logging.Handler] = [_Error()] if verbose else []
    if file is not None:
        try:
            handlers.append(logging.FileHandler(file, encoding="utf-8"))
        except OSError as error:
            raise InputError(f"cannot be written ({error.strerror})", f"--log {file}") from None
    log = logging.getLogger("footfall")
    if handlers:
        log.setLevel(logging.INFO)
    began = time.monotonic()
    for handler in handlers:
        handler.setFormatter(logging.Formatter(_LAYOUT))
        log.addHandler(handler)

    def end() -> None:
        # It is printed later, when this log has ended; without a log, logging itself would print it too.
        if handlers and isinstance(error := sys.exc_info()[1], InputError):
            logging.getLogger(SAID).error("%s", error)
        log.info("ended after %.1f s", time.monotonic() - began)
        for handler in handlers:
            log.removeHandler(handler)
            handler.close()
        if handlers:
            log.setLevel(logging.NOTSET)

    return end
