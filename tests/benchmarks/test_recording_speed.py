"""The benchmark of recording runs, and tells each effect's cost beside the kernel's."""

import json

from benchmarks.speed import recording
from footfall.models.imu import EFFECTS


def test_it_prices_every_effect_beside_the_strapdown_kernel(tmp_path, capsys):
    recording.main(["--minutes", "0.2", "--json", str(tmp_path / "speed.json")])
    figures = json.loads((tmp_path / "speed.json").read_text())
    assert figures["strapdown_ns"] > 0
    assert set(EFFECTS) < set(figures["ns"])
    assert all(cost > 0 for cost in figures["ns"].values())
    assert 64 < figures["peak_bytes"] < 100
    assert "record, all effects" in capsys.readouterr().out


def test_its_unit_has_every_effect():
    unit = recording.complete_unit()
    for triad in (unit.gyro, unit.accel):
        assert triad.non_linearity.any()
        assert triad.temperature2.any()
