"""Parameters of a method tuned on some walks and units, and judged on others beside the default.

HDR's errors at a thousand parameter sets come from one compiled pass. Other methods are searched by optuna's
tree of Parzen estimators, asked for a batch of sets at a time: the same seed asks for the same sets, however
many processes answer.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from footfall.errors import InputError
from footfall.late import late
from footfall.scenarios.execute import Progress
from footfall.scenarios.judge.gate import Gate
from footfall.scenarios.judge.verdict import Verdict, decide, weigh
from footfall.scenarios.studies.budget import Case
from footfall.scenarios.studies.extra import needed
from footfall.scenarios.studies.factors import Factor, points_at
from footfall.scenarios.studies.kept import Kept, made_of
from footfall.scenarios.studies.map import is_compiled, mapped
from footfall.scenarios.studies.points import evaluate_points, over_cases
from footfall.scenarios.studies.spreading import Workers, listen_to
from footfall.scenarios.studies.tuning_file import Tuning, read_tuning
from footfall.scenarios.trial import Setup, Trial

qmc = late("scipy.stats.qmc")

MAPPED, SEARCHED = 1024, 100  # sets that are tried where the file says nothing: compiled, and one by one
BATCH = 8  # sets that optuna is asked for at once
_DIGITS = 4  # of a value: what is tuned is no more certain

Point = Mapping[str, Any]
Errors = Callable[[Sequence[Point], Sequence[Trial]], np.ndarray]  # (p, cases)


@dataclass(frozen=True)
class Tuned:
    """What tuning chose, and what it is worth.

    Attributes
    ----------
    chosen : address -> value
    tried : how many sets
    train, test : (2, cases) errors of the default and of the chosen set
    verdict : whether the chosen set errs less than the default on the cases of the test
    """

    tuning: Tuning
    chosen: Point
    tried: int
    train: np.ndarray
    test: np.ndarray
    verdict: Verdict

    @property
    def better(self) -> bool:
        """Whether the chosen set is to be taken."""
        return self.verdict.verdict == "pass" and self.verdict.reason != "identical"

    @property
    def advice(self) -> str:
        """One sentence: take it, or keep the default."""
        change = f"{self.verdict.estimate:+.0f} %"
        if self.verdict.reason == "identical":
            return "nothing is better than the default: keep it"
        if self.better:
            return f"better on walks and units it has not seen ({change}): take it"
        why = "worse" if self.verdict.verdict == "fail" else "undecided"
        return f"not better on walks and units it has not seen ({change}, {why}): keep the default"


def tuned(
    study: str | os.PathLike[str] | Tuning,
    *,
    workers: Workers = None,
    folder: Path | None = None,
    **changes: Any,
) -> Tuned:
    """Tune by a file or the name of a tuning that comes with Footfall: `tuned("mine.toml").advice`.

    Parameters
    ----------
    study : its name or file
    workers, folder : as of `perform_tuning`
    **changes : keys of the file with other values, as `method="hdr-basic"`

    Raises
    ------
    InputError
        As of `read_tuning` and `perform_tuning`.
    """
    asked = study if isinstance(study, Tuning) else read_tuning(os.fspath(study), changes)
    return perform_tuning(asked, workers=workers, folder=folder)


def perform_tuning(
    tuning: Tuning,
    *,
    workers: Workers = None,
    folder: Path | None = None,
    on_cases: Callable[[int, int], None] | None = None,
    on_trials: Callable[[Progress], None] | None = None,
    on_tried: Callable[[int, int], None] | None = None,
) -> Tuned:
    """Choose on the cases of `train`, judge on those of `test`.

    Parameters
    ----------
    workers : processes, one a core when None; or a cluster
    folder : where sets that were tried are kept, and found again; footfalls, too
    on_cases, on_trials, on_tried : progress of cases heard, of trials, and of sets tried

    Raises
    ------
    InputError
        No case came to its end; what a parameter or a recording refuses; or optuna is not installed.
    """
    (method,) = tuning.base.methods
    report = on_tried or (lambda done, all_: None)
    if is_compiled(method, tuning.file.metric) and all(
        factor.values is None and factor.address.startswith(f"{method.name}.") for factor in tuning.factors
    ):
        count = tuning.file.trials or MAPPED
        errors = _compiled(tuning, workers, on_cases)
        sets = [{}, *_filling(tuning.factors, count, tuning.file.seed)]
        found = errors(sets, tuning.train)
        report(len(sets), len(sets))
        best = _smallest(found, tuning)
    else:
        count = tuning.file.trials or SEARCHED
        errors = _in_full(tuning, workers, folder, on_trials)
        sets, found = _searched(tuning, errors, count, folder, report)
        best = _smallest(found, tuning)
    chosen = dict(sets[best])
    test = errors([{}, chosen], tuning.test)
    train = found[[0, best]]
    return Tuned(tuning, chosen, len(sets), train, test, judged(test, tuning.file.metric))


def judged(test: np.ndarray, metric: str) -> Verdict:
    """Whether the second row of errors (2, cases) is smaller than the first, case by case."""
    gate = Gate(name="tuned", method="tuned", against="default", metric=metric, margin_percent=0.0)
    (verdict,) = decide([weigh(gate, {metric: test[1]}, {metric: test[0]}, 0.0)])
    return verdict


def _smallest(errors: np.ndarray, tuning: Tuning) -> int:
    scores = over_cases(errors, tuning.file.over)
    if not np.isfinite(scores).any():
        raise InputError("no parameter set has a score: too many of its cases failed", tuning.name)
    return int(np.argmin(scores))


def _filling(factors: Sequence[Factor], count: int, seed: int) -> list[Point]:
    """Sets that fill the ranges evenly."""
    shares = qmc.Sobol(len(factors), seed=seed).random(count)
    return [_short(point) for point in points_at(factors, np.asarray(shares))]


def _short(point: Point) -> dict[str, Any]:
    return {
        address: float(f"{value:.{_DIGITS}g}") if isinstance(value, float) else value
        for address, value in point.items()
    }


def _compiled(tuning: Tuning, workers: Workers, on_cases: Callable[[int, int], None] | None) -> Errors:
    addresses = [factor.address for factor in tuning.factors]
    trials = (*tuning.train, *tuning.test)
    heard = dict(
        zip(map(_case, trials), listen_to(trials, workers=workers, on_progress=on_cases), strict=True)
    )
    lost = [one for one in heard.values() if not isinstance(one, Case)]
    if len(lost) == len(heard):
        raise InputError(f"no case came to its end: {lost[0][1]}", tuning.name)
    now = tuning.defaults()

    def errors(points: Sequence[Point], cases: Sequence[Trial]) -> np.ndarray:
        values = [[point.get(address, now[address]) for address in addresses] for point in points]
        own = [heard[_case(trial)] for trial in cases]
        return mapped(own, tuning.base, addresses, tuning.file.metric, np.array(values, dtype=float))

    return errors


def _case(trial: Trial) -> tuple[int, int, int]:
    return trial.walk_seed, trial.unit_seed, trial.noise_seed


def _in_full(
    tuning: Tuning,
    workers: Workers,
    folder: Path | None,
    on_trials: Callable[[Progress], None] | None,
) -> Errors:
    def errors(points: Sequence[Point], cases: Sequence[Trial]) -> np.ndarray:
        def deal(setup: Setup) -> list[Trial]:
            return [Trial(setup, one.number, one.walk_seed, one.unit_seed, one.noise_seed) for one in cases]

        found = evaluate_points(
            tuning.base,
            points,
            deal,
            tuning.file.metric,
            workers=workers,
            store=None if folder is None else folder / "footfalls",
            on_progress=on_trials,
        )
        return np.asarray(found.errors[0])

    return errors


def _searched(
    tuning: Tuning,
    errors: Errors,
    count: int,
    folder: Path | None,
    report: Callable[[int, int], None],
) -> tuple[list[Point], np.ndarray]:
    """Sets by optuna, the default first, and their errors (sets, cases)."""
    optuna = needed("optuna")
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    sampler = optuna.samplers.TPESampler(seed=tuning.file.seed, constant_liar=True)
    study = optuna.create_study(sampler=sampler)
    kept = Kept(folder, *made_of(tuning.base.setup(), tuning.train, tuning.file.metric))

    def tried(batch: Sequence[Point]) -> np.ndarray:
        keys = [json.dumps(point, sort_keys=True) for point in batch]
        return kept(keys, lambda new: errors([batch[i] for i in new], tuning.train))

    points: list[Point] = [{}]
    found = [tried([{}])]
    while len(points) - 1 < count:
        asked = [study.ask() for _ in range(min(BATCH, count - len(points) + 1))]
        batch = [_short({one.address: _suggested(trial, one) for one in tuning.factors}) for trial in asked]
        made = tried(batch)
        for trial, score in zip(asked, over_cases(made, tuning.file.over), strict=True):
            if np.isfinite(score):
                study.tell(trial, float(score))
            else:
                study.tell(trial, state=optuna.trial.TrialState.FAIL)
        points += batch
        found.append(made)
        report(len(points) - 1, count)
    return points, np.concatenate(found)


def _suggested(trial: Any, factor: Factor) -> Any:
    if factor.values is not None:
        which = trial.suggest_categorical(factor.address, list(range(len(factor.values))))
        return factor.values[which]
    return trial.suggest_float(factor.address, factor.low, factor.high, log=factor.log)
