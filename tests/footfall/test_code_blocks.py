"""Every block of code of README and docs: Python runs, files are read, and commands are such as there are.

Commands that walk for long are parsed by their own parsers; the others run, in their order.
"""

import argparse
import ast
import importlib
import inspect
import runpy
import shutil
import sys
import tomllib
from itertools import pairwise
from pathlib import Path

import pytest
import typer

import footfall
from footfall.cli.app import app, main
from footfall.cli.choices import methods_of
from footfall.errors import InputError
from footfall.recording import read_recording, write_recording
from footfall.scenarios.parameters import documents, parsed, with_values
from tests.helpers.blocks import blocks, commands
from tests.helpers.places import DOCS, ROOT

PAGES = sorted(
    page.relative_to(ROOT).as_posix()
    for page in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", *DOCS.rglob("*.md"))
    if page.is_file() and blocks(page.read_text(encoding="utf-8"))
)
LANGUAGES = {"bash", "python", "toml", "yaml"}

# Programs of others.
OTHERS = {
    "python3",
    "pip",
    "pytest",
    "ruff",
    "mypy",
    "pre-commit",
    "sphinx-build",
    "evo_ape",
    "source",
    "dask",
    "kubectl",
    "uv",
}
# They run here: what they need is made by others before them, and takes no walk.
RUN = {"list", "parameters", "sample", "inspect", "record", "track", "score", "export"}
# Python of which a page shows a part, or what only another project has; the first line of each, and which
# test holds it.
SHOWN = {
    "def straightened(footfalls, start):": "test_method_examples.py",
    "@dataclass(frozen=True)": "test_method_examples.py",
    "python = find_method(": "test_method_examples.py",
    'wave = observation[:, LAYOUT["step_phase"]]  # sine and cosine': "test_tutorial.py",
    'envs = gymnasium.make_vec("footfall/Walk-v0", num_envs=48, threads=2, '
    "difficulty=Difficulty(level=0.0), ...)": "test_tutorial.py",
}
# Their Python starts studies of minutes on what the reader has: it is parsed, and its imports are made.
STUDIES = {"docs/gates.md", "docs/hypotheses.md", "docs/sensitivity.md", "docs/sweeps.md", "docs/tuning.md"}
# Their Python needs a machine that is not here: it is parsed.
ELSEWHERE = {"docs/cluster.md"}
# What a page speaks of, as it is here: shorter, fewer, or lying in the working folder.
HERE = {
    '"straight"': '"short.toml"',
    '"closed-loop"': '"short.toml"',
    "units=10": "units=1",
    "units=20": "units=1",
    "num_envs=8, vectorization_mode": "num_envs=1, vectorization_mode",
    "num_envs=64": "num_envs=2",
    "mypkg.nav:": "nav.py:",
}


def text_of(page):
    return (ROOT / page).read_text(encoding="utf-8")


def of(language):
    """Page and block, of every block in a language."""
    found = [(page, block) for page in PAGES for block in blocks(text_of(page)) if block.language == language]
    return [pytest.param(*one, id=f"{one[0]}:{one[1].line}") for one in found]


def pages_with(language):
    return [page for page in PAGES if any(block.language == language for block in blocks(text_of(page)))]


needs_docs = pytest.mark.skipif(not DOCS.is_dir(), reason="no docs beside these tests")


@needs_docs
def test_there_are_pages_and_no_languages_that_nothing_checks():
    assert {"README.md", "docs/methods.md"} <= set(PAGES)
    assert {block.language for page in PAGES for block in blocks(text_of(page))} <= LANGUAGES


# Python


@pytest.fixture
def folder(here, monkeypatch):
    """The working folder of a reader: a walk and what was made of it, and the examples of the pages."""
    recording = read_recording("rec.parquet")
    for name in ("walk.csv", "walk_of_somebody.csv"):
        write_recording(recording, name)
    for file in (DOCS / "examples" / "methods").glob("*.py"):
        shutil.copy(file, here)
    (here / "docs").symlink_to(DOCS)
    monkeypatch.syspath_prepend(str(here))
    # A method of a page runs in this process; the pool that README speaks of has its own tests.
    monkeypatch.setattr("footfall.scenarios.evaluate.travelling", lambda methods, workers=None: 1)
    yield here
    sys.modules.pop("nav", None)


@pytest.mark.parametrize("page", pages_with("python"))
def test_the_python_of_a_page_runs(page, folder):
    """Block after block, in one namespace, as somebody who reads along would run them."""
    names = {"__name__": "__main__"}
    for block in blocks(text_of(page)):
        if block.language != "python" or block.code.splitlines()[0] in SHOWN:
            continue
        code = block.code
        for old, new in HERE.items():
            code = code.replace(old, new)
        tree = ast.parse("\n" * (block.line - 1) + code, page)
        if page in ELSEWHERE:
            continue
        if page in STUDIES:
            tree.body = [part for part in tree.body if isinstance(part, (ast.Import, ast.ImportFrom))]
        exec(compile(tree, page, "exec"), names)
    for name in ("env", "envs"):
        if name in names:
            names[name].close()


@needs_docs
def test_what_is_shown_in_part_is_still_shown():
    """And the tests that hold those parts are there."""
    firsts = {block.code.splitlines()[0] for page in PAGES for block in blocks(text_of(page))}
    assert set(SHOWN) <= firsts
    for test in SHOWN.values():
        assert list((ROOT / "tests").rglob(test)), test


