"""The command line, command by command: what it prints where, what it writes, and how it ends."""

import numpy as np
import pytest
import typer

from footfall.cli.app import app
from footfall.errors import InputError
from footfall.hdr.methods import METHODS
from footfall.models.imu import EFFECTS, stock_specs
from footfall.recording import read_recording
from footfall.scenarios.scenario import stock_scenarios
from footfall.simulate.walk import read_walk
from footfall.tables import read_table, write_table
from tests.helpers.commands import SCORES, one_document, write_csv

COMMANDS = typer.main.get_command(app).commands
# Help


def test_every_command_is_known():
    assert set(COMMANDS) >= {"list", "run", "walk", "record", "track", "score", "allan"}


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_explains_itself_and_each_of_its_arguments(cli, name):
    code, out, err = cli(f"{name} --help")
    assert (code, err) == (0, "")
    assert COMMANDS[name].help.split()[0] in out
    for parameter in COMMANDS[name].params:
        if parameter.name != "help":
            assert len(parameter.help.split()) >= 3, parameter.name
            assert parameter.name in out or any(option in out for option in parameter.opts)


@pytest.mark.parametrize(("name", "text"), [("run", "[set]"), ("map", "[set]"), ("tune", "[study]")])
def test_brackets_of_a_help_text_are_shown_and_are_no_style(cli, name, text):
    assert text in cli(f"{name} --help")[1]


def test_without_a_command_it_shows_them_all(cli):
    code, out, err = cli("")
    assert (code, err) == (0, "")
    assert all(f" {name} " in out for name in COMMANDS)


def test_it_tells_its_version(cli):
    from footfall import __version__

    assert cli("--version") == (0, f"{__version__}\n", "")


# list


def test_list_names_everything_within_80_columns(cli):
    code, out, err = cli("list")
    assert (code, err) == (0, "")
    words = out.replace(",", " ").split()
    assert {*stock_scenarios(), *stock_specs(), *METHODS, *EFFECTS, "instep", "heel"}.issubset(words)
    assert max(map(len, out.splitlines())) <= 80
    assert "…" not in out


def test_list_for_programs(cli):
    code, out, err = cli("list --json")
    assert (code, err) == (0, "")
    document = one_document(out)
    assert set(document["scenarios"]) == set(stock_scenarios())
    assert set(document["imus"]) == set(stock_specs())
    assert set(document["methods"]) == set(METHODS)
    assert document["effects"] == list(EFFECTS)
    assert "instep" in document["mounts"]


# Step by step


def test_a_walk_is_written_with_its_footfalls(cli, here):
    code, out, err = cli("walk short.toml --number 2 --rate 100 --mount heel -o other.parquet")
    assert (code, out) == (0, "")
    walk, first = read_walk("other.parquet"), read_walk("walk.parquet")
    assert err == f"{len(walk.footfalls.t)} footfalls in {walk.t[-1]:.0f} s: other.parquet\n"
    assert (walk.meta["subject"], walk.meta["seed"], walk.meta["rate_hz"]) == ("shorter", 4, 100)
    assert (first.meta["subject"], first.meta["seed"], first.meta["rate_hz"]) == ("reference", 3, 200)
    # The heel's IMU leans the other way.
    assert np.sign(walk.accel[0, 0]) == -np.sign(first.accel[0, 0])


def test_a_seed_draws_the_path_too(cli, here, monkeypatch):
    asked = []

    def walked(plan, **_):
        asked.append(plan)
        raise InputError("enough")

    monkeypatch.setattr("footfall.simulate.cache.cached_walk", walked)
    for options in ("--number 4", "--seed 4", "--number 4 --seed 4", ""):
        assert cli(f"walk rooms {options} -o walk.parquet")[0] == 2
    assert [plan.seed for plan in asked] == [4, 4, 4, 1]
    ends = [round(plan.route.length, 6) for plan in asked]
    assert ends[0] == ends[1] == ends[2] != ends[3]


