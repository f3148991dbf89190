"""What docs/swaying.md says of HDR's stages is what they do."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks.papers import swaying
from footfall.hdr.hdr import HdrParams, trace
from tests.helpers.synthetic_foot import footfalls

DEG = np.pi / 180


@pytest.mark.parametrize("period", [2.2, 5.0, 20.0, 80.0])
def test_the_double_filter_leaves_what_the_page_says(period):
    t = 1.1 * np.arange(1, 2001)
    found = trace(footfalls(DEG * np.cos(2 * np.pi * t / period), 1.1), HdrParams(i_c=0.0))
    late = slice(1000, None)
    wave = np.exp(-2j * np.pi * t / period)
    left = abs(np.mean(found.twice[1:][late] * wave[late]) / np.mean(found.raw[1:][late] * wave[late]))
    assert swaying.gain(period, 8.0) == pytest.approx(left, rel=0.02)
    if period == 2.2:
        assert swaying.gain(period, 8.0) == pytest.approx((1.1 / 17.1) ** 2)


def test_delagging_on_the_page_undoes_the_filter():
    rng = np.random.default_rng(2)
    walk = footfalls(rng.normal(0, 3, 100) * DEG, rng.uniform(0.9, 1.3, 100))
    back = swaying.delagged(trace(walk).twice, walk.interval, HdrParams().tau_s)
    np.testing.assert_allclose(back, walk.rate, rtol=0, atol=1e-12)


def test_the_motions_are_the_scenarios_walks_and_three_others():
    trials = swaying.perfect_trials(swaying.load_scenario("swaying"))
    plans = {name: trial.plan for name, trial in trials.items()}
    assert [plan.gait.wander_m for plan in plans.values()] == [0.0, 0.1, 0.3, 0.0, 0.0, 0.0]
    turned = {name: np.degrees(plan.route.heading[-1]) for name, plan in plans.items()}
    assert turned["turning"] == pytest.approx(90)
    assert turned["curving, radius 60 m"] == pytest.approx(90)
    assert turned["curving, radius 400 m"] == pytest.approx(28.65, abs=0.01)
    # One of the arcs is taken for drift at the walkers' pace, the other is not.
    assert 60 < HdrParams().erased_radius(1.3) < 400


def test_errors_are_of_every_sway_walk_unit_and_noise(monkeypatch):
    """In the order of the table: sways that err by their trial's seeds."""
    scenario = swaying.load_scenario("swaying")

    def done(trials, processes, label):
        errors = [(one.walk_seed - scenario.seeds.base, one.unit_seed, one.noise_seed) for one in trials]
        return [SimpleNamespace(rows=[(m, *error) for m in range(3)]) for error in errors]

    monkeypatch.setattr(swaying, "outcomes", done)
    monkeypatch.setattr(
        swaying, "heading_errors_deg", lambda row: (row[1] + 10 * row[0], row[2] + row[3] / 10)
    )
    found = swaying.scored(scenario, 2, range(7, 9), range(3), 1)
    assert found.shape == (3, 2, 2, 3, 3, 2)
    sway, walk, unit, noise, method, _ = np.indices(found.shape)
    final = swaying.FINAL
    np.testing.assert_array_equal(found[..., final], (sway + 3 * walk + 10 * method)[..., final])
    np.testing.assert_allclose(found[..., 1 - final], (7 + unit + noise / 10)[..., final])


def stand_in(rate):
    walk = footfalls(np.asarray(rate), 1.1)
    return swaying.Motion("none", walk, trace(walk), np.zeros(len(walk)), walk.position)


def test_the_stages_are_those_of_the_trace():
    one = stand_in(np.full(200, 0.6 * DEG))  # beyond theta_w for ever
    row = dict(zip(swaying.stage_sheet([one]).headings, swaying.stage_sheet([one]).rows[0], strict=True))
    assert (row["footfalls"], row["SD raw"], row["A = 0 (%)"], row["mean A"]) == (
        "201",
        "0.00",
        "100",
        "0.00",
    )
    assert float(row["largest I"]) == pytest.approx(np.degrees(np.abs(one.found.integrator).max()), abs=1e-3)
    assert float(row["final (deg)"]) == pytest.approx(np.degrees(one.found.heading[-1]), abs=0.05)
    swinging = stand_in(np.tile([3.0, -3.0], 100) * DEG)
    row = dict(
        zip(swaying.stage_sheet([swinging]).headings, swaying.stage_sheet([swinging]).rows[0], strict=True)
    )
    assert row["SD raw"] == "3.00"
    assert float(row["once"]) == pytest.approx(3 * 1.1 / 17.1, abs=0.01)


def test_the_table_of_errors_counts_by_walk_unit_and_noise():
    errors = np.zeros((3, 2, 5, 2, 3, 2))
    errors[..., 0, swaying.FINAL], errors[..., 0, swaying.AVERAGE] = 60.0, 30.0
    errors[1, :, :, :, 2, swaying.AVERAGE] = 40.0  # HDR on the second sway: worse
    errors[1, :, :, 1, 2, swaying.FINAL] = 7.0  # with one of two noises
    sheet = swaying.error_sheet(errors)
    assert sheet.rows[0] == [swaying.SWAYS[0], "uncorrected", "30.0", "30.0", "60.0", "60.0", "", "0.0"]
    assert sheet.rows[5] == ["", "HDR", "40.0", "40.0", "3.5", "7.0", "100", "7.0"]
    assert sheet.rows[8][-2:] == ["0", "0.0"]


def test_a_figure_is_drawn_of_short_and_long_walks(tmp_path):
    rng = np.random.default_rng(0)
    motions = [stand_in(rng.normal(0, 3 * DEG, n)) for n in (60, 600)]
    swaying.draw(tmp_path / "figure.png", motions)
    assert (tmp_path / "figure.png").stat().st_size > 30_000
