"""The benchmark of the IHDE paper's Table 2: what it tunes, judges and writes."""

import importlib
import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from footfall.hdr.methods import track
from footfall.models.imu import draw_unit, load_spec
from footfall.pdr.ins import FilterSettings
from footfall.scenarios.run import start_pose
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.score import score
from footfall.simulate.cache import cached_walk
from footfall.simulate.record import record

FOLDER = Path(__file__).resolve().parents[1] / "benchmarks"


@pytest.fixture
def scripts(monkeypatch):
    monkeypatch.syspath_prepend(str(FOLDER))
    names = ("ihde_table2", "_ihde_page")
    return SimpleNamespace(**{name.strip("_"): importlib.import_module(name) for name in names})


@pytest.mark.parametrize("name", ["pdr", "hde-2010", "iez", "hde", "ihde", "ihde-jimenez", "hde-paper"])
def test_its_ways_are_the_methods_of_those_names(scripts, short_walk, name):
    """With default parameters a way is what `footfall run` scores."""
    bench = scripts.ihde_table2
    scenario = replace(load_scenario("ihde-test1"), imu="nimu")
    way = {
        "pdr": bench.Way(None, None),
        "hde-2010": bench.Way(bench.Hde2010Params(), None),
        "iez": bench.Way(None, bench.OURS),
        "hde": bench.Way(bench.HdeParams(), bench.OURS),
        "ihde": bench.Way(bench.IhdeParams(), bench.OURS),
        "ihde-jimenez": bench.Way(bench.JimenezParams(), bench.OURS),
        "hde-paper": bench.Way(bench.HdeParams(), FilterSettings.paper()),
    }[name]
    job = bench.Job(scenario, 3, (way,))
    air = scenario.temperature_of(0)
    recording = record(short_walk, draw_unit(load_spec("nimu"), 3), seed=3, temperature=air)
    expected = score(track(recording, name, start_pose(short_walk)), short_walk)
    assert score(way.track(job.reckoning(short_walk)), short_walk) == expected


def test_the_velocity_noise_is_matched_between_the_scanned_ones(scripts):
    bench = scripts.ihde_table2
    sigma = np.array(bench.SIGMA_V)
    errors = np.zeros((3, len(sigma), 3))
    errors[:, :, 0] = 0.1 / sigma  # %
    for wanted in (0.2, 1.0, 9.15):
        assert bench.match_sigma(errors, wanted) == pytest.approx(0.1 / wanted, rel=1e-6)
    assert bench.match_sigma(errors, 1e3) == pytest.approx(sigma[0])


def test_the_best_set_is_the_best_over_the_tests(scripts):
    errors = {test: np.random.default_rng(seed).uniform(1, 2, (4, 5, 3)) for seed, test in enumerate("abc")}
    errors["a"][:, 3, 1] = errors["b"][:, 3, 1] = 0.5
    errors["c"][:, 3, 1] = 99.0
    assert scripts.ihde_table2.best(range(5), errors, "ab") == 3
    assert scripts.ihde_table2.best(range(5), errors, "abc") != 3


def test_tables_replace_their_older_selves_and_nothing_else(scripts, tmp_path):
    page = tmp_path / "page.md"
    page.write_text("# A\n<!-- table one -->\nold\n<!-- end -->\ntext\n<!-- table two -->\n<!-- end -->\n")
    scripts.ihde_page.fill(page, {"one": "| 1 |", "two": "| 2 |"})
    once = page.read_text()
    assert "old" not in once
    assert once.startswith("# A\n<!-- table one -->\n\n| 1 |\n\n<!-- end -->\ntext\n")
    scripts.ihde_page.fill(page, {"one": "| 1 |"})
    assert page.read_text() == once
    with pytest.raises(SystemExit, match="expected one mark <!-- table three -->, found 0"):
        scripts.ihde_page.fill(page, {"three": ""})


def test_each_gait_stands_with_the_threshold_that_suits_it(scripts):
    bench = scripts.ihde_table2

    def walk(gait, test, suits):
        """IEZ errs by 9 %; the threshold `suits` leaves 1 deg and, by form, 0.5, 0.25 and 0.1 %."""
        errors = np.full((1 + 3 * len(bench.THRESHOLDS), 3), 9.0)
        for form, left in enumerate((0.5, 0.25, 0.1)):
            errors[1 + form * len(bench.THRESHOLDS) + suits] = left, 1.0, 1.0
        return bench.Scattered(gait, test, 2.0, -3.0, -2.2, errors.tolist())

    found = [walk(gait, test, suits) for gait, suits in (("a", 0), ("b", 3)) for test in bench.TESTS]
    table = scripts.ihde_page.scatter_table(found, ["a", "b", "c"], bench.TESTS, bench.THRESHOLDS)
    _, _, first, second, paper = table.splitlines()
    assert first == "| a | 2.0 | -3.0 / -2.2 | 0.7 / 0.7 / 0.7 |" + " 9.00 | 0.50 | 0.25 | 0.10 |" * 3
    assert second == "| b | 2.0 | -3.0 / -2.2 | 2 / 2 / 2 |" + " 9.00 | 0.50 | 0.25 | 0.10 |" * 3
    assert "8.7 to 9.6 | 0.2 to 0.4" in paper


def test_a_seed_on_both_sides_is_refused(scripts):
    with pytest.raises(SystemExit, match="share a walk seed"):
        scripts.ihde_table2.main(["--tuning-seed", "20"])


def test_it_runs_from_walks_to_page(scripts, workshop, tmp_path, monkeypatch, capsys):
    """On thirty metres in place of the tests, with few parameters."""
    bench = scripts.ihde_table2
    short = load_scenario(workshop / "short.toml")
    monkeypatch.setattr(bench, "load_scenario", lambda test: replace(short, name=test))
    for module in ("ihde_table2", "footfall.scenarios.run"):  # the name alone makes no other walk
        monkeypatch.setattr(
            f"{module}.cached_walk", lambda plan, **keys: cached_walk(replace(plan, name="short"), **keys)
        )
    monkeypatch.setattr(bench, "SIGMA_V", bench.SIGMA_V[::4])
    for grid in ("HDE_GRID", "JIMENEZ_GRID"):
        monkeypatch.setattr(bench, grid, getattr(bench, grid)[:2])
    monkeypatch.setattr(bench, "IHDE_GRID", [bench.IHDE_GRID[0], bench.IHDE_GRID[-1]])
    marks = "".join(
        f"<!-- table {name} -->\n<!-- end -->\n" for name in ("matched", "ours", "settings", "thresholds")
    )
    page, out = tmp_path / "page.md", tmp_path / "out.json"
    page.write_text(marks)
    few = ["--walks", "2", "--tuning-walks", "1", "--gait-walks", "0", "--processes", "1"]
    bench.main([*few, "--page", str(page), "--figures", str(tmp_path / "images"), "--json", str(out)])
    document = json.loads(out.read_text())
    for side in ("ours", "matched"):
        assert set(document[side]) == set(bench.TESTS)
        for rows in document[side].values():
            assert all(np.shape(errors) == (2, 3) for errors in rows.values())
    # The three stand-ins are one and the same path, so the filter that needs no matching gives one result.
    assert document["ours"]["ihde-test1"] == document["ours"]["ihde-test2"]
    assert "8.7 to 9.6" in page.read_text()
    assert {path.name for path in (tmp_path / "images").iterdir()} == {
        "ihde_tracks.png",
        "ihde_evaluation.png",
    }
