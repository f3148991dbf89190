"""`footfall gate` from the command line; the walks are those of a synthetic foot."""

import json
from xml.etree import ElementTree as xml

import pyarrow.parquet as pq
import pytest

from footfall.scenarios.studies.gate_file import stock_gates
from tests.helpers.commands import expect_one_sentence, one_document
from tests.helpers.feet import round_a_block, walk_instead

GATES = """
description = "what is promised"
[cases]
scenario = "straight"
units = 8
[[gates]]
name = "HDR is good | for <half>"
method = "hdr"
at_most = 15.0
[[gates]]
name = "and no worse"
method = "hdr"
against = "pdr"
margin_percent = 500
"""
TIGHT = '[[gates]]\nname = "tight"\nmethod = "hdr"\nat_most = 0.001\n'
OPEN = '[[gates]]\nname = "open"\nmethod = "hdr"\nstatistic = "p75"\nat_most = 1\n'


@pytest.fixture(scope="module")
def block():
    return round_a_block(3)


@pytest.fixture
def gates(tmp_path, monkeypatch, block):
    """gates.toml in the working folder; more is put to its end."""
    walk_instead(monkeypatch, block)
    monkeypatch.chdir(tmp_path)

    def writing(more=""):
        (tmp_path / "gates.toml").write_text(GATES + more, encoding="utf-8")

    writing()
    return writing


def test_people_get_a_table_and_the_folder(gates, cli, tmp_path):
    code, out, err = cli("gate gates.toml")
    assert code == 0
    lines = out.splitlines()
    assert lines[0] == "straight: 8 units on 2 walks, nimu, seeds 1.. / 1000.."
    assert all(word in lines[1] for word in ("gate", "estimate", "95 % bounds", "limit", "verdict"))
    assert any("<= 15 deg" in line and line.rstrip().endswith("pass") for line in lines)
    assert any("<= +500 %" in line for line in lines)
    assert "hdr against pdr: log ratios scatter by" in out
    assert "heading_error_mean_deg" in out
    assert err.splitlines()[-1] == "Verdicts and cases are in out/gates"
    folder = tmp_path / "out" / "gates"
    assert sorted(file.name for file in folder.iterdir()) >= ["cases.parquet", "gate.json"]
    table = pq.read_table(folder / "cases.parquet")
    assert set(table["method"].to_pylist()) == {"hdr", "pdr"}
    assert len(table) == 16


def test_programs_get_one_document(gates, cli, tmp_path):
    code, out, _ = cli("gate gates.toml --units 9 --json")
    assert code == 0
    found = one_document(out)
    assert found == json.loads((tmp_path / "out" / "gates" / "gate.json").read_text())
    assert found["format"] == "footfall gate 1"
    assert found["name"] == "gates"
    assert found["command"] == "footfall gate gates.toml --units 9"
    assert found["cases"] == {
        "scenario": "straight",
        "walks": 2,
        "units": 9,
        "seeds": {"walks": 1, "units": 1000},
        "imu": "nimu",
    }
    assert found["exit_code"] == 0
    first, second = found["gates"]
    assert set(first) >= {
        "name", "method", "against", "metric", "unit", "statistic", "estimate", "low", "high", "limit",
        "verdict", "reason", "needed", "scatter",
    }  # fmt: skip
    assert (first["verdict"], first["against"], first["limit"], first["cases"]) == ("pass", None, 15, 9)
    assert first["low"] < first["estimate"] < first["high"] < 15
    assert (second["against"], second["unit"], second["limit"]) == ("pdr", "%", 500)


def test_what_has_no_bound_is_null(gates, cli):
    gates(OPEN.replace("p75", "share_below").replace("at_most = 1", "below = 100\nat_least_percent = 66"))
    code, out, _ = cli("gate gates.toml --json")
    assert code == 0
    assert one_document(out)["gates"][2]["high"] == 100
    gates(TIGHT.replace("0.001", "1e-9"))
    code, out, _ = cli("gate gates.toml --json --sequential 4,9")
    document = one_document(out)
    assert document["confidence"] == 0.975
    assert document["gates"][2]["verdict"] == "fail"


def test_a_failed_gate_is_exit_code_1(gates, cli):
    gates(TIGHT)
    code, out, _ = cli("gate gates.toml")
    assert code == 1
    assert "fail" in out


def test_an_undecided_gate_is_exit_code_3_and_says_how_many_cases_would_decide(gates, cli):
    gates(OPEN.replace("p75", "median"))
    code, out, _ = cli("gate gates.toml --json")
    estimate = one_document(out)["gates"][2]["estimate"]
    gates(OPEN.replace("p75", "median").replace("at_most = 1", f"at_most = {estimate * 1.001}"))
    code, out, _ = cli("gate gates.toml")
    assert code == 3
    assert " ".join(out.split()).count("undecided: open: 8 cases cannot tell") == 1
    gates(TIGHT + OPEN.replace("p75", "median").replace("at_most = 1", f"at_most = {estimate * 1.001}"))
    assert cli("gate gates.toml")[0] == 1


