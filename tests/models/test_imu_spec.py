"""Data sheets and the units drawn from them."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.stats import chi2

from footfall.errors import InputError
from footfall.models.imu import ImuSpec, TriadSpec, draw_unit, load_spec, stock_specs
from footfall.streams import stream

SIGMAS = {
    "scale": "scale_sigma",
    "misalignment": "misalignment_sigma",
    "non_linearity": "non_linearity_sigma",
    "g": "g_sigma",
    "g2": "g2_sigma",
    "temperature": "temperature_sigma",
    "temperature2": "temperature2_sigma",
}
FULL = ImuSpec(
    "full",
    gyro=TriadSpec(range=1.0, **dict.fromkeys(SIGMAS.values(), 1.0)),
    accel=TriadSpec(range=1.0, **{name: 1.0 for name in SIGMAS.values() if name != "g_sigma"}),
)


def test_perfect_has_no_error_at_all():
    assert load_spec("perfect") == ImuSpec("perfect")


def test_nimu_in_si_units():
    spec = load_spec("nimu")
    assert spec.gyro.range == pytest.approx(20.94395)  # 1,200 deg/s
    # 4.4 deg/rt-h walk by 4.4 deg in an hour.
    assert math.degrees(spec.gyro.white * math.sqrt(3600)) == pytest.approx(4.4)
    assert math.degrees(spec.gyro.flicker) * 3600 == pytest.approx(80)
    assert math.degrees(spec.gyro.random_walk * 3600 * math.sqrt(3600)) == pytest.approx(30)
    assert math.degrees(spec.gyro.g_sigma * 9.80665) == pytest.approx(0.15)
    assert math.degrees(spec.gyro.g2_sigma * 9.80665**2) == pytest.approx(5e-4)
    assert math.degrees(spec.gyro.temperature_sigma) == pytest.approx(0.011)
    assert spec.accel.range == pytest.approx(147.09975)
    assert spec.accel.white == pytest.approx(80e-6 * 9.80665)
    assert spec.accel.random_walk * 60 == pytest.approx(100e-6 * 9.80665)
    # 100 ug/g2: one g of vibration makes 100 ug.
    assert spec.accel.g2_sigma * 9.80665**2 == pytest.approx(100e-6 * 9.80665)
    assert spec.thermal.reported
    assert spec.thermal.time_constant == 600


def test_non_linearity_of_the_second_papers_table_1():
    """0.03 % of full scale of the accelerometers, 0.01 % of the gyros; none is published of the first's."""
    spec = load_spec("mtig710")
    assert spec.accel.non_linearity_sigma * spec.accel.range == pytest.approx(0.0003 * 15 * 9.80665)
    assert math.degrees(spec.gyro.non_linearity_sigma * spec.gyro.range) == pytest.approx(0.1)
    nimu = load_spec("nimu")
    assert nimu.gyro.non_linearity_sigma == nimu.accel.non_linearity_sigma == 0


def test_every_stock_sheet_loads_and_draws():
    assert {"nimu", "perfect"} <= set(stock_specs())
    for name in stock_specs():
        assert draw_unit(load_spec(name), 0).spec.name


def test_a_users_sheet_works_where_a_stock_name_does(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text('name = "mine"\n[gyro]\nrange_deg_s = 500\n[accel]\n')
    assert load_spec(path) == load_spec(str(path))
    assert load_spec(path).gyro == TriadSpec(range=math.radians(500))


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ('name = "a"\n[gyro]\nrange_degs = 1\n[accel]\n', ["gyro.range_degs", "1"]),
        ('name = "a"\n[gyro]\nflicker_deg_h = -80.0\n[accel]\n', ["gyro.flicker_deg_h", "-80.0"]),
        ('name = "a"\n[gyro]\nflicker_deg_h = nan\n[accel]\n', ["gyro.flicker_deg_h", "nan"]),
        ('name = "a"\n[gyro]\n[accel]\nrange_g = "15"\n', ["accel.range_g", "'15'"]),
        ('name = "a"\n[gyro]\n[accel]\nrange_g = 0\n', ["accel.range_g", "0"]),
        ('name = "a"\n[gyro]\n[accel]\n[thermal]\nreported = 1\n', ["thermal.reported", "1"]),
        (
            'name = "a"\n[gyro]\n[accel]\nnon_linearity_sigma_percent_fs = 0.03\n',
            ["accel", "0.0003", "no range"],
        ),
        ('name = "a"\n[gyro]\n', ["accel", "missing"]),
        ("[gyro]\n[accel]\n", ["name", "missing"]),
        ('name = "a\n', ["not valid TOML"]),
    ],
)
def test_a_bad_sheet_is_refused_by_file_key_and_value(tmp_path, text, named):
    path = tmp_path / "bad.toml"
    path.write_text(text)
    with pytest.raises(InputError) as error:
        load_spec(path)
    message = str(error.value)
    assert all(word in message for word in [str(path), *named]), message
    assert "\n" not in message


