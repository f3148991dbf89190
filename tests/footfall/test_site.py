"""What the site shows: programs of the gallery and notebooks run, its menu and its links are there."""

import importlib.util
import re
import runpy
import sys

import pytest

from tests.helpers.places import DOCS

GALLERY = sorted((DOCS / "gallery").glob("plot_*.py"))
NOTEBOOKS = sorted((DOCS / "notebooks").glob("*.ipynb"))


def name(path):
    return path.stem


@pytest.mark.parametrize("program", GALLERY, ids=name)
def test_a_program_of_the_gallery_draws(program, monkeypatch):
    """It runs from anywhere and shows one figure, of which every axis is named and none is empty."""
    import matplotlib as mpl

    mpl.use("agg")
    from matplotlib import pyplot

    monkeypatch.setattr(pyplot, "show", lambda: None)
    try:
        runpy.run_path(str(program), run_name="__main__")
        (number,) = pyplot.get_fignums()
        axes = pyplot.figure(number).axes
        assert all(axis.get_ylabel() and axis.lines for axis in axes)
        assert axes[-1].get_xlabel()
    finally:
        pyplot.close("all")


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=name)
def test_a_notebook_runs(notebook, tmp_path, monkeypatch):
    import nbclient
    import nbformat

    monkeypatch.setenv("PYTHONPATH", ":".join(path for path in sys.path if path))
    told = nbformat.read(notebook, as_version=4)
    nbformat.validate(told)
    assert not any(cell.get("outputs") for cell in told.cells), "outputs are made by the build"
    nbclient.NotebookClient(told, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    shown = [output for cell in told.cells for output in cell.get("outputs", ())]
    assert not [output for output in shown if output.get("name") == "stderr"]
    if notebook.stem == "gate_your_estimator":
        (good, bad) = (
            "".join(o.text for o in cell.outputs if "text" in o)
            for cell in told.cells
            if "judged" in cell.source
        )
        assert good.count("pass: ") == 2
        assert bad.count("fail: ") == 2
        assert told.cells[-1].outputs[-1].data["text/plain"] == "1"
    else:
        assert any("image/png" in output.get("data", {}) for output in shown)


# docs/conf.py


@pytest.fixture(scope="module")
def conf():
    file = DOCS / "conf.py"
    if not file.is_file():
        pytest.skip("no docs beside these tests")
    spec = importlib.util.spec_from_file_location("footfall_docs_conf", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_menu_has_every_page_once(conf):
    page = DOCS / "index.md"
    menu = "".join(conf.menus(conf.told(page.read_text(encoding="utf-8"), page)))
    entries = re.findall(r"^(\w\S*)$", menu, flags=re.MULTILINE)
    pages = {file.relative_to(DOCS).as_posix() for file in DOCS.rglob("*.md")} - {"index.md"}
    books = {f"notebooks/{file.name}" for file in NOTEBOOKS}
    assert sorted(entries) == sorted({*pages, *books, "api.rst", "auto_gallery/index.rst"})
    assert menu.index(":caption: Tutorials") < menu.index("tour.md") < menu.index(":caption: How to")


def test_links_lead_to_the_site_or_to_the_repository(conf):
    text = (
        "[a](docs/gait.md) [b](LICENSE) [c](https://x.org/y) "
        "[d](CHANGELOG.md#added) [e](#here) ![f](docs/images/g.png)"
    )
    readme, page = DOCS.parent / "README.md", DOCS / "decisions" / "page.md"
    assert conf.relinked(text, readme, page) == (
        f"[a](../gait.md) [b]({conf.REPOSITORY}/blob/main/LICENSE) [c](https://x.org/y) "
        "[d](../changelog.md#added) [e](#here) ![f](../images/g.png)"
    )


def test_a_page_takes_in_parts_of_other_files(conf):
    text = "\n# T\n\n## A\na\n\n## B\nb\n"
    assert conf.part(text, "A", "B") == "\n## A\na\n"
    assert conf.part(text, "", "B") == "\n# T\n\n## A\na\n"
    assert conf.part(text, "B", "") == "\n## B\nb\n"
    with pytest.raises(ValueError, match="no heading 'C'"):
        conf.part(text, "C", "")
    page = DOCS / "tour.md"
    shown = conf.told(page.read_text(encoding="utf-8"), page)
    assert "footfall walk straight -o walk.parquet" in shown
    assert "](scenarios.md)" in shown
    assert "README" not in shown
