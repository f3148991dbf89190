"""Files of gates: what they mean, and how their mistakes are told."""

import pytest

from footfall.errors import InputError
from footfall.hdr.methods import METHODS
from footfall.scenarios.studies.gate_file import is_uncorrected, read_gates, stock_gates

CASES = '[cases]\nscenario = "straight"\n'
GATE = '[[gates]]\nname = "a gate"\nmethod = "hdr"\nat_most = 15\n'
AGAINST = '[[gates]]\nname = "a gate"\nmethod = "hdr"\nagainst = "pdr"\n'


@pytest.fixture
def read(tmp_path):
    """Read gates of this content."""

    def reading(text, **keys):
        file = tmp_path / "gates.toml"
        file.write_text(text, encoding="utf-8")
        return read_gates(file, **keys)

    return reading


def test_what_a_file_leaves_out_is_the_scenarios(read):
    found = read(CASES + GATE)
    assert (found.name, found.units, found.walks, found.seed) == ("gates", 60, 2, 1)
    assert [method.name for method in found.setup.methods] == ["hdr"]
    assert found.setup.imu == "nimu"
    assert found.gates[0].metrics == ("heading_error_mean_deg",)


def test_what_a_file_says(read):
    found = read(
        'description = "all of it"\n' + CASES + 'imu = "perfect"\nwalks = 3\nseed = 7\nunits = 33\n'
        '[set]\n"pdr.tilt_gain" = 0.1\n"hdr.theta_w_deg_s" = 0.3\n' + AGAINST
    )
    assert (found.units, found.walks, found.seed, found.setup.imu) == (33, 3, 7, "perfect")
    assert found.setup.pdr.tilt_gain == 0.1
    hdr, pdr = found.setup.methods
    assert hdr.params != METHODS["hdr"].params
    assert pdr.name == "pdr"


def test_an_uncorrected_heading_is_gated_with_ten_cases_and_two_percent(read):
    found = read(CASES + '[[gates]]\nname = "a gate"\nmethod = "iez"\nagainst = "pdr"\n')
    assert found.units == 10
    assert found.margin_percent(found.gates[0]) == 2
    found = read(CASES + AGAINST)
    assert found.units == 60
    assert found.margin_percent(found.gates[0]) == 10
    found = read(
        CASES + '[[methods]]\nname = "mine"\nuse = "pdr"\n'
        '[[gates]]\nname = "a gate"\nmethod = "mine"\nagainst = "b.parquet"\n'
    )
    assert found.units == 10
    assert found.margin_percent(found.gates[0]) == 2
    names = {name for name, method in METHODS.items() if is_uncorrected(method)}
    assert names == {"pdr", "iez", "iez-paper"}


def test_what_a_file_names_lies_beside_it(read, tmp_path, monkeypatch):
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    monkeypatch.chdir(folder)
    (tmp_path / "nav.py").write_text("def mine(recording, start): ...\n", encoding="utf-8")
    text = '[[methods]]\nname = "mine"\nuse = "nav.py:mine"\n[[gates]]\nname = "g"\nmethod = "mine"\n'
    found = read(CASES + text + 'against = "b.parquet"\n')
    assert found.setup.methods[0].name == "mine"
    assert found.baseline(found.gates[0]) == tmp_path / "b.parquet"
    with pytest.raises(InputError, match=r"gates\.toml: scenario 'paths.toml': neither"):
        read('[cases]\nscenario = "paths.toml"\n' + GATE)


def test_methods_can_be_given(read):
    found = read(
        CASES + '[[gates]]\nname = "g"\nmethod = "mine"\nat_most = 1\n', methods={"mine": METHODS["pdr"]}
    )
    assert found.setup.methods[0].name == "mine"


def test_quick_is_twenty_cases_or_as_many_as_a_gate_needs(read):
    assert read(CASES + GATE).quick().units == 20
    assert read(CASES + "units = 12\n" + GATE).quick().units == 12
    found = read(CASES + GATE + '[[gates]]\nname = "b"\nmethod = "hdr"\nstatistic = "p90"\nat_most = 40\n')
    assert found.quick().units == 29
    with pytest.raises(
        InputError, match=r"gates.toml: gate 'b': p90 needs 29 cases to pass, and there are 28"
    ):
        found.with_units(28)


