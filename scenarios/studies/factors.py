"""What a study varies: parameters by address, each over a range or a list of values."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from pydantic import Field, model_validator

from footfall.toml import Strict


class FactorTable(Strict):
    """A parameter's range in a file: `{ from = 4, to = 16, scale = "log" }` or `{ values = [...] }`."""

    from_: float | None = Field(default=None, alias="from")
    to: float | None = None
    scale: Literal["linear", "log"] = "linear"
    values: list[int | float | str | bool | list[float]] | None = None
    label: str = ""

    @model_validator(mode="after")
    def _one_of_both(self) -> FactorTable:
        ranged = self.from_ is not None and self.to is not None
        if (self.values is None) == (self.from_ is None and self.to is None):
            raise ValueError("expected either from and to, or values")
        if self.values is not None:
            if len(self.values) < 2:
                raise ValueError(f"{len(self.values)} values, expected at least 2")
            return self
        if not ranged:
            raise ValueError(f"{'to' if self.to is None else 'from'} is missing")
        assert self.from_ is not None
        assert self.to is not None
        if not self.from_ < self.to:
            raise ValueError(f"from = {self.from_:g} is not below to = {self.to:g}")
        if self.scale == "log" and self.from_ <= 0:
            raise ValueError(f"from = {self.from_:g} on a logarithmic scale, expected a positive number")
        return self


@dataclass(frozen=True)
class Factor:
    """One parameter of a study.

    Attributes
    ----------
    address : dotted
    low, high : of its range; of a list the first and last number of an element
    log : whether equal ratios count alike, instead of equal differences
    values : where it is a list: these and no others
    label : what it is called in tables and figures; its address without one
    unit : of its values, or ""
    """

    address: str
    low: float
    high: float
    log: bool = False
    values: tuple[Any, ...] | None = None
    label: str = ""
    unit: str = ""

    @property
    def name(self) -> str:
        """For people."""
        return self.label or self.address

    def at(self, share: np.ndarray) -> np.ndarray:
        """Its values (n,) at shares (n,) of its range, from 0 to 1; of a list an object array."""
        if self.values is not None:
            which = np.minimum((np.asarray(share) * len(self.values)).astype(int), len(self.values) - 1)
            chosen = np.empty(len(self.values), dtype=object)
            chosen[:] = self.values
            return chosen[which]
        if self.log:
            inside = np.exp(math.log(self.low) + share * math.log(self.high / self.low))
        else:
            inside = self.low + share * (self.high - self.low)
        return np.clip(inside, self.low, self.high)  # rounding leads beyond no bound

    @property
    def ends(self) -> tuple[Any, ...]:
        """What must be allowed for all of it to be: the ends of the range, or every value."""
        return (self.low, self.high) if self.values is None else self.values

    def as_dict(self) -> dict[str, Any]:
        """For a document."""
        told = {"label": self.name, "unit": self.unit}
        if self.values is not None:
            return {**told, "values": list(self.values)}
        return {**told, "from": self.low, "to": self.high, "scale": "log" if self.log else "linear"}


def factors_of(tables: Mapping[str, FactorTable]) -> tuple[Factor, ...]:
    """The factors of a file, in its order."""
    found = []
    for address, table in tables.items():
        if table.values is not None:
            last = float(len(table.values) - 1)
            found.append(Factor(address, 0.0, last, values=tuple(table.values), label=table.label))
        else:
            assert table.from_ is not None
            assert table.to is not None
            found.append(Factor(address, table.from_, table.to, table.scale == "log", label=table.label))
    return tuple(found)


def points_at(factors: Sequence[Factor], shares: np.ndarray) -> list[dict[str, Any]]:
    """Address -> value at each of (p, factors) shares."""
    columns = [factor.at(shares[:, i]).tolist() for i, factor in enumerate(factors)]
    names = [factor.address for factor in factors]
    return [dict(zip(names, values, strict=True)) for values in zip(*columns, strict=True)]
