"""Tables of benchmarks, on the terminal and in pages of the docs."""

import re

import pytest

from benchmarks._page import Sheet, by_name, fill
from tests.helpers.places import DOCS

SHEET = Sheet("one", "One", ["a", "b"], [["**x**", "1"], ["y", r"2\*"]])


def test_a_sheet_is_markdown_with_words_to_the_left():
    assert SHEET.markdown() == "| a | b |\n| --- | ---: |\n| **x** | 1 |\n| y | 2\\* |"
    assert Sheet("", "", ["a", "b", "c"], left=2).markdown() == "| a | b | c |\n| --- | --- | ---: |"


def test_a_terminal_shows_no_marks_of_markdown(capsys):
    SHEET.show()
    shown = capsys.readouterr().out
    assert re.search(r"x +\S+ +1 ", shown)
    assert re.search(r"y +\S+ +2\* ", shown)
    assert "**" not in shown
    assert "\\" not in shown


def test_parts_replace_their_older_selves_and_nothing_else(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("# A\n<!-- table one -->\nold\n<!-- end -->\ntext\n<!-- table two -->\n<!-- end -->\n")
    fill(page, by_name([SHEET]) | {"two": "words"})
    once = page.read_text()
    assert "old" not in once
    assert once.startswith("# A\n<!-- table one -->\n\n| a | b |\n")
    assert once.endswith("| y | 2\\* |\n\n<!-- end -->\ntext\n<!-- table two -->\n\nwords\n\n<!-- end -->\n")
    fill(page, by_name([SHEET]))
    assert page.read_text() == once


def test_a_page_without_a_mark_is_told_and_left_alone(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("<!-- table one -->\nold\n<!-- end -->\n")
    with pytest.raises(SystemExit, match="expected one mark <!-- table three -->, found 0"):
        fill(page, {"one": "new", "three": ""})
    assert "old" in page.read_text()


@pytest.mark.parametrize(
    ("page", "names"),
    [
        ("gait", ["counts", "feet", "walks", "recordings"]),
        ("ihde", ["people", "line", "settings", "decides", "loop"]),
        ("iez", ["grid", "parts", "feet", "detectors", "tests", "walker"]),
        ("results", ["hdr", "hdr noise", "hdr mounts"]),
        ("swaying", ["stages", "gain", "errors"]),
        ("real_recordings", ["recordings", "targets", "methods", "detectors pdr", "detectors iez"]),
        ("real_recordings", ["strides", "mechanics", "late", "bias", "clipped", "drift"]),
    ],
)
def test_every_page_has_a_place_for_its_tables(page, names, tmp_path):
    copy = tmp_path / "page.md"
    copy.write_text((DOCS / f"{page}.md").read_text(encoding="utf-8"), encoding="utf-8")
    fill(copy, dict.fromkeys(names, "here"))
    assert copy.read_text().count("\nhere\n") == len(names)
