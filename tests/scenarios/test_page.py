"""The page of a run, as its source tells it; tests/scenarios/test_page_browser.py looks at it."""

import itertools
import json
import re
import subprocess
import sys

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.pdr.track import read_track
from footfall.scenarios.report.page import write_page
from footfall.scenarios.report.page.charts import Trace, frame, looks_of
from footfall.tables import read_table, write_table
from tests.helpers.commands import expect_one_sentence
from tests.helpers.pages import METHODS, NASTY, Page, budget_of, run_folder
from tests.helpers.synthetic import synthetic_walk

CSS = "page.css"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = run_folder(tmp_path_factory.mktemp("page") / "run")
    write_page(folder)
    return folder


@pytest.fixture(scope="module")
def page(folder):
    return Page(folder / "report.html")


def test_the_page_needs_nothing_beside_it(page):
    targets = re.findall(r"""(?:src|href|url)(?:=|\()["']([^"']*)""", page.text)
    assert "data:," in targets
    assert all(target.startswith(("#", "data:,")) for target in targets)
    assert "@import" not in page.text
    assert page.plotly > 1e6
    assert "connect-src" not in page.text
    assert "default-src 'none'" in page.text


def test_the_same_folder_gives_the_same_page(folder):
    before = (folder / "report.html").read_bytes()
    assert write_page(folder) == folder / "report.html"
    assert (folder / "report.html").read_bytes() == before


@pytest.mark.parametrize("walk", ["1", "2"])
@pytest.mark.parametrize("method", METHODS)
def test_the_map_has_every_footfall_with_what_is_to_be_told_of_it(folder, page, walk, method):
    track = read_track(folder / f"walk-{walk}.{method}.parquet")
    x, y, hover = page.trace("map", method, walk=walk)
    np.testing.assert_allclose(np.column_stack([x, y]), track.position[:, :2], rtol=1e-6, atol=1e-5)
    off = 0.01 * int(walk) * (1 + METHODS.index(method)) * (track.t - track.t[0])
    np.testing.assert_allclose(hover["time"], track.t, rtol=1e-6)
    np.testing.assert_allclose(hover["error"], off, atol=1e-4)
    np.testing.assert_allclose(hover["heading"], np.degrees(track.heading), atol=1e-4)
    # The drift of the stride that ends at the footfall; the first footfall ends none.
    strides = np.arange(len(track.t)).clip(1)
    total = np.degrees(1e-5 * int(walk) * strides - 3e-5 + 1e-9 * strides)
    np.testing.assert_allclose(hover["drift"], total, rtol=1e-5)
    if method == "hdr":
        np.testing.assert_allclose(hover["integrator"], np.degrees(track.evidence["integrator"]), atol=1e-7)
        np.testing.assert_allclose(hover["attenuator"], 0.25)
    else:
        assert set(hover) == {"time", "heading", "error", "drift"}
    last = page.trace("map", method, nth=1, walk=walk)
    np.testing.assert_allclose(last[:2], [[x[-1]], [y[-1]]])


def test_a_metre_is_as_long_along_x_as_along_y_on_the_map_alone(page):
    assert [chart["place"] for chart in page.data["charts"] if chart["equal"]] == ["map", "map"]


def test_truth_begins_at_the_triangle(folder, page):
    falls, _ = read_table(folder / "walk-2.footfalls.parquet")
    x, y, _ = page.trace("map", "truth", walk="2")
    np.testing.assert_allclose([x, y], [falls["x"], falls["y"]], rtol=1e-6, atol=1e-6)
    x, y, _ = page.trace("map", "start", walk="2")
    np.testing.assert_allclose([x, y], [falls["x"][:1], falls["y"][:1]], rtol=1e-6)


def test_units_of_evidence_are_those_that_people_read(page):
    (chart,) = page.charts("map", walk="1")
    (trace,) = [trace for trace in chart["traces"] if trace["name"] == "hdr" and trace["hover"]]
    assert {line["label"]: line["unit"] for line in trace["hover"]} == {
        "time": "s",
        "heading": "deg",
        "error": "deg",
        "drift": "deg/s",
        "integrator": "deg/s",
        "attenuator": "",
    }


def test_the_error_over_time_ends_where_the_scores_end(folder, page):
    scores = json.loads((folder / "scores.json").read_text())
    for number, row in enumerate(scores["walks"], 1):
        for method in METHODS:
            _, error, _ = page.trace("error", method, walk=str(number))
            told = row["methods"][method]
            assert abs(error[-1]) == pytest.approx(told["heading_error_final_deg"], abs=1e-3)
            assert np.abs(error).mean() == pytest.approx(told["heading_error_mean_deg"], abs=1e-3)


