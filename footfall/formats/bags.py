"""Robots' logs: ROS bags (rosbags, extra `ros`) and PX4's ULog (pyulog, extra `px4`)."""

from __future__ import annotations

from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

from footfall.errors import InputError
from footfall.formats.files import Content, require_file
from footfall.formats.options import Reading
from footfall.formats.samples import Samples, Source

ULOG = b"ULog\x01\x12\x35"
_IMU = "sensor_msgs/msg/Imu"


def is_bag(path: Path) -> bool:
    """Whether this is a bag of ROS: a file of version 1, or a folder of version 2."""
    if path.is_dir():
        return (path / "metadata.yaml").is_file()
    try:
        if not path.is_file():  # opening a pipe would wait for it
            return False
        with open(path, "rb") as file:
            return file.read(8) == b"#ROSBAG "
    except (OSError, ValueError):
        return False  # `open_content` says what is the matter


def open_bag(path: Path, reading: Reading) -> Source:
    """Open a bag of ROS: the messages `sensor_msgs/Imu` of one topic, at their header's stamps.

    Raises
    ------
    InputError
        rosbags is not installed, the bag is damaged, no such messages, or several topics and none chosen.
    """
    try:
        from rosbags.highlevel import AnyReader
    except ImportError:
        raise InputError(
            "a bag of ROS: reading it needs rosbags (pip install 'footfall[ros]')", path
        ) from None
    from rosbags.typesys import Stores, get_typestore

    if not path.is_dir():
        require_file(path)
    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.LATEST)) as bag:
            topics = [one.topic for one in bag.connections if one.msgtype == _IMU]
            topic = _chosen(path, list(dict.fromkeys(topics)), reading.sensor)
            own = [one for one in bag.connections if one.topic == topic and one.msgtype == _IMU]
            rows = [_row(bag.deserialize(raw, _IMU)) for _, _, raw in bag.messages(connections=own)]
    except InputError:
        raise
    except Exception as error:  # rosbags raises whatever a damaged bag makes it stumble over
        raise InputError(f"not a readable bag of ROS ({error})", path) from None
    values = np.array(rows, dtype=float).reshape(-1, 8)
    t = values[:, 0] - values[:1, 0] + 1e-9 * values[:, 1]
    return Source(path, "ros-bag", len(t), iter([Samples(0, t, values[:, 2:5], values[:, 5:])]))


def _row(message: Any) -> list[float]:
    stamp, w, f = message.header.stamp, message.angular_velocity, message.linear_acceleration
    return [stamp.sec, stamp.nanosec, w.x, w.y, w.z, f.x, f.y, f.z]


def open_ulog(content: Content, reading: Reading) -> Source:
    """Open a log of PX4: its message `sensor_combined`, or one of several `vehicle_imu`.

    Raises
    ------
    InputError
        pyulog is not installed, the log is damaged, or holds no such message.
    """
    path = content.path
    try:
        from pyulog import ULog
    except ImportError:
        raise InputError(
            "a log of PX4: reading it needs pyulog (pip install 'footfall[px4]')", path
        ) from None
    try:
        with redirect_stdout(StringIO()):  # it prints what it thinks of a damaged log
            log = ULog(str(content.at), ["sensor_combined"])
        held = {f"{one.name} {one.multi_id}": one.data for one in log.data_list}
    except Exception as error:  # pyulog raises whatever a damaged log makes it stumble over
        raise InputError(f"not a readable ULog ({error})", path) from None
    data = held[_chosen(path, list(held), reading.sensor)]
    names = [f"gyro_rad[{i}]" for i in range(3)] + [f"accelerometer_m_s2[{i}]" for i in range(3)]
    values = np.column_stack([np.asarray(data[name], dtype=float) for name in names])
    t = 1e-6 * (data["timestamp"] - data["timestamp"][:1]).astype(float)
    return Source(path, "ulog", len(t), iter([Samples(0, t, values[:, :3], values[:, 3:])]))


def _chosen(path: Path, names: list[str], sensor: str | None) -> str:
    if not names:
        raise InputError("holds no messages of an IMU", path)
    if sensor is None and len(names) == 1:
        return names[0]
    if sensor is None:
        raise InputError(f"holds {len(names)} sensors, choose one with --sensor: {', '.join(names)}", path)
    if sensor not in names:
        raise InputError(f"holds no sensor {sensor!r}, but {', '.join(names)}", path)
    return sensor
