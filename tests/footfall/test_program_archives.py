"""Archives, logs and bags as apps, PX4 and ROS write them."""

import struct
import zipfile

import numpy as np
import pytest

from footfall.formats import read
from footfall.formats.options import Reading
from tests.footfall.test_programs import NS, numbers
from tests.footfall.test_text_tables import foot, same

__all__ = ["foot"]


def archive(path, tables):
    with zipfile.ZipFile(path, "w") as file:
        for name, text in tables.items():
            file.writestr(name, text)


def alone(foot, head, stamp, values, order=(0, 1, 2)):
    """A table of one sensor."""
    rows = zip(foot.t, values[:, order], strict=True)
    return "\n".join([head, *(",".join([*stamp(t), *numbers(row)]) for t, row in rows)]) + "\n"


def test_an_archive_of_sensor_logger(foot, tmp_path):
    """Accelerometer.csv is without gravity, and columns stand z, y, x."""

    def table(values):
        stamp = lambda t: [str(NS + round(1e9 * t)), f"{t:.6f}"]  # noqa: E731
        return alone(foot, "time,seconds_elapsed,z,y,x", stamp, values, (2, 1, 0))

    gravity = np.tile([1.2, -0.4, 9.72], (len(foot.t), 1))
    tables = {
        "Gyroscope.csv": table(foot.gyro),
        "Accelerometer.csv": table(foot.accel - gravity),
        "Gravity.csv": table(gravity),
        "Metadata.csv": "version,device name\n3,phone\n",
        "Annotation.csv": "time,seconds_elapsed,text,millisecond_press_duration\n",
    }
    archive(tmp_path / "sum.zip", tables)
    same(tmp_path / "sum.zip", foot)
    archive(tmp_path / "total.zip", tables | {"TotalAcceleration.csv": table(foot.accel)})
    same(tmp_path / "total.zip", foot)


LOGGER = "version,device name,recording epoch time,platform,appVersion,sampleRateMs"


@pytest.mark.parametrize(
    ("head", "told", "sign"),
    [
        (LOGGER, "3,phone,1700000000000,ios,1.28,5|5", -1),
        (LOGGER + ",standardisation,platform version", "3,phone,1700000000000,ios,1.40,5|5,false,17.4", -1),
        (LOGGER + ",standardisation,platform version", "3,phone,1700000000000,ios,1.40,5|5,true,17.4", 1),
        (LOGGER + ",standardisation,platform version", "3,phone,1700000000000,android,1.40,5|5,false,14", 1),
    ],
)
def test_an_iphones_archive_says_minus_f(foot, tmp_path, head, told, sign):
    stamp = lambda t: [str(NS + round(1e9 * t)), f"{t:.6f}"]  # noqa: E731

    def table(values):
        return alone(foot, "time,seconds_elapsed,z,y,x", stamp, values, (2, 1, 0))

    gravity = np.tile([1.2, -0.4, 9.72], (len(foot.t), 1))
    tables = {
        "Gyroscope.csv": table(foot.gyro),
        "Accelerometer.csv": table(sign * (foot.accel - gravity)),
        "Gravity.csv": table(sign * gravity),
        "Metadata.csv": f"{head}\n{told}\n",
    }
    archive(tmp_path / "a.zip", tables)
    findings = same(tmp_path / "a.zip", foot)
    assert ("an iPhone's accelerometers" in " ".join(findings.sentences())) == (sign < 0)


def test_an_archive_of_phyphox(foot, tmp_path):
    """Each experiment has names of its own."""
    stamp = lambda t: [f"{t:.9E}"]  # noqa: E731
    names = [f'"Acceleration {a} (m/s^2)"' for a in "xyz"], [f'"Gyroscope {a} (rad/s)"' for a in "xyz"]
    tables = {
        f"{name}.csv": alone(foot, ",".join(['"Time (s)"', *one]), stamp, values)
        for name, one, values in zip(
            ("Accelerometer", "Gyroscope"), names, (foot.accel, foot.gyro), strict=True
        )
    }
    archive(tmp_path / "a.zip", tables | {"meta/time.csv": '"event","experiment time"\n"START",0\n'})
    same(tmp_path / "a.zip", foot)


def ulog(foot, instances=1):
    """A log of PX4 by its specification: header, flags, a format, subscriptions and data."""

    def message(kind, content):
        return struct.pack("<HB", len(content), ord(kind)) + content

    layout = (
        b"sensor_combined:uint64_t timestamp;float[3] gyro_rad;uint32_t gyro_integral_dt;"
        b"int32_t accelerometer_timestamp_relative;float[3] accelerometer_m_s2;"
        b"uint32_t accelerometer_integral_dt;"
    )
    parts = [
        b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 12345),
        message("B", bytes(40)),
        message("F", layout),
    ]
    for one in range(instances):
        parts.append(message("A", struct.pack("<BH", one, one) + b"sensor_combined"))
    for t, w, f in zip(foot.t, foot.gyro, foot.accel, strict=True):
        for one in range(instances):
            row = struct.pack("<Q3fIi3fI", 12345 + round(1e6 * t), *w, 5000, 0, *f, 5000)
            parts.append(message("D", struct.pack("<H", one) + row))
    return b"".join(parts)


def test_a_log_of_px4(foot, tmp_path):
    pytest.importorskip("pyulog")
    (tmp_path / "a.ulg").write_bytes(ulog(foot))
    assert same(tmp_path / "a.ulg", foot).format == "ulog"


def test_a_log_of_px4_with_two_imus(foot, tmp_path):
    from footfall.errors import InputError

    pytest.importorskip("pyulog")
    (tmp_path / "a.ulg").write_bytes(ulog(foot, 2))
    with pytest.raises(
        InputError, match="2 sensors, choose one with --sensor: sensor_combined 0, sensor_com"
    ):
        read(tmp_path / "a.ulg")
    same(tmp_path / "a.ulg", foot, reading=Reading(sensor="sensor_combined 1"))


def test_a_damaged_log_of_px4(foot, tmp_path):
    from footfall.errors import InputError

    pytest.importorskip("pyulog")
    (tmp_path / "a.ulg").write_bytes(ulog(foot)[:300])
    with pytest.raises(InputError, match=r"a\.ulg"):
        read(tmp_path / "a.ulg")


def test_a_bag_of_ros_1(foot, tmp_path):
    rosbag1 = pytest.importorskip("rosbags.rosbag1")
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    kind = store.types
    imu, header, stamp = (
        kind[name] for name in ("sensor_msgs/msg/Imu", "std_msgs/msg/Header", "builtin_interfaces/msg/Time")
    )
    vector, quaternion = kind["geometry_msgs/msg/Vector3"], kind["geometry_msgs/msg/Quaternion"]
    with rosbag1.Writer(tmp_path / "a.bag") as writer:
        connection = writer.add_connection("/imu/data", imu.__msgtype__, typestore=store)
        for i, (t, w, f) in enumerate(zip(foot.t, foot.gyro, foot.accel, strict=True)):
            at = NS + round(1e9 * t)
            none = np.zeros(9)
            message = imu(
                header(i, stamp(at // 10**9, at % 10**9), "foot"),
                quaternion(0.0, 0.0, 0.0, 1.0),
                none,
                vector(*w),
                none,
                vector(*f),
                none,
            )
            writer.write(connection, at, store.serialize_ros1(message, imu.__msgtype__))
    assert same(tmp_path / "a.bag", foot).format == "ros-bag"