def test_the_correction_is_what_a_method_takes_for_drift(folder, page):
    """-I of HDR. Of another that turns 0.02 deg/s more to the left than PDR: it takes -0.02 deg/s for it."""
    t, correction, _ = page.trace("drift", "hdr", walk="1")
    np.testing.assert_allclose(correction, -np.degrees(np.linspace(0, 0.002, len(t))), atol=1e-6)
    _, correction, _ = page.trace("drift", NASTY, walk="1")
    np.testing.assert_allclose(correction, -0.02, atol=1e-4)
    (chart,) = page.charts("drift", walk="1")
    assert [trace["name"] for trace in chart["traces"]] == ["true drift", "hdr", NASTY]
    t, drift, _ = page.trace("drift", "true drift", walk="1")
    assert drift[15] == pytest.approx(np.degrees(1e-5 * 16 - 3e-5), rel=1e-3)  # a mean of its neighbours


def test_a_jump_leaves_the_frame_and_flattens_nothing(page):
    flat, jump = np.linspace(0.0, 1.0, 199), np.array([-40.0])
    low, high = frame([Trace("a", flat, flat, "s0"), Trace("b", jump, jump, "s1")])
    assert -0.4 < low < 0
    assert 1 < high < 1.4
    assert frame([Trace("a", flat[:1], flat[:1], "s0")]) == (-1, 1)  # of a level line, a frame all the same
    for chart in page.charts("drift"):
        low, high = chart["y"]["bounds"]
        assert all(low < page.arrays[trace["y"]].min() for trace in chart["traces"])
        assert all(high > page.arrays[trace["y"]].max() for trace in chart["traces"])


def test_the_budget_sums_drift_up_over_the_strides(page):
    walk = synthetic_walk(strides=40)
    budget = budget_of(walk)
    for cause in ("temperature", "white"):
        t, heading, _ = page.trace("budget", cause, walk="1")
        np.testing.assert_allclose(t, budget.t, rtol=1e-6)
        summed = np.degrees(np.cumsum(budget.causes[cause] * budget.interval))
        np.testing.assert_allclose(heading, summed, rtol=1e-5)
    _, total, _ = page.trace("budget", "sum", walk="1")
    np.testing.assert_allclose(total, np.degrees(np.cumsum(budget.total * budget.interval)), rtol=1e-5)
    _, others, _ = page.trace("budget", "all others", walk="1")  # what is small is taken together
    np.testing.assert_allclose(
        total - others, sum(page.trace("budget", c, walk="1")[1] for c in ("temperature", "white")), atol=1e-6
    )
    assert not [t for c in page.charts("budget", walk="1") for t in c["traces"] if t["name"] == "scale"]


def test_tables_hold_every_score_without_a_script(folder, page):
    scores = json.loads((folder / "scores.json").read_text())
    rows = page.table("Each walk by each method")
    assert rows[0][:5] == [
        "walk",
        "unit",
        "method",
        "mean heading error (deg)",
        "final heading error (deg)",
    ]
    assert len(rows) == 1 + 2 * 3 + 3
    for cells, (row, method) in zip(rows[1:7], itertools.product(scores["walks"], METHODS), strict=True):
        told = row["methods"][method]
        assert cells[1] == str(row["unit"])
        assert cells[3:5] == [
            f"{told['heading_error_mean_deg']:.1f}",
            f"{told['heading_error_final_deg']:.1f}",
        ]
        assert cells[6] == f"{told['distance_error_pct']:+.2f}"
    assert [row[0] for row in rows[7:]] == ["mean"] * 3
    assert rows[8][3] == f"{scores['mean']['hdr']['heading_error_mean_deg']:.1f}"


def test_tiles_tell_the_mean_error_and_what_a_method_makes_of_it(tmp_path, page):
    """hdr's error is twice pdr's, that of the third method three times."""
    tiles = re.findall(r"<strong>(.*?)</strong><span>(.*?)</span>", page.text)
    assert [more.rpartition("; ")[2] for _, more in tiles[1:]] == [
        "2.0 times larger than uncorrected",
        "3.0 times larger than uncorrected",
    ]
    assert tiles[0][0] == "0.3 deg"
    assert "uncorrected" not in tiles[0][1]
    better = Page(write_page(run_folder(tmp_path / "run", ("hdr", "pdr"), 1)))
    assert "; 2.0 times smaller than uncorrected" in better.text


