"""The recording that comes with the package makes README's tour run as it stands."""

import json


def test_the_sample_is_looked_into_tracked_and_scored(cli, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert cli("sample")[0] == 0
    code, out, _ = cli("inspect walk.csv --json")
    assert (code, json.loads(out)["refused"]) == (0, "")
    code, _, err = cli("track walk.csv -o track.parquet")
    assert code == 0, err
    assert "warning" not in err
    assert "20 footfalls" in err
    code, out, _ = cli("score track.parquet --footprints footprints.csv --json")
    assert code == 0
    assert json.loads(out)["footprint_rmse_m"] < 0.3
