"""Bad input ends in one sentence that names the culprit, exit code 2, and nothing half-written."""

import os
from dataclasses import replace

import numpy as np
import pytest

from footfall.simulate.walk import read_walk, write_walk
from footfall.tables import read_table
from tests.helpers.commands import content, expect_one_sentence, write_csv


@pytest.fixture
def bad(here):
    """The workshop and many a file that cannot be used."""
    short = (here / "short.toml").read_text()

    def scenario(name, old, new):
        assert old in short
        (here / f"{name}.toml").write_text(short.replace(old, new))

    scenario("broken", "[path]", "[path")
    scenario("typo", "pace_m_s = 1.3", "pace_m_s = 1.3\nvariabilty = 0.5")
    scenario("nan", "pace_m_s = 1.3", "pace_m_s = nan")
    scenario(
        "tight",
        'kind = "corner", turn_deg = 90.0, radius_m = 2.5',
        'kind = "arc", turn_deg = 90.0, radius_m = 1.0',
    )
    scenario("rate", "calibration_s = 26.0", "rate_hz = 300")
    scenario("brief", "calibration_s = 26.0", "calibration_s = 10.0")
    scenario("sheetless", 'imu = "nimu"', 'imu = "nimo"')
    (here / "sheet.toml").write_text('name = "x"\n[gyro]\nflicker_deg_h = -1.0\n[accel]\n')
    (here / "folder").mkdir()
    (here / "folder.parquet").mkdir()
    (here / "file").touch()
    (here / "torn.parquet").write_bytes((here / "rec.parquet").read_bytes()[:5000])
    walk = read_walk("walk.parquet")
    write_walk(replace(walk, meta={**walk.meta, "seed": 4}), "elsewhere.parquet")
    (here / "lonely.parquet").write_bytes((here / "walk.parquet").read_bytes())

    rec, _ = read_table("rec.parquet")
    rec = {name: values[::4].copy() for name, values in rec.items()}

    def recording(name, rows=slice(None), **changed):
        write_csv(f"{name}.csv", {key: values[rows] for key, values in (rec | changed).items()})

    def at(row, values, value):
        values = values.copy()
        values[row] = value
        return values

    recording("cut", slice(0, 300))
    recording("one", slice(0, 1))
    recording("walking", slice(1500, None))
    recording("g", **{name: rec[name] / 9.81 for name in ("accel_x", "accel_y", "accel_z")})
    recording("still", slice(0, 1290))
    write_csv("names.csv", {"when" if key == "t" else key: values for key, values in rec.items()})
    write_csv("words.csv", rec | {"t": [f"{t} s" for t in rec["t"]]})

    track, _ = read_table("hdr.parquet")
    write_csv("late.csv", track | {"t": track["t"] + 100})
    write_csv("half.csv", {key: values[:8] for key, values in track.items()})
    write_csv("phone.csv", {"seconds": rec["t"], "ax": rec["accel_x"]})
    write_csv("lost.csv", track | {"x": at(3, track["x"], np.inf)})
    return here