def test_other_units_and_noises_are_told_where_a_run_has_them(tmp_path):
    spread = {"mean": 3.0, "median": 2.5, "p90": 7.25}
    extent = {"median": 2.5, "smallest": 1.0, "largest": 9.0}
    errors = ("heading_error_final_deg", "heading_error_mean_deg")
    more = {
        "other_units": {"count": 50, "methods": {"pdr": dict.fromkeys(errors, spread)}},
        "other_noises": {"count": 10, "methods": {"pdr": dict.fromkeys(errors, extent)}},
        "without": ["white", "flicker"],
    }
    page = Page(write_page(run_folder(tmp_path / "run", ("pdr",), 1, **more)))
    assert page.table("50 other units")[1] == ["pdr", "3.0", "2.5", "7.2", "3.0", "2.5", "7.2"]
    assert page.table("10 other noise seeds")[1] == ["pdr", "2.5", "1.0", "9.0", "2.5", "1.0", "9.0"]
    assert "switched off: white, flicker" in page.text
    assert len(page.table("Each walk")) == 2  # of one walk, no mean


def test_parameters_seeds_versions_and_the_command_are_told(page):
    assert page.table("Set for this run") == [["hdr.tau_s", "4"]]
    assert page.table("Method hdr") == [["tau_s", "8"], ["inner.deep", "1.5"]]
    assert page.table("Seeds")[2] == ["2", "12", "102", "202", "reference", "40"]
    assert ["numpy", "2.4.6"] in page.table("Versions")
    assert "footfall run corridor --methods &#x27;pdr,hdr&#x27;" in page.text
    assert "Two corridors. 2 walks of 56 m, IMU nimu, methods pdr, hdr" in page.text


def test_no_text_of_a_file_becomes_markup(tmp_path):
    bad = '</script><script>window.hacked=1</script>"onload="x'
    more = {
        "scenario": bad,
        "description": bad,
        "command": bad,
        "settings": {bad: bad},
        "versions": {bad: bad},
    }
    text = Page(write_page(run_folder(tmp_path / "run", ("pdr", NASTY), 1, **more))).text
    assert "<script>window" not in text
    assert "<img" not in text
    assert text.count("<script") == 3
    assert text.count("&lt;img src=x onerror=window.hacked=1&gt;&amp;amp;") == 5


def test_times_that_methods_share_are_written_once(page):
    assert len({array.tobytes() for array in page.arrays}) == len(page.arrays)
    (chart,) = page.charts("error", walk="1")
    assert len({trace["x"] for trace in chart["traces"]}) == 1


def test_scores_of_an_earlier_version_have_a_page_too(tmp_path):
    folder = run_folder(tmp_path / "run", ("pdr",), 1)
    told = json.loads((folder / "scores.json").read_text())
    for key in ("command", "description", "settings"):
        del told[key]
    (folder / "scores.json").write_text(json.dumps(told))
    assert "does not tell the command" in Page(write_page(folder)).text


def test_of_many_walks_the_first_are_drawn_and_all_are_told(tmp_path):
    page = Page(write_page(run_folder(tmp_path / "run", ("pdr",), 14, strides=6)))
    assert len(page.charts("map")) == 12
    assert "The first 12 walks are drawn" in page.text
    assert len(page.table("Each walk by each method")) == 1 + 14 + 1


def test_the_page_of_a_folder_by_command(cli, tmp_path):
    folder = run_folder(tmp_path / "run", ("pdr",), 1)
    code, out, err = cli(f"report {folder}")
    assert (code, out) == (0, "")
    assert err == f"The page is {folder / 'report.html'}\n"
    assert "corridor" in (folder / "report.html").read_text()


def _cut(folder):
    (folder / "scores.json").write_text("{")


def _other(folder):
    (folder / "scores.json").write_text('{"walks": []}')


def _list(folder):
    (folder / "scores.json").write_text("[]")


def _lost(folder):
    (folder / "walk-1.pdr.parquet").unlink()


def _narrow(folder):
    write_table(folder / "walk-1.parquet", {"t": np.arange(3.0)}, {}, {})


def _empty(folder):
    (folder / "scores.json").unlink()


