"""What a run says and draws where heading methods are compared."""

import itertools
import math
import os
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console

from footfall.scenarios.judge.papers import IHDE_TABLE_2, range_text
from footfall.scenarios.judge.score import Score, compare
from footfall.scenarios.report.figures import heading_errors, maps
from footfall.scenarios.report.heading_figures import evaluation, heading_figures, judging
from footfall.scenarios.report.style import colours_of
from footfall.scenarios.report.tables import run_report
from footfall.scenarios.run import parts, perform_run
from footfall.scenarios.scenario import load_scenario
from footfall.scenarios.trial import setup

METHODS = ("iez", "hde", "ihde")


@pytest.fixture(scope="module")
def walked(workshop):
    made = setup(load_scenario(workshop / "short.toml"), methods=METHODS)
    (result,) = perform_run(parts(made, walks=1), workers=1)
    return result


def scored(walked, errors):
    """Walks with these return errors (%), the same for every method."""
    results = []
    for number, error in enumerate(errors):
        score = Score(1.0, 2.0, error, 0.1, 0.5, 0.7)
        scores = dict.fromkeys((*METHODS, "ihde-paper"), score)
        results.append(replace(walked, trial=replace(walked.trial, number=number), scores=scores))
    return results


def report(name, results):
    console = Console(width=80, no_color=True)
    with console.capture() as capture:
        for part in run_report(name, results):
            console.print(part)
    return capture.get()


@pytest.mark.parametrize("name", IHDE_TABLE_2)
def test_the_papers_row_stands_beside_ours_and_its_spread(walked, name):
    errors = np.random.default_rng(0).uniform(0.1, 30, 20)
    text = report(name, scored(walked, errors))
    assert max(map(len, text.splitlines())) <= 80
    low, high = np.percentile(errors, [10, 90])
    ours = (
        f"{errors.mean():.2f}",
        f"{np.median(errors):.2f}",
        f"{low:.2f} to {high:.2f}",
        f"{errors.min():.2f} to {errors.max():.2f}",
    )
    (table,) = text.split("Position, mean")[0].split("Return error P_err")[1:]
    for method, paper in {**IHDE_TABLE_2[name], "ihde-paper": IHDE_TABLE_2[name]["ihde"]}.items():
        (line,) = [line for line in table.splitlines() if line.split()[:1] == [method]]
        assert all(cell in line for cell in ours)
        assert line.rstrip().endswith(range_text(paper))


def test_other_paths_have_no_row_of_the_papers(walked):
    assert "P_err" not in report("short", scored(walked, [1.0, 2.0]))


def test_ranges_read_as_in_the_paper():
    assert range_text((8.7, 9.6)) == "8.7 to 9.6"
    assert range_text((20.0, math.inf)) == "> 20"


def test_heading_and_evaluation_are_drawn_as_they_are(walked):
    figure = evaluation(walked)
    above, amid, below = figure.axes
    track = walked.tracks["ihde"]
    drawn = {line.get_label(): line.get_xydata() for line in [*above.lines, *below.lines]}
    np.testing.assert_allclose(drawn["IHDE"][:, 1], np.degrees(track.heading), atol=1e-6)
    for name, line in zip(walked.tracks, amid.lines, strict=False):
        off = np.degrees(compare(walked.tracks[name], walked.walk).heading_error)
        np.testing.assert_allclose(line.get_ydata(), off)
    both = np.vstack([drawn["E, heading corrected"], drawn["E, left alone"]])
    order = np.argsort(both[:, 0])
    np.testing.assert_allclose(both[order, 1], track.evidence["evaluation"])
    active = drawn["E, heading corrected"][:, 1]
    assert (active > track.meta["params"]["gamma2"]).all()
    assert {"truth", "IEZ", "HDE", "IHDE"} <= set(drawn)


def test_a_track_from_a_wrong_start_is_drawn_as_it_is(walked):
    """Nothing is laid on the truth: an error of the start shows in every figure."""
    track, wrong = walked.tracks["ihde"], 0.3
    astray = replace(
        track, position=track.position + np.array([3.0, -2.0, 0.0]), heading=track.heading + wrong
    )
    result = replace(walked, tracks={"ihde": astray})
    lines = {line.get_label(): line.get_xydata() for line in maps([result]).axes[0].lines}
    np.testing.assert_allclose(lines["IHDE"], astray.position[:, :2])
    error = max((line.get_ydata() for line in heading_errors([result]).axes[0].lines), key=len)
    assert error[0] == pytest.approx(math.degrees(wrong), abs=1.0)
    drawn = {line.get_label(): line.get_ydata() for line in evaluation(result).axes[0].lines}
    np.testing.assert_allclose(drawn["IHDE"], np.degrees(astray.heading))
    assert (drawn["IHDE"] - drawn["truth"])[0] == pytest.approx(math.degrees(wrong), abs=1.0)


def test_nothing_hides_another(walked):
    figure = evaluation(walked, "a title that goes on and on " * 8)
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    boxes = [axis.get_tightbbox(renderer) for axis in figure.axes]
    boxes += [legend.get_window_extent(renderer) for legend in figure.legends]
    for one, other in itertools.combinations(boxes, 2):
        wide = min(one.x1, other.x1) - max(one.x0, other.x0)
        high = min(one.y1, other.y1) - max(one.y0, other.y0)
        assert min(wide, high) < 1
    assert all(box.x0 > -1 and box.x1 < figure.bbox.x1 + 1 for box in boxes)


def test_a_track_that_another_repeats_still_shows(walked):
    for axis in (maps([walked]).axes[0], evaluation(walked).axes[0]):
        lines = {line.get_label(): line for line in axis.lines}
        drawn = [lines[label] for label in ("IEZ", "HDE", "IHDE")]
        assert [axis.lines.index(line) for line in drawn] == sorted(axis.lines.index(line) for line in drawn)
        widths = [line.get_linewidth() for line in drawn]
        assert widths == sorted(set(widths), reverse=True)


def test_the_figure_is_drawn_where_a_method_evaluates(walked, tmp_path):
    heading_figures([walked], tmp_path)
    assert os.listdir(tmp_path) == ["evaluation.png"]
    without = replace(walked, tracks={name: walked.tracks[name] for name in ("iez", "hde")})
    assert judging(without) is None
    heading_figures([without], tmp_path / "none")  # makes nothing, not even the folder
    assert not (tmp_path / "none").exists()


def test_methods_drawn_together_have_colours_of_their_own():
    for names in (
        METHODS,
        ("iez", "iez-paper", "hde", "hde-paper", "ihde", "ihde-paper"),
        ("pdr", "hdr", "x"),
    ):
        colours = colours_of(names)
        assert len({colours[name] for name in names}) == len(names)
