"""A page of results: one HTML file that needs nothing beside it and opens without a network.

`write_page` is all that others need. A page is made from the files of its folder alone: what a folder holds
decides of which kind it is.
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


def write_page(folder: str | os.PathLike[str]) -> Path:
    """Write `report.html` into a folder, from the results of a run, a sweep or a gate that it holds.

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
    from footfall.scenarios.report.page.gate import gate_page
    from footfall.scenarios.report.page.run import run_page
    from footfall.scenarios.report.page.sweep import sweep_page

    kinds: dict[str, Callable[[Path, Mapping[str, Any]], Page]] = {
        "scores.json": run_page,
        "study.json": sweep_page,
        "gate.json": gate_page,
    }
    if not folder.is_dir():
        raise InputError("no such folder", folder)
    name = next((name for name in kinds if (folder / name).is_file()), None)
    if name is None:
        raise InputError(f"no results to report: expected {', '.join(kinds)} in it", folder)
    file = folder / name
    try:
        told = json.loads(file.read_text(encoding="utf-8"))
        return kinds[name](folder, told)
    except InputError:
        raise
    except (ValueError, OSError) as error:
        raise InputError(f"not a readable JSON file ({error})", file) from None
    except (LookupError, TypeError, AttributeError) as error:
        raise InputError(f"not as Footfall writes it ({type(error).__name__}: {error})", file) from None
