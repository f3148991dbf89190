"""The rows of a finished study, as notebooks show them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from footfall.scenarios.judge.score import unit_of
from footfall.scenarios.report.style import colours_of, label_of, plain_log
from footfall.scenarios.studies.rows import AFTER, CASE, SCORES
from footfall.shown import Shown, table_html

_DRAWN = "heading_error_mean_deg"
_MOST_PANELS = 6


@dataclass(frozen=True)
class Results(Shown):
    """Rows of scores of a study: one a trial, setting and method.

    Attributes
    ----------
    table : pyarrow.Table, the columns of `footfall.scenarios.studies.rows.schema`
    """

    table: Any

    def __len__(self) -> int:
        return int(self.table.num_rows)

    def axes(self) -> dict[str, list[Any]]:
        """What differs between the rows beside the case and the method: column -> its values, in order."""
        names = [name for name in self.table.column_names if name not in (*CASE, *SCORES, *AFTER)]
        found = {}
        for name in ("scenario", "imu", *names):
            values = [value for value in self.table[name].unique().to_pylist() if value is not None]
            if len(values) > 1:
                found[name] = sorted(values)
        return found

    def _columns(self) -> dict[str, Any]:
        return {name: self.table[name].to_pandas() for name in self.table.column_names}

    def _units(self) -> Mapping[str, str]:
        return {name: unit_of(name) for name in SCORES}

    def _repr_html_(self) -> str:
        method, error = np.array(self.table["method"].to_pylist()), self.table[_DRAWN].to_numpy()
        told: dict[str, list[Any]] = {"method": list(dict.fromkeys(method))}
        groups = [error[method == name] for name in told["method"]]
        told["rows"] = [len(group) for group in groups]
        told["failed"] = [int(np.isnan(group).sum()) for group in groups]
        for share, name in ((50, "median"), (90, "p90")):
            found = [group[~np.isnan(group)] for group in groups]
            values = [float(np.percentile(group, share)) if len(group) else np.nan for group in found]
            told[f"mean heading error, {name}"] = values
        return table_html(f"Results ({len(self):,} rows) by method, in deg", told, {})

    def _draw(self) -> np.ndarray:
        """A panel an axis: median and 90th percentile of the mean heading error by method, over all else."""
        from matplotlib import pyplot

        frame = self.table.to_pandas()
        methods = list(dict.fromkeys(frame["method"]))
        colours = colours_of(methods)
        axes = dict(list(self.axes().items())[:_MOST_PANELS]) or {
            "scenario": list(frame["scenario"].unique())
        }
        width = 3.6 * len(axes) + 0.8
        _, panels = pyplot.subplots(1, len(axes), figsize=(width, 3.2), sharey=True, squeeze=False)
        for panel, (name, values) in zip(panels[0], axes.items(), strict=True):
            for method in methods:
                own = frame[frame["method"] == method]
                # A method without such a setting is the same at each of its values.
                groups = [own if own[name].isna().all() else own[own[name] == value] for value in values]
                middle, high = (
                    [group[_DRAWN].quantile(share) if len(group) else np.nan for group in groups]
                    for share in (0.5, 0.9)
                )
                panel.plot(middle, "o-", color=colours[method], label=label_of(method), ms=4)
                panel.plot(high, "_", color=colours[method], ms=9)
            panel.set_xticks(range(len(values)), [_short(value) for value in values])
            panel.set_xlabel(name)
            panel.set_yscale("log")
            plain_log(panel.yaxis)
        panels[0, 0].set_ylabel("mean heading error (deg)")
        panels[0, 0].set_title("dots: medians; bars: 90th percentiles")
        panels[0, -1].legend()
        return np.asarray(panels[0])


def _short(value: Any) -> str:
    return f"{value:.3g}" if isinstance(value, float) else str(value)
