"""Which parameters a method's error depends on: Morris' and Sobol's figures, in full or by the budget."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from footfall.errors import InputError
from footfall.scenarios.execute import Progress
from footfall.scenarios.judge.gate import floor_of
from footfall.scenarios.studies.budget import Case
from footfall.scenarios.studies.check import Check, check_points
from footfall.scenarios.studies.indices import Screened, Sobol, morris, morris_design, sobol_until
from footfall.scenarios.studies.listening import Heard, Lost, listened
from footfall.scenarios.studies.points import evaluate_points, over_cases, require_finite
from footfall.scenarios.studies.sensitivity_file import UNIT, Study

Evaluate = Callable[[np.ndarray], np.ndarray]  # shares (p, factors) of the ranges -> scores (p,)


@dataclass(frozen=True)
class Watch:
    """How a study's work is spread, kept and watched.

    Attributes
    ----------
    workers : processes; one a core when None
    store : folder of footfalls (`footfall.scenarios.store`)
    on_trials, on_cases : progress of the full chain, and of the budget's cases
    on_check : called with the check of the budget, before it is refused
    """

    workers: int | None = None
    store: Path | None = None
    on_trials: Callable[[Progress], None] | None = None
    on_cases: Callable[[int, int], None] | None = None
    on_check: Callable[[Check], None] = field(default=lambda check: None)


@dataclass(frozen=True)
class Points:
    """Points of a design, where they lie, and what was found there.

    Attributes
    ----------
    shares : (p, factors) of each range
    scores : (p,) the metric over the cases
    """

    design: str
    shares: np.ndarray
    scores: np.ndarray


@dataclass(frozen=True)
class Found:
    """What a study found.

    Attributes
    ----------
    nominal : the metric over the cases at the values that the documents have
    morris : of each factor, or None where it was not asked for
    convergence : Sobol's indices after ever more samples; the last are the result
    check : the budget beside the full chain, where that was used
    points : of each design
    """

    study: Study
    nominal: float
    morris: tuple[Screened, ...] | None
    convergence: tuple[Sobol, ...]
    check: Check | None
    points: tuple[Points, ...]

    @property
    def sobol(self) -> Sobol | None:
        """The last and best indices."""
        return self.convergence[-1] if self.convergence else None

    def rows(self) -> Iterator[dict[str, Any]]:
        """A row a point: design, its values by address, its score."""
        for part in self.points:
            values, which = self.study.points(part.shares)
            for i, (point, score) in enumerate(zip(values, part.scores.tolist(), strict=True)):
                unit = {} if which is None else {UNIT: self.study.factors[-1].ends[which[i]]}
                yield {"design": part.design, **point, **unit, self.study.file.metric: score}


def perform_study(study: Study, watch: Watch | None = None) -> Found:
    """Screen the factors and find their indices.

    Raises
    ------
    InputError
        The budget is too far off the full chain; a point at which too many cases fail; what a study's parts
        refuse; or SALib is not installed.
    """
    watch = watch or Watch()
    full = _full(study, watch)
    if study.file.fidelity == "full":
        return _found(study, full, _nominal(study, watch), None)
    heard, budget = _budget(study, watch)
    shares = check_points(len(study.factors), study.file.seed)
    check = Check(shares, full(shares), budget(shares))
    watch.on_check(check)
    check.require()
    known = _heard(study, heard, ())(np.empty((1, 0)))
    return _found(study, budget, float(over_cases(known, study.file.over)[0]), check)


def _found(study: Study, evaluate: Evaluate, nominal: float, check: Check | None) -> Found:
    file, count = study.file, len(study.factors)
    screened, points = None, []
    if file.morris is not None:
        shares = morris_design(count, file.morris.trajectories, file.seed)
        scores = evaluate(shares)
        screened = morris(shares, transformed(study, scores), file.seed)
        points.append(Points("morris", shares, scores))
    convergence: list[Sobol] = []
    if file.sobol is not None:
        asked: list[tuple[np.ndarray, np.ndarray]] = []

        def judged(shares: np.ndarray) -> np.ndarray:
            asked.append((shares, evaluate(shares)))
            return transformed(study, asked[-1][1])

        at_most = max(file.sobol.at_most, file.sobol.samples)
        steps = sobol_until(
            judged,
            count,
            samples=file.sobol.samples,
            at_most=at_most,
            widest=file.sobol.widest,
            seed=file.seed,
        )
        convergence = [found for found, _, _ in steps]
        points.append(Points("sobol", *map(np.concatenate, zip(*asked, strict=True))))
    return Found(study, nominal, screened, tuple(convergence), check, tuple(points))


def transformed(study: Study, scores: np.ndarray) -> np.ndarray:
    """What the indices are of: the score's logarithm where ratios count, else the score itself."""
    return np.log(np.maximum(scores, floor_of(study.file.metric))) if study.file.of == "ratio" else scores


def _full(study: Study, watch: Watch) -> Evaluate:
    """The full chain."""

    def evaluate(shares: np.ndarray) -> np.ndarray:
        points, which = study.points(shares)
        found = evaluate_points(
            study.base,
            points,
            study.file.cases.deal,
            study.file.metric,
            which=which,
            workers=watch.workers,
            store=watch.store,
            on_progress=watch.on_trials,
        )
        scores = over_cases(found.errors, study.file.over)
        require_finite(scores, shares, study.factors, found.failures)
        return scores

    return evaluate


def _nominal(study: Study, watch: Watch) -> float:
    found = evaluate_points(
        study.base,
        [{}],
        study.file.cases.deal,
        study.file.metric,
        workers=watch.workers,
        store=watch.store,
        on_progress=watch.on_trials,
    )
    return float(over_cases(found.errors, study.file.over)[0])


def _budget(study: Study, watch: Watch) -> tuple[Sequence[Case | Lost], Evaluate]:
    """The cases and the surrogate over them."""
    listed = next((factor for factor in study.varied if factor.values is not None), None)
    if listed is not None:
        raise InputError('the budget takes ranges, no lists: use fidelity = "full"', listed.address)
    addresses = [factor.address for factor in study.varied]
    _heard(study, (), addresses)  # refused before anything is walked
    trials = study.file.cases.deal(study.base.setup())
    heard = listened(trials, workers=watch.workers, on_progress=watch.on_cases)
    model = _heard(study, heard, addresses)
    reasons = {one[1]: 1 for one in heard if not isinstance(one, Case)}
    if len(reasons) and not any(isinstance(one, Case) for one in heard):
        raise InputError(f"no case came to its end: {next(iter(reasons))}")

    def evaluate(shares: np.ndarray) -> np.ndarray:
        values = [factor.at(shares[:, i]) for i, factor in enumerate(study.varied)]
        errors = model(np.column_stack(values))
        _, which = study.points(shares)
        if which is not None:
            errors = errors[np.arange(len(errors)), which][:, None]
        scores = over_cases(errors, study.file.over)
        require_finite(scores, shares, study.factors, reasons)
        return scores

    return heard, evaluate


def _heard(study: Study, heard: Sequence[Case | Lost], addresses: Sequence[str]) -> Heard:
    setup = study.base.setup()
    return Heard(heard, setup.spec, setup.methods[0], addresses, study.file.metric)
