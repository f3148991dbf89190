"""What notebooks show of Footfall's tables: pandas, HTML and figures. Nothing here changes a number.

A class that is shown has columns with units, and draws itself; pandas and matplotlib are loaded when they are
asked for.
"""

from __future__ import annotations

import html
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STYLE = Path(__file__).with_name("footfall.mplstyle")
AXES = dict(zip("xyz", ("#c1440e", "#6a9f3a", "#1f6fb4"), strict=True))  # of a triad
_ROWS = 3  # of a table's head and of its tail


class Shown(ABC):
    """Something with columns that a notebook shows as a table, gives to pandas, and draws."""

    @abstractmethod
    def _columns(self) -> Mapping[str, Any]:
        """Name -> (n,) values."""

    def _units(self) -> Mapping[str, str]:
        """Column -> unit; "" or nothing for none."""
        return {}

    @abstractmethod
    def _draw(self) -> Any:
        """Draw into a new figure of pyplot; its axes."""

    def to_pandas(self) -> Any:
        """The columns as a table of pandas.

        Returns
        -------
        DataFrame
            `attrs` holds `units` by column, and `meta` where there is some.
        """
        import pandas

        units = self._units()
        frame = pandas.DataFrame(self._columns())
        frame.attrs["units"] = {name: units[name] for name in frame.columns if units.get(name)}
        if meta := getattr(self, "meta", None):
            frame.attrs["meta"] = dict(meta)
        return frame

    def plot(self) -> Any:
        """Draw it in a new figure of pyplot, in Footfall's style.

        Returns
        -------
        Its axes, as matplotlib gives them.
        """
        with styled():
            return self._draw()

    def _repr_html_(self) -> str:
        return table_html(type(self).__name__, self._columns(), self._units())


@contextmanager
def styled() -> Iterator[None]:
    """Figures that are made in this block are in Footfall's style."""
    import matplotlib as mpl

    with mpl.rc_context(fname=STYLE):
        yield


def table_html(title: str, columns: Mapping[str, Any], units: Mapping[str, str]) -> str:
    """The first and the last rows of columns as a table of HTML, under a line that counts them."""
    count = len(next(iter(columns.values()), ()))
    rows: list[int | None] = list(range(count))
    if count > 2 * _ROWS + 1:
        rows = [*range(_ROWS), None, *range(count - _ROWS, count)]
    head = "".join(
        f"<th>{html.escape(name)}"
        + (f"<br><small>{html.escape(units[name])}</small>" if units.get(name) else "")
        + "</th>"
        for name in columns
    )
    body = "".join(
        "<tr>"
        + "".join(f"<td>{'...' if row is None else _cell(values[row])}</td>" for values in columns.values())
        + "</tr>"
        for row in rows
    )
    told = f"{html.escape(title)}: {count:,} row{'' if count == 1 else 's'}"
    return f"<p>{told}</p><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _cell(value: Any) -> str:
    if isinstance(value, (float, np.floating)):
        return f"{value:.5g}"
    return html.escape("" if value is None else str(value))


def draw_triads(t: np.ndarray, gyro: np.ndarray, accel: np.ndarray, title: str) -> np.ndarray:
    """What an IMU said, in a new figure: rates above, specific force below."""
    from matplotlib import pyplot

    _, axes = pyplot.subplots(2, sharex=True, figsize=(8, 4.5))
    for axis, values, unit in zip(axes, (np.degrees(gyro), accel), ("deg/s", "m/s²"), strict=True):
        for column, (name, colour) in enumerate(AXES.items()):
            axis.plot(t, values[:, column], color=colour, lw=0.8, label=name)
        axis.set_ylabel(f"{'rate' if unit == 'deg/s' else 'specific force'} ({unit})")
    axes[0].set_title(title)
    axes[0].legend(ncols=3, loc="upper right", frameon=True, edgecolor="none")
    axes[1].set_xlabel("time (s)")
    return np.asarray(axes)


def draw_way(axis: Axes, x: np.ndarray, y: np.ndarray, **line: Any) -> None:
    """A way from above, from its start (a triangle) to its end (a dot), at equal scales."""
    (drawn,) = axis.plot(x, y, **line)
    axis.plot(x[0], y[0], "^", color="#222222", ms=7)
    axis.plot(x[-1], y[-1], "o", color=drawn.get_color(), ms=5)
    axis.set_aspect("equal", adjustable="datalim")
    axis.set_xlabel("x (m)")
    axis.set_ylabel("y (m)")


def draw_walk(walk: Any) -> np.ndarray:
    """The truth of a walk, in a new figure: its footfalls from above, and two strides of a perfect IMU."""
    from matplotlib import pyplot

    figure = pyplot.figure(figsize=(8, 5.5))
    axes = figure.subplot_mosaic([["way", "rate"], ["way", "force"]])
    falls = walk.footfalls.position
    draw_way(axes["way"], falls[:, 0], falls[:, 1], color="#222222", marker=".", ms=3)
    axes["way"].set_title(f"{len(falls)} footfalls")
    # One stride says more than a mark of all of them: two strides amid the walk.
    first, last = (walk.footfalls.t[min(len(falls) // 2 + n, len(falls) - 1)] for n in (0, 2))
    shown = (walk.t >= first) & (walk.t <= last)
    for name, values, label in (
        ("rate", np.degrees(walk.gyro), "rate (deg/s)"),
        ("force", walk.accel, "specific force (m/s²)"),
    ):
        for column, (part, colour) in enumerate(AXES.items()):
            axes[name].plot(walk.t[shown], values[shown, column], color=colour, label=part)
        axes[name].set_ylabel(label)
    axes["rate"].set_title("a perfect IMU, two strides")
    axes["rate"].legend(ncols=3)
    axes["force"].set_xlabel("time (s)")
    return np.array(list(axes.values()))