def test_several_mounts_are_one_walk_in_a_file_each(cli, here):
    code, out, err = cli("walk short.toml --mount instep,heel,instep-left -o w.parquet")
    assert (code, out) == (0, "")
    instep, heel, left = (read_walk(f"w-{name}.parquet") for name in ("instep", "heel", "instep-left"))
    assert [line.rpartition(" ")[2] for line in err.splitlines()] == [
        f"w-{name}.parquet" for name in ("instep", "heel", "instep-left")
    ]
    assert not (here / "w.parquet").exists()
    np.testing.assert_array_equal(instep.gyro, read_walk("walk.parquet").gyro)
    np.testing.assert_array_equal(heel.contact, instep.contact)  # the same steps to the last bit
    # Both sit on one foot: their distance does not change, up to where each is in the room.
    apart = np.linalg.norm(heel.position - instep.position, axis=1)
    np.testing.assert_allclose(apart, np.hypot(0.135, 0.02), atol=1e-6)
    # The other foot stands while this one swings.
    assert not (left.stance & instep.stance)[len(left.t) // 2 :][: len(left.t) // 4].all()
    assert np.abs(left.position[0, 1] - instep.position[0, 1]) > 0.1


def test_one_unknown_mount_among_several_writes_nothing(cli, here):
    before = set(here.iterdir())
    code, _, err = cli("walk short.toml --mount instep,hel -o w.parquet")
    assert code == 2
    assert "--mount 'hel' is unknown; did you mean heel" in err
    assert set(here.iterdir()) == before


def test_seeds_make_walks(cli, here):
    for name, options in (("again", ""), ("same", "--seed 3 --no-cache"), ("other", "--seed 8")):
        assert cli(f"walk short.toml {options} -o {name}.parquet")[0] == 0
    first, again, same, other = (read_walk(f"{name}.parquet") for name in ("walk", "again", "same", "other"))
    np.testing.assert_array_equal(again.gyro, first.gyro)
    np.testing.assert_array_equal(same.gyro, first.gyro)
    assert not np.array_equal(other.footfalls.position[:5], first.footfalls.position[:5])


def test_a_recording_is_its_units(cli, here):
    for seed in (7, 8):
        code, out, err = cli(f"record walk.parquet --unit-seed {seed} -o rec-{seed}.parquet")
        assert (code, out) == (0, "")
    same, other, first = (read_recording(f"{name}.parquet") for name in ("rec-7", "rec-8", "rec"))
    assert err == f"{len(other.t)} samples: rec-8.parquet\n"
    np.testing.assert_array_equal(same.gyro, first.gyro)
    assert not np.array_equal(other.gyro, first.gyro)


def test_another_noise_is_another_recording_of_the_same_unit(cli, here):
    """The constants of the unit stay: with its noises switched off there is no difference."""
    quiet = " ".join(f"--without {name}" for name in ("turn_on", "flicker", "rate_random_walk", "white"))
    for name, options in (("own", ""), ("same", "--noise-seed 7"), ("other", "--noise-seed 8")):
        assert cli(f"record walk.parquet --unit-seed 7 {options} -o {name}.parquet")[0] == 0
        assert cli(f"record walk.parquet --unit-seed 7 {options} {quiet} -o {name}-quiet.parquet")[0] == 0
    own, same, other = (read_recording(f"{name}.parquet") for name in ("own", "same", "other"))
    np.testing.assert_array_equal(same.gyro, own.gyro)
    assert not np.array_equal(other.gyro, own.gyro)
    assert [(made.meta["unit_seed"], made.meta["noise_seed"]) for made in (own, other)] == [(7, 7), (7, 8)]
    still, elsewhere = (read_recording(f"{name}-quiet.parquet") for name in ("own", "other"))
    np.testing.assert_array_equal(elsewhere.gyro, still.gyro)
    assert not np.array_equal(still.gyro, read_walk("walk.parquet").gyro)


def test_without_all_effects_a_recording_is_the_truth(cli, here):
    without = " ".join(f"--without {effect}" for effect in EFFECTS)
    assert cli(f"record walk.parquet {without} -o rec.parquet")[0] == 0
    assert cli("record walk.parquet --imu perfect -o perfect.parquet")[0] == 0
    walk = read_walk("walk.parquet")
    for name in ("rec", "perfect"):
        recording = read_recording(f"{name}.parquet")
        np.testing.assert_array_equal(recording.gyro, walk.gyro)
        np.testing.assert_array_equal(recording.accel, walk.accel)


def test_the_cold_is_felt(cli, here):
    assert cli("record walk.parquet --unit-seed 7 --indoors 20 --outdoors -15 -o cold.parquet")[0] == 0
    cold, warm = read_recording("cold.parquet"), read_recording("rec.parquet")
    assert cold.temperature[-1] < warm.temperature[-1] - 1
    assert not np.array_equal(cold.gyro[-200:], warm.gyro[-200:])


def test_a_track_has_one_row_a_footfall_and_the_methods_evidence(cli, here):
    assert cli("track rec.parquet --method hdr --heading 0 -o hdr.parquet")[0] == 0
    code, out, err = cli("track rec.parquet --method hdr --heading 90 -o turned.parquet")
    columns, meta = read_table("hdr.parquet")
    assert (code, out) == (0, "")
    said = err.splitlines()
    assert said[0].startswith("rec.parquet: plausibility: velocity left 0.1")
    assert said[1:] == [f"{len(columns['t'])} footfalls: turned.parquet"]
    assert {"t", "x", "y", "z", "heading", "raw_rate", "integrator"} <= set(columns)
    assert meta["method"] == "hdr"
    assert abs(len(columns["t"]) - len(read_walk("walk.parquet").footfalls.t)) <= 1
    turned, _ = read_table("turned.parquet")
    np.testing.assert_allclose(turned["heading"] - columns["heading"], np.pi / 2, atol=1e-9)
    x, y, _ = meta["start"]["position_m"]
    np.testing.assert_allclose(turned["y"] - y, columns["x"] - x, atol=1e-9)
    np.testing.assert_allclose(turned["x"] - x, -(columns["y"] - y), atol=1e-9)


def test_a_track_is_told_the_directions_of_its_building(cli, here):
    def heading(options):
        assert cli(f"track rec.parquet --method ihde --heading 15 {options} -o t.parquet")[0] == 0
        return read_table("t.parquet")[0]["heading"]

    told = heading("--reference 15")
    np.testing.assert_allclose(heading("--reference 105"), told, atol=1e-9)
    assert np.abs(heading("--reference 18 --directions 8") - told).max() > 1e-3


def test_a_simulated_recording_knows_its_start(cli, here):
    """So that the steps one by one come to what `run` comes to, and a perfect IMU to the truth."""
    assert cli("record walk.parquet --imu perfect -o perfect.parquet")[0] == 0
    assert cli("track perfect.parquet --method pdr -o t.parquet")[0] == 0
    scores = one_document(cli("score t.parquet walk.parquet --json")[1])
    assert scores["heading_error_mean_deg"] < 0.1
    assert scores["position_rmse_m"] < 0.003 * 36
    assert cli("track perfect.parquet --method pdr --heading 20 -o t.parquet")[0] == 0
    scores = one_document(cli("score t.parquet walk.parquet --json")[1])
    assert scores["heading_error_mean_deg"] == pytest.approx(20, abs=4)


def test_a_track_may_be_aligned_and_the_score_says_so(cli, here):
    assert cli("track rec.parquet --method pdr --heading 50 -o t.parquet")[0] == 0
    final = {}
    for align, said in (("none", "nothing fitted"), ("start", "first row laid"), ("rigid", "shift and turn")):
        code, out, err = cli(f"score t.parquet walk.parquet --align {align}")
        assert (code, err) == (0, "")
        assert said in out.splitlines()[0]
        assert max(map(len, out.splitlines())) <= 80
        scores = one_document(cli(f"score t.parquet walk.parquet --align {align} --json")[1])
        assert scores["align"] == align
        final[align] = scores["position_rmse_m"]
    assert final["none"] > 10 * final["start"] > 0
    assert final["rigid"] < final["start"]


def test_a_track_and_a_walk_are_exported(cli, here):
    code, out, err = cli("export pdr.parquet --format tum -o pdr.tum")
    columns, _ = read_table("pdr.parquet")
    assert (code, out, err) == (0, "", f"{len(columns['t'])} poses: pdr.tum\n")
    np.testing.assert_allclose(np.loadtxt("pdr.tum")[:, 2], columns["y"], atol=1e-9)
    assert cli("export walk.parquet -o walk.tum")[0] == 0
    assert len(np.loadtxt("walk.tum")) == len(read_walk("walk.parquet").t)


def test_a_csv_gives_the_same_track(cli, here):
    write_csv("rec.csv", read_table("rec.parquet")[0])
    # Nor does it say that it is simulated.
    told = "--method pdr --detector threshold --bias-time 20 --heading 0"
    assert cli(f"track rec.csv {told} -o csv.parquet")[0] == 0
    assert cli(f"track rec.parquet {told} -o pdr.parquet")[0] == 0
    ours, meta = read_table("pdr.parquet")
    # A CSV says nothing of its start.
    for i, axis in enumerate("xyz"):
        ours[axis] -= meta["start"]["position_m"][i]
    theirs, _ = read_table("csv.parquet")
    for name, values in ours.items():
        np.testing.assert_allclose(theirs[name], values, rtol=0, atol=1e-12)


def test_a_score_for_people_and_for_programs(cli, here):
    code, out, err = cli("score hdr.parquet walk.parquet")
    assert (code, err) == (0, "")
    assert max(map(len, out.splitlines())) <= 80
    code, document, err = cli("score hdr.parquet walk.parquet --json")
    assert (code, err) == (0, "")
    scores = one_document(document)
    assert scores.pop("align") == "none"
    assert set(scores) == SCORES
    assert all(f"{value:.3f}" in out for value in scores.values())
    assert scores["heading_error_final_deg"] < 20
    assert abs(scores["distance_error_pct"]) < 5


def test_anyones_track_can_be_scored(cli, here):
    falls, _ = read_table("walk.footfalls.parquet")
    write_csv("anyone.csv", {name: falls[name] for name in ("heading", "t", "x", "y", "z")})
    code, out, _ = cli("score anyone.csv walk.parquet --json")
    assert code == 0
    assert one_document(out) == pytest.approx(dict.fromkeys(SCORES, 0) | {"align": "none"}, abs=1e-9)


def test_a_track_without_a_true_walk_can_be_scored(cli, here):
    """The walk's own footfalls, as if measured in a frame that is turned by a quarter and shifted."""
    falls, _ = read_table("walk.footfalls.parquet")
    write_csv("prints.csv", {"t": falls["t"], "x": 5 - falls["y"], "y": falls["x"] - 9})
    code, out, err = cli("score hdr.parquet --footprints prints.csv")
    assert (code, err) == (0, "")
    assert "shift and turn fitted" in out
    over = one_document(cli("score hdr.parquet --footprints prints.csv --json")[1])
    assert f"{over['footprint_rmse_m']:.3f}" in out
    aligned = one_document(cli("score hdr.parquet walk.parquet --align rigid --json")[1])
    assert over["footprint_rmse_m"] == pytest.approx(aligned["position_rmse_m"], abs=0.02)
    # The last instant of rest is another one to the truth than to the track, as a shuffle before it may be.
    assert len(falls["t"]) == over["footprints"]
    assert 1 <= over["footprints"] - over["matched"] <= 2

    code, out, err = cli("score hdr.parquet --closed")
    assert (code, err) == (0, "")
    closed = one_document(cli("score hdr.parquet --closed --json")[1])
    track, _ = read_table("hdr.parquet")
    end = np.hypot(track["x"][-1] - track["x"][0], track["y"][-1] - track["y"][0])
    assert closed["return_error_m"] == pytest.approx(end)
    assert f"{end:.3f}" in out


# allan


def test_allan_of_a_simulated_rest_for_people_and_for_programs(cli, here):
    code, out, err = cli("allan --hours 0.1 --unit-seed 4 --figure allan.png")
    assert (code, err) == (0, "")
    code, document, err = cli("allan --hours 0.1 --unit-seed 4 --json")
    assert (code, err) == (0, "")
    found = one_document(document)
    assert found["duration_s"] == pytest.approx(360)
    assert found["angle_random_walk_deg_rt_h"] == pytest.approx(4.4, rel=0.05)  # the sheet's
    assert f"{found['suggested_bias_time_s']:.1f} s" in out
    assert (here / "allan.png").read_bytes().startswith(b"\x89PNG")


def test_allan_of_a_recording(cli, here):
    t = np.arange(6000) / 100
    gyro = np.random.default_rng(5).normal(0, np.radians(1), (6000, 3))  # 0.1 deg/s/sqrt(Hz)
    columns = {"t": t} | {f"gyro_{axis}": gyro[:, i] for i, axis in enumerate("xyz")}
    columns |= dict.fromkeys(("accel_x", "accel_y"), 0 * t) | {"accel_z": 0 * t + 9.81}
    write_table("rest.parquet", columns, {}, {})
    code, out, err = cli("allan rest.parquet --json")
    assert (code, err) == (0, "")
    assert one_document(out)["angle_random_walk_deg_rt_h"] == pytest.approx(6, rel=0.1)
