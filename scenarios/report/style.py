"""The house's style of figures. Matplotlib is imported only when a figure is asked for."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from footfall.shown import styled
from footfall.tables import replacing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

TRUTH = "#222222"
COLOURS = {
    "pdr": "#c1440e",
    "hdr": "#1f6fb4",
    "hdr-basic": "#6a9f3a",
    "iez": "#c98a00",
    "hde": "#6a9f3a",
    "ihde": "#1f6fb4",
    "ihde-plus": "#7b4fa3",
}
MORE = ("#7b4fa3", "#c98a00", "#2a9d8f", "#8d5524", "#d16ba5", "#444f9b")
_LABELS = {
    "pdr": "PDR",
    "hdr": "PDR + HDR",
    "hdr-basic": "PDR + basic HDR",
    "iez": "IEZ",
    "hde": "HDE",
    "ihde": "IHDE",
    "ihde-plus": "IHDE+",
    "iez-paper": "IEZ as in the paper",
}


def new_figure(
    rows: int, columns: int, width: float, height: float, **kwargs: Any
) -> tuple[Figure, np.ndarray]:
    """A figure in the house's style with (rows, columns) axes, drawn without a screen."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with styled():
        figure = Figure(figsize=(width, height), layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots(rows, columns, squeeze=False, **kwargs)
    return figure, axes


def new_panels(
    count: int, width: float, height: float, columns: int | None = None, **kwargs: Any
) -> tuple[Figure, list[Axes]]:
    """A figure of `count` panels of width x height inches, row by row, as many columns as look good."""
    columns = columns or {1: 1, 2: 2, 3: 3, 4: 2, 5: 3, 6: 3}.get(count, 4)
    rows = -(-count // columns)
    width = max(width * columns, 5.2)
    figure, grid = new_figure(rows, columns, width, height * rows + 0.6, **kwargs)
    axes = list(grid.flat)
    for axis in axes[count:]:
        figure.delaxes(axis)
    for axis in axes[max(0, count - columns) : count]:  # nothing stands below these
        axis.tick_params(labelbottom=True)
    return figure, axes[:count]


def label_edges(axes: Sequence[Axes], x: str, y: str) -> None:
    """Name the axes once: y at the left of each row, x below the lowest panel of each column."""
    for axis in axes:
        place = axis.get_subplotspec()
        assert place is not None
        columns = place.get_gridspec().ncols
        if place.is_first_col():
            axis.set_ylabel(y)
        if place.num1 + columns >= len(axes):
            axis.set_xlabel(x)


def head(figure: Figure, title: str, axes: Sequence[Axes]) -> None:
    """Title, and below it one legend for all panels, clear of every line."""
    entries: dict[str, Any] = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels(), strict=True):
            entries.setdefault(label, handle)
    width = figure.get_figwidth()
    columns = _legend_columns(list(entries), width)
    ordered = list(entries.items())
    # Matplotlib fills column after column; people read row after row.
    ordered = [ordered[i] for column in range(columns) for i in range(column, len(ordered), columns)]
    figure.legend(
        [handle for _, handle in ordered],
        [label for label, _ in ordered],
        title="\n".join(textwrap.fill(line, int(13 * width)) for line in title.splitlines()),
        loc="outside upper left",
        ncols=columns,
        alignment="left",
        frameon=False,
        fontsize=8,
        title_fontsize=10,
    )


def _legend_columns(labels: Sequence[str], width: float) -> int:
    """As many columns as labels, row after row, have room for in `width` inches."""
    for columns in range(len(labels), 1, -1):
        longest = (max(map(len, labels[column::columns])) for column in range(columns))
        if sum(0.55 + 0.063 * letters for letters in longest) <= width:
            return columns
    return 1


def save(figure: Figure, path: Path) -> None:
    """Write as PNG."""
    with replacing(path) as temporary:
        figure.savefig(temporary, format="png", dpi=160)


def plain_log(axis: Axis) -> None:
    """Plain numbers at 1, 2 and 5 of each decade of an x or y axis that is logarithmic."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def colours_of(methods: Sequence[str]) -> dict[str, str]:
    """A colour for each of up to ten methods, the same in every figure of a run; usual ones keep theirs."""
    # Colours that are no method's own come first, so that red stays what is uncorrected.
    palette = [*(one for one in MORE if one not in COLOURS.values()), *dict.fromkeys(COLOURS.values())]
    found: dict[str, str] = {}
    for method in sorted(methods, key=lambda name: name not in COLOURS):
        usual = COLOURS.get(method)
        left = [colour for colour in palette if colour not in found.values()] or palette
        found[method] = usual if usual in left else left[0]
    return found


def widths_of(methods: Sequence[str]) -> dict[str, float]:
    """Line widths: wider what is drawn first, so that it shows on both sides of whatever repeats it."""
    step = min(0.9, 3 / len(methods))
    return {method: 1.1 + step * later for later, method in enumerate(reversed(list(methods)))}


def label_of(method: str) -> str:
    """A method's name in legends."""
    return _LABELS.get(method, method)


def entitle(axis: Axes, text: str) -> None:
    """A panel's title."""
    axis.set_title(text, loc="left", fontsize=9)
