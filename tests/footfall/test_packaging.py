"""What a newcomer gets: the two README lines, a package that imports whole, data files, links that work."""

import importlib
import importlib.metadata
import os
import pkgutil
import re
import subprocess
import sys
import tomllib
from importlib.resources import files
from pathlib import Path

import pytest

import footfall
from footfall.models.imu import load_spec, stock_specs
from footfall.models.imu.spec import ACCEL_KEYS, GYRO_KEYS, ThermalSheet
from footfall.models.policy import stock_policy
from footfall.scenarios.path import Arc, Corner, Straight
from footfall.scenarios.scenario import ScenarioFile, stock_scenarios
from tests.helpers.places import ROOT

ROOMS = ("hdr", "models", "pdr", "scenarios", "simulate")
TRAINING = {"footfall.simulate.learn.ppo", "footfall.simulate.learn.train"}  # need footfall[train]
MODULES = sorted(module.name for module in pkgutil.walk_packages(footfall.__path__, "footfall."))


@pytest.fixture
def checkout() -> Path:
    """The source tree; these tests also run away from it, against an installed wheel."""
    if not (ROOT / "pyproject.toml").is_file():
        pytest.skip("no source tree around these tests")
    return ROOT


@pytest.mark.parametrize("name", MODULES)
def test_every_module_imports(name):
    if name in TRAINING:
        pytest.importorskip("torch", reason="training needs footfall[train], gigabytes that CI does without")
        pytest.importorskip("cma", reason="training needs footfall[train]")
    importlib.import_module(name)


def test_every_file_of_the_rooms_is_a_module(checkout):
    found = {
        ".".join(file.relative_to(checkout).with_suffix("").parts)
        for room in ROOMS
        for file in (checkout / "footfall" / room).rglob("*.py")
        if file.name != "__init__.py"
    }
    assert found <= set(MODULES)
    assert found >= TRAINING


def test_data_files_come_with_the_package():
    assert {"nimu", "perfect"}.issubset(stock_specs())
    assert all(load_spec(name).name for name in stock_specs())
    assert {"straight", "curving", "turning", "closed-loop", "closed-loop-gentle"}.issubset(stock_scenarios())
    assert stock_policy().weights
    assert files("footfall").joinpath("py.typed").is_file()
    page = files("footfall.scenarios.report.page")
    assert all(page.joinpath(name).is_file() for name in ("page.html", "page.css", "page.js", "tables.js"))


def test_one_version():
    assert importlib.metadata.version("footfall") == footfall.__version__


def test_the_version_is_the_one_declared_and_cited(checkout):
    project = tomllib.loads((checkout / "pyproject.toml").read_text())["project"]
    assert project["version"] == footfall.__version__
    assert f"\nversion: {footfall.__version__}\n" in (checkout / "CITATION.cff").read_text()
    assert f"## {footfall.__version__}" in (checkout / "CHANGELOG.md").read_text()


@pytest.mark.parametrize("room", ROOMS)
def test_the_package_links_to_its_rooms(checkout, room):
    if not (checkout / ".ci").is_dir():
        pytest.skip("an archive has the rooms themselves, not links to them")
    assert os.readlink(checkout / "footfall" / room) == f"../{room}"


@pytest.mark.parametrize("module", ["footfall", "footfall.hdr", "footfall.cli.app"])
def test_a_checkout_without_links_says_so(tmp_path, module):
    """Where git makes no links, each is a text file that holds its target."""
    package = tmp_path / "footfall"
    for room in ROOMS:
        (package / room).mkdir(parents=True)
    for name in ("__init__.py", "_gymnasium.py"):
        (package / name).write_bytes(files("footfall").joinpath(name).read_bytes())
    (package / "hdr").rmdir()
    (package / "hdr").write_text("../hdr")
    found = subprocess.run(
        [sys.executable, "-c", f"import {module}"], cwd=tmp_path, capture_output=True, text=True
    )
    said = r"ImportError: \S+hdr should be a symbolic link to a folder, .*`git clone -c core.symlinks=true`"
    assert re.fullmatch(said, found.stderr.splitlines()[-1])


