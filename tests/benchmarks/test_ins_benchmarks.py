"""The filter's benchmarks run, and what they say of a foot whose motion is known is right."""

import json

import numpy as np
import pytest

from benchmarks.papers import _false_bias, iez_false_bias, iez_ways
from benchmarks.speed import filter as filter_speed
from footfall.hdr.methods import Reckoning
from footfall.hdr.tracks import iez_track, pdr_track
from footfall.pdr.detectors import DETECTORS
from footfall.pdr.filter.ins import FilterSettings
from footfall.pdr.reckoning import PdrParams, dead_reckon
from footfall.scenarios.trial import perform
from tests.helpers.synthetic_foot import walk


@pytest.fixture
def feet():
    """Sixty strides on a foot that rocks at rest, in a perfect IMU."""
    truth = walk(np.concatenate([np.zeros(2), np.linspace(0, 3, 58)]), still_s=25.5)
    detector = PdrParams(detector=DETECTORS["shoe"])
    return truth, _false_bias.Feet("synthetic", Reckoning(truth.recording(), pdr=detector))


def test_strapdown_between_quiet_instants_is_how_the_foot_moves(feet):
    truth, found = feet
    motion = found.motion
    speed = np.linalg.norm(truth.velocity, axis=1)
    at = found.reckoning.detected.stances.resets
    rows = slice(at[0], at[-1])
    assert np.abs(np.linalg.norm(motion.velocity, axis=1) - speed)[rows].max() < 0.05
    swing = motion.velocity[rows][speed[rows] > 1.5]
    assert swing[:, 0].min() > 1.0  # forward is where the stride goes
    assert np.abs(swing[:, 1]).mean() < 0.2 * np.abs(swing[:, 0]).mean()


def test_told_its_own_motion_the_filter_invents_nothing(feet):
    bias, settings = _false_bias, _false_bias.PAPER
    _, found = feet
    zero = bias.drive(found, settings, lambda motion: np.zeros_like(motion.velocity))
    told = bias.drive(found, settings, lambda motion: motion.velocity)
    assert abs(zero) > 0.1
    assert abs(told) < 0.05 * abs(zero)
    # Zero all along is what the package's own run does.
    whole = bias.without(found, "", np.inf)
    assert whole == pytest.approx(zero, rel=1e-3)


def test_sideways_velocity_at_touchdown_is_the_bias_that_the_page_says(feet):
    """v more to the left when the foot is first called still is a share of v / L; v all along is no bias."""
    bias = _false_bias
    _, found = feet
    v = np.array([0.0, 0.01, 0.0])

    def made(share):
        def told(motion):
            return motion.velocity + v * (motion.place <= share)[:, None]

        return bias.drive(found, bias.PAPER, told)

    true, settling, always = made(0.0), made(0.3), made(1.0)
    expected = np.degrees(v[1] / 1.5)
    # The rest goes into the tilt, which standing then puts right.
    assert expected / 5 < settling - true < expected
    assert abs(always - true) < expected / 10


def test_the_false_bias_page_is_filled_and_drawn(feet, monkeypatch, tmp_path):
    script = iez_false_bias
    truth, found = feet
    known = _false_bias.Feet("known", found.reckoning, truth.heading(found.reckoning.footfalls.t))
    monkeypatch.setattr(script, "perfect", lambda scenario: known)
    monkeypatch.setattr(script, "AFTER_S", 10.0)
    monkeypatch.setattr(script, "PLAIN_S", 3.0)
    page = tmp_path / "page.md"
    names = ("grid", "parts", "feet", "detectors")
    page.write_text("".join(f"<!-- table {name} -->\nstale\n<!-- end -->\n" for name in (*names, "walker")))
    out = tmp_path / "out.json"
    script.main(f"--no-real --walks 0 --page {page} --figures {tmp_path} --json {out}".split())
    text = page.read_text()
    assert "stale" not in text
    assert "default" in text
    assert set(json.loads(out.read_text())) >= set(names)
    for name in ("iez_cause.png", "iez_cure.png"):
        assert (tmp_path / name).stat().st_size > 10_000


def test_the_papers_tests_are_judged_with_their_imu_and_a_perfect_one(short_walk, monkeypatch):
    script = iez_false_bias
    monkeypatch.setattr("footfall.simulate.cache.cached_walk", lambda plan, **keys: short_walk)
    trials = script.paper_trials("ihde-test2", 2)
    assert [(one.number, one.walk_seed, one.setup.imu) for one in trials] == [
        (0, 1, "mtig710"),
        (0, 1, "perfect"),
        (1, 2, "mtig710"),
        (1, 2, "perfect"),
    ]
    assert {one.setup.scenario.sensor.bias_shift_deg_s for one in trials} == {0.0}
    rows = {row.method: row for row in perform(trials[1], short_walk).rows}
    assert set(rows) == set(script.filters())
    assert rows["default"].require().return_error_pct < 1.0
    table = script.paper_tests(1, 1)
    assert len(table) == 2 * len(rows) + 1
    at = list(rows).index("default") * 2 + 1
    assert table[at][0] == "default, perfect IMU"
    assert table[at][2].startswith(f"{rows['default'].require().return_error_pct:.2f} (")


def test_filter_speed_tells_every_case(tmp_path, monkeypatch):
    out = tmp_path / "out.json"
    monkeypatch.setattr(filter_speed, "SHORT_S", 1.0)
    filter_speed.main(["--minutes", "0.1", "--json", str(out)])
    found = json.loads(out.read_text())["ns_a_sample"]
    assert all(value > 0 for value in found.values())
    assert {"compiled, one update a stance", "numpy twin, an update every still sample"} <= set(found)


def test_ways_beside_the_default_are_the_default_but_for_what_they_change(feet):
    """Stance by stance, the default is what the package's own run makes; every other way is another track."""
    _, found = feet
    own = iez_track(found.reckoning, FilterSettings(), name="iez")
    made = {name: iez_ways.track(found.reckoning, way) for name, way in iez_ways.WAYS.items()}
    default, *others = made.values()
    np.testing.assert_allclose(default.position, own.position, atol=1e-9)
    np.testing.assert_allclose(default.heading, own.heading, atol=1e-12)
    for other in others:
        assert np.abs(other.heading - own.heading).max() > 1e-9


def test_a_foot_that_slides_is_seen_to_slide():
    """What zero velocity overlooks is what the strides lack: here 20 mm/s forward, all along the walk."""
    truth = walk(np.zeros(42), rocking=0.0)
    found = pdr_track(dead_reckon(truth.recording()))
    place = truth.position[truth.at(found.t)][:, :2]
    moved = place + 0.02 * found.t[:, None] * [1.0, 0.0]
    still, slid = iez_ways.slid(found, place), iez_ways.slid(found, moved)
    assert still.level == pytest.approx(0.0, abs=1e-3)
    assert slid.level - still.level == pytest.approx(0.02, abs=1e-4)
    assert np.isnan(slid.up)
