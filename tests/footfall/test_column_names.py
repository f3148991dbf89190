"""Names of columns as people and loggers write them, and units."""

import numpy as np
import pytest

from footfall.conventions import GRAVITY
from footfall.formats.layout import Header, find_layouts
from footfall.formats.names import understood
from footfall.formats.units import unit_size

DEG = np.pi / 180

UNITS = {
    "gyro": {
        1.0: ["rad/s", "rad s^-1", "rad/sec", "radians/second", "rad_s", "rad s-1", "RAD/S", "rad s**-1"],
        DEG: ["deg/s", "dps", "°/s", "deg/sec", "degrees per second", "deg_s", "º/s", "Â°/s", "\u6385/s"],
        DEG / 1000: ["mdps", "mdeg/s"],
    },
    "accel": {
        1.0: ["m/s2", "m/s^2", "m s^-2", "m/(s^2)", "m/sec^2", "m/s²", "m/s/s", "m_s2", "m·s⁻²", "meter/s^2"],
        GRAVITY: ["g", "G", "g's"],
        GRAVITY / 1000: ["mg"],
        0.3048: ["ft/s2"],
    },
    "t": {1.0: ["s", "sec", "seconds"], 1e-3: ["ms", "msec"], 1e-6: ["us", "µs", "Âµs", "microseconds"]},
}


@pytest.mark.parametrize(
    ("quantity", "size", "text"),
    [(kind, size, text) for kind, sizes in UNITS.items() for size, texts in sizes.items() for text in texts],
)
def test_units_are_known_however_they_are_spelled(quantity, size, text):
    assert unit_size(quantity, text) == pytest.approx(size)


@pytest.mark.parametrize("text", ["", "rad", "rad/s/s", "s", "m/s", "deg", "furlong/s", "/s", "^2", "s/deg"])
def test_what_is_no_rate_has_no_size(text):
    assert unit_size("gyro", text) is None


NAMES = {
    "gyro_x": ("gyro_x", None, ""),
    "Acc Y [g]": ("accel_y", GRAVITY, ""),
    "w_RS_S_x [rad s^-1]": ("gyro_x", 1.0, ""),
    "a_RS_S_z [m s^-2]": ("accel_z", 1.0, ""),
    "field.angular_velocity.x": ("gyro_x", None, ""),
    "/imu/data/linear_acceleration/y": ("accel_y", None, ""),
    "Shimmer_8A2F_Gyro_X_CAL": ("gyro_x", None, "shimmer_8a2f"),
    "left_sensor gyr_z": ("gyro_z", None, "left"),
    "gyro_rad[0]": ("gyro_x", 1.0, ""),
    "accelerometer_m_s2[2]": ("accel_z", 1.0, ""),
    "motionRotationRateY(rad/s)": ("gyro_y", 1.0, ""),
    "AsZ(°/s)": ("gyro_z", DEG, ""),
    "Angular velocity X(°/s)": ("gyro_x", DEG, ""),
    "gFx": ("accel_x", GRAVITY, ""),
    "xgyro": ("gyro_x", None, ""),
    "ACCELEROMETER X (m/s²)": ("accel_x", 1.0, ""),
    "wy": ("gyro_y", None, ""),
    "imu2.az": ("accel_z", None, "imu2"),
    "Time since start in ms": ("t", 1e-3, ""),
    "seconds_elapsed": ("t", 1.0, ""),
    "#timestamp [ns]": ("t", 1e-9, ""),
    "SampleTimeFine": ("t", None, ""),
    "Temperature (°C)": ("temperature", 1.0, ""),
    "ω_x (°/s)": ("gyro_x", DEG, ""),
    "ms": ("t", 1e-3, ""),
    "Zeit (s)": ("t", 1.0, ""),
    "Beschl X": ("accel_x", None, ""),
    "Beschleunigung y (m/s^2)": ("accel_y", 1.0, ""),
    "Drehrate z": ("gyro_z", None, ""),
}


@pytest.mark.parametrize("name", NAMES)
def test_a_name_says_channel_unit_and_sensor(name):
    found = understood(name)
    assert (found.channel, found.sensor) == (NAMES[name][0], NAMES[name][2])
    assert found.size == (None if NAMES[name][1] is None else pytest.approx(NAMES[name][1]))


@pytest.mark.parametrize(
    "name",
    [
        *("mag_x", "gyro", "gyro_xy", "gyro_x_furlong", "accelerate_x", "grax", "t_parsec", "accel_x_deg_s"),
        *("GRAVITY X (m/s²)", "field.angular_velocity_covariance0", "orientation.x", "PacketCounter", "roll"),
        *("gyro_bias_x", "angle_x", "Euler_X", "DeviceName", "", "   ", "quat_w", "steps"),
    ],
)
def test_other_names_are_none(name):
    assert understood(name) is None


