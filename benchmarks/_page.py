"""Tables of benchmarks: on the terminal, as Markdown, and between the marks of a page of the docs."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from rich.table import Table

from benchmarks._common import out


@dataclass
class Sheet:
    r"""A table. Its cells are Markdown; a figure that ends in \* is a wrong one.

    Attributes
    ----------
    name : of its mark in a page
    title : on the terminal
    headings, rows : all equally long
    left : so many columns are words, the others are figures
    """

    name: str
    title: str
    headings: list[str]
    rows: list[list[str]] = field(default_factory=list)
    left: int = 1

    def show(self) -> None:
        """On the terminal."""
        table = Table(title=self.title, title_justify="left")
        for place, heading in enumerate(self.headings):
            table.add_column(heading, justify="left" if place < self.left else "right")
        for row in self.rows:
            table.add_row(*(_styled(cell) for cell in row))
        out.print(table)

    def markdown(self) -> str:
        """For a page."""
        rules = ["---" if place < self.left else "---:" for place in range(len(self.headings))]
        return "\n".join("| " + " | ".join(line) + " |" for line in [self.headings, rules, *self.rows])


def _styled(cell: str) -> str:
    """A Markdown cell for a terminal."""
    if cell.startswith("**") and cell.endswith("**"):
        return f"[bold]{cell[2:-2]}[/bold]"
    return f"[red]{cell[:-2]}*[/red]" if cell.endswith(r"\*") else cell


def by_name(sheets: Iterable[Sheet]) -> dict[str, str]:
    """Name -> Markdown."""
    return {sheet.name: sheet.markdown() for sheet in sheets}


def fill(page: Path, parts: Mapping[str, str]) -> None:
    """Put each part between its two marks in the page: <!-- table NAME --> and <!-- end -->.

    Raises
    ------
    SystemExit
        The page lacks a mark, and is left as it is.
    """
    text = page.read_text(encoding="utf-8")
    for name, part in parts.items():
        text, count = re.subn(
            rf"(<!-- table {re.escape(name)} -->\n).*?(<!-- end -->)",
            lambda found, part=part: f"{found[1]}\n{part}\n\n{found[2]}",
            text,
            flags=re.DOTALL,
        )
        if count != 1:
            raise SystemExit(f"{page}: expected one mark <!-- table {name} -->, found {count}")
    page.write_text(text, encoding="utf-8")