def test_junit_has_an_error_where_it_is_undecided(gates, cli, tmp_path):
    gates(TIGHT)
    _, out, _ = cli("gate gates.toml --json")
    estimate = one_document(out)["gates"][0]["estimate"]
    gates(TIGHT + OPEN.replace("p75", "median").replace("at_most = 1", f"at_most = {estimate * 1.001}"))
    assert cli("gate gates.toml --junit gates.xml")[0] == 1
    (suite,) = xml.parse(tmp_path / "gates.xml").getroot()
    assert {name: suite.get(name) for name in ("name", "tests", "failures", "errors", "skipped")} == {
        "name": "gates", "tests": "4", "failures": "1", "errors": "1", "skipped": "0"
    }  # fmt: skip
    cases = {case.get("name"): case for case in suite}
    assert list(cases) == ["HDR is good | for <half>", "and no worse", "tight", "open"]
    assert [child.tag for child in cases["and no worse"]] == ["system-out"]
    assert [child.tag for child in cases["tight"]] == ["failure"]
    (error,) = cases["open"]
    assert (error.tag, error.get("type")) == ("error", "undecided")
    assert "cannot tell" in error.get("message")


def test_markdown_is_put_to_the_end(gates, cli, tmp_path):
    (tmp_path / "summary.md").write_text("before\n")
    cli("gate gates.toml --markdown summary.md")
    cli("gate gates.toml --markdown summary.md")
    lines = (tmp_path / "summary.md").read_text().splitlines()
    assert lines[0] == "before"
    assert lines.count("### Gates: gates") == 2
    rows = [line for line in lines if line.startswith("| HDR is good \\| for &lt;half>")]
    assert len(rows) == 2
    assert rows[0].endswith("| pass |")


def test_a_baseline_is_recorded_and_held(gates, cli, tmp_path):
    gates('[[gates]]\nname = "nothing moved"\nmethod = "hdr"\nagainst = "kept.parquet"\nstatistic = "same"\n')
    expect_one_sentence(*cli("gate gates.toml"), r"kept\.parquet: no such file")
    code, out, err = cli("gate gates.toml --record kept.parquet")
    assert (code, out) == (0, "")
    assert err.splitlines()[-1] == "Scores of hdr, pdr are in kept.parquet"
    assert not (tmp_path / "out").exists()
    first = (tmp_path / "kept.parquet").read_bytes()
    code, out, _ = cli("gate gates.toml")
    assert code == 0
    assert "0 of 8 moved" in out
    cli("gate gates.toml --record again.parquet")
    assert (tmp_path / "again.parquet").read_bytes() == first
    # The cases of a gate are a baseline, too.
    assert (tmp_path / "out" / "gates" / "cases.parquet").read_bytes() == first


def test_the_cache_key_is_one_line(gates, cli, tmp_path):
    code, out, err = cli("gate gates.toml --cache-key")
    assert (code, err) == (0, "")
    assert len(out.strip()) == 32
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("line", "culprit"),
    [
        ("gate nothing.toml", r"nothing\.toml: cannot be read"),
        ("gate nothing", "nothing: gates are a TOML file"),
        ("gate gates.toml --units 4", "gates.toml: gate 'HDR is good .* needs 5 cases"),
        ("gate gates.toml --units 8 --quick", "--units, --quick and --sequential: expected one of them"),
        ("gate gates.toml --sequential 9,8", "looks at 9, 8 cases"),
        ("gate gates.toml --sequential often", "--sequential often: expected numbers of cases"),
        ("gate gates.toml --junit gates.json", r"gates\.json: expected a name that ends in \.xml"),
        ("gate gates.toml --record nowhere/b.parquet", "the folder nowhere does not exist"),
        ("gate gates.toml --markdown .", "a folder, expected a file to write"),
        ("gate gates.toml --out gates.toml", "gates.toml"),
    ],
)
def test_mistakes_are_one_sentence(gates, cli, tmp_path, line, culprit):
    before = {file.name for file in tmp_path.rglob("*")}
    code, out, err = cli(line)
    said = [one for one in err.splitlines() if one.startswith("footfall: ")]
    expect_one_sentence(code, out, "".join(f"{one}\n" for one in said), culprit)
    assert {file.name for file in tmp_path.rglob("*")} == before


def test_quick_is_of_fewer_cases(gates, cli):
    _, out, _ = cli("gate gates.toml --quick --json")
    assert one_document(out)["cases"]["units"] == 8


def test_gates_that_come_with_footfall_are_listed(cli):
    code, out, _ = cli("gate list")
    assert code == 0
    assert any(line.split()[:1] == ["closed-loop"] and "HDR" in line for line in out.splitlines())
    assert set(one_document(cli("gate list --json")[1])) == set(stock_gates())