# Files


@pytest.mark.parametrize(("page", "block"), of("toml"))
def test_a_toml_file_is_read(page, block, tmp_path):
    told = tomllib.loads(block.code)
    if "path" in told:
        file = tmp_path / "mine.toml"
        file.write_text(block.code, encoding="utf-8")
        assert footfall.load_scenario(file).path.route.length > 0


# Commands

# What parsers raise (typer's class depends on its version), what finds nothing, and what ended badly.
REFUSALS = (
    typer.BadParameter.__mro__[1],
    InputError,
    SystemExit,
    ModuleNotFoundError,
    FileNotFoundError,
    AssertionError,
)


class ParsedError(Exception):
    """Raised in place of what a script would do next."""


def parse_script(run, words, monkeypatch):
    """Let a script parse `words`, and do no more."""
    original = argparse.ArgumentParser.parse_args

    def parse(self, arguments=None, namespace=None):
        original(self, words, namespace)
        raise ParsedError

    with monkeypatch.context() as patch:
        patch.setattr(argparse.ArgumentParser, "parse_args", parse)
        with pytest.raises(ParsedError):
            run()


def parse_footfall(words):
    """By the command line's own parser, which refuses what it does not know; the command's parameters."""
    group, context = typer.main.get_command(app), None
    while hasattr(group, "resolve_command"):
        context = group.make_context("footfall", list(words), parent=context)
        name, group, words = group.resolve_command(context, list(words))
    if words == ["--help"]:
        return {}
    return group.make_context(name, list(words)).params


def understand(params):
    """Find the scenario, methods and addresses that a walk would be made with."""
    if params.get("scenario"):
        methods = methods_of(params["methods"]) if params.get("methods") else ["pdr"]
        base = documents(params["scenario"], imu=params.get("imu"), methods=methods)
        with_values(base, parsed(params.get("settings") or ())).setup()


def module_of(words, monkeypatch):
    """Of `python -m NAME`: it is there, and takes its arguments."""
    name, rest = words[1], words[2:]
    if name.startswith("footfall.simulate.learn"):
        pytest.importorskip("torch", reason="training needs footfall[train]")
    module = importlib.import_module(name)
    if ".parse_args(" in inspect.getsource(module):
        parse_script(module.main, rest, monkeypatch)
    else:
        assert not rest, f"{name} takes no arguments"


def inputs_of(words):
    return [
        word
        for before, word in pairwise(words)
        if before not in ("-o", "--output") and word.endswith((".parquet", ".csv"))
    ]


def perform(words, monkeypatch):
    """What a reader would type: run where it takes no walk, else parsed."""
    program, *rest = words
    if program == "footfall":
        while rest[0].startswith("-") and rest != ["--help"]:  # options of all commands
            assert rest[0] in ("-v", "--log"), rest[0]
            rest = rest[1 if rest[0] == "-v" else 2 :]
        understand(parse_footfall(rest))
        if rest[0] in RUN and all(Path(word).is_file() for word in inputs_of(rest)):
            assert main(rest) == 0, rest
    elif program == "python" and rest[0] == "-m":
        module_of(rest, monkeypatch)
    elif program == "python" and rest[0] == "-c":
        exec(rest[1], {"__name__": "__main__"})
    elif program == "python":
        parse_script(lambda: runpy.run_path(rest[0], run_name="__main__"), rest[1:], monkeypatch)
    elif "/" in program:
        assert (ROOT / program).is_file(), program
    else:
        assert program in OTHERS, program


@pytest.mark.parametrize("page", pages_with("bash"))
def test_the_commands_of_a_page_are_such_as_there_are(page, folder, monkeypatch, capsys):
    for block in blocks(text_of(page)):
        if block.language == "toml" and "[path]" in block.code:
            (folder / "park.toml").write_text(block.code, encoding="utf-8")
        if block.language == "bash":
            for words in commands(block.code):
                perform(words, monkeypatch)


@needs_docs
@pytest.mark.parametrize(
    "line",
    [
        "footfall rnu straight",
        "footfall run straight --unit 5",
        "footfall run strait",
        "footfall run straight --methods pdr,hrd",
        "footfall run straight --set hdr.theta_q_deg_s=0.4",
        "footfall run straight --units five",
        "footfall cache prune --keep",
        "footfall record rec.parquet -o again.parquet",
        "python -m benchmarks.speed.nothing",
        "python -m benchmarks.speed.startup --repeat",
        "python -m benchmarks.speed.navigation --units 5",
        "python docs/examples/nothing.py",
        "benchmarks/nothing.sh",
        "fotfall list",
    ],
)
def test_a_command_that_is_not_there_is_found(line, folder, monkeypatch, capsys):
    (words,) = commands(line + "  # of a page\n")
    with pytest.raises(REFUSALS):
        perform(words, monkeypatch)


def test_commands_are_cut_out_of_their_lines():
    code = (
        "# first\n\n$ footfall list  # scenarios\n.venv/bin/pip install -e '.[docs]' && footfall run 'a b'\n"
    )
    assert list(commands(code)) == [
        ["footfall", "list"],
        ["pip", "install", "-e", ".[docs]"],
        ["footfall", "run", "a b"],
    ]
    page = "# Title\n\n```bash\none\n```\n\n    ```\n\n```python\ntwo\nthree\n```\n"
    assert [tuple(block) for block in blocks(page)] == [("bash", 4, "one\n"), ("python", 10, "two\nthree\n")]
