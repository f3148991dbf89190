"""The benchmark of the IHDE paper's Table 2: what it tunes, judges and writes."""

import json
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.papers import _ihde_page, _ihde_ways, ihde_table2
from footfall.scenarios.scenario import build_scenario, load_scenario, read_document
from footfall.scenarios.trial import Trial, perform, setup

TUNED = ihde_table2.Tuned(
    ihde_table2.HdeParams(),
    ihde_table2.IhdeParams(),
    ihde_table2.JimenezParams(),
    ihde_table2.IhdePlusParams(),
)


@pytest.mark.parametrize(
    "name", ["pdr", "hde-2010", "iez", "hde", "ihde", "ihde-jimenez", "ihde-plus", "iez-paper", "ihde-paper"]
)
def test_its_ways_are_the_methods_of_those_names(short_walk, name):
    """With default parameters a way is what `footfall run` scores."""
    scenario = load_scenario("ihde-test1").changed("sensor", imu="nimu", bias_time_s=20.0)
    methods = [name, TUNED.ways()[name].method("way")]
    own, way = perform(Trial(setup(scenario, methods=methods), 0, 1, 3, 3), short_walk).rows
    assert way.require() == own.require()


def test_a_job_wears_each_unit_with_its_bias_and_its_start(short_walk, monkeypatch):
    """A start that is wrong by 5 deg turns the heading by 5; without a bias the filter is right."""
    monkeypatch.setattr("footfall.simulate.cache.cached_walk", lambda plan, **keys: short_walk)
    scenario = load_scenario("ihde-test1")
    scenario = scenario.changed("sensor", imu="perfect", bias_time_s=20.0, bias_shift_deg_s=0.2)
    way = _ihde_ways.Way
    ways = (way("iez"), way("iez", bias=0.0), way("iez", bias=0.0, start_off_deg=5.0), way("iez", bias=2.0))
    job = _ihde_ways.Job(scenario, {1: (1, 2, 3)}, ways)
    (found,) = _ihde_ways.judge([job], 1, "").values()
    assert found.shape == (3, 4, 3)
    final = found[:, :, 2]
    assert (final[:, 1] < 0.5).all()
    assert final[:, 2] == pytest.approx(5.0, abs=0.5)
    assert final[:, 3] == pytest.approx(2 * final[:, 0], rel=0.2)
    assert final[:, 0] == pytest.approx(0.2 * (short_walk.t[-1] - 26), rel=0.4)
    guided = {one.setup.guided for one in job.trials()}
    assert guided == {setup(scenario).guided}  # filters do not know who has no bias


def test_each_method_is_tuned_in_its_own_part_of_the_grid(monkeypatch):
    """The last set of each grid is made the best; for HDE, Test 3 has no say."""
    bench = ihde_table2
    grids = (bench.HDE_GRID, bench.IHDE_GRID, bench.JIMENEZ_GRID, bench.PLUS_GRID)

    def judged(jobs, processes, label):
        assert all(job.units == {101: (101,), 102: (102,)} for job in jobs)
        assert {job.scenario.gait.variability for job in jobs} == {1.0, 0.3}
        ways = [way.params for way in jobs[0].ways]
        errors = np.full((2, len(ways), 3), 5.0)
        for grid in grids:
            errors[:, ways.index(grid[-1]), 1] = 1.0
        third = errors.copy()
        third[:, ways.index(grids[0][-1]), 1] = 1e9
        return {(test, 1.0): third if test == "ihde-test3" else errors for test in bench.TESTS}

    monkeypatch.setattr(bench, "judge", judged)
    scenarios = {test: load_scenario(test) for test in bench.TESTS}
    tuned = bench.tune(scenarios, [101, 102], 1)
    assert (tuned.hde, tuned.ihde, tuned.jimenez, tuned.plus) == tuple(grid[-1] for grid in grids)


def test_the_tables_say_median_and_spread():
    errors = np.zeros((11, 3))
    errors[:, 0], errors[:, 1] = np.arange(11), 2.0
    by = {test: {"ihde": errors, "no bias": errors} for test in ihde_table2.TESTS}
    table = _ihde_page.table_2("people", by).markdown().splitlines()
    assert table[2].startswith("| **the paper: IEZ** | 8.7 to 9.6 |  | 2.3 to 2.8 |")
    assert table[5] == "| `ihde` |" + " 5.00 (1.00 to 9.00) | 2.0 |" * 3
    variants = _ihde_page.variant_table(by, by).markdown().splitlines()
    assert variants[3] == "| no bias |" + " 5.00 (1.00 to 9.00) |" * 6
    looped = np.stack([errors, 40 + errors], axis=1)
    loop = _ihde_page.loop_table(["a", "b"], looped).markdown().splitlines()
    assert loop[2] == "| `a` | 2.0 | 2.0 | 0.0 | 0.0 | 0 of 11 |"
    assert loop[3] == "| `b` | 42.0 | 42.0 | 40.0 | 40.0 | 11 of 11 |"


def test_a_seed_on_both_sides_is_refused():
    with pytest.raises(SystemExit, match="share a walk seed"):
        ihde_table2.main(["--tuning-seed", "20"])


def test_it_runs_from_walks_to_page(workshop, tmp_path, monkeypatch):
    """On thirty metres in place of the tests and the loop, with few parameters."""
    bench = ihde_table2
    short = read_document(workshop / "short.toml")
    monkeypatch.setattr(bench, "GAITS", {"people": 1.0, "line": 1.0})
    monkeypatch.setattr(bench, "load_scenario", lambda test: build_scenario(replace(short, name=test)))
    for grid in ("HDE_GRID", "JIMENEZ_GRID", "IHDE_GRID", "PLUS_GRID"):
        monkeypatch.setattr(bench, grid, getattr(bench, grid)[-1:])
    names = ("people", "line", "settings", "decides", "loop")
    page, out = tmp_path / "page.md", tmp_path / "out.json"
    page.write_text("".join(f"<!-- table {name} -->\n<!-- end -->\n" for name in names))
    few = ["--walk-seed", "3", "--walks", "1", "--tuning-seed", "4", "--tuning-walks", "1"]
    few += ["--loop-walks", "1", "--loop-units", "2", "--processes", "1"]
    bench.main([*few, "--page", str(page), "--figures", str(tmp_path / "images"), "--json", str(out)])
    document = json.loads(out.read_text())
    assert set(document["table_2"]["people"]) == set(bench.TESTS)
    assert "ihde-plus as it comes" in document["decides"]["line"]["ihde-test3"]
    assert np.shape(document["loop"]["hde"]) == (2, 3)
    # The three stand-ins are one and the same path.
    assert document["table_2"]["people"]["ihde-test1"] == document["table_2"]["line"]["ihde-test2"]
    assert page.read_text().count("`ihde-plus`") >= 3
    assert {path.name for path in (tmp_path / "images").iterdir()} == {
        "ihde_table2.png",
        "ihde_tracks.png",
        "ihde_evaluation.png",
    }
