"""Gates judged over cases, and against baselines; the walks are those of a synthetic foot."""

import json
from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest

from footfall.errors import InputError
from footfall.hdr.methods import METHODS, track
from footfall.scenarios.evaluate import Rows
from footfall.scenarios.studies import gate as gating
from footfall.scenarios.studies.baseline import write_baseline
from footfall.scenarios.studies.gate import cache_key, gate, judge, read_baselines, scored
from footfall.scenarios.studies.gate_file import read_gates
from footfall.tables import META_KEY
from tests.helpers.feet import round_a_block, walk_instead

HEAD = '[cases]\nscenario = "straight"\nunits = 10\n'
HALF = '[[gates]]\nname = "half"\nmethod = "hdr"\nat_most = 15\n'
OTHER = '[[gates]]\nname = "other"\nmethod = "hdr"\nagainst = "pdr"\n'
KEPT = '[[gates]]\nname = "kept"\nmethod = "pdr"\nagainst = "b.parquet"\n'
SAME = '[[gates]]\nname = "same"\nmethod = "pdr"\nagainst = "b.parquet"\nstatistic = "same"\n'


@pytest.fixture(scope="module")
def block():
    return round_a_block(3)


@pytest.fixture
def file(tmp_path, monkeypatch, block):
    """Write gates of this content."""
    walk_instead(monkeypatch, block)

    def writing(text):
        (tmp_path / "gates.toml").write_text(text, encoding="utf-8")
        return tmp_path / "gates.toml"

    return writing


@pytest.fixture
def performed(monkeypatch):
    """Unit seeds of the trials that were performed."""
    seeds = []

    def execute(trials, **keys):
        seeds.extend(trial.unit_seed for trial in trials)
        return original(trials, **keys)

    original = gating.execute
    monkeypatch.setattr(gating, "execute", execute)
    return seeds


def baseline(file, **keys):
    """The scores of the file's methods, in b.parquet."""
    made = read_gates(file, **keys)
    write_baseline(scored(made, range(made.units)), file.parent / "b.parquet")


def test_every_gate_has_its_verdict(file):
    found = gate(file(HEAD + HALF + OTHER))
    assert [verdict.name for verdict in found] == ["half", "other"]
    assert (found[0].verdict, found[0].cases, len(found.rows)) == ("pass", 10, 20)
    errors = {name: found.rows.of(name).values("heading_error_mean_deg") for name in ("hdr", "pdr")}
    assert found[0].estimate == pytest.approx(np.median(errors["hdr"]))
    assert found[0].high == sorted(errors["hdr"])[8]
    assert found[1].estimate == pytest.approx(100 * np.median(errors["hdr"] / errors["pdr"]) - 100, abs=0.01)
    assert found[1].scatter == pytest.approx(np.std(np.log(errors["hdr"] / errors["pdr"]), ddof=1))


def test_exit_codes(file):
    tight = HALF.replace("15", "0.0001").replace("half", "tight")
    assert gate(file(HEAD + HALF + tight)).exit_code == 1
    found = gate(file(HEAD + HALF))
    middle = HALF.replace("15", f"{found[0].estimate}")
    assert gate(file(HEAD + middle)).exit_code == 3
    assert gate(file(HEAD + middle + tight)).exit_code == 1


def test_the_cases_are_units_dealt_to_walks(file, performed):
    found = gate(file(HEAD + HALF))
    assert performed == list(range(1000, 1010))
    assert [row.number for row in found.rows] == [0, 1] * 5
    assert [row.walk_seed for row in found.rows] == [1, 2] * 5
    assert len({row.recording_sha for row in found.rows}) == 10


def test_the_same_against_its_baseline_is_identical(file):
    baseline(path := file(HEAD + KEPT + SAME))
    found = gate(path)
    assert [(one.verdict, one.reason) for one in found] == [("pass", "identical")] * 2
    assert found[0].scatter == 0
    assert len(gate(path, units=6).rows) == 6  # of ten in the baseline


def test_a_change_is_seen_against_a_baseline(file):
    baseline(path := file(HEAD + KEPT + SAME))
    found = gate(path, methods={"pdr": METHODS["hdr"].renamed("mine")})
    assert found[1].verdict == "fail"
    assert found[1].reason.startswith("10 of 10 cases moved")
    assert found[0].reason != "identical"


def test_other_recordings_are_not_compared(file):
    baseline(path := file(HEAD + KEPT))
    sheet = '[set]\n"imu.gyro.angle_random_walk_deg_rt_h" = 9.0\n'
    with pytest.raises(InputError) as caught:
        gate(file(HEAD + sheet + KEPT))
    assert str(caught.value) == (
        f"{path.parent / 'b.parquet'}: was made on other recordings (the same versions, so another scenario, "
        "sheet or machine): make it anew, or compare with a method"
    )


def test_other_versions_are_named(file):
    baseline(path := file(HEAD + KEPT))
    kept = path.parent / "b.parquet"
    table = pq.read_table(kept)
    meta = dict(table.schema.metadata)
    told = json.loads(meta[META_KEY])
    here = told["made"]["numpy"]
    told["made"] |= {"numpy": "2.0.1", "the walker": "another"}
    meta[META_KEY] = json.dumps(told).encode()
    sha = table.column_names.index("recording_sha")
    table = table.set_column(sha, "recording_sha", [["0" * 64] * len(table)])
    pq.write_table(table.replace_schema_metadata(meta), kept)
    with pytest.raises(InputError, match=f"numpy {here} here, 2.0.1 there; another version of the walker"):
        gate(path)