def layouts(names, **header):
    return find_layouts("a.csv", Header(names, **header), "auto")


@pytest.mark.parametrize("names", ["gyro{} accel{}", "Gyro_{} Acc_{}", "gyr[{}] acc[{}]"])
def test_axes_numbered_from_one_and_from_nought(names):
    for first in (0, 1):
        columns = ["t", *(one.format(first + i) for one in names.split() for i in range(3))]
        (found,) = layouts(columns)
        assert [found.columns[f"gyro_{axis}"] for axis in "xyz"] == columns[1:4]
        assert [found.columns[f"accel_{axis}"] for axis in "xyz"] == columns[4:]


def six(gyro, accel):
    return [pattern.format(axis) for pattern in (gyro, accel) for axis in "xyz"]


def test_the_best_of_several_accelerometers_is_taken():
    names = ["time", *six("gyro_{}", "accel_{}"), *six("linear_acceleration_{}", "accel_{}_raw")]
    (found,) = layouts(names)
    assert found.columns["accel_x"] == "accel_x"
    (phone,) = layouts(["time", "gFx", "gFy", "gFz", "ax", "ay", "az", "wx", "wy", "wz"])
    assert (phone.columns["accel_x"], phone.sizes["accel_x"]) == ("gFx", GRAVITY)
    (shimmer,) = layouts([*six("Gyro_{}", "Accel_LN_{}"), *six("Mag_{}", "Accel_WR_{}")])
    assert shimmer.columns["accel_x"] == "Accel_WR_x"


def test_sensors_are_told_apart_by_their_names():
    found = layouts(["time", *six("left_gyr_{}", "left_acc_{}"), *six("right_gyr_{}", "right_acc_{}")])
    assert [one.sensor for one in found] == ["left", "right"]
    assert all(one.columns["t"] == "time" for one in found)


def test_gyro_and_accelerometer_of_two_chips_are_one_sensor():
    (found,) = layouts(["t", *six("bmi270_gyro_{}", "adxl375_accel_{}")])
    assert (found.columns["gyro_y"], found.columns["accel_y"]) == ("bmi270_gyro_y", "adxl375_accel_y")


@pytest.mark.parametrize(
    ("format", "names", "sizes", "header"),
    [
        ("xsens", ["SampleTimeFine", *six("Gyr_{}", "Acc_{}")], (1e-4, 1.0), {"preamble": ["// Start"]}),
        ("movella", ["SampleTimeFine", *six("Gyr_{}", "Acc_{}")], (1e-6, DEG), {"preamble": ["sep=,"]}),
        (
            "ros",
            ["%time", *six("field.angular_velocity.{}", "field.linear_acceleration.{}")],
            (None, 1.0),
            {},
        ),
        ("gaitmap", ["time", *six("left_sensor_gyr_{}", "left_sensor_acc_{}")], (None, DEG), {}),
        (
            "px4",
            [
                "timestamp",
                *[f"gyro_rad[{i}]" for i in range(3)],
                *[f"accelerometer_m_s2[{i}]" for i in range(3)],
            ],
            (1e-6, 1.0),
            {},
        ),
    ],
)
def test_formats_that_leave_units_open_have_those_of_their_makers(format, names, sizes, header):
    (found,) = layouts(names, **header)
    assert found.format == format
    assert (found.sizes["t"], found.sizes["gyro_x"]) == sizes
    assert found.sizes["accel_z"] == 1.0


def test_units_below_the_names_count_as_those_in_them():
    (found,) = layouts(["Time", *six("Gyr_{}", "Acc_{}")], units=["(ms)", *["(deg/s)"] * 3, *["(g)"] * 3])
    assert (found.sizes["t"], found.sizes["gyro_z"], found.sizes["accel_x"]) == (1e-3, DEG, GRAVITY)


def test_seconds_and_nanoseconds_of_ros_belong_together():
    names = ["header.stamp.secs", "header.stamp.nsecs", *six("angular_velocity.{}", "linear_acceleration.{}")]
    (found,) = layouts(names)
    assert (found.columns["t"], found.finer) == ("header.stamp.secs", "header.stamp.nsecs")


def test_increments_are_no_rates():
    (found,) = layouts(["t", *six("dtheta_{}", "dv_{}")])
    assert found.increments == set(found.columns) - {"t"}
    (both,) = layouts(["t", *six("dtheta_{}", "dv_{}"), *six("gyro_{}", "accel_{}")])
    assert both.columns["gyro_x"] == "gyro_x"
