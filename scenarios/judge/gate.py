"""A gate: what is asked of a method's scores over many cases."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields
from typing import Annotated, Self

from pydantic import AfterValidator, Field, model_validator

from footfall.scenarios.judge.score import Score, unit_of
from footfall.settings import did_you_mean
from footfall.toml import Strict

METRICS = tuple(item.name for item in fields(Score))
DEFAULT_METRIC = "heading_error_mean_deg"
QUANTILES = {"median": 0.5, "p75": 0.75, "p90": 0.9, "p95": 0.95}
STATISTICS = (*QUANTILES, "share_below", "same")

_FLOORS = {"deg": 0.01, "m": 0.01, "%": 0.001}


def floor_of(metric: str) -> float:
    """What a smaller score counts as in a ratio: 0.01 deg, 0.01 m, 0.001 %."""
    return _FLOORS[unit_of(metric)]


def _among(known: Iterable[str]) -> AfterValidator:
    def check(name: str) -> str:
        if name not in (names := tuple(known)):
            raise ValueError(f"unknown{did_you_mean(name, names)}")
        return name

    return AfterValidator(check)


class Gate(Strict):
    """A gate as it stands in TOML.

    Attributes
    ----------
    name : in tables and in what programs are told
    method : whose scores
    metric : which of them; None for the mean heading error, and with `statistic` "same" for all
    statistic : over the cases: a quantile, or the share of them below a value, or whether all are the same
    at_most : for a quantile, in the metric's unit
    below, at_least_percent : for "share_below": at least so many of the cases are below so much
    against : another method, or a file with a baseline of the same method: then the statistic is the median
        of the ratios of the cases, or "same"
    margin_percent : how much larger than 1 the ratio may be; None for the default of the method
    tolerance_percent : how far the scores of a case may lie apart, with "same"
    """

    name: Annotated[str, Field(min_length=1)]
    method: Annotated[str, Field(min_length=1)]
    metric: Annotated[str, _among(METRICS)] | None = None
    statistic: Annotated[str, _among(STATISTICS)] = "median"
    at_most: Annotated[float, Field(gt=0)] | None = None
    below: Annotated[float, Field(gt=0)] | None = None
    at_least_percent: Annotated[float, Field(gt=0, lt=100)] | None = None
    against: Annotated[str, Field(min_length=1)] | None = None
    margin_percent: Annotated[float, Field(gt=-100)] | None = None
    tolerance_percent: Annotated[float, Field(ge=0)] = 0.1

    @model_validator(mode="after")
    def _whole(self) -> Self:
        """Each kind of gate has its own keys, and no others."""
        if self.statistic == "same":
            kind, needs = 'statistic = "same"', {"against"}
            takes = {"metric", "tolerance_percent"}
        elif self.statistic == "share_below":
            kind, needs, takes = 'statistic = "share_below"', {"below", "at_least_percent"}, {"metric"}
        elif self.against is not None:
            kind, needs, takes = "a gate against another", {"against"}, {"metric", "margin_percent"}
            if self.statistic != "median":
                raise ValueError(f'statistic = "{self.statistic}": {kind} takes "median" or "same"')
        else:
            kind, needs, takes = "a gate without against", {"at_most"}, {"metric"}
        given = self.model_fields_set - {"name", "method", "statistic"}
        if missing := sorted(needs - given):
            raise ValueError(f"gate {self.name!r}: {kind} needs {missing[0]}")
        if stray := sorted(given - needs - takes):
            raise ValueError(f"gate {self.name!r}: {kind} takes no {stray[0]}")
        return self

    @property
    def metrics(self) -> tuple[str, ...]:
        """The scores that count."""
        if self.metric is not None:
            return (self.metric,)
        return METRICS if self.statistic == "same" else (DEFAULT_METRIC,)

    @property
    def share(self) -> float:
        """Of the cases, that must lie within the limit."""
        if self.statistic == "share_below":
            assert self.at_least_percent is not None
            return self.at_least_percent / 100
        return QUANTILES.get(self.statistic, 0.5)
