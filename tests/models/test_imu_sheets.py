"""The stock data sheets: every value that was published, converted by hand, against what is loaded."""

import math
import tomllib

import pytest

from footfall.models.imu import ThermalSpec, load_spec
from footfall.models.imu.spec import SHEETS

# Key of the sheet -> (its published value, its attribute, its value in SI). By hand, 1 deg = 1.745329e-2 rad,
# 1 g = 9.80665 m/s2, 1 h = 3600 s: 4.4 deg/rt-h are 4.4/60 deg/s/rt-Hz, 30 deg/h/rt-h 30/3600/60 deg/s/rt-s.
NIMU = {
    "gyro": {
        "range_deg_s": (1200.0, "range", 20.94395),
        "bandwidth_hz": (50.0, "bandwidth", 50.0),
        "resolution_deg_s": (0.054932, "resolution", 9.587443e-4),
        "angle_random_walk_deg_rt_h": (4.4, "white", 1.279908e-3),
        "flicker_deg_h": (80.0, "flicker", 3.878509e-4),
        "rate_random_walk_deg_h_rt_h": (30.0, "random_walk", 2.424068e-6),
        "turn_on_sigma_deg_s": (0.5, "turn_on_sigma", 8.726646e-3),
        "scale_sigma": (0.003, "scale_sigma", 0.003),
        "misalignment_sigma_deg": (0.17, "misalignment_sigma", 2.967060e-3),
        "g_sensitivity_sigma_deg_s_g": (0.15, "g_sigma", 2.669611e-4),
        "g2_sigma_deg_s_g2": (5e-4, "g2_sigma", 9.074151e-8),
        "temperature_sigma_deg_s_k": (0.011, "temperature_sigma", 1.919862e-4),
        "temperature2_sigma_deg_s_k2": (0.0, "temperature2_sigma", 0.0),
    },
    "accel": {
        "range_g": (15.0, "range", 147.0998),
        "bandwidth_hz": (50.0, "bandwidth", 50.0),
        "resolution_mg": (0.45776, "resolution", 4.489092e-3),
        "noise_density_ug_rt_hz": (80.0, "white", 7.845320e-4),
        "flicker_ug": (100.0, "flicker", 9.806650e-4),
        "random_walk_ug_rt_h": (100.0, "random_walk", 1.634442e-5),
        "turn_on_sigma_mg": (10.0, "turn_on_sigma", 9.806650e-2),
        "scale_sigma": (0.003, "scale_sigma", 0.003),
        "misalignment_sigma_deg": (0.17, "misalignment_sigma", 2.967060e-3),
        "g2_sigma_ug_g2": (100.0, "g2_sigma", 1.019716e-5),
        "temperature_sigma_mg_k": (0.1, "temperature_sigma", 9.806650e-4),
        "temperature2_sigma_mg_k2": (0.0, "temperature2_sigma", 0.0),
    },
    "thermal": {
        "time_constant_s": (600.0, "time_constant", 600.0),
        "reference_degC": (25.0, "reference", 25.0),
        "resolution_degC": (0.018165, "resolution", 0.018165),
        "reported": (True, "reported", True),
    },
}
MTIG710 = {
    "gyro": {
        "range_deg_s": (1000.0, "range", 17.45329),
        "bandwidth_hz": (415.0, "bandwidth", 415.0),
        "angle_random_walk_deg_rt_h": (0.6, "white", 1.745329e-4),  # .01 deg/s/rt-Hz
        "flicker_deg_h": (15.06, "flicker", 7.301294e-5),  # a floor of 10 deg/h: 10 / .664
        "turn_on_sigma_deg_s": (0.07, "turn_on_sigma", 1.221730e-3),
        "scale_sigma": (0.0005, "scale_sigma", 0.0005),
        "misalignment_sigma_deg": (0.03, "misalignment_sigma", 5.235988e-4),
        "non_linearity_sigma_percent_fs": (0.01, "non_linearity_sigma", 1e-4),
        "g_sensitivity_sigma_deg_s_g": (0.003, "g_sigma", 5.339222e-6),
    },
    "accel": {
        "range_g": (15.0, "range", 147.0998),
        "bandwidth_hz": (375.0, "bandwidth", 375.0),
        "noise_density_ug_rt_hz": (80.0, "white", 7.845320e-4),
        "flicker_ug": (60.2, "flicker", 5.903603e-4),  # a floor of 40 ug: 40 / .664
        "turn_on_sigma_mg": (1.0, "turn_on_sigma", 9.806650e-3),
        "scale_sigma": (0.0005, "scale_sigma", 0.0005),
        "misalignment_sigma_deg": (0.03, "misalignment_sigma", 5.235988e-4),
        "non_linearity_sigma_percent_fs": (0.03, "non_linearity_sigma", 3e-4),
    },
}
TACTICAL = {
    "gyro": {
        "range_deg_s": (2000.0, "range", 34.90659),
        "bandwidth_hz": (375.0, "bandwidth", 375.0),
        "angle_random_walk_deg_rt_h": (0.15, "white", 4.363323e-5),
        "flicker_deg_h": (1.506, "flicker", 7.301294e-6),  # a floor of 1 deg/h: 1 / .664
        "turn_on_sigma_deg_s": (0.0011, "turn_on_sigma", 1.919862e-5),  # 4 deg/h
        "scale_sigma": (0.0005, "scale_sigma", 0.0005),
        "misalignment_sigma_deg": (0.05, "misalignment_sigma", 8.726646e-4),
        "non_linearity_sigma_percent_fs": (0.0025, "non_linearity_sigma", 2.5e-5),  # 25 ppm
        "g_sensitivity_sigma_deg_s_g": (0.0028, "g_sigma", 4.983273e-6),  # 10 deg/h/g
        "g2_sigma_deg_s_g2": (4e-4, "g2_sigma", 7.259321e-8),
        "temperature_sigma_deg_s_k": (1.1e-4, "temperature_sigma", 1.919862e-6),  # 10 deg/h over 25 K
    },
    "accel": {
        "range_g": (40.0, "range", 392.2660),
        "bandwidth_hz": (350.0, "bandwidth", 350.0),
        "noise_density_ug_rt_hz": (119.0, "white", 1.166991e-3),  # .07 m/s/rt-h: .07 / 60
        "flicker_ug": (19.58, "flicker", 1.920142e-4),  # a floor of 13 ug: 13 / .664
        "turn_on_sigma_mg": (0.75, "turn_on_sigma", 7.354988e-3),
        "scale_sigma": (0.0005, "scale_sigma", 0.0005),
        "misalignment_sigma_deg": (0.05, "misalignment_sigma", 8.726646e-4),
        "g2_sigma_ug_g2": (80.0, "g2_sigma", 8.157730e-6),
        "temperature_sigma_mg_k": (0.05, "temperature_sigma", 4.903325e-4),
    },
    "thermal": {
        "time_constant_s": (600.0, "time_constant", 600.0),
        "reference_degC": (25.0, "reference", 25.0),
    },
}
INDUSTRIAL = {
    "gyro": {
        "range_deg_s": (2000.0, "range", 34.90659),
        "bandwidth_hz": (375.0, "bandwidth", 375.0),
        "angle_random_walk_deg_rt_h": (0.48, "white", 1.396263e-4),  # .008 deg/s/rt-Hz
        "flicker_deg_h": (12.05, "flicker", 5.842005e-5),  # a floor of 8 deg/h: 8 / .664
        "turn_on_sigma_deg_s": (0.5, "turn_on_sigma", 8.726646e-3),
        "scale_sigma": (0.0033, "scale_sigma", 0.0033),
        "misalignment_sigma_deg": (0.05, "misalignment_sigma", 8.726646e-4),
        "non_linearity_sigma_percent_fs": (0.1, "non_linearity_sigma", 1e-3),
        "g_sensitivity_sigma_deg_s_g": (0.01, "g_sigma", 1.779741e-5),
        "g2_sigma_deg_s_g2": (4e-4, "g2_sigma", 7.259321e-8),
        "temperature_sigma_deg_s_k": (0.007, "temperature_sigma", 1.221730e-4),
    },
    "accel": {
        "range_g": (40.0, "range", 392.2660),
        "bandwidth_hz": (350.0, "bandwidth", 350.0),
        "noise_density_ug_rt_hz": (200.0, "white", 1.961330e-3),
        "flicker_ug": (19.58, "flicker", 1.920142e-4),  # 13 / .664
        "turn_on_sigma_mg": (15.0, "turn_on_sigma", 0.1470998),
        "scale_sigma": (0.0033, "scale_sigma", 0.0033),
        "misalignment_sigma_deg": (0.05, "misalignment_sigma", 8.726646e-4),
        "non_linearity_sigma_percent_fs": (0.1, "non_linearity_sigma", 1e-3),
        "g2_sigma_ug_g2": (80.0, "g2_sigma", 8.157730e-6),
        "temperature_sigma_mg_k": (0.05, "temperature_sigma", 4.903325e-4),
    },
    "thermal": {
        "time_constant_s": (600.0, "time_constant", 600.0),
        "reference_degC": (25.0, "reference", 25.0),
    },
}
CONSUMER = {
    "gyro": {
        "range_deg_s": (2000.0, "range", 34.90659),
        "bandwidth_hz": (80.0, "bandwidth", 80.0),
        "resolution_deg_s": (0.060976, "resolution", 1.064232e-3),  # 1 / 16.4
        "angle_random_walk_deg_rt_h": (0.168, "white", 4.886922e-5),  # .0028 deg/s/rt-Hz
        "flicker_deg_h": (15.06, "flicker", 7.301294e-5),  # 10 / .664
        "turn_on_sigma_deg_s": (0.5, "turn_on_sigma", 8.726646e-3),
        "scale_sigma": (0.005, "scale_sigma", 0.005),
        "misalignment_sigma_deg": (0.716, "misalignment_sigma", 1.249656e-2),  # 1.25 %
        "non_linearity_sigma_percent_fs": (0.1, "non_linearity_sigma", 1e-3),
        "g_sensitivity_sigma_deg_s_g": (0.033, "g_sigma", 5.873144e-5),  # .1 / 3
        "g2_sigma_deg_s_g2": (5e-4, "g2_sigma", 9.074151e-8),
        "temperature_sigma_deg_s_k": (0.005, "temperature_sigma", 8.726646e-5),
    },
    "accel": {
        "range_g": (16.0, "range", 156.9064),
        "bandwidth_hz": (80.0, "bandwidth", 80.0),
        "resolution_mg": (0.48828, "resolution", 4.788391e-3),  # 1 / 2.048
        "noise_density_ug_rt_hz": (70.0, "white", 6.864655e-4),
        "flicker_ug": (45.18, "flicker", 4.430644e-4),  # 30 / .664
        "turn_on_sigma_mg": (20.0, "turn_on_sigma", 0.1961330),
        "scale_sigma": (0.005, "scale_sigma", 0.005),
        "misalignment_sigma_deg": (0.573, "misalignment_sigma", 1.000074e-2),  # 1 %
        "non_linearity_sigma_percent_fs": (0.1, "non_linearity_sigma", 1e-3),
        "g2_sigma_ug_g2": (100.0, "g2_sigma", 1.019716e-5),
        "temperature_sigma_mg_k": (0.15, "temperature_sigma", 1.470998e-3),
    },
    "thermal": {
        "time_constant_s": (600.0, "time_constant", 600.0),
        "reference_degC": (25.0, "reference", 25.0),
        "resolution_degC": (0.0075483, "resolution", 0.0075483),  # 1 / 132.48
        "reported": (True, "reported", True),
    },
}
PHONE = {
    "gyro": {
        "range_deg_s": (2000.0, "range", 34.90659),
        "bandwidth_hz": (74.6, "bandwidth", 74.6),
        "resolution_deg_s": (0.060976, "resolution", 1.064232e-3),  # 1 / 16.4
        "angle_random_walk_deg_rt_h": (0.42, "white", 1.221730e-4),  # .007 deg/s/rt-Hz
        "flicker_deg_h": (15.06, "flicker", 7.301294e-5),  # 10 / .664
        "turn_on_sigma_deg_s": (3.0, "turn_on_sigma", 5.235988e-2),
        "scale_sigma": (0.01, "scale_sigma", 0.01),
        "misalignment_sigma_deg": (0.573, "misalignment_sigma", 1.000074e-2),  # 1 %
        "non_linearity_sigma_percent_fs": (0.05, "non_linearity_sigma", 5e-4),
        "g_sensitivity_sigma_deg_s_g": (0.033, "g_sigma", 5.873144e-5),  # .1 / 3
        "g2_sigma_deg_s_g2": (5e-4, "g2_sigma", 9.074151e-8),
        "temperature_sigma_deg_s_k": (0.05, "temperature_sigma", 8.726646e-4),
    },
    "accel": {
        "range_g": (16.0, "range", 156.9064),
        "bandwidth_hz": (80.0, "bandwidth", 80.0),
        "resolution_mg": (0.48828, "resolution", 4.788391e-3),  # 1 / 2.048
        "noise_density_ug_rt_hz": (180.0, "white", 1.765197e-3),
        "flicker_ug": (45.18, "flicker", 4.430644e-4),  # 30 / .664
        "turn_on_sigma_mg": (20.0, "turn_on_sigma", 0.1961330),  # 60 / 3
        "scale_sigma": (0.0133, "scale_sigma", 0.0133),
        "misalignment_sigma_deg": (0.286, "misalignment_sigma", 4.991642e-3),  # .5 %
        "non_linearity_sigma_percent_fs": (0.5, "non_linearity_sigma", 5e-3),
        "g2_sigma_ug_g2": (100.0, "g2_sigma", 1.019716e-5),
        "temperature_sigma_mg_k": (0.4, "temperature_sigma", 3.922660e-3),
    },
    "thermal": {
        "time_constant_s": (600.0, "time_constant", 600.0),
        "reference_degC": (23.0, "reference", 23.0),
        "resolution_degC": (0.0019531, "resolution", 0.0019531),  # 1 / 512
        "reported": (True, "reported", True),
    },
}
SHEETS_BY_HAND = {
    "nimu": NIMU,
    "mtig710": MTIG710,
    "tactical": TACTICAL,
    "industrial": INDUSTRIAL,
    "consumer": CONSUMER,
    "phone": PHONE,
}


