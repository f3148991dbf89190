"""Designs: which values the axes of a study take together."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag, model_validator

from footfall.errors import InputError
from footfall.late import late
from footfall.toml import Strict

qmc = late("scipy.stats.qmc")

DIGITS = 6  # of a value between the ends of a range


class RangeTable(Strict):
    """From one number to another; `steps` of them in a grid."""

    start: float = Field(alias="from")
    to: float
    steps: int | None = Field(default=None, ge=2)
    scale: Literal["linear", "log"] = "linear"
    label: str | None = None

    @model_validator(mode="after")
    def _ends(self) -> RangeTable:
        if self.to <= self.start:
            raise ValueError(f"from = {self.start:g}, to = {self.to:g}: expected to beyond from")
        if self.scale == "log" and self.start <= 0:
            raise ValueError(f'from = {self.start:g}: expected a positive number, as scale = "log"')
        return self

    def at(self, share: float) -> float:
        """The number so far on the way, from 0 to 1; the ends as they are given."""
        if share in (0.0, 1.0):
            return self.to if share else self.start
        if self.scale == "log":
            value = self.start * math.exp(share * math.log(self.to / self.start))
        else:
            value = self.start + share * (self.to - self.start)
        return float(f"{value:.{DIGITS}g}")


class ValuesTable(Strict):
    """Values one by one, with what people call them."""

    values: Annotated[tuple[Any, ...], Field(strict=False, min_length=1)]
    label: str | None = None


def _kind(entry: object) -> str:
    if isinstance(entry, list | tuple):
        return "list"
    return "values" if isinstance(entry, Mapping) and "values" in entry else "range"


AxisEntry = Annotated[
    Annotated[tuple[Any, ...], Field(strict=False, min_length=1), Tag("list")]
    | Annotated[ValuesTable, Tag("values")]
    | Annotated[RangeTable, Tag("range")],
    Discriminator(_kind),
]
Kind = Literal["grid", "list", "random", "sobol", "latin-hypercube"]


class DesignTable(Strict):
    """A study's `[design]`: every combination, points one by one, or so many samples of the ranges."""

    kind: Kind = "grid"
    axes: dict[str, AxisEntry] = Field(default={})
    points: Annotated[tuple[dict[str, Any], ...], Field(strict=False)] = ()
    samples: int | None = Field(default=None, ge=1)
    seed: int = Field(default=1, ge=0)

    @model_validator(mode="after")
    def _whole(self) -> DesignTable:
        sampled = self.kind not in ("grid", "list")
        if (self.kind == "list") != bool(self.points):
            raise ValueError('points: expected with kind = "list" and with no other')
        if self.kind == "list" and self.axes:
            raise ValueError('axes: kind = "list" has points instead')
        if sampled and not (self.axes and self.samples):
            raise ValueError(f'kind = "{self.kind}": expected axes, and how many samples')
        if not sampled and self.samples:
            raise ValueError(f'samples = {self.samples}: kind = "{self.kind}" has none')
        if self.kind == "sobol" and (self.samples or 0).bit_count() != 1:
            less = 1 << ((self.samples or 1).bit_length() - 1)
            raise ValueError(
                f"samples = {self.samples}: a Sobol sequence is even with a power of 2, {less} or {2 * less}"
            )
        for address, axis in self.axes.items():
            if isinstance(axis, RangeTable) and (axis.steps is None) != sampled:
                raise ValueError(
                    f"{address}: steps = {axis.steps}: samples are not on steps"
                    if sampled
                    else f"{address}: how many steps from {axis.start:g} to {axis.to:g}?"
                )
        return self


@dataclass(frozen=True)
class Point:
    """Values of the axes that are meant together.

    Attributes
    ----------
    shared : address -> value, of what all methods share
    own : method -> its own parameter sets, each address -> value
    """

    shared: Mapping[str, Any]
    own: Mapping[str, tuple[Mapping[str, Any], ...]]


Whole = Callable[[str], bool]