def test_an_unknown_imu_is_refused_with_the_stock_names():
    with pytest.raises(InputError, match=r"'nimo'.*; did you mean nimu\?"):
        load_spec("nimo")
    with pytest.raises(InputError, match=r"'acme'.*; expected one of .*nimu.*perfect"):
        load_spec("acme")


def test_the_same_seed_draws_the_same_unit_and_another_seed_another():
    a, b, c = draw_unit(FULL, 7), draw_unit(FULL, 7), draw_unit(FULL, 8)
    for sensor in ("gyro", "accel"):
        for name in SIGMAS:
            first, again, other = (getattr(getattr(unit, sensor), name) for unit in (a, b, c))
            np.testing.assert_array_equal(first, again)
            assert not first.any() or not np.array_equal(first, other)


@pytest.mark.parametrize("name", SIGMAS)
def test_each_constant_has_its_own_draw(name):
    """Taking one error out of a sheet leaves all others of its units as they were."""
    less = dataclasses.replace(FULL, gyro=dataclasses.replace(FULL.gyro, **{SIGMAS[name]: 0.0}))
    full, without = draw_unit(FULL, 3), draw_unit(less, 3)
    assert getattr(full.gyro, name).any()
    assert not getattr(without.gyro, name).any()
    for other in set(SIGMAS) - {name}:
        np.testing.assert_array_equal(getattr(full.gyro, other), getattr(without.gyro, other))
    np.testing.assert_array_equal(full.accel.scale, without.accel.scale)


def test_no_two_constants_share_a_draw():
    unit = draw_unit(FULL, 0)
    values = np.concatenate(
        [getattr(sensor, name).ravel() for sensor in (unit.gyro, unit.accel) for name in SIGMAS]
    )
    values = values[values != 0]
    assert len(np.unique(values)) == len(values)


def test_which_elements_a_sensor_has():
    unit = draw_unit(FULL, 0)
    assert np.count_nonzero(unit.gyro.g) == 9
    assert not np.diag(unit.gyro.misalignment).any()
    assert not unit.accel.g.any()
    np.testing.assert_array_equal(unit.accel.g2, np.diag(np.diag(unit.accel.g2)))


@pytest.mark.parametrize("name", SIGMAS)
def test_units_scatter_as_the_sheet_says(name):
    """Sum of squares over 200 units against chi squared, two-sided 1e-4."""
    sigma = 0.3
    spec = ImuSpec("one", gyro=TriadSpec(range=1.0, **{SIGMAS[name]: sigma}))
    drawn = np.array([getattr(draw_unit(spec, seed).gyro, name) for seed in range(200)])
    values = drawn[drawn != 0]
    low, high = chi2.ppf([5e-5, 1 - 5e-5], len(values))
    assert low < np.sum((values / sigma) ** 2) < high
    assert abs(values.mean()) < 4 * sigma / math.sqrt(len(values))


@pytest.mark.parametrize("seed", [-1, 1.5, True, "1"])
def test_a_seed_that_is_none_is_refused(seed):
    with pytest.raises(InputError, match="seed"):
        draw_unit(FULL, seed)


def test_streams_are_reproducible_and_apart():
    assert stream(1, "a").random() == stream(1, "a").random()
    assert len({stream(seed, name).random() for seed in (1, 2) for name in ("a", "b", "ab", "ba")}) == 8