@pytest.mark.parametrize("name", SHEETS_BY_HAND)
def test_every_key_of_a_sheet_says_what_was_published(name):
    sheet = tomllib.loads((SHEETS / f"{name}.toml").read_text())
    published = {
        part: {key: value for key, (value, _, _) in keys.items()}
        for part, keys in SHEETS_BY_HAND[name].items()
    }
    assert {part: sheet[part] for part in sheet if part != "name"} == published


@pytest.mark.parametrize("name", SHEETS_BY_HAND)
def test_every_key_of_a_sheet_arrives_in_si(name):
    spec = load_spec(name)
    for part, keys in SHEETS_BY_HAND[name].items():
        loaded = getattr(spec, part)
        for key, (_, attribute, si) in keys.items():
            assert getattr(loaded, attribute) == pytest.approx(si, rel=2e-6), (part, key)
        for attribute in {*vars(loaded)} - {attribute for _, attribute, _ in keys.values()}:
            assert getattr(loaded, attribute) == 0, (part, attribute)


def test_what_the_second_paper_calls_bias_stability_is_the_allan_floor():
    """Deng et al. (2018), Table 1: 10 deg/h and 40 ug; a coefficient B has a floor of .664 B."""
    spec = load_spec("mtig710")
    assert math.degrees(0.664 * spec.gyro.flicker) * 3600 == pytest.approx(10, rel=1e-3)
    assert 0.664 * spec.accel.flicker / 9.80665e-6 == pytest.approx(40, rel=1e-3)
    assert spec.gyro.white == pytest.approx(math.radians(0.01))  # the sheet's deg/s/rt-Hz


def test_a_sheet_without_a_thermal_table_has_its_zero_at_25_degrees(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text('name = "mine"\n[gyro]\ntemperature_sigma_deg_s_k = 0.01\n[accel]\n')
    assert load_spec(path).thermal.reference == ThermalSpec().reference == 25


def test_quadratic_temperature_errors_which_no_stock_sheet_has_arrive_in_si(tmp_path):
    path = tmp_path / "mine.toml"
    keys = "[gyro]\ntemperature2_sigma_deg_s_k2 = 1.0\n[accel]\ntemperature2_sigma_mg_k2 = 1.0\n"
    path.write_text(f'name = "mine"\n{keys}')
    assert load_spec(path).gyro.temperature2_sigma == pytest.approx(1.745329e-2, rel=2e-6)
    assert load_spec(path).accel.temperature2_sigma == pytest.approx(9.80665e-3, rel=2e-6)
