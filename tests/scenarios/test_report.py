"""Tables for people, the document for programs, and figures that can be read."""

import itertools
import json
import re
from dataclasses import asdict, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from footfall.scenarios.judge.papers import HDR_TABLE_2, HDR_TABLE_2_MEAN
from footfall.scenarios.judge.score import Score, mean_score
from footfall.scenarios.judge.statistics import extent, running_mean, spread
from footfall.scenarios.report import figures
from footfall.scenarios.report.document import run_document
from footfall.scenarios.report.style import head, new_panels
from footfall.scenarios.report.tables import paper_table, path_line, run_report
from footfall.scenarios.run import parts, perform_run
from footfall.scenarios.scenario import build_scenario, load_scenario
from footfall.scenarios.trial import setup

NOISY = ((1.0, 9.0, 2.0), (41.0, 29.0, 20.0), (7.0, 7.0, 7.0))  # deg, errors of a walk by further noise


def printed(*parts, width=80):
    console = Console(width=width, no_color=True)
    with console.capture() as capture:
        for part in parts:
            console.print(part)
    return capture.get()


@pytest.fixture(scope="module")
def walked(workshop):
    scenario = load_scenario(workshop / "short.toml")
    made = setup(scenario, methods=("pdr", "hdr", "hdr-basic"))
    (result,) = perform_run(parts(made, walks=1, other_units=1), workers=1)
    return result


def several(walked, walks, methods=("pdr", "hdr"), factor=1.0):
    """As many walks as asked, of as many methods, each with scores of its own."""
    tracks = dict(zip(methods, itertools.cycle(walked.tracks.values()), strict=False))
    results = []
    for number in range(walks):
        scores = {
            name: Score(*(factor * (30 * number + 10 * i + j + 0.5) for j in range(6)))
            for i, name in enumerate(methods)
        }
        trial = replace(walked.trial, number=number, unit_seed=1000 + number)
        noises = tuple(dict.fromkeys(methods, Score(*([factor * at] * 6))) for at in NOISY[number % 3])
        given = {"scores": scores, "others": (scores,), "noises": noises}
        results.append(replace(walked, trial=trial, tracks=tracks, **given))
    return results


def of_scenario(result, scenario):
    """The same result, said to be of this scenario."""
    made = replace(result.trial.setup, scenario=scenario)
    return replace(result, trial=replace(result.trial, setup=made))


def pair(score):
    return f"{score.heading_error_mean_deg:.1f} / {score.heading_error_final_deg:.1f}"


@pytest.mark.parametrize(("walks", "methods"), [(1, 1), (1, 2), (5, 2), (5, 3), (12, 4)])
def test_tables_keep_every_figure_on_80_columns(walked, walks, methods):
    results = several(walked, walks, ("pdr", "hdr", "hdr-basic", "ihde")[:methods])
    text = printed(*run_report("closed-loop", results))
    assert "…" not in text
    assert max(map(len, text.splitlines())) <= 80
    for result in results:
        (line,) = [line for line in text.splitlines() if line.split()[1:2] == [str(result.trial.unit_seed)]]
        assert line.split()[0] == str(result.trial.number + 1)
        assert [pair(score) in line for score in result.scores.values()] == [True] * methods
    for name in results[0].scores:
        assert pair(mean_score([result.scores[name] for result in results])) in text
    # A line of improvements for each walk and the mean; one more each in the paper's own table.
    gains = [line for line in text.splitlines() if re.search(r"x( better| worse)? /", line)]
    assert len(gains) == 6 + (walks + 1) * (methods > 1)


def test_many_methods_wrap_and_lose_nothing(walked):
    names = ("pdr", "hdr", "hdr-basic", "hde", "ihde", "iez", "zupt", "mine")
    text = printed(*run_report("short", several(walked, 3, names)))
    assert "…" not in text
    assert set(names) <= set(text.split())
    assert {"0.5", "71.5", "131.5"} <= set(text.split())


def test_an_improvement_is_the_ratio_of_the_errors_and_of_the_means(walked):
    text = printed(*run_report("short", several(walked, 2)))
    (first, gain), (mean, mean_gain) = [
        [line.split("  ")[-1].strip() for line in text.splitlines()[i : i + 2]]
        for i, line in enumerate(text.splitlines())
        if line.split()[:1] in (["1"], ["mean"]) and "/" in line
    ]
    assert (first, gain) == ("10.5 / 11.5", f"{10.5 / 0.5:.1f}x / {11.5 / 1.5:.1f}x worse")
    assert (mean, mean_gain) == ("25.5 / 26.5", f"{25.5 / 15.5:.1f}x / {26.5 / 16.5:.1f}x worse")


