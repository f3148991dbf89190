"""A gate's baseline: what methods scored, kept in a file with what their recordings were made of."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from footfall.errors import InputError
from footfall.scenarios.studies.rows import in_order, read_rows, table, write_rows
from footfall.scenarios.trial import Row
from footfall.simulate.plan import versions
from footfall.sources import stage_digest
from footfall.tables import META_KEY

_STAGES = {"walk": "the walker", "record": "the sensor's model"}  # stage of the sources -> in words

Case = tuple[Any, ...]
_CASE = ("scenario", "number", "walk_seed", "unit_seed", "noise_seed")  # the recording's hash tells the rest


@dataclass(frozen=True)
class Baseline:
    """Scores to compare with.

    Attributes
    ----------
    source : the file
    rows : method -> case -> the rows of that case, which differ in sheet or settings
    made : versions and sources that made the recordings, by name
    """

    source: str
    rows: Mapping[str, Mapping[Case, Sequence[Mapping[str, Any]]]]
    made: Mapping[str, str]


def write_baseline(rows: Iterable[Row], path: str | os.PathLike[str]) -> None:
    """Write rows, with versions and sources, to Parquet: the same rows, the same bytes.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    made = in_order(table(rows))
    told = dict(made.schema.metadata)
    told[META_KEY] = json.dumps(json.loads(told[META_KEY]) | {"made": _made()}).encode()
    write_rows(made.replace_schema_metadata(told), path)


def read_baseline(path: str | os.PathLike[str]) -> Baseline:
    """The baseline in a file.

    Raises
    ------
    InputError
        No such file, or not one of rows of scores.
    """
    found = read_rows(path)
    rows: dict[str, dict[Case, list[Mapping[str, Any]]]] = {}
    for row in found.to_pylist():
        rows.setdefault(row["method"], {}).setdefault(_case(row), []).append(row)
    told = json.loads((found.schema.metadata or {}).get(META_KEY, b"{}"))
    return Baseline(os.fspath(path), rows, told.get("made", {}))


def require_method(baseline: Baseline, method: str) -> None:
    """Refuse a baseline without scores of a method."""
    if method not in baseline.rows:
        raise InputError(f"no scores of {method}, only of {', '.join(baseline.rows)}", baseline.source)


def matched(baseline: Baseline, rows: Sequence[Row]) -> list[Mapping[str, Any]]:
    """Those rows of a baseline that are of the same method and of the same recordings, in order.

    Raises
    ------
    InputError
        A case that it has not, or that was another recording.
    """
    require_method(baseline, rows[0].method)
    kept, found = baseline.rows[rows[0].method], []
    for row in rows:
        others = kept.get(_case(row.as_dict()), [])
        if not others:
            raise InputError(
                f"{len(kept)} cases of {row.method}, and none of {row.scenario}, walk seed {row.walk_seed}, "
                f"unit {row.unit_seed}: make it anew",
                baseline.source,
            )
        same = [other for other in others if other["recording_sha"] == row.recording_sha]
        if not same:
            raise InputError(
                f"was made on other recordings ({_difference(baseline.made)}): make it anew, or compare with "
                "a method",
                baseline.source,
            )
        if len(same) > 1:
            raise InputError(
                f"several rows of {row.method} on one recording: which of them?", baseline.source
            )
        found.append(same[0])
    return found


def _made() -> dict[str, str]:
    return versions() | {words: stage_digest(stage) for stage, words in _STAGES.items()}


def _difference(made: Mapping[str, str]) -> str:
    """What made other recordings of the same cases."""
    here = _made()
    differ = [name for name, value in here.items() if made.get(name) != value]
    said = [f"{name} {here[name]} here, {made.get(name)} there" for name in differ if name in versions()]
    said += [f"another version of {name}" for name in differ if name not in versions()]
    return "; ".join(said) if said else "the same versions, so another scenario, sheet or machine"


def _case(row: Mapping[str, Any]) -> Case:
    return tuple(row[name] for name in _CASE)