def points(table: DesignTable, own: Callable[[str], str | None], whole: Whole) -> list[Point]:
    """The points of a design, none of them twice.

    A method's own axes multiply that method alone: what others make of a point is made once.

    Parameters
    ----------
    own : address -> the method that it belongs to, or None
    whole : whether a whole number is expected at an address
    """
    if table.kind == "grid":
        return _grid({address: _steps(axis, whole(address)) for address, axis in table.axes.items()}, own)
    return _grouped(table.points if table.kind == "list" else _samples(table, whole), own)


def labels(table: DesignTable) -> dict[str, str]:
    """Address -> what people call it, where the study says so."""
    known = {address: getattr(axis, "label", None) for address, axis in table.axes.items()}
    return {address: label for address, label in known.items() if label}


def _steps(axis: Any, whole: bool) -> tuple[Any, ...]:
    if isinstance(axis, RangeTable):
        assert axis.steps is not None
        values = [axis.at(i / (axis.steps - 1)) for i in range(axis.steps)]
        return tuple(dict.fromkeys(round(value) if whole else value for value in values))
    given = axis.values if isinstance(axis, ValuesTable) else axis
    return tuple({repr(value): value for value in given}.values())


def _samples(table: DesignTable, whole: Whole) -> list[dict[str, Any]]:
    assert table.samples is not None
    made = []
    for row in unit_cube(table.kind, len(table.axes), table.samples, table.seed):
        point = {}
        for (address, axis), share in zip(table.axes.items(), row, strict=True):
            if isinstance(axis, RangeTable):
                value = axis.at(float(share))
                point[address] = round(value) if whole(address) else value
            else:
                values = axis.values if isinstance(axis, ValuesTable) else axis
                point[address] = values[min(int(share * len(values)), len(values) - 1)]
        made.append(point)
    return made


def unit_cube(kind: str, axes: int, samples: int, seed: int) -> np.ndarray:
    """(samples, axes) points of the unit cube: independent, on a scrambled Sobol sequence, or such that each
    of `samples` equal slices of each axis has one ("latin-hypercube")."""
    if kind == "random":
        return np.random.default_rng(seed).random((samples, axes))
    engine = qmc.Sobol if kind == "sobol" else qmc.LatinHypercube
    return np.asarray(engine(axes, rng=np.random.default_rng(seed)).random(samples))


def _grid(axes: Mapping[str, Sequence[Any]], own: Callable[[str], str | None]) -> list[Point]:
    shared = {address: values for address, values in axes.items() if own(address) is None}
    apart: dict[str, dict[str, Sequence[Any]]] = {}
    for address, values in axes.items():
        if (method := own(address)) is not None:
            apart.setdefault(method, {})[address] = values
    variants = {method: tuple(_combined(told)) for method, told in apart.items()}
    return [Point(values, variants) for values in _combined(shared)]


def _combined(axes: Mapping[str, Sequence[Any]]) -> list[dict[str, Any]]:
    return [dict(zip(axes, values, strict=True)) for values in product(*axes.values())]


def _grouped(given: Iterable[Mapping[str, Any]], own: Callable[[str], str | None]) -> list[Point]:
    """Points of equal shared values as one, with each method's parameter sets of any of them."""
    groups: dict[str, tuple[dict[str, Any], dict[str, dict[str, dict[str, Any]]]]] = {}
    for point in given:
        shared = {address: value for address, value in point.items() if own(address) is None}
        _, sets = groups.setdefault(repr(sorted(shared.items(), key=str)), (shared, {}))
        apart: dict[str, dict[str, Any]] = {}
        for address, value in point.items():
            if (method := own(address)) is not None:
                apart.setdefault(method, {})[address] = value
        for method, values in apart.items():
            sets.setdefault(method, {})[repr(sorted(values.items(), key=str))] = values
    return [
        Point(shared, {method: tuple(found.values()) for method, found in sets.items()})
        for shared, sets in groups.values()
    ]


def require_addresses(given: Iterable[Point], known: Collection[str], where: str) -> None:
    """Refuse an axis that is set for the whole study, too."""
    for point in given:
        for address in (*point.shared, *(one for sets in point.own.values() for one in sets[0])):
            if address in known:
                raise InputError(f"{address}: an axis, and set for the whole study, too", where)