@pytest.mark.parametrize(
    ("mean", "final", "told"),
    [
        (2.0, 20.0, "5.0x better / 2.0x worse"),
        (20.0, 2.0, "2.0x worse / 5.0x better"),
        (20.0, 40.0, "2.0x / 4.0x worse"),
        (10.4, 10.0, "1.0x / 1.0x"),
    ],
)
def test_what_is_worse_than_uncorrected_is_called_so(walked, mean, final, told):
    zeros = {"distance_error_pct": 0.0, "return_error_pct": 0.0}
    zeros |= {"position_rmse_m": 0.0, "position_error_final_m": 0.0}
    scores = {
        "pdr": Score(heading_error_mean_deg=10.0, heading_error_final_deg=10.0, **zeros),
        "hdr": Score(heading_error_mean_deg=mean, heading_error_final_deg=final, **zeros),
    }
    assert told in printed(*run_report("short", [replace(walked, scores=scores)]))


def test_only_a_path_that_returns_has_a_return_error(walked):
    there = printed(*run_report("x", [of_scenario(walked, load_scenario("straight"))]))
    back = printed(*run_report("x", [of_scenario(walked, load_scenario("closed-loop"))]))
    assert ("return" in back, " end " in back) == (True, False)
    assert ("return" in there, " end " in there) == (False, True)


def test_a_flawless_method_breaks_no_table(walked):
    results = several(walked, 2, factor=0.0)
    assert "nan" not in printed(*run_report("short", results))
    json.dumps(run_document("short", results), allow_nan=False)


def test_other_noises_are_told_by_walk_and_of_the_mean(walked):
    """Median and extent over the noises; of the mean over the walks, not the mean of medians."""
    results = several(walked, 3)
    text = printed(*run_report("short", results))
    assert "with 3 other noise seeds each" in text
    rows = [line.split() for line in text[text.index("3 other noise seeds") :].splitlines()]
    found = {(row[0], row[1]): row[2:] for row in rows if row[1:2] in (["pdr"], ["hdr"])}
    for walk, (median, low, high) in {
        "1": (2.0, 1.0, 9.0),
        "2": (29.0, 20.0, 41.0),
        "3": (7.0, 7.0, 7.0),
        "mean": (15.0, 9.7, 16.3),  # of 49/3, 45/3 and 29/3; the medians' mean is 12.7
    }.items():
        expected = [f"{median}", f"{low}", "to", f"{high}"] * 2
        assert found[walk, "pdr"] == found[walk, "hdr"] == expected
    document = json.loads(json.dumps(run_document("short", results), allow_nan=False))
    key = "heading_error_final_deg"
    assert document["walks"][1]["other_noises"]["count"] == document["other_noises"]["count"] == 3
    assert document["walks"][1]["other_noises"]["methods"]["hdr"][key] == extent([20.0, 29.0, 41.0])
    assert document["other_noises"]["methods"]["hdr"][key] == extent([49 / 3, 45 / 3, 29 / 3])
    assert document["walks"][1]["noise"] == results[1].trial.noise_seed
    silent = [replace(result, noises=()) for result in results]
    assert "other noise seeds" not in printed(*run_report("short", silent))
    assert "other_noises" not in json.dumps(run_document("short", silent))


def test_the_papers_table_is_printed_for_its_own_walk_alone(walked):
    results = several(walked, 1)
    assert "Borenstein" in printed(*run_report("closed-loop", results))
    assert "Borenstein" not in printed(*run_report("short", results))
    text = printed(paper_table())
    for row in (*HDR_TABLE_2, HDR_TABLE_2_MEAN):
        for figure in (row.uncorrected, row.hdr):
            assert f" {figure.average:g} / {figure.final:g}" in text
        assert f"{row.improvement.average:g}x / {row.improvement.final:g}x" in text


def test_chosen_units_are_owned_up_to(walked):
    results = several(walked, 1)
    assert "kept because" not in printed(*run_report("closed-loop", results))
    chosen = results[0].trial.setup.scenario.changed("seeds", units=[1000])
    results = [of_scenario(results[0], chosen)]
    assert "kept because" in printed(*run_report("closed-loop", results))


def test_the_document_holds_every_walk_and_the_means(walked):
    results = several(walked, 3)
    document = json.loads(json.dumps(run_document("short", results), allow_nan=False))
    assert [row["unit"] for row in document["walks"]] == [1000, 1001, 1002]
    for row, result in zip(document["walks"], results, strict=True):
        assert row["seed"] == result.trial.walk_seed
        assert row["subject"] == "reference"
        assert row["footfalls"] == len(result.tracks["pdr"])
        assert row["methods"] == {name: asdict(score) for name, score in result.scores.items()}
    assert document["mean"]["hdr"]["heading_error_final_deg"] == pytest.approx(41.5)
    assert document["other_units"]["count"] == 3
    errors = [result.others[0]["hdr"].heading_error_mean_deg for result in results]
    assert document["other_units"]["methods"]["hdr"]["heading_error_mean_deg"] == spread(errors)
    assert "other_units" not in run_document("short", [replace(result, others=()) for result in results])


@given(st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=30))
def test_spread_lies_within_its_values(values):
    found = spread(values)
    slack = 1e-9 * max(map(abs, values))
    assert all(min(values) - slack <= value <= max(values) + slack for value in found.values())
    assert found["median"] <= found["p90"] + slack