REFUSED = [
    # Words that typer knows nothing of
    ("rnu", "No such command 'rnu'"),
    ("list --jsn", "No such option: --jsn"),
    ("run", "Missing argument"),
    ("walk short.toml", "Missing option '--output' / '-o'"),
    ("run short.toml --walks 0", "'--walks'.* 1, got '0'"),
    ("run short.toml --walks two", "'--walks'.* (integer|whole number), got 'two'"),
    ("run short.toml --walks=two", "'--walks'.* (integer|whole number), got 'two'"),
    ("run folder", "scenario 'folder': a folder, expected a TOML file"),
    ("record walk.parquet -o r.parquet --outdoors -400", "'--outdoors'.* -40, got '-400'"),
    ("record walk.parquet -o r.parquet --set imu.gyro.scale_sigma=1000", "gyro.scale_sigma = 1000.*0.5"),
    ("score hdr.parquet rec.parquet", "rec.parquet: is a recording, expected a walk"),
    ("score rec.parquet walk.parquet", "rec.parquet: is a recording, expected a track"),
    ("score rec.parquet --closed", "rec.parquet: is a recording, expected a track"),
    ("record hdr.parquet -o r.parquet", "hdr.parquet: is a track, expected a walk"),
    (
        "record phone.csv -o r.parquet",
        "phone.csv: is not a walk: its columns are seconds, ax; .*--from-recording",
    ),
    ("parameters thetaw", "no address contains 'thetaw'; did you mean theta_w_deg_s"),
    ("parameters 42", "no address contains '42'; `footfall parameters` lists them all"),
    ("sensitivity nimu-headin", "study 'nimu-headin': neither a stock study .*; did you mean nimu-heading"),
    ("tune hdr-closed", "tuning 'hdr-closed': neither a stock tuning .*; did you mean hdr-closed-loop"),
    ("walk short.toml -o w.parquet --rate nan", "'--rate'.* nan .*finite"),
    ("track rec.parquet -o t.parquet --heading inf", "'--heading'.* inf .*finite"),
    ("track rec.parquet -o t.parquet --method hde --reference nan", "'--reference'.* nan .*finite"),
    ("track rec.parquet -o t.parquet --method hde --directions 0", "'--directions'.* 1"),
    ("allan --hours nan", "'--hours'"),
    # Names
    (
        "run loop",
        r"scenario 'loop': neither a stock scenario .*; did you mean closed-loop or closed-loop-gentle\?",
    ),
    ("run short.toml --methods pdr,magic", "method 'magic' is unknown; expected one of pdr, hdr"),
    ("run short.toml --methods ''", "method '' is unknown"),
    ("run short.toml --imu nimo", r"IMU 'nimo': neither a stock IMU nor a TOML file .*; did you mean nimu\?"),
    (
        "run short.toml --imu sheet.toml",
        r"sheet.toml: gyro.flicker_deg_h = -1.0: expected at least 0",
    ),
    ("walk short.toml -o w.parquet --mount hat", "--mount 'hat' is unknown; expected one of instep"),
    ("record walk.parquet --imu nimo -o r.parquet", "IMU 'nimo'"),
    (
        "record walk.parquet --without magic -o r.parquet",
        "effect 'magic' does not exist; expected one of ",
    ),
    ("track rec.parquet --method magic -o t.parquet", "method 'magic' is unknown"),
    (
        "track rec.parquet --directions 8 -o t.parquet",
        "method 'hdr' goes by no dominant directions; these do: hde",
    ),
    (
        "track rec.parquet --method ihde-learned --reference 30 -o t.parquet",
        "method 'ihde-learned' learns where its dominant directions are",
    ),
    # Scenarios
    ("run broken.toml", "broken.toml: not valid TOML .*line"),
    (
        "run typo.toml",
        "typo.toml: unknown key 'gait.variabilty' = 0.5",
    ),
    ("walk nan.toml -o w.parquet", "nan.toml: gait.pace_m_s = nan: .*finite"),
    ("run tight.toml", r"tight.toml: path.elements no. 2, radius_m = 1: .*less than 1.5 m"),
    ("run rate.toml", "rate.toml: sensor.rate_hz: rate = 300 Hz does not divide the physics rate of 1000 Hz"),
    ("walk short.toml --rate 300 -o w.parquet", "rate = 300 Hz does not divide"),
    (
        "run brief.toml",
        "brief: sensor.calibration_s = 10: a run averages the static bias over sensor.bias_time_s = 25 s",
    ),
    ("run sheetless.toml", "sheetless.toml: IMU '.*nimo': neither"),
    # Where to write
    ("run short.toml --out file", "file: the folder cannot be made .*exists"),
    ("run short.toml --out file/deeper", "file/deeper: the folder cannot be made"),
    ("walk short.toml -o gone/w.parquet", "gone/w.parquet: the folder gone does not exist"),
    ("walk short.toml -o folder.parquet", "folder.parquet: a folder, expected a file"),
    ("walk short.toml -o w.txt", r"w.txt: expected a name that ends in .parquet or .csv"),
    ("record walk.parquet -o folder.parquet", "folder.parquet: a folder"),
    ("record walk.parquet -o walk.parquet", "walk.parquet: would overwrite what it is made from"),
    ("record walk.parquet -o walk.footfalls.parquet", "walk.footfalls.parquet: would overwrite"),
    ("track rec.parquet -o ./rec.parquet", "rec.parquet: would overwrite what it is made from"),
    ("track rec.parquet -o gone/t.parquet", "gone/t.parquet: the folder gone does not exist"),
    ("allan --figure allan.pdf", r"allan.pdf: expected a name that ends in .png"),
    ("allan --figure gone/allan.png", "gone/allan.png: the folder gone does not exist"),
    # What is read
    ("record gone.parquet -o r.parquet", "gone.parquet: no such file"),
    ("record rec.parquet -o r.parquet", "rec.parquet: is a recording, expected a walk"),
    ("record lonely.parquet -o r.parquet", "lonely.footfalls.parquet: no such file"),
    ("track gone.csv -o t.parquet", "gone.csv: no such file"),
    ("track folder -o t.parquet", "folder: a folder, expected a file"),
    ("track torn.parquet -o t.parquet", "torn.parquet: not a readable Parquet file"),
    ("track names.csv -o t.parquet", "names.csv: no column of time, and no rate"),
    ("track words.csv -o t.parquet", "words.csv: column 't' holds '.* s', expected numbers"),
    ("track one.csv -o t.parquet", "one.csv: 1 samples, expected at least 2"),
    ("track cut.csv -o t.parquet", "cut.csv: no stride found"),
    ("track walking.csv --bias-time 3 -o t.parquet", "walking.csv: the IMU moves at t = .* s at rest"),
    ("track still.csv -o t.parquet", "still.csv: no stride found"),
    ("track g.csv -o t.parquet", "g.csv: the accelerometers measure 1.* at rest, expected 9.81"),
    ("track rec.parquet --bias-time -1 -o t.parquet", "--bias-time: bias_s = -1.0, expected a positive"),
    ("score gone.parquet walk.parquet", "gone.parquet: no such file"),
    ("score walk.parquet hdr.parquet", "walk.parquet: is a walk, expected a track"),
    ("score hdr.parquet lonely.parquet", "lonely.footfalls.parquet: no such file"),
    (
        "score hdr.parquet elsewhere.parquet",
        r"hdr.parquet: was made of the walk short \(seed 3, .*\), and cannot be judged .* short \(seed 4,",
    ),
    ("score hdr.parquet", "score: expected one of a walk, --footprints and --closed"),
    ("score hdr.parquet walk.parquet --closed", "score: expected one of a walk, --footprints and --closed"),
    ("score hdr.parquet --closed --align yaw", "--align: is for a walk"),
    ("score hdr.parquet --footprints hdr.csv", "hdr.csv: no such file"),
    ("score hdr.parquet walk.parquet --align se3", "align = 'se3': expected one of none, start, yaw, rigid"),
    ("track walk.parquet -o t.parquet", "walk.parquet: is the truth .*`footfall record walk.parquet --imu"),
    ("record --from-recording walk.parquet -o t.parquet", "walk.parquet: is the truth of a walk"),
    ("allan walk.parquet", "walk.parquet: is the truth of a walk"),
    ("export rec.parquet -o t.tum", "rec.parquet: column 'x' is missing"),
    ("export hdr.parquet --format kml -o t.tum", "format 'kml' is unknown; expected one of tum, kitti, csv"),
    ("export hdr.parquet -o t.parquet", "t.parquet: .*tum"),
    ("score late.csv walk.parquet", "late.csv: .* lies outside the walk"),
    ("score half.csv walk.parquet", "half.csv: .* covers only a part of the walk"),
    ("score lost.csv walk.parquet --json", "lost.csv: x is not finite at row 3"),
    ("allan gone.parquet", "gone.parquet: no such file"),
    ("allan cut.csv --json", "cut.csv: Allan deviation: 6 s at rest, expected at least 10 s"),
    ("allan --imu perfect --hours 0.05 --figure a.png", "perfect: Allan deviation: .*one constant"),
]


