"""Which source files a result depends on: what a stage's modules import, followed to the end.

Caches and identities hash these files and no others: an edit of the drawing code throws no walk away, and a
new module in a subfolder is not forgotten.
"""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

import footfall
from footfall.identity import digest_of

# What makes the result of each stage; together with its input it determines that result.
STAGES = {
    "walk": ("footfall.simulate.walking",),
    "record": ("footfall.simulate.record",),
    "reckon": ("footfall.pdr.reckoning", "footfall.pdr.detectors"),
    "track": ("footfall.hdr.methods",),
    "score": ("footfall.scenarios.judge.score",),
}
# What is imported and changes no number: messages, the format of files, what is only seen, and this file.
NO_PART = frozenset(
    {
        "footfall.columns",
        "footfall.errors",
        "footfall.late",
        "footfall.models.appearance",
        "footfall.shown",
        "footfall.sources",
        "footfall.tables",
    }
)

_ROOT = Path(footfall.__file__).parent


@lru_cache
def stage_digest(stage: str) -> str:
    """SHA-256 of the sources of one of `STAGES`."""
    return modules_digest(*STAGES[stage])


def modules_digest(*roots: str) -> str:
    """SHA-256 of the sources of these modules and of all that they import of Footfall."""
    return digest_of({module: _content(module) for module in modules_of(*roots)})


@lru_cache
def modules_of(*roots: str) -> tuple[str, ...]:
    """These modules of Footfall and all that they import of it, by name, but for `NO_PART`.

    Of a package counts what is imported from it, and its `__init__` where that holds the imported name.
    """
    found: set[str] = set()
    ahead = list(roots)
    while ahead:
        module = ahead.pop()
        if module not in found and module not in NO_PART:
            found.add(module)
            ahead += imports_of(module)
    return tuple(sorted(found))


def file_of(module: str) -> Path:
    """Where the source of a module or package of Footfall lies."""
    place = _ROOT.joinpath(*module.split(".")[1:])
    return place / "__init__.py" if place.is_dir() else place.with_suffix(".py")


@lru_cache
def imports_of(module: str) -> tuple[str, ...]:
    """The modules of Footfall that a module imports, anywhere in it; not those for its types alone."""
    return tuple(dict.fromkeys(_imported(ast.parse(file_of(module).read_bytes()))))


@lru_cache
def _content(module: str) -> str:
    return hashlib.sha256(file_of(module).read_bytes()).hexdigest()


def _imported(node: ast.AST) -> Iterator[str]:
    if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
        return
    if isinstance(node, ast.Import):
        yield from (name.name for name in node.names if name.name.startswith("footfall."))
    elif isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "footfall":
        assert node.module is not None
        for name in node.names:
            inside = f"{node.module}.{name.name}"
            if file_of(inside).is_file():
                yield inside
            elif node.module != "footfall":
                yield node.module
    elif isinstance(node, ast.Call) and ast.unparse(node.func) == "late":  # footfall.late
        yield from (name.value for name in node.args if str(name.value).startswith("footfall."))  # type: ignore[attr-defined]
    else:
        for child in ast.iter_child_nodes(node):
            yield from _imported(child)