def test_a_running_mean_is_of_fewer_at_the_ends():
    np.testing.assert_allclose(running_mean(np.array([0.0, 3.0, 6.0, 0.0]), 3), [1.5, 3.0, 3.0, 3.0])


# Figures


@given(st.lists(st.floats(-100, 100), min_size=1, max_size=12), st.floats(0.01, 20))
def test_labels_are_moved_apart_and_no_further(values, gap):
    values = np.sort(values)
    places = figures.spread_out(values, gap)
    assert (np.diff(places) >= gap * (1 - 1e-9)).all()
    assert places.mean() == pytest.approx(values.mean(), abs=1e-6)
    if (np.diff(values) >= gap).all():
        np.testing.assert_allclose(places, values, atol=1e-9)


DRAWINGS = (
    figures.maps,
    figures.heading_errors,
    figures.drift_budget,
    figures.filtered_rates,
    figures.controller,
)


@pytest.mark.parametrize("walks", [1, 2, 5, 8])
@pytest.mark.parametrize("draw", DRAWINGS, ids=lambda draw: draw.__name__)
def test_nothing_in_a_figure_hides_another(walked, walks, draw):
    """Panels, their names and the head keep clear of each other and inside the figure; long names wrap."""
    results = several(walked, walks)
    name = "a-scenario-of-a-name-that-goes-on-and-on-for-ever-and-a-day"
    scenario = build_scenario(replace(walked.trial.setup.scenario.document, name=name))
    results = [of_scenario(result, scenario) for result in results]
    figure = draw(results)
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    boxes = [axis.get_tightbbox(renderer) for axis in figure.axes]
    boxes += [legend.get_window_extent(renderer) for legend in figure.legends]
    assert len(figure.legends) == 1
    for one, other in itertools.combinations(boxes, 2):
        wide = min(one.x1, other.x1) - max(one.x0, other.x0)
        high = min(one.y1, other.y1) - max(one.y0, other.y0)
        assert min(wide, high) < 1, (one, other)
    frame = figure.bbox
    for box in boxes:
        assert box.x0 > frame.x0 - 1
        assert box.x1 < frame.x1 + 1
        assert box.y0 > frame.y0 - 1
        assert box.y1 < frame.y1 + 1


def test_every_line_is_in_the_legend_once(walked):
    figure = figures.maps(several(walked, 3, ("pdr", "hdr", "hdr-basic", "theirs", "mine")))
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == ["PDR", "PDR + HDR", "PDR + basic HDR", "theirs", "mine", "truth", "start"]
    lines = [line for line in figure.axes[0].lines if line.get_label() in labels]
    assert len({line.get_color() for line in lines if line.get_label() not in ("truth", "start")}) == 5


def test_a_legend_is_read_row_after_row():
    figure, (axis,) = new_panels(1, 4.0, 3.0)
    names = [f"line {i}" for i in range(7)]
    for name in names:
        axis.plot([0, 1], label=name)
    head(figure, "seven", [axis])
    figure.canvas.draw()
    places = {text.get_text(): text.get_window_extent() for text in figure.legends[0].get_texts()}
    assert sorted(places, key=lambda name: (-round(places[name].y0), places[name].x0)) == names
    assert len({round(place.y0) for place in places.values()}) > 1


def test_maps_of_one_scenario_have_one_scale(walked):
    figure = figures.maps(several(walked, 3))
    assert len({(*axis.get_xlim(), *axis.get_ylim()) for axis in figure.axes}) == 1
    low, high = figure.axes[0].get_xlim()
    for line in (line for axis in figure.axes for line in axis.lines):
        assert low < line.get_xdata().min() <= line.get_xdata().max() < high


def test_walks_are_told_apart_by_colour_and_by_dashes(walked):
    lines = figures.heading_errors(several(walked, 4)).axes[0].lines[:4]
    assert len({line.get_color() for line in lines}) == 4
    assert len({line.get_linestyle() for line in lines}) == 4


def test_the_rate_that_is_judged_has_a_panel_of_its_own(walked):
    above, below = figures.filtered_rates([walked]).axes
    assert len(above.lines) == len(below.lines) + 2
    np.testing.assert_array_equal(above.lines[2].get_ydata(), below.lines[0].get_ydata())
    assert np.ptp(below.get_ylim()) < np.ptp(above.get_ylim())


def test_small_causes_are_pooled_and_the_sum_is_the_sum(walked):
    figure = figures.drift_budget([walked])
    lines = {line.get_label(): line.get_ydata() for line in figure.axes[0].lines}
    parts = [values for label, values in lines.items() if label not in ("sum",) and not label.startswith("_")]
    np.testing.assert_allclose(np.sum(parts, axis=0), lines["sum"], atol=1e-9)
    assert len(parts) < len(walked.budget.causes)


def test_the_path_line_tells_length_and_closure():
    closed = path_line(load_scenario("closed-loop").path)
    assert closed == "The path is 1800 m long and ends where it starts"
    level = "The path is 1800 m long and ends 1800.0 m from its start"
    assert path_line(load_scenario("straight").path) == level
