"""What was evaluated once is not evaluated again: values by key, in a file that grows line by line."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from footfall.identity import digest_of
from footfall.scenarios.trial import Setup, Trial
from footfall.sources import STAGES, stage_digest

BLOCK = 32  # keys that are evaluated together: so much is lost by an end in between


class Kept:
    """Arrays by key; without a folder for as long as this lives.

    Parameters
    ----------
    folder : where the file is, called by the digest of `made`
    made : all that decides the values besides the keys
    """

    def __init__(self, folder: Path | None, *made: Any) -> None:
        self._file = None if folder is None else folder / f"kept-{digest_of(*made)[:24]}.jsonl"
        self._known: dict[str, Any] = dict(self._read())

    def __call__(self, keys: Sequence[str], work: Callable[[list[int]], np.ndarray]) -> np.ndarray:
        """The arrays of keys, stacked.

        Parameters
        ----------
        work : (k, ...) of the keys with these indices; called with new ones alone, some at a time
        """
        new = list({key: index for index, key in enumerate(keys) if key not in self._known}.values())
        for first in range(0, len(new), BLOCK):
            block = new[first : first + BLOCK]
            made = {keys[index]: _plain(row) for index, row in zip(block, work(block), strict=True)}
            self._known |= made
            self._append(made)
        return np.array([_numbers(self._known[key]) for key in keys])

    def _read(self) -> Iterator[tuple[str, Any]]:
        if self._file is None or not self._file.is_file():
            return
        for line in self._file.read_text(encoding="utf-8").splitlines():
            with suppress(ValueError):  # a line that was cut short
                key, row = json.loads(line)
                yield key, row

    def _append(self, made: Mapping[str, Any]) -> None:
        """A full disk costs only that it is evaluated again."""
        if self._file is None:
            return
        with suppress(OSError):
            self._file.parent.mkdir(parents=True, exist_ok=True)
            cut = self._file.is_file() and not self._file.read_bytes().endswith(b"\n")
            with self._file.open("a", encoding="utf-8") as out:
                out.writelines(["\n"] * cut + [json.dumps(pair) + "\n" for pair in made.items()])


def made_of(setup: Setup, cases: Sequence[Trial], metric: str) -> tuple[Any, ...]:
    """All that decides the errors of a setup's methods in these cases, with the code that makes them."""
    return (
        [stage_digest(stage) for stage in STAGES],
        setup.scenario,
        setup.spec,
        setup.pdr,
        setup.guided,
        setup.directions,
        dict(setup.unit),
        setup.without,
        [(method.name, method.version, method.params) for method in setup.methods],
        [(one.number, one.walk_seed, one.unit_seed, one.noise_seed) for one in cases],
        metric,
    )


def _plain(values: Any) -> Any:
    """Nested lists; JSON has no infinity."""
    if isinstance(values, np.ndarray):
        return [_plain(one) for one in values] if values.ndim else _plain(float(values))
    return float(values) if np.isfinite(values) else None


def _numbers(row: Any) -> Any:
    if isinstance(row, list):
        return [_numbers(one) for one in row]
    return np.inf if row is None else row