def test_what_a_baseline_lacks_is_told(file):
    path = file(HEAD + KEPT)
    with pytest.raises(InputError, match=r"b\.parquet: no such file"):
        gate(path)
    baseline(path)
    with pytest.raises(InputError, match=r"b\.parquet: no scores of hdr, only of pdr"):
        gate(file(HEAD + KEPT.replace("pdr", "hdr")))
    with pytest.raises(InputError, match="10 cases of pdr, and none of straight, walk seed 1, unit 1010: "):
        gate(file(HEAD.replace("10", "12") + KEPT))
    (path.parent / "b.parquet").write_text("no table")
    with pytest.raises(InputError, match="not a readable Parquet file"):
        gate(path)


def test_a_baseline_is_known_before_any_work(file, performed):
    with pytest.raises(InputError):
        gate(file(HEAD + HALF + KEPT))
    assert performed == []


def test_looks_stop_where_all_is_decided(file, performed):
    path = file(HEAD + HALF)
    found = gate(path, looks=[7, 14, 28])
    assert performed == list(range(1000, 1007))
    assert found.alpha == pytest.approx(0.05 / 3)
    assert (found[0].verdict, found[0].cases, found.gates.units) == ("pass", 7, 7)
    # At 5 %/3 six cases cannot pass: 0.5^6 = 1.6 %, 0.5^5 = 3.1 %.
    performed.clear()
    assert gate(path, looks=[5, 8, 28])[0].cases == 8
    assert performed == list(range(1000, 1008))


def test_a_gate_keeps_the_verdict_of_its_look(file, performed):
    """The one is decided at seven cases, the other never."""
    path = file(HEAD + HALF)
    on = gate(path, units=8)[0].estimate
    found = gate(file(HEAD + HALF + HALF.replace("half", "on").replace("15", f"{on}")), looks=[7, 8])
    assert [(one.verdict, one.cases) for one in found] == [("pass", 7), ("undecided", 8)]
    assert found.exit_code == 3
    assert len(found.rows) == 8


def test_looks_that_cannot_be(file):
    with pytest.raises(InputError, match="looks at 20, 10 cases: expected numbers that increase"):
        gate(file(HEAD + HALF), looks=[20, 10])
    with pytest.raises(
        InputError, match="'half': median needs 6 cases to pass at 2 looks, and the last is at 5"
    ):
        gate(file(HEAD + HALF), looks=[4, 5])


def failing(recording, start):
    """Dead reckoning that some recordings are too much for."""
    if recording.gyro[-1, 0] > 0:
        raise ValueError("positive at the end")
    return track(recording, "pdr", start)


def test_a_method_that_fails_is_infinitely_bad_there(file):
    path = file(HEAD + HALF.replace("hdr", "mine") + KEPT.replace('"b.parquet"', '"mine"'))
    found = gate(path, methods={"mine": failing})
    failures = found.rows.of("mine").failures
    assert 0 < len(failures) < 10
    assert "positive at the end" in failures[0].error
    assert (found[0].failed, found[0].failure) == (len(failures), failures[0].error)
    assert (found[1].failed, found[1].failure) == (0, "")
    assert found[0].high == float("inf")
    assert found[1].low == pytest.approx(-100)  # where it alone failed, pdr is infinitely better


def test_without_a_walk_there_is_no_case(file, monkeypatch):
    def fall(plan, **keys):
        raise InputError("the walker fell at 3 m", plan.name)

    path = file(HEAD + HALF)
    monkeypatch.setattr("footfall.simulate.cache.cached_walk", fall)
    with pytest.raises(InputError, match="the walker fell at 3 m"):
        gate(path)


def test_methods_that_cannot_travel_are_judged_here(file, monkeypatch):
    monkeypatch.setattr("footfall.scenarios.execute.cores", lambda: 2)
    path = file(HEAD + HALF.replace("hdr", "mine"))
    found = gate(path, methods={"mine": lambda recording, start: failing(recording, start)})
    assert len(found.rows) == 10


def test_the_cache_key_is_of_the_walks_alone(file):
    def key(text):
        return cache_key(read_gates(file(text)))

    first = key(HEAD + HALF)
    assert len(first) == 32
    assert key(HEAD + OTHER) == first
    assert key(HEAD + 'imu = "perfect"\n' + HALF) == first
    assert key(HEAD.replace("10", "20") + HALF) == first
    assert key(HEAD + "seed = 2\n" + HALF) != first
    assert key(HEAD + "walks = 1\n" + HALF) != first
    assert key(HEAD + '[set]\n"scenario.gait.pace_m_s" = 1.2\n' + HALF) != first


def test_rows_are_judged_without_performing(file, performed):
    made = read_gates(file(HEAD + HALF))
    rows = Rows(tuple(scored(made, range(10))))
    performed.clear()
    (verdict,) = judge(made, rows, read_baselines(made))
    assert verdict == gate(made)[0]
    (none,) = judge(made, Rows(tuple(replace(row, score=None) for row in rows)), {})
    assert none.verdict == "fail"
