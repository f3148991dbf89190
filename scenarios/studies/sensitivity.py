"""Which parameters methods' errors depend on: Morris' and Sobol's figures, in full or by the budget."""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from footfall.errors import InputError
from footfall.scenarios.execute import Progress
from footfall.scenarios.judge.gate import floor_of
from footfall.scenarios.studies.budget import Case
from footfall.scenarios.studies.check import Check, check_points
from footfall.scenarios.studies.indices import Index, Screened, Sobol, morris, morris_design, sobol_until
from footfall.scenarios.studies.kept import Kept, made_of
from footfall.scenarios.studies.listening import Heard, Lost
from footfall.scenarios.studies.points import Evaluated, evaluate_points, over_cases, require_finite
from footfall.scenarios.studies.sensitivity_file import UNIT, Study, read_study
from footfall.scenarios.studies.spreading import Workers, listen_to
from footfall.settings import did_you_mean

Evaluate = Callable[[np.ndarray], np.ndarray]  # shares (p, factors) of the ranges -> scores (p, methods)


@dataclass(frozen=True)
class Watch:
    """How a study's work is spread, kept and watched.

    Attributes
    ----------
    workers : processes, one a core when None; or a cluster
    store : folder of footfalls (`footfall.scenarios.store`) and of what was evaluated (`studies.kept`)
    on_points, on_trials, on_cases : progress of points in full, of their trials, and of the budget's cases
    on_check : called with the check of the budget, before it is refused
    """

    workers: Workers = None
    store: Path | None = None
    on_points: Callable[[int, int], None] = field(default=lambda done, all_: None)
    on_trials: Callable[[Progress], None] | None = None
    on_cases: Callable[[int, int], None] | None = None
    on_check: Callable[[Check], None] = field(default=lambda check: None)


@dataclass(frozen=True)
class Answer:
    """What a study found of one method.

    Attributes
    ----------
    nominal : the metric over the cases at the values that the documents have
    scores : design -> (p,) the metric over the cases at its points
    morris : of each factor, or None where it was not asked for
    convergence : Sobol's indices after ever more samples; the last are the result
    check : the budget beside the full chain, where that was used
    """

    method: str
    nominal: float
    scores: Mapping[str, np.ndarray]
    morris: tuple[Screened, ...] | None
    convergence: tuple[Sobol, ...]
    check: Check | None

    @property
    def sobol(self) -> Sobol | None:
        """The last and best indices."""
        return self.convergence[-1] if self.convergence else None


@dataclass(frozen=True)
class Found:
    """What a study found.

    Attributes
    ----------
    shares : design -> (p, factors) its points, as shares of the ranges
    answers : of each method
    """

    study: Study
    shares: Mapping[str, np.ndarray]
    answers: tuple[Answer, ...]

    def of(self, method: str) -> Answer:
        """What was found of a method.

        Raises
        ------
        InputError
            It is none of the study's.
        """
        found = {one.method: one for one in self.answers}
        if method not in found:
            raise InputError(f"method {method!r}: not in the study{did_you_mean(method, found)}")
        return found[method]

    def total(self, method: str) -> dict[str, Index]:
        """Address -> Sobol's total index; empty where the study has none."""
        sobol = self.of(method).sobol
        names = [factor.address for factor in self.study.factors]
        return {} if sobol is None else dict(zip(names, sobol.total, strict=True))

    def rows(self) -> Iterator[dict[str, Any]]:
        """A row a point and method: design, the values by address, method, score."""
        metric = self.study.file.metric
        for design, shares in self.shares.items():
            values, which = self.study.points(shares)
            for i, point in enumerate(values):
                unit = {} if which is None else {UNIT: self.study.factors[-1].ends[which[i]]}
                for one in self.answers:
                    score = float(one.scores[design][i])
                    yield {"design": design, **point, **unit, "method": one.method, metric: score}


def sensitivity(study: str | os.PathLike[str] | Study, watch: Watch | None = None, **changes: Any) -> Found:
    """A study that comes with Footfall by name, or of a file: `sensitivity("mine.toml").total("hdr")`.

    Parameters
    ----------
    **changes : keys of the file with other values, as `fidelity="full"`

    Raises
    ------
    InputError
        As of `read_study` and `perform_study`.
    """
    return perform_study(study if isinstance(study, Study) else read_study(os.fspath(study), changes), watch)


def perform_study(study: Study, watch: Watch | None = None) -> Found:
    """Screen the factors and find their indices, for every method on the same recordings.

    Raises
    ------
    InputError
        The budget is too far off the full chain; a point at which too many cases fail; what a study's parts
        refuse; or SALib is not installed.
    """
    watch = watch or Watch()
    if study.file.fidelity == "full":
        return _found(study, _full(study, watch), _nominal(study, watch), ())
    heard = _listened(study, watch)
    checks = _checked(study.without_unit(), heard, watch)
    setup, over = study.base.setup(), study.file.over
    known = [Heard(heard, setup.spec, method, (), study.file.metric) for method in setup.methods]
    nominal = np.array([over_cases(model(np.empty((1, 0))), over)[0] for model in known])
    return _found(study, _budget(study, heard), nominal, checks)


def _checked(study: Study, heard: Sequence[Case | Lost], watch: Watch) -> tuple[Check, ...]:
    """The budget beside the full chain, over all units at each point."""
    shares = check_points(len(study.factors), study.file.seed)
    full, budget = _full(study, watch)(shares), _budget(study, heard)(shares)
    names = [method.name for method in study.base.methods]
    checks = tuple(map(Check, names, [shares] * len(names), full.T, budget.T))
    for check in checks:
        watch.on_check(check)
    for check in checks:
        check.require()
    return checks