def commands(readme: str) -> list[str]:
    """The lines of the README that set up a fresh machine."""
    return re.findall(r"^python3 -m venv .*$", readme, flags=re.MULTILINE)


def test_the_readme_has_two_lines_that_do_everything(checkout):
    main_job, tests = commands((checkout / "README.md").read_text())
    assert main_job.endswith("footfall run closed-loop")
    assert "pytest" in tests.split("&&")[-1]


def test_ci_runs_the_readmes_test_line(checkout):
    if not (checkout / ".ci").is_dir():
        pytest.skip("an archive comes without .ci")
    script = (checkout / ".ci" / "run").read_text()
    (extraction,) = re.findall(r"^line=\$\((.*)\)$", script, flags=re.MULTILINE)
    found = subprocess.run(
        ["bash", "-c", extraction], cwd=checkout, capture_output=True, text=True, check=True
    ).stdout
    assert found.splitlines() == commands((checkout / "README.md").read_text())[1:]
    assert '-c "$line"' in script
    assert os.access(checkout / ".ci" / "run", os.X_OK)


PAGES = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md"]
PAGES += sorted(str(file.relative_to(ROOT)) for file in ROOT.glob("docs/**/*.md"))


@pytest.mark.parametrize("page", PAGES)
def test_links_between_pages_lead_somewhere(checkout, page):
    text = (checkout / page).read_text()
    targets = re.findall(r"\]\(([^)#\s]+)[^)]*\)", text)
    here = (checkout / page).parent
    broken = [target for target in targets if "://" not in target and not (here / target).exists()]
    assert not broken


def test_the_docs_map_names_every_page(checkout):
    index = (checkout / "docs" / "index.md").read_text()
    folder = checkout / "docs"
    pages = {file.relative_to(folder).as_posix() for file in folder.rglob("*.md")} - {"index.md"}
    assert pages == set(re.findall(r"\]\(([\w/-]+\.md)\)", index))


def test_documented_keys_are_the_ones_that_exist(checkout):
    sensor = (checkout / "docs" / "sensor.md").read_text()
    for key in {*GYRO_KEYS, *ACCEL_KEYS, *ThermalSheet.model_fields}:
        assert f"`{key}`" in sensor, key
    scenarios = (checkout / "docs" / "scenarios.md").read_text()
    tables = [ScenarioFile, *(field.annotation for field in ScenarioFile.model_fields.values())]
    for table in [*tables, Straight, Arc, Corner]:
        for key in getattr(table, "model_fields", {}):
            assert re.search(rf"[`\[ ]{key}[`\] ]", scenarios), key


def test_the_readme_of_package_indices_leads_to_the_repository(checkout):
    """Links and pictures, by the substitutions that the build makes; of the owner that project.urls names."""
    told = tomllib.loads((checkout / "pyproject.toml").read_text())
    hook = told["tool"]["hatch"]["metadata"]["hooks"]["fancy-pypi-readme"]
    owner = told["project"]["urls"]["Repository"].removeprefix("https://github.com/")
    text = (checkout / "README.md").read_text()
    before = re.findall(r"\]\(([^)]+)\)", text)
    for substitution in hook["substitutions"]:
        text = re.sub(substitution["pattern"], substitution["replacement"], text)
    after = re.findall(r"(!?)\[[^\]]*\]\(([^)]+)\)", text)
    assert len(after) == len(before)
    for old, (picture, new) in zip(before, after, strict=True):
        if "://" in old:
            assert new == old
        elif picture:
            assert new == f"https://raw.githubusercontent.com/{owner}/v$HFPR_VERSION/{old}"
        else:
            assert new == f"https://github.com/{owner}/blob/v$HFPR_VERSION/{old}"
    assert all(owner.split("/")[0] in url for url in told["project"]["urls"].values())
