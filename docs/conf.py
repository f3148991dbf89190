"""The documentation site: `pip install -e '.[docs]' && sphinx-build -W docs build/site`.

Pages are Markdown that reads as well on its own. What the site adds is made here: its menu, from the links of
index.md, and parts of files that lie outside docs/, between comments of a page that ask for them.
"""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import footfall

DOCS = Path(__file__).resolve().parent
ROOT = DOCS.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
REPOSITORY = PROJECT["urls"]["Repository"]

project = "Footfall"
author = PROJECT["authors"][0]["name"]
project_copyright = author
version = release = footfall.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "sphinx_gallery.gen_gallery",
    "sphinx_copybutton",
]
templates_path = ["templates"]
# Beside the pages of the gallery lie its scripts, as notebooks and otherwise.
exclude_patterns = [
    "gallery",
    "examples",
    "templates",
    *(f"auto_gallery/*.{end}" for end in ("ipynb", "py", "json", "zip")),
]

myst_heading_anchors = 4
nb_execution_mode = "cache"  # in the build folder
nb_execution_timeout = 300
nb_execution_raise_on_error = True
nb_merge_streams = True

autosummary_generate = True
autodoc_typehints = "signature"  # shapes and units are in the docstrings
autodoc_typehints_format = "short"
python_maximum_signature_line_length = 80
numpydoc_show_class_members = False
# A docstring of one summary, whose parameters are there, in their order.
numpydoc_validation_checks = {
    "GL03",
    "GL06",
    "GL07",
    "GL08",
    "SS01",
    "SS02",
    "SS03",
    "SS06",
    "PR02",
    "PR03",
    "PR10",
}

sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "auto_gallery",
    "filename_pattern": r"/plot_",
    "image_srcset": ["2x"],
    "min_reported_time": 1e9,
    "show_memory": False,
    "write_computation_times": False,
    "abort_on_example_error": True,
    "download_all_examples": False,
    "notebook_images": False,
}

html_theme = "furo"
html_title = f"Footfall {version}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_theme_options = {
    "source_repository": f"{REPOSITORY}/",
    "source_branch": "main",
    "source_directory": "docs/",
}
copybutton_prompt_text = "$ "

# <!-- site: FILE, from HEADING, until HEADING --> what the page says elsewhere <!-- /site -->
PART = re.compile(
    r"<!-- site: ([^,>]+)(?:, from ([^,>]+))?(?:, until ([^,>]+))? -->.*?<!-- /site -->", flags=re.DOTALL
)
LINK = re.compile(r"(?<=\]\()([^)#\s]+)(?=[)#])")
# Where the site has what these links name on the way to a reader of the files.
MADE = {
    ROOT / "README.md": DOCS / "tour.md",
    ROOT / "CHANGELOG.md": DOCS / "changelog.md",
    ROOT / "CONTRIBUTING.md": DOCS / "contributing.md",
    DOCS / "gallery" / "README.rst": DOCS / "auto_gallery" / "index.rst",
}


def relinked(text: str, origin: Path, page: Path) -> str:
    """`text` of the file `origin`, with its links as they are on `page` of the site."""

    def there(found: re.Match[str]) -> str:
        if "://" in found[0]:
            return found[0]
        target = Path(os.path.normpath(origin.parent / found[0]))
        target = MADE.get(target, target)
        if target.is_relative_to(DOCS):
            return os.path.relpath(target, page.parent)
        return f"{REPOSITORY}/blob/main/{target.relative_to(ROOT)}"

    return LINK.sub(there, text)


def part(text: str, first: str, last: str) -> str:
    """The sections of Markdown from the heading `first` until the heading `last`, "" for the file's ends."""
    for heading in filter(None, (first, last)):
        if f"\n## {heading}\n" not in text:
            raise ValueError(f"docs/conf.py: no heading {heading!r} where a page of the site wants it")
    text = text[text.index(f"\n## {first}\n") :] if first else text
    return text[: text.index(f"\n## {last}\n")] if last else text


def told(text: str, page: Path) -> str:
    """`text` of a page, with the parts of other files in place of what says to its readers where they are."""

    def taken(found: re.Match[str]) -> str:
        name, first, last = found.groups(default="")
        source = Path(os.path.normpath(page.parent / name))
        return relinked(part(source.read_text(encoding="utf-8"), first, last), source, page)

    return PART.sub(taken, relinked(text, page, page))


def menus(text: str) -> Iterator[str]:
    """A hidden toctree for each section of index.md that links pages."""
    for title, body in re.findall(r"^## (.+?)$(.*?)(?=^## |\Z)", text, flags=re.MULTILINE | re.DOTALL):
        pages = [link for link in LINK.findall(body) if link.endswith((".md", ".rst", ".ipynb"))]
        if pages:
            yield "\n".join(["", "```{toctree}", ":hidden:", f":caption: {title}", "", *pages, "```", ""])


def read(app: Any, name: str, content: list[str]) -> None:
    """Make the text of a page into that of the site."""
    page = DOCS / f"{name}.md"
    if not page.is_file():
        return
    content[0] = told(content[0], page)
    if name == "index":
        content[0] += "".join(menus(content[0]))


def setup(app: Any) -> None:
    """Called by Sphinx."""
    app.connect("source-read", read)
