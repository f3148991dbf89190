"""docs/gates.md: its file is the example, its workflow runs as it stands, its keys are those there are."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from xml.etree import ElementTree as xml

import pytest

from footfall.cli.gate import gate as command
from footfall.scenarios.judge.gate import STATISTICS, Gate
from footfall.scenarios.judge.verdict import Verdict
from footfall.scenarios.studies.gate_file import CasesTable, GatesFile
from tests.helpers.places import DOCS, ROOT

yaml = pytest.importorskip("yaml", reason="reads the workflow")

PAGE = (DOCS / "gates.md").read_text(encoding="utf-8")
EXAMPLES = DOCS / "examples" / "gates"
(WORKFLOW,) = re.findall(r"```yaml\n(.*?)```", PAGE, flags=re.DOTALL)

# `footfall` of the steps: the real one, but whatever is to be walked is a synthetic foot's street.
FOOTFALL = f"""#!{sys.executable}
import sys
sys.path.insert(0, {str(ROOT)!r})
import pytest
from tests.helpers.feet import round_a_block, walk_instead
with pytest.MonkeyPatch.context() as patch:
    walk_instead(patch, round_a_block(15, legs=1))
    from footfall.cli.app import main
    sys.exit(main())
"""


def test_the_file_on_the_page_is_the_example():
    (shown,) = re.findall(r"```toml\n(.*?)```", PAGE, flags=re.DOTALL)
    assert shown == (EXAMPLES / "gates.toml").read_text(encoding="utf-8")


def steps():
    """Of the workflow, in order."""
    document = yaml.safe_load(WORKFLOW)
    (job,) = document["jobs"].values()
    return job["steps"]


@pytest.fixture(scope="module")
def repository(tmp_path_factory):
    """A stranger's repository whose workflow was run, one step after the other, in bash."""
    folder = tmp_path_factory.mktemp("repository")
    for name in ("gates.toml", "nav.py"):
        shutil.copy(EXAMPLES / name, folder)
    programs = folder / ".programs"
    programs.mkdir()
    (programs / "footfall").write_text(FOOTFALL)
    (programs / "pip").write_text('#!/bin/sh\necho "$@" > pip.txt\n')
    for program in programs.iterdir():
        program.chmod(0o755)
    environment = os.environ | {
        "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
        "GITHUB_OUTPUT": str(folder / "output"),
        "GITHUB_STEP_SUMMARY": str(folder / "summary.md"),
        "XDG_CACHE_HOME": str(folder / ".cache"),
        "NO_COLOR": "1",
    }
    for step in steps():
        if step.get("uses", "").startswith("actions/checkout") and "with" in step:
            (folder / step["with"]["path"]).mkdir()
            shutil.copy(EXAMPLES / "nav.py", folder / step["with"]["path"])
        if "run" in step:
            done = subprocess.run(
                ["bash", "-e", "-o", "pipefail", "-c", step["run"]],
                cwd=folder,
                env=environment,
                capture_output=True,
                text=True,
            )
            assert done.returncode == 0, (step["run"], done.stdout, done.stderr)
    return folder


def test_the_workflow_gives_a_verdict_in_the_summary(repository):
    summary = (repository / "summary.md").read_text()
    assert "### Gates: gates" in summary
    assert "closed-loop: 60 units on 5 walks, nimu" in summary
    assert re.search(r"\| half of the units stay under 18 deg \|.*\| pass \|", summary)
    assert re.search(r"\| no worse than before \| identical \|.*\| pass \|", summary)


def test_the_workflow_leaves_what_it_uploads(repository):
    (step,) = [step for step in steps() if step.get("uses", "").startswith("actions/upload-artifact")]
    assert step["if"] == "always()"
    for path in step["with"]["path"].split():
        assert (repository / path).exists(), path
    (suite,) = xml.parse(repository / "gates.xml").getroot()
    assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("2", "0", "0")


def test_the_workflow_keeps_walks_by_their_key(repository):
    written = (repository / "output").read_text()
    assert re.fullmatch(r"key=[0-9a-f]{32}\n", written)
    (step,) = [step for step in steps() if step.get("uses", "").startswith("actions/cache")]
    (maker,) = [one for one in steps() if one.get("id") == "walks"]
    assert steps().index(maker) < steps().index(step)
    assert step["with"]["key"].endswith("${{ steps.walks.outputs.key }}")
    assert step["with"]["path"] == "~/.cache/footfall"


def test_the_workflow_installs_footfall_first(repository):
    assert shlex.split((repository / "pip.txt").read_text()) == ["install", "footfall"]


def test_the_page_names_every_key_and_option():
    keys = {*Gate.model_fields, *CasesTable.model_fields, *GatesFile.model_fields} - {"description"}
    for key in keys - {"gates", "cases", "set", "methods"}:
        assert f"`{key}" in PAGE, key
    for table in ("[cases]", "[set]", "[[methods]]", "[[gates]]"):
        assert f"`{table}`" in PAGE
    for name in STATISTICS:
        assert f"`{name}`" in PAGE or f'"{name}"' in PAGE, name
    for key in Verdict.__dataclass_fields__:
        assert f"`{key}`" in PAGE, key
    options = {name.replace("_", "-") for name in command.__annotations__} - {"gates", "return"}
    renamed = {"as-json": "json"}
    for option in options - {"no-cache", "units"}:
        assert f"--{renamed.get(option, option)}" in PAGE, option
