"""Chains of recordings: pieces have one mount, joints do not turn, and what is judged is the error added."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from benchmarks.validation import _chains, real_chains
from footfall.pdr.reckoning import dead_reckon
from footfall.pdr.track import Track
from footfall.recording import Recording
from footfall.scenarios.judge.reference import Footprints
from tests.helpers.commands import write_csv
from tests.helpers.synthetic_foot import walk

G = 9.80665
HEADINGS = np.radians([*np.zeros(8), 30, 60, *np.full(8, 90), 60, 60, *np.full(6, 60.0)])
STRIDES, STILL_S = len(HEADINGS) - 1, 1.5


def real(drift=0.0, turn=0.0, tilt=0.0, prints=True, rate=250.0):
    """A walk to the left and on, on a sensor that is turned in its case and drifts by `drift` rad/s."""
    truth = walk(HEADINGS, still_s=STILL_S, tail_s=0.5, rate=rate)
    up = truth.accel[5] / np.linalg.norm(truth.accel[5])
    case = Rotation.from_euler("zy", [turn, tilt])
    noise = np.random.default_rng(0).normal(0, 1e-3, truth.gyro.shape)
    gyro = truth.gyro + noise
    gyro[truth.t > STILL_S] += drift * up  # what the rest does not know
    recording = Recording(truth.t, case.apply(gyro), case.apply(truth.accel))
    feet = dead_reckon(Recording(truth.t, truth.gyro, truth.accel), replace(_chains.PATIENT, bias_s=1.0))
    found = Footprints(feet.t, feet.position[:, :2]) if prints else None
    return SimpleNamespace(name="made", recording=recording, footprints=found)


@pytest.fixture(scope="module")
def piece():
    return _chains.piece_of(real(turn=2.5, tilt=0.3))


def reckoned(*pieces, true=False):
    return dead_reckon(_chains.chain(pieces, 0, true), _chains.PATIENT)


def turned(feet):
    return np.degrees(feet.heading[-1] - feet.heading[0])


def test_a_piece_is_level_and_x_is_the_way_that_it_walks(piece):
    np.testing.assert_allclose(piece.start, [0, 0, G], atol=0.01)
    assert piece.seconds == pytest.approx(STILL_S + 1.1 * STRIDES + 0.5, abs=0.5)
    feet = reckoned(piece)
    assert turned(feet) == pytest.approx(60, abs=0.5)
    assert feet.t[0] == pytest.approx(_chains.REST_S + STILL_S, abs=0.6)
    assert feet.distance[1:] == pytest.approx(np.full(STRIDES, 1.5), rel=0.05)
    first = feet.position[2] - feet.position[1]
    assert np.arctan2(first[1], first[0]) == pytest.approx(0, abs=0.02)


def test_its_own_drift_is_told_by_its_footprints_and_taken_off_the_truth():
    drift = np.radians(0.2)
    piece = _chains.piece_of(real(drift))
    assert piece.drift == pytest.approx(drift, rel=0.2)
    assert turned(reckoned(piece, true=True)) == pytest.approx(60, abs=1)
    assert turned(reckoned(piece)) - 60 == pytest.approx(0.2 * 0.94 * 1.1 * STRIDES, abs=0.5)


def test_variants_turn_to_either_side(piece):
    walks = piece.variants()
    assert [turned(reckoned(one)) for one in walks] == pytest.approx([60, -60, -60, 60], abs=0.6)
    there, back = reckoned(walks[0]).position[:, :2], reckoned(walks[2]).position[:, :2]
    steps = [np.linalg.norm(places[6:] - places[:-6], axis=1) for places in (there, back)]
    np.testing.assert_allclose(steps[1], steps[0][::-1], atol=0.03)
    assert back[1, 0] - back[0, 0] > 1.0  # it walks ahead


def test_the_same_mirrored_twice_or_backwards_twice_is_the_same(piece):
    for again in (piece.mirrored().mirrored(), piece.backwards().backwards()):
        for name in ("gyro", "accel", "start", "end", "drift"):
            np.testing.assert_array_equal(getattr(again, name), getattr(piece, name))


def test_what_a_gyro_says_too_much_stays_the_same_error_in_every_variant():
    piece = _chains.piece_of(real(np.radians(0.2)))
    off = [turned(reckoned(one)) - turned(reckoned(one, true=True)) for one in piece.variants()]
    assert off == pytest.approx([off[0], -off[0], -off[0], off[0]], abs=0.3)
    whole = np.degrees(piece.drift) * piece.seconds  # of which swings, pitched, show less
    assert 0.75 * whole < off[0] < whole


def test_a_joint_tilts_the_foot_and_turns_it_nowhere():
    end, start = np.array([0.5, -0.8, 9.7]), np.array([-0.3, 0.2, 9.8])
    gyro, force = _chains.joint(end, start)
    attitude = Rotation.identity()
    ups = []
    for rate, felt in zip(gyro, force, strict=True):
        attitude = attitude * Rotation.from_rotvec(rate / _chains.RATE_HZ / 2)
        ups.append(attitude.apply(felt / np.linalg.norm(felt)))
        attitude = attitude * Rotation.from_rotvec(rate / _chains.RATE_HZ / 2)
    np.testing.assert_allclose(ups, np.tile(end / np.linalg.norm(end), (len(ups), 1)), atol=1e-9)
    assert abs(gyro @ (end / np.linalg.norm(end))).max() < 1e-9
    np.testing.assert_allclose(force[-1], start, atol=0.01)


def test_a_chain_goes_on_where_the_piece_before_ends(piece):
    both = reckoned(piece, piece.mirrored(), piece)
    one = len(reckoned(piece)) - 1
    assert len(both) >= 3 * one + 1
    assert turned(both) == pytest.approx(60, abs=1)
    assert np.degrees(both.heading[one] - both.heading[0]) == pytest.approx(60, abs=1)


def test_units_walk_the_pieces_in_an_order_of_their_own(piece, monkeypatch):
    monkeypatch.setattr(real_chains, "LENGTH_S", 2.5 * piece.seconds)
    pieces = [replace(piece, name=name) for name in "abc"]
    orders = [real_chains.in_order(pieces, seed) for seed in (1, 1, 2)]
    names = [[(one.name, tuple(one.gyro[0])) for one in order] for order in orders]
    assert [len(order) for order in orders] == [3, 3, 3]
    assert names[0] == names[1] != names[2]
    assert all(len(set(order)) == 3 for order in names)


def test_an_error_of_a_heading_is_told_at_its_own_footfalls():
    truth = Track(np.arange(3.0), np.zeros((3, 3)), np.array([0.0, 1.0, 2.0]))
    track = Track(np.array([0.0, 0.5, 2.0]), np.zeros((3, 3)), np.array([0.0, 0.4, 2.1]))
    off = real_chains.heading_error_deg(track, truth)
    np.testing.assert_allclose(off, np.degrees([0.0, -0.1, 0.1]))


def test_it_judges_and_fills_its_page(tmp_path, monkeypatch, capsys):
    folder = tmp_path / "xio"
    folder.mkdir()
    made = real().recording
    columns = {"Time (s)": made.t[1:]}
    columns |= {f"Gyroscope {a} (deg/s)": np.degrees(made.gyro[1:, i]) for i, a in enumerate("XYZ")}
    columns |= {f"Accelerometer {a} (g)": made.accel[1:, i] / G for i, a in enumerate("XYZ")}
    write_csv(folder / "long_walk.csv", columns)
    page, out = tmp_path / "page.md", tmp_path / "out.json"
    marks = ("real feet", "real feet as they are")
    page.write_text("".join(f"# {mark}\n<!-- table {mark} -->\noutdated\n<!-- end -->\n" for mark in marks))
    arguments = ["--data", tmp_path, "--units", 2, "--processes", 1, "--page", page, "--json", out]
    real_chains.main([*map(str, arguments), "--methods", "hdr", "hypotheses"])
    text = page.read_text()
    assert "outdated" not in text
    rows = json.loads(out.read_text())["chains"]
    assert len(rows) == 2 * 2 * 2 * 3  # groups, units, added or not, methods
    by = {(one["group"], one["added"], one["unit"], one["method"]): one for one in rows}
    for group in ("mixed", "rooms"):
        averages = [
            by[group, added, unit, "pdr"]["average"] for added in (False, True) for unit in (1000, 1001)
        ]
        assert len(set(averages)) == 4
        assert {by[group, True, 1000, name]["average"] for name in ("hdr", "hypotheses")}.isdisjoint(averages)
    assert "| rooms | pdr |" in text
    assert "chains of recordings" in capsys.readouterr().err


def test_the_recordings_beside_the_checkout_are_all_in_a_group():
    if not real_chains.BESIDE.is_dir():
        pytest.skip("no recordings beside the checkout")
    names = {one.name for one in real_chains.find(real_chains.BESIDE)}
    assert set().union(*real_chains.GROUPS.values()) == names


def test_an_empty_folder_is_told(tmp_path):
    with pytest.raises(SystemExit, match="no recordings here"):
        real_chains.main(["--data", str(tmp_path)])
