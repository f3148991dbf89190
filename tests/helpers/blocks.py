"""Blocks of code of a Markdown page, and the commands in them."""

import re
import shlex
from typing import NamedTuple


class Block(NamedTuple):
    """Code of a page: its language, the line of the page on which it begins, and its text."""

    language: str
    line: int
    code: str


_FENCED = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_INDENTED = re.compile(r"(?<=\n\n)(?: {4}(?:footfall|python) .*\n)+")


def blocks(text):
    """Fenced blocks of code, in the order of the page, and indented ones that are commands.

    A fence that names no language holds commands, where it begins with one; else it is "text".
    """
    found, rest = [], text
    for one in _FENCED.finditer(text):
        named = one[1] or ("bash" if re.match(r"(\$ )?(footfall|python) ", one[2]) else "text")
        found.append(Block(named, _line(text, one.start()) + 1, one[2]))
        rest = rest.replace(one[0], "\n" * one[0].count("\n"), 1)
    for one in _INDENTED.finditer(rest):
        code = re.sub(r"^ {4}", "", one[0], flags=re.MULTILINE)
        found.append(Block("bash", _line(rest, one.start()), code))
    return sorted(found, key=lambda block: block.line)


def _line(text, place):
    return text.count("\n", 0, place) + 1


def commands(code, language="bash"):
    """Words of each command of a shell's block: without comments, a prompt, or the folder of .venv.

    On a "console" the lines without a prompt are what was printed.
    """
    for line in code.splitlines():
        if language == "console" and not line.startswith("$ "):
            continue
        words = shlex.split(line.removeprefix("$ "), comments=True)
        while words:
            end = words.index("&&") if "&&" in words else len(words)
            command, words = words[:end], words[end + 1 :]
            yield [command[0].removeprefix(".venv/bin/"), *command[1:]]