MISTAKES = {
    "no gates": (CASES, "key 'gates' is missing"),
    "no cases": (GATE, "key 'cases' is missing"),
    "unknown key": (CASES + "unit = 3\n" + GATE, "unknown key 'cases.unit' = 3"),
    "unknown scenario": ('[cases]\nscenario = "strait"\n' + GATE, "strait"),
    "unknown method": (
        CASES + GATE.replace('"hdr"', '"hrd"'),
        r"method 'hrd': unknown; did you mean hdr\?",
    ),
    "unknown metric": (
        CASES + GATE + 'metric = "heading_error_deg"\n',
        r"gates no. 1, metric = 'heading_error_deg': unknown; did you mean heading_error_",
    ),
    "unknown statistic": (
        CASES + GATE + 'statistic = "mean"\n',
        r"gates no. 1, statistic = 'mean': unknown; ",
    ),
    "no limit": (CASES + GATE.replace("at_most = 15", ""), "'a gate': a gate without against needs at_most"),
    "limit and other": (
        CASES + AGAINST + "at_most = 3\n",
        "'a gate': a gate against another takes no at_most",
    ),
    "margin of nothing": (
        CASES + GATE + "margin_percent = 3\n",
        "a gate without against takes no margin_perc",
    ),
    "quantile of ratios": (
        CASES + AGAINST + 'statistic = "p90"\n',
        r'statistic = "p90": a gate against another takes "median" or "same"',
    ),
    "same as nothing": (
        CASES + '[[gates]]\nname = "a gate"\nmethod = "hdr"\nstatistic = "same"\n',
        "'a gate': statistic = \"same\" needs against",
    ),
    "share of what": (
        CASES + '[[gates]]\nname = "a gate"\nmethod = "hdr"\nstatistic = "share_below"\nbelow = 3\n',
        "'a gate': statistic = \"share_below\" needs at_least_percent",
    ),
    "itself": (CASES + AGAINST.replace('"pdr"', '"hdr"'), "gate 'a gate': hdr against itself"),
    "a name twice": (CASES + GATE + GATE, "two gates are called 'a gate'"),
    "a method twice": (
        CASES + '[[methods]]\nname = "m"\nuse = "pdr"\n[[methods]]\nname = "m"\nuse = "hdr"\n' + GATE,
        "two methods are called 'm'",
    ),
    "a missing file": (
        CASES + '[[methods]]\nname = "mine"\nuse = "nav.py:mine"\n' + GATE.replace('"hdr"', '"mine"'),
        "nav.py: cannot be read",
    ),
    "unknown address": (
        CASES + '[set]\n"pdr.tilt" = 3\n' + GATE,
        r"pdr\.tilt: unknown; did you mean pdr.tilt_g",
    ),
    "refused value": (CASES + '[set]\n"pdr.tilt_gain" = 3\n' + GATE, r"pdr\.tilt_gain = 3: expected"),
    "too few for p95": (
        CASES + "units = 58\n" + GATE + 'statistic = "p95"\n',
        "gate 'a gate': p95 needs 59 cases to pass, and there are 58 units",
    ),
    "too few for a median": (
        CASES + "units = 4\n" + GATE,
        "median needs 5 cases to pass, and there are 4 units",
    ),
    "not TOML": ("[cases\n", "not valid TOML"),
    "no number": (CASES + GATE.replace("at_most = 15", "at_most = nan"), "at_most"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_one_sentence_that_names_the_file(read, tmp_path, mistake):
    text, said = MISTAKES[mistake]
    with pytest.raises(InputError, match=said) as caught:
        read(text)
    told = str(caught.value)
    assert told.startswith(str(tmp_path / "gates.toml"))
    assert len(told.splitlines()) == 1


def test_a_name_is_that_of_gates_that_come_with_footfall():
    for name in stock_gates():
        assert read_gates(name).name == f"{name}.gates"
    with pytest.raises(InputError, match="closed-lop: gates are a TOML file"):
        read_gates("closed-lop")
