"""`footfall scenario from`: what it writes, says and refuses."""

from tests.helpers.commands import content, expect_one_sentence


def test_a_scenario_and_its_map(cli, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "way.csv").write_text("x,y\n0,0\n40,0\n40,30\n")
    code, out, err = cli("scenario from way.csv -o mine.toml --figure map.png")
    assert (code, out) == (0, "")
    assert err == "mine.toml: path of 69 m: 2 straights, 1 corner; at most 0.6 m off the 3 points\n"
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")


def test_heights_that_the_path_leaves_out_are_told(cli, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "hill.csv").write_text("x,y,z\n0,0,3\n40,0,\n40,30,7.25\n")
    (tmp_path / "flat.csv").write_text("x,y,z\n0,0,3\n40,0,3\n40,30,3.01\n")
    code, _, err = cli("scenario from hill.csv -o hill.toml")
    assert (code, err.strip().endswith("3 points; level, although heights differ by 4.2 m")) == (0, True), err
    assert "although heights differ by 4.2 m" in (tmp_path / "hill.toml").read_text().splitlines()[0]
    code, _, err = cli("scenario from flat.csv -o flat.toml")
    assert (code, err.strip().endswith("3 points")) == (0, True), err


def test_nothing_is_written_of_what_cannot_be_walked(cli, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "way.csv").write_text("x,y\n0,0\n40,0\n0,0\n")
    before = content(tmp_path)
    for line, culprit in (
        ("way.csv -o mine.toml", r"way\.csv: point no\. 2: the way turns back on itself"),
        ("way.csv -o mine.csv", r"mine\.csv: expected a name that ends in \.toml"),
        ("way.csv -o mine.toml --figure a.pdf", r"a\.pdf: expected a name that ends in \.png"),
        ("other.gpx -o mine.toml", r"other\.gpx: cannot be read"),
        ("way.csv -o mine.toml --tolerance nan", "got 'nan'"),
    ):
        expect_one_sentence(*cli(f"scenario from {line}"), culprit)
    assert content(tmp_path) == before