@pytest.mark.parametrize(("line", "culprit"), REFUSED, ids=[line for line, _ in REFUSED])
def test_a_mistake_ends_in_one_sentence_and_leaves_nothing(cli, bad, line, culprit):
    before = content(bad)
    expect_one_sentence(*cli(line), culprit)
    assert content(bad) == before


def test_a_folder_without_leave_to_write_is_refused(cli, here, monkeypatch):
    monkeypatch.setattr(os, "access", lambda path, mode: mode != os.W_OK)  # root may always
    (here / "theirs").mkdir()
    for line in (
        "run short.toml --out theirs",
        "walk short.toml -o theirs/w.parquet",
        "record walk.parquet -o theirs/r.parquet",
        "track rec.parquet -o theirs/t.parquet",
        "allan --figure theirs/a.png",
    ):
        expect_one_sentence(*cli(line), "the folder (theirs )?cannot be written")


def test_a_fall_is_told_and_leaves_nothing(cli, here, monkeypatch):
    from footfall.models.policy import Policy, stock_policy

    stock = stock_policy()
    lame = Policy(stock.weights, stock.biases, np.zeros(32), "lame")
    monkeypatch.setattr("footfall.simulate.cache.stock_policy", lambda: lame)
    before = content(here)
    fell = r"short: the walker fell at -?\d+ m"
    expect_one_sentence(*cli("walk short.toml -o w.parquet"), fell)
    expect_one_sentence(*cli("run short.toml --walks 1 --units 0 --noises 0 --out new/deep --json"), fell)
    assert content(here) == before


def full(*_, **__):
    raise OSError(28, "No space left on device")


def test_a_full_disk_is_told_and_leaves_nothing(cli, here, monkeypatch):
    before = content(here)
    monkeypatch.setattr("footfall.tables.pq.write_table", full)
    for line in (
        "walk short.toml -o w.parquet",
        "record walk.parquet -o r.parquet",
        "track rec.parquet -o t.parquet",
        "run short.toml --walks 1 --units 0 --out new",
    ):
        expect_one_sentence(*cli(line), r"parquet: cannot be written \(No space left on device\)")
    assert content(here) == before


def test_any_trouble_of_the_machine_is_told_in_a_sentence(cli, here, monkeypatch):
    monkeypatch.setattr("footfall.pdr.track.write_track", full)
    expect_one_sentence(*cli("track rec.parquet -o t.parquet"), "No space left on device")


def interrupt(*_, **__):
    raise KeyboardInterrupt


@pytest.mark.parametrize(
    ("line", "where"),
    [
        ("walk short.toml --no-cache -o w.parquet", "footfall.simulate.walking._physics"),
        ("run short.toml --walks 1 --units 0 --out new", "footfall.scenarios.report.results.run_figures"),
        ("track rec.parquet -o t.parquet", "footfall.tables.pq.write_table"),
    ],
)
def test_an_interrupt_leaves_nothing(cli, here, monkeypatch, line, where):
    before = content(here)
    monkeypatch.setattr(where, interrupt)
    assert cli(line) == (130, "", "footfall: interrupted\n")
    assert content(here) == before