def _found(study: Study, evaluate: Evaluate, nominal: np.ndarray, checks: Sequence[Check]) -> Found:
    file, count = study.file, len(study.factors)
    methods = study.base.methods
    points: dict[str, np.ndarray] = {}
    scores: dict[str, np.ndarray] = {}
    screened: list[tuple[Screened, ...] | None] = [None] * len(methods)
    if file.morris is not None:
        shares = points["morris"] = morris_design(count, file.morris.trajectories, file.seed)
        made = scores["morris"] = evaluate(shares)
        screened = [morris(shares, column, file.seed) for column in transformed(study, made).T]
    steps: list[tuple[Sobol, ...]] = []
    if file.sobol is not None:
        asked: list[tuple[np.ndarray, np.ndarray]] = []

        def judged(shares: np.ndarray) -> np.ndarray:
            asked.append((shares, evaluate(shares)))
            return transformed(study, asked[-1][1])

        told = file.sobol
        at_most = max(told.at_most, told.samples)
        steps = list(
            sobol_until(
                judged,
                count,
                samples=told.samples,
                at_most=at_most,
                widest=told.widest,
                seed=file.seed,
            )
        )
        points["sobol"], scores["sobol"] = map(np.concatenate, zip(*asked, strict=True))
    answers = [
        Answer(
            method.name,
            float(nominal[i]),
            {design: made[:, i] for design, made in scores.items()},
            screened[i],
            tuple(step[i] for step in steps),
            checks[i] if checks else None,
        )
        for i, method in enumerate(methods)
    ]
    return Found(study, points, tuple(answers))


def transformed(study: Study, scores: np.ndarray) -> np.ndarray:
    """What the indices are of: the score's logarithm where ratios count, else the score itself."""
    return np.log(np.maximum(scores, floor_of(study.file.metric))) if study.file.of == "ratio" else scores


def _full(study: Study, watch: Watch) -> Evaluate:
    """The full chain; what was evaluated before is found again where there is a store."""
    setup = study.base.setup()
    kept = Kept(watch.store, *made_of(setup, study.file.cases.deal(setup), study.file.metric))
    failures: Counter[str] = Counter()

    def evaluate(shares: np.ndarray) -> np.ndarray:
        points, which = study.points(shares)
        cases = [None] * len(points) if which is None else which.tolist()
        keys = [json.dumps(pair, sort_keys=True) for pair in zip(points, cases, strict=True)]

        def work(new: list[int]) -> np.ndarray:
            watch.on_points(new[0], len(points))
            own = None if which is None else which[new]
            found = _evaluated(study, watch, [points[i] for i in new], own)
            failures.update(found.failures)
            return found.errors.swapaxes(0, 1)

        errors = kept(keys, work).swapaxes(0, 1)
        scores = np.stack([over_cases(own, study.file.over) for own in errors], axis=1)
        require_finite(scores.max(axis=1), shares, study.factors, failures)
        return scores

    return evaluate


def _nominal(study: Study, watch: Watch) -> np.ndarray:
    found = _evaluated(study, watch, [{}], None)
    return np.array([over_cases(errors, study.file.over)[0] for errors in found.errors])


def _evaluated(
    study: Study, watch: Watch, points: Sequence[Mapping[str, Any]], which: np.ndarray | None
) -> Evaluated:
    return evaluate_points(
        study.base,
        points,
        study.file.cases.deal,
        study.file.metric,
        which=which,
        workers=watch.workers,
        store=watch.store,
        on_progress=watch.on_trials,
    )


def _listened(study: Study, watch: Watch) -> list[Case | Lost]:
    """The cases, heard once."""
    listed = next((factor for factor in study.varied if factor.values is not None), None)
    if listed is not None:
        raise InputError('the budget takes ranges, no lists: use fidelity = "full"', listed.address)
    _models(study, ())  # refused before anything is walked
    trials = study.file.cases.deal(study.base.setup())
    heard = listen_to(trials, workers=watch.workers, on_progress=watch.on_cases)
    if not any(isinstance(one, Case) for one in heard):
        raise InputError(f"no case came to its end: {next(iter(_reasons(heard)))}")
    return heard


def _reasons(heard: Sequence[Case | Lost]) -> Counter[str]:
    return Counter(one[1] for one in heard if not isinstance(one, Case))


def _budget(study: Study, heard: Sequence[Case | Lost]) -> Evaluate:
    """The surrogate."""
    models, reasons, over = _models(study, heard), _reasons(heard), study.file.over

    def evaluate(shares: np.ndarray) -> np.ndarray:
        values = [factor.at(shares[:, i]) for i, factor in enumerate(study.varied)]
        _, which = study.points(shares)
        columns = []
        for addresses, model in models:
            own = [values[i] for i, factor in enumerate(study.varied) if factor.address in addresses]
            errors = model(np.column_stack(own) if own else np.empty((len(shares), 0)))
            if which is not None:
                errors = errors[np.arange(len(errors)), which][:, None]
            columns.append(over_cases(errors, over))
        scores = np.stack(columns, axis=1)
        require_finite(scores.max(axis=1), shares, study.factors, reasons)
        return scores

    return evaluate


def _models(study: Study, heard: Sequence[Case | Lost]) -> list[tuple[list[str], Heard]]:
    """Of each method the addresses that concern it, and the surrogate."""
    setup = study.base.setup()
    found = []
    for method in setup.methods:
        others = [f"{one.name}." for one in setup.methods if one is not method and one.params is not None]
        addresses = [
            one.address for one in study.varied if not any(one.address.startswith(head) for head in others)
        ]
        found.append((addresses, Heard(heard, setup.spec, method, addresses, study.file.metric)))
    return found