@pytest.mark.parametrize(
    ("harm", "said"),
    [
        (_empty, r"run: no results to report: expected scores\.json"),
        (_cut, r"scores\.json: not a readable JSON file"),
        (_other, r"scores\.json: not as Footfall writes it"),
        (_list, r"scores\.json: not as Footfall writes it"),
        (_lost, r"walk-1\.pdr\.parquet: no such file"),
        (_narrow, r"walk-1\.parquet: column 'px' is missing"),
    ],
)
def test_what_is_no_run_is_one_sentence_and_leaves_no_page(cli, tmp_path, harm, said):
    folder = run_folder(tmp_path / "run", ("pdr",), 1)
    harm(folder)
    before = sorted(folder.iterdir())
    expect_one_sentence(*cli(f"report {folder}"), said)
    assert sorted(folder.iterdir()) == before


def test_no_folder_is_one_sentence(cli, tmp_path):
    expect_one_sentence(*cli(f"report {tmp_path / 'nowhere'}"), "nowhere: no such folder")
    with pytest.raises(InputError):
        write_page(tmp_path / "nowhere")


def test_plotly_is_imported_only_when_a_page_is_written():
    code = """
import sys, pkgutil, importlib
import footfall.cli, footfall.scenarios.report.results
for module in pkgutil.iter_modules(footfall.cli.__path__):
    importlib.import_module(f"footfall.cli.{module.name}")
import footfall.scenarios.report.page.document
sys.exit("plotly" in sys.modules)
"""
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


# Looks


@pytest.mark.parametrize("count", [1, 9, 10, 17, 40])
def test_no_two_methods_look_alike(count):
    names = ["hdr", "pdr", "ihde", "hde", "hdr-basic", *(f"mine-{i}" for i in range(40))][:count]
    looks = looks_of(names)
    assert list(looks) == names
    assert len(set(looks.values())) == count
    assert looks["hdr"][0] == "s1"  # as in the figures
    if count <= 9:
        assert len({colour for colour, _ in looks.values()}) == count


def shades():
    """Of both schemes: name of a colour -> (3,) linear RGB."""
    from importlib.resources import files

    css = files("footfall.scenarios.report.page").joinpath(CSS).read_text(encoding="utf-8")
    blocks = re.findall(r"\{[^{}]*--bg:[^{}]*\}", css)
    assert len(blocks) == 2
    for block in blocks:
        found = dict(re.findall(r"--(\w+): (#\w{6})", block))
        yield {name: linear(shade) for name, shade in found.items()}


def linear(shade):
    value = np.array([int(shade[i : i + 2], 16) for i in (1, 3, 5)]) / 255
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def contrast(one, other):
    """WCAG 2.2."""
    low, high = sorted(float(shade @ [0.2126, 0.7152, 0.0722]) for shade in (one, other))
    return (high + 0.05) / (low + 0.05)


def test_text_and_lines_stand_out_from_their_grounds():
    """WCAG 2.2 AA: 4.5 for text, 3 for what is drawn."""
    for scheme in shades():
        for ground in ("bg", "card"):
            for text in ("ink", "soft", "link"):
                assert contrast(scheme[text], scheme[ground]) >= 4.5, (text, ground)
            for line in ("truth", *(f"s{i}" for i in range(9))):
                assert contrast(scheme[line], scheme[ground]) >= 3, (line, ground)


# Machado et al. (2009), Table 1, severity 1: linear RGB as people without a kind of cone see it.
SIGHTS = {
    "all cones": np.eye(3),
    "protanopia": [[0.152, 1.053, -0.205], [0.115, 0.786, 0.099], [-0.004, -0.048, 1.052]],
    "deuteranopia": [[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]],
    "tritanopia": [[1.256, -0.077, -0.179], [-0.078, 0.931, 0.148], [0.005, 0.691, 0.304]],
}
# Ottosson (2020), Oklab: distances in it are as they are seen; 0.02 can just be told apart.
CONES = np.array([[0.4122, 0.5363, 0.0514], [0.2119, 0.6807, 0.1074], [0.0883, 0.2817, 0.6300]])
OKLAB = np.array([[0.2105, 0.7936, -0.0041], [1.9780, -2.4286, 0.4506], [0.0259, 0.7828, -0.8087]])


@pytest.mark.parametrize("sight", SIGHTS)
def test_methods_are_told_apart_by_every_kind_of_sight(sight):
    """The first five more clearly than all nine."""
    for scheme in shades():
        seen = [np.clip(np.array(SIGHTS[sight]) @ scheme[f"s{i}"], 0, 1) for i in range(9)]
        places = [OKLAB @ np.cbrt(CONES @ shade) for shade in seen]
        apart = {
            (i, j): float(np.linalg.norm(places[i] - places[j]))
            for i, j in itertools.combinations(range(9), 2)
        }
        assert min(apart.values()) >= 0.055
        assert min(far for (_, j), far in apart.items() if j < 5) >= 0.09
