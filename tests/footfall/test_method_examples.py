"""The examples of docs/methods.md are complete: each is found, passes, and is what the page shows."""

import re
import shutil
import subprocess
import tomllib

import numpy as np
import pytest

from footfall.hdr import check as module
from footfall.hdr.check import Case, checks, synthetic_case
from footfall.hdr.methods import METHODS, find_method
from footfall.hdr.tracks import Reckoning
from tests.helpers.commands import one_document
from tests.helpers.places import DOCS

EXAMPLES = DOCS / "examples" / "methods"
PAGE = (DOCS / "methods.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def case() -> Case:
    return synthetic_case(1)


@pytest.fixture(autouse=True)
def cases_once(case, monkeypatch):
    monkeypatch.setattr(module, "synthetic_case", lambda seed: case if seed == 1 else module._halved(case))


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The examples beside a program that was built as the page says."""
    compiler = next((name for name in ("c++", "g++", "clang++") if shutil.which(name)), None)
    if compiler is None:
        pytest.skip("no C++ compiler here")
    folder = tmp_path_factory.mktemp("methods")
    for name in ("nav.cpp", "program.py", "programs.py"):
        shutil.copy(EXAMPLES / name, folder)
    line = next(line for line in PAGE.splitlines() if "c++ -O2" in line)
    assert line.split()[-4:] == ["-O2", "-o", "nav", "nav.cpp"]
    subprocess.run([compiler, "-O2", "-Wall", "-Werror", "-o", "nav", "nav.cpp"], cwd=folder, check=True)
    return folder


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """The package of the example as an installer would leave it: importable, with its entry points."""
    project = tomllib.loads((EXAMPLES / "package" / "pyproject.toml").read_text())["project"]
    info = tmp_path / f"{project['name']}-{project['version']}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Name: {project['name']}\nVersion: {project['version']}\n")
    points = project["entry-points"]["footfall.methods"].items()
    lines = [f"{name} = {value}" for name, value in points]
    (info / "entry_points.txt").write_text("\n".join(["[footfall.methods]", *lines]) + "\n")
    shutil.copytree(EXAMPLES / "package" / "mynav", tmp_path / "mynav")
    monkeypatch.syspath_prepend(str(tmp_path))
    return [name for name, _ in points]


def passes(method):
    """All checks but that of another process, which costs seconds for each."""
    for name, check in checks(method):
        if name != "survives pickling":
            check()


def ran(method, case):
    return method.track(Reckoning(case.recording, case.start))


@pytest.mark.parametrize("name", ["straightened", "SteadyPace"])
def test_a_method_in_a_file(case, name):
    method = find_method(f"{EXAMPLES / 'nav.py'}:{name}")
    passes(method)
    made = ran(method, case)
    if name == "straightened":
        assert method.needs == "footfalls"
        assert made.heading[-1] == pytest.approx(made.heading[0])
    else:
        strides = np.linalg.norm(
            np.diff(ran(method.with_params({"stride_m": 1.5}), case).position, axis=0), axis=1
        )
        np.testing.assert_allclose(strides, 1.5)


def test_a_method_of_an_installed_package(case, installed):
    assert installed == ["smoothed"]
    method = find_method("smoothed")
    assert method.name == "smoothed"
    passes(method)
    assert np.abs(np.diff(ran(method, case).heading)).max() < np.abs(np.diff(case_heading(case))).max()


def test_an_installed_method_is_listed(cli, installed):
    code, out, _ = cli("list --json")
    assert code == 0
    assert list(one_document(out)["methods"]) == [*METHODS, *installed]


def case_heading(case):
    return ran(METHODS["pdr"], case).heading


def test_a_program_in_python(case):
    """Which reckons as Footfall does, but for tilt."""
    made = ran(find_method(f"{EXAMPLES / 'programs.py'}:python"), case)
    ours = ran(METHODS["pdr"], case)
    assert abs(made.heading[-1] - ours.heading[-1]) < np.radians(1)
    assert np.linalg.norm(made.position[-1] - ours.position[-1]) < 2.0
    assert abs(len(made) - len(ours)) <= 1


def test_a_program_in_cpp(case, built):
    """It passes, and comes to what the one in Python comes to."""
    method = find_method(f"{built / 'programs.py'}:cpp")
    passes(method)
    made, other = ran(method, case), ran(find_method(f"{built / 'programs.py'}:python"), case)
    np.testing.assert_allclose(made.t, other.t)
    np.testing.assert_allclose(made.position, other.position, atol=1e-6)
    np.testing.assert_allclose(made.heading, other.heading, atol=1e-9)
    assert len(ran(method.with_params({"still_rate": 0.01}), case)) != len(made)


def test_programs_say_why_they_refuse(case, built):
    short = case._replace(recording=module._rows(case.recording, np.arange(2000)))
    for name in ("python", "cpp"):
        with pytest.raises(ValueError, match=r"ended with 1: too short: expected 25 s at rest and a walk$"):
            ran(find_method(f"{built / 'programs.py'}:{name}"), short)


def test_a_program_that_was_not_built_is_told():
    with pytest.raises(ValueError, match="nav: there is no such program"):
        find_method(f"{EXAMPLES / 'programs.py'}:cpp")


def blocks():
    """Code of the page that stands under the name of a file of the examples."""
    return re.findall(
        r"\[([\w./]+)\]\(examples/methods/[\w./]+\):\n\n```\w+\n(.*?)```", PAGE, flags=re.DOTALL
    )


@pytest.mark.parametrize(("name", "code"), blocks(), ids=[name for name, _ in blocks()])
def test_the_page_shows_what_runs(name, code):
    assert code.strip() in (EXAMPLES / name).read_text(encoding="utf-8")


def test_the_page_shows_every_kind_and_links_what_is_there():
    assert {name for name, _ in blocks()} >= {"nav.py", "package/pyproject.toml", "programs.py"}
    for link in re.findall(r"\]\((examples/methods/[^)]*)\)", PAGE):
        assert (DOCS / link).exists(), link


def test_the_page_names_each_check():
    for name, _ in checks(METHODS["pdr"]):
        assert f"| {name} |" in PAGE


def test_the_pages_sentence_is_the_programs():
    mine = find_method(f"{EXAMPLES / 'nav.py'}:SteadyPace")
    with pytest.raises(ValueError, match=r"^stride_m = -1: ") as refused:
        mine.with_params({"stride_m": -1})
    assert f"`mine.{refused.value}`" in PAGE
    assert "mine.yaw_deg" in PAGE
    assert mine.with_params({"yaw_deg": 90}).params.yaw == pytest.approx(np.pi / 2)


def test_the_pages_python_is_python():
    for code in re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL):
        compile(code, "methods.md", "exec")
