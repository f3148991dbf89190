"""Gates judged: the cases performed, the scores compared, and a verdict each."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from footfall.errors import InputError
from footfall.hdr.method import Method
from footfall.identity import digest_of
from footfall.models.policy import stock_policy
from footfall.pdr.track import Track
from footfall.scenarios.evaluate import Rows, cases, travelling
from footfall.scenarios.execute import Progress, execute
from footfall.scenarios.judge.bounds import ALPHA
from footfall.scenarios.judge.gate import METRICS
from footfall.scenarios.judge.verdict import Scores, Verdict, decide, weigh
from footfall.scenarios.store import footfalls_folder
from footfall.scenarios.studies.baseline import Baseline, matched, read_baseline, require_method
from footfall.scenarios.studies.gate_file import Gates, needed, read_gates
from footfall.scenarios.trial import Row, Trial
from footfall.simulate.cache import is_cached, plan_key

PASSED, FAILED, UNDECIDED = 0, 1, 3  # exit codes


@dataclass(frozen=True)
class Judged(Sequence[Verdict]):
    """The verdicts of a file's gates, in its order.

    Attributes
    ----------
    gates : over the cases that were needed
    rows : of every case and method
    alpha : how often each one-sided bound may miss
    """

    gates: Gates
    rows: Rows
    verdicts: tuple[Verdict, ...]
    alpha: float = ALPHA

    def __getitem__(self, index: Any) -> Any:
        return self.verdicts[index]

    def __len__(self) -> int:
        return len(self.verdicts)

    def __iter__(self) -> Iterator[Verdict]:
        return iter(self.verdicts)

    @property
    def exit_code(self) -> int:
        """0 where all passed, 1 where one failed, 3 where none failed and some are undecided."""
        found = {verdict.verdict for verdict in self.verdicts}
        return FAILED if "fail" in found else UNDECIDED if "undecided" in found else PASSED


def gate(
    source: str | os.PathLike[str] | Gates,
    *,
    methods: Mapping[str, Method | Callable[..., Track]] | None = None,
    units: int | None = None,
    quick: bool = False,
    looks: Sequence[int] = (),
    workers: int | None = None,
    use_cache: bool = True,
    on_progress: Callable[[Progress], None] | None = None,
) -> Judged:
    """Judge a file of gates, or those of a name that come with Footfall.

    Parameters
    ----------
    methods : by name, in place of what the file says of that name
    units : how many cases, in place of the file's
    quick : 20 of them, or as many as a gate needs
    looks : numbers of cases after which to look, each at an equal part of the 5 %, and to stop where every
        gate is decided; instead of `units`
    workers, use_cache, on_progress : as of `execute`

    Raises
    ------
    InputError
        What cannot be read or found; a walk or a recording that comes to no end; a baseline of others.
    """
    made = source if isinstance(source, Gates) else read_gates(source, methods)
    made = made if units is None else made.with_units(units)
    made = made.quick() if quick else made
    looks = _looks(made, looks)
    made, alpha = replace(made, units=looks[-1]), ALPHA / len(looks)
    baselines = read_baselines(made)
    rows: list[Row] = []
    verdicts: dict[str, Verdict] = {}
    seen = 0
    for units_now in looks:
        rows += scored(
            made, range(seen, units_now), workers=workers, use_cache=use_cache, on_progress=on_progress
        )
        seen = units_now
        for verdict in judge(made, Rows(tuple(rows)), baselines, alpha):
            if verdict.name not in verdicts or verdicts[verdict.name].verdict == "undecided":
                verdicts[verdict.name] = verdict
        if all(verdict.verdict != "undecided" for verdict in verdicts.values()):
            break
    return Judged(replace(made, units=seen), Rows(tuple(rows)), tuple(verdicts.values()), alpha)


def read_baselines(gates: Gates) -> dict[Path, Baseline]:
    """What the gates are against, by file.

    Raises
    ------
    InputError
        A file that cannot be read, or that has no scores of the method.
    """
    found: dict[Path, Baseline] = {}
    for one in gates.gates:
        if (file := gates.baseline(one)) is not None:
            if file not in found:
                found[file] = read_baseline(file)
            require_method(found[file], one.method)
    return found


def scored(
    gates: Gates,
    units: range,
    *,
    workers: int | None = None,
    use_cache: bool = True,
    on_progress: Callable[[Progress], None] | None = None,
) -> list[Row]:
    """The rows of these of the cases, counted from 0; arguments as of `execute`.

    Raises
    ------
    InputError
        A walk or a recording came to no end: without it there is no case.
    """
    found: list[Row] = []
    trials = _trials(gates)[units.start : units.stop]
    workers = travelling(gates.setup.methods, workers)
    store = footfalls_folder() if use_cache else None
    done = execute(trials, workers=workers, use_cache=use_cache, store=store, on_progress=on_progress)
    with closing(done):
        for outcome in done:
            for row in outcome.rows:
                if row.stage in ("walk", "record"):
                    raise InputError(row.error)
            found += outcome.rows
    return found


def judge(
    gates: Gates, rows: Rows, baselines: Mapping[Path, Baseline], alpha: float = ALPHA
) -> list[Verdict]:
    """The verdicts over rows that are there.

    Raises
    ------
    InputError
        A baseline that is of other recordings.
    """
    found = []
    for one in gates.gates:
        own = rows.of(one.method)
        file, against = gates.baseline(one), None
        if file is not None:
            against = _kept_scores(matched(baselines[file], own))
        elif one.against is not None:
            against = _scores(rows.of(one.against))
        found.append(weigh(one, _scores(own), against, gates.margin_percent(one), alpha))
    return [_with_failures(verdict, rows.of(verdict.method)) for verdict in decide(found, alpha)]


def _with_failures(verdict: Verdict, rows: Rows) -> Verdict:
    failures = rows.failures
    return replace(verdict, failed=len(failures), failure=failures[0].error) if failures else verdict


def walks_cached(gates: Gates) -> int:
    """How many of the cases' walks are in the user's cache."""
    return sum(is_cached(key) for key in _walk_keys(gates))


def cache_key(gates: Gates) -> str:
    """Hash (32 hex digits) of all that makes the walks of the cases: with another they are walked anew."""
    return digest_of(_walk_keys(gates))[:32]


def _walk_keys(gates: Gates) -> list[str]:
    policy = stock_policy()
    first = {trial.number: trial for trial in reversed(_trials(gates))}
    return [plan_key(first[number].plan, policy) for number in sorted(first)]


def _trials(gates: Gates) -> list[Trial]:
    """By unit, so that fewer cases are the first of more."""
    trials = cases(gates.setup, units=gates.units, walks=gates.walks, seed=gates.seed)
    return sorted(trials, key=lambda trial: trial.unit_seed)


def _looks(gates: Gates, looks: Sequence[int]) -> tuple[int, ...]:
    if not looks:
        return (gates.units,)
    if any(after <= before for before, after in pairwise((0, *looks))):
        raise InputError(f"looks at {', '.join(map(str, looks))} cases: expected numbers that increase")
    alpha = ALPHA / len(looks)
    for one in gates.gates:
        if looks[-1] < needed(one, alpha):
            raise InputError(
                f"gate {one.name!r}: {one.statistic} needs {needed(one, alpha)} cases to pass at "
                f"{len(looks)} looks, and the last is at {looks[-1]}",
                gates.source,
            )
    return tuple(looks)


def _scores(rows: Rows) -> Scores:
    return {metric: _magnitudes([_score(row, metric) for row in rows]) for metric in METRICS}


def _kept_scores(rows: Sequence[Mapping[str, Any]]) -> Scores:
    return {metric: _magnitudes([row[metric] for row in rows]) for metric in METRICS}


def _score(row: Row, metric: str) -> float | None:
    return None if row.score is None else float(getattr(row.score, metric))


def _magnitudes(values: Sequence[float | None]) -> np.ndarray:
    """(n,) without signs, infinite where there is none."""
    return np.array([np.inf if value is None else abs(value) for value in values])
