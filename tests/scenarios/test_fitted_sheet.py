"""A sheet that is fitted to a rest is that of the sensor which rested."""

from types import SimpleNamespace

import numpy as np
import pytest

from footfall.errors import InputError
from footfall.models.imu import draw_unit, load_spec
from footfall.recording import Recording, write_recording
from footfall.scenarios.fitted_sheet import noise_of, resolution_of, sheet_text, write_sheet
from footfall.scenarios.report.allan import resting_recording
from tests.helpers.commands import content, expect_one_sentence


@pytest.mark.parametrize("name", ["mtig710", "consumer"])
def test_the_noises_of_a_sheet_are_found_again(name, tmp_path):
    """An hour at rest; flicker within 40 %, since few averages are that long."""
    spec = load_spec(name)
    resting = resting_recording(draw_unit(spec, 3), 3600, 3, rate_hz=100)
    write_sheet(resting, "mine", "rest.parquet", tmp_path / "mine.toml")
    found = load_spec(tmp_path / "mine.toml")
    for mine, true in ((found.gyro, spec.gyro), (found.accel, spec.accel)):
        assert mine.white == pytest.approx(true.white, rel=0.1)
        assert mine.flicker == pytest.approx(true.flicker, rel=0.4)
        assert mine.scale_sigma == 0
        assert mine.range == np.inf
    bias = resting.gyro.mean(axis=0)
    assert found.gyro.turn_on_sigma == pytest.approx(np.sqrt(bias @ bias / 3), rel=1e-3)


def test_the_floor_of_the_allan_deviation_is_two_thirds_of_the_flicker(monkeypatch):
    """IEEE Std 952: sigma = 0.664 B. What a simulation tells of it scatters far more."""
    found = SimpleNamespace(white=0.0, floor=0.664, random_walk=0.0)
    monkeypatch.setattr("footfall.scenarios.fitted_sheet.fit_allan", lambda x, interval: found)
    values = np.random.default_rng(1).normal(size=(100, 3))  # of no resolution
    assert noise_of(values, 0.01) == {"flicker": pytest.approx(1.0, abs=1e-3)}


def test_the_resolution_is_the_step_of_what_is_written():
    rng = np.random.default_rng(1)
    x = rng.normal(0, 1, (5000, 3))
    assert resolution_of(np.round(x / 0.05) * 0.05) == pytest.approx(0.05)
    assert resolution_of(x) == 0
    assert resolution_of(np.zeros((10, 3))) == 0


def test_a_name_is_no_toml():
    rest = resting_recording(draw_unit(load_spec("nimu"), 1), 20, 1)
    assert "name = \"a 'b'\"" in sheet_text(rest, 'a "b"', "c.csv")


def test_the_command(cli, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_recording(resting_recording(draw_unit(load_spec("nimu"), 1), 60, 1), "rest.parquet")
    code, _, err = cli("allan rest.parquet --sheet mine.toml")
    assert code == 0
    assert err.startswith("mine.toml: the noises of rest.parquet;")
    assert load_spec("mine.toml").name == "mine"
    short = Recording(np.arange(100) / 100, np.ones((100, 3)), np.tile([0, 0, 9.8], (100, 1)))
    write_recording(short, "short.parquet")
    before = content(tmp_path)
    for line, culprit in (
        ("allan --sheet a.toml", "--sheet: expected a recording at rest"),
        ("allan rest.parquet --sheet a.csv", r"a\.csv: expected a name that ends in \.toml"),
        ("allan short.parquet --sheet a.toml", r"short\.parquet"),
    ):
        expect_one_sentence(*cli(line), culprit)
    assert content(tmp_path) == before
    with pytest.raises(InputError, match="at rest"):
        sheet_text(short, "a", "b")
