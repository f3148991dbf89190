"""A page of results: one HTML file that needs nothing beside it and opens without a network.

`write_page` is all that others need. A page is made from the files of its folder alone, which
also decide its kind.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from footfall.errors import InputError
from footfall.tables import replacing

if TYPE_CHECKING:
    from footfall.scenarios.report.page.document import Page

REPORT = "report.html"
Maker = Callable[[Path, Mapping[str, Any]], "Page"]


def write_page(folder: str | os.PathLike[str]) -> Path:
    """Write `report.html` into a folder, from the results of a run, a sweep, a gate or a sensitivity study.

    Returns
    -------
    Path
        Of the page.

    Raises
    ------
    InputError
        There are no results in the folder, they cannot be read, or the folder cannot be written.
    """
    # Late: plotly's package and the readers of results, which only a page needs.
    from footfall.scenarios.report.page.document import render

    place = Path(folder)
    page = place / REPORT
    content = render(_page(place))
    with replacing(page) as temporary:
        temporary.write_text(content, encoding="utf-8")
    return page


def _page(folder: Path) -> Page:
    if not folder.is_dir():
        raise InputError("no such folder", folder)
    kind = next((name for name in _KINDS if (folder / name).is_file()), None)
    if kind is None:
        raise InputError(f"no results to report: expected {', '.join(_KINDS)} in it", folder)
    file, make = folder / kind, _KINDS[kind]()
    try:
        return make(folder, json.loads(file.read_text(encoding="utf-8")))
    except InputError:
        raise
    except (ValueError, OSError) as error:
        raise InputError(f"not a readable JSON file ({error})", file) from None
    except (LookupError, TypeError, AttributeError) as error:
        raise InputError(f"not as Footfall writes it ({type(error).__name__}: {error})", file) from None


# Each is imported when there is one of its kind.


def _of_run() -> Maker:
    from footfall.scenarios.report.page.run import run_page

    return run_page


def _of_sweep() -> Maker:
    from footfall.scenarios.report.page.sweep import sweep_page

    return sweep_page


def _of_gate() -> Maker:
    from footfall.scenarios.report.page.gate import gate_page

    return gate_page


def _of_sensitivity() -> Maker:
    from footfall.scenarios.report.page.sensitivity import sensitivity_page

    return sensitivity_page


_KINDS: dict[str, Callable[[], Maker]] = {
    "scores.json": _of_run,
    "study.json": _of_sweep,
    "gate.json": _of_gate,
    "sensitivity.json": _of_sensitivity,
}
