"""Blocks of code of a Markdown page, and the commands in them."""

import re
import shlex
from typing import NamedTuple


class Block(NamedTuple):
    """Code of a page: its language, the line of the page on which it begins, and its text."""

    language: str
    line: int
    code: str


def blocks(text):
    """Fenced blocks that name a language."""
    found = re.finditer(r"^```(\w+)\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)
    return [Block(one[1], text.count("\n", 0, one.start()) + 2, one[2]) for one in found]


def commands(code):
    """Words of each command of a shell's block: without comments, a prompt, or the folder of .venv."""
    for line in code.splitlines():
        words = shlex.split(line.removeprefix("$ "), comments=True)
        while words:
            end = words.index("&&") if "&&" in words else len(words)
            command, words = words[:end], words[end + 1 :]
            yield [command[0].removeprefix(".venv/bin/"), *command[1:]]
