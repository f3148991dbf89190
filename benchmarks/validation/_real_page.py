"""Tables for the terminal and for a page of the docs, between its marks."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from rich.console import Console
from rich.table import Table

# A file is as wide as the widest table.
out = Console(soft_wrap=True, width=None if sys.stdout.isatty() else 140)


@dataclass
class Sheet:
    """A table: its mark in the page, title, headings and rows."""

    mark: str
    title: str
    headings: list[str]
    rows: list[list[str]] = field(default_factory=list)

    def show(self) -> None:
        """On the terminal."""
        table = Table(title=self.title, title_justify="left")
        for place, heading in enumerate(self.headings):
            table.add_column(heading, justify="right" if place else "left")
        for row in self.rows:
            table.add_row(*row)
        out.print(table)

    def markdown(self) -> str:
        """For the page."""
        lines = [self.headings, ["---"] + ["---:"] * (len(self.headings) - 1), *self.rows]
        return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def fill(page: Path, sheets: Iterable[Sheet]) -> None:
    """Put every sheet between `<!-- MARK -->` and `<!-- / -->` of the page."""
    text = page.read_text(encoding="utf-8")
    for sheet in sheets:
        found = re.compile(rf"(<!-- {sheet.mark} -->\n).*?(\n<!-- / -->)", re.DOTALL)
        if not found.search(text):
            raise SystemExit(f"{page}: no mark <!-- {sheet.mark} -->")
        body = sheet.markdown()
        text = found.sub(lambda match, body=body: match[1] + body + match[2], text)
    page.write_text(text, encoding="utf-8")
