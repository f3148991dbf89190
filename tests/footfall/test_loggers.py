"""Files of HDF5, MATLAB 7.3 and ROS as their makers write them; each library is an extra."""

import numpy as np
import pytest
from scipy.io import savemat

from footfall.errors import InputError
from footfall.formats import read
from footfall.formats.options import Reading
from tests.footfall.test_text_tables import foot, same

__all__ = ["foot"]


def apdm(path, *feet, labels=("Left Foot", "Right Foot")):
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        file.attrs["SampleRate"] = 200
        for number, one in enumerate(feet):
            group = file.create_group(f"Sensors/{1200 + number}")
            group["Time"] = (1.7e15 + 1e6 * one.t).astype(np.uint64)
            group["Accelerometer"], group["Gyroscope"] = one.accel, one.gyro
            group.create_group("Configuration").attrs["Label 0"] = labels[number].encode()


def test_an_opal(foot, tmp_path):
    apdm(tmp_path / "a.h5", foot)
    assert same(tmp_path / "a.h5", foot).format == "apdm"


def test_two_opals_are_listed_by_their_labels(foot, tmp_path):
    apdm(tmp_path / "a.h5", foot, foot)
    with pytest.raises(InputError, match="2 sensors, choose one with --sensor: Left Foot, Right Foot"):
        read(tmp_path / "a.h5")
    same(tmp_path / "a.h5", foot, reading=Reading(sensor="Right Foot"))
    with pytest.raises(InputError, match="no sensor 'Head', but Left Foot"):
        read(tmp_path / "a.h5", reading=Reading(sensor="Head"))


def test_an_hdf5_file_of_another_kind_and_a_damaged_one(foot, tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["x"] = np.zeros(9)
    with pytest.raises(InputError, match=r"a\.h5"):
        read(tmp_path / "a.h5")
    apdm(tmp_path / "b.h5", foot)
    (tmp_path / "b.h5").write_bytes((tmp_path / "b.h5").read_bytes()[:3000])
    with pytest.raises(InputError, match="not a readable HDF5 file"):
        read(tmp_path / "b.h5")


def test_matlab_73(foot, tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.mat", "w") as file:  # MATLAB writes arrays transposed
        file["imu"], file["ts"] = np.hstack([foot.accel, foot.gyro]).T, foot.t[None]
    assert same(tmp_path / "a.mat", foot).format == "matlab"


@pytest.mark.parametrize(
    "held",
    [
        lambda f: {"gyro": f.gyro, "acc": f.accel, "fs": 200.0},
        lambda f: {"acc": f.accel.T, "gyr": f.gyro.T, "time": f.t},
        lambda f: {"data": {"gyro": f.gyro, "accel": f.accel, "t": f.t}},
        lambda f: {"imu": np.hstack([f.accel, f.gyro]), "ts": f.t, "gt": np.zeros((9, 3))},
    ],
)
def test_matlab_under_other_names(foot, tmp_path, held):
    savemat(tmp_path / "a.mat", held(foot))
    same(tmp_path / "a.mat", foot)


def bag(path, foot, topics):
    rosbags = pytest.importorskip("rosbags.rosbag2")
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.LATEST)
    kind = store.types
    imu, header, stamp = (
        kind[name] for name in ("sensor_msgs/msg/Imu", "std_msgs/msg/Header", "builtin_interfaces/msg/Time")
    )
    vector, quaternion = kind["geometry_msgs/msg/Vector3"], kind["geometry_msgs/msg/Quaternion"]
    unknown = np.zeros(9)
    with rosbags.Writer(path, version=9) as writer:
        for topic in topics:
            connection = writer.add_connection(topic, imu.__msgtype__, typestore=store)
            for t, w, f in zip(foot.t, foot.gyro, foot.accel, strict=True):
                at = 1_700_000_000_000_000_000 + round(1e9 * t)
                message = imu(
                    header(stamp(at // 10**9, at % 10**9), "foot"),
                    quaternion(0.0, 0.0, 0.0, 1.0),
                    unknown,
                    vector(*w),
                    unknown,
                    vector(*f),
                    unknown,
                )
                writer.write(connection, at, store.serialize_cdr(message, imu.__msgtype__))


def test_a_bag_of_ros(foot, tmp_path):
    bag(tmp_path / "bag", foot, ["/imu"])
    assert same(tmp_path / "bag", foot).format == "ros-bag"


def test_two_topics_are_listed(foot, tmp_path):
    bag(tmp_path / "bag", foot, ["/left", "/right"])
    with pytest.raises(InputError, match="2 sensors, choose one with --sensor: /left, /right"):
        read(tmp_path / "bag")
    same(tmp_path / "bag", foot, reading=Reading(sensor="/right"))


def test_a_damaged_bag(tmp_path):
    (tmp_path / "bag").mkdir()
    (tmp_path / "bag" / "metadata.yaml").write_text("nonsense: [")
    with pytest.raises(InputError, match="bag of ROS"):
        read(tmp_path / "bag")
    (tmp_path / "a.bag").write_bytes(b"#ROSBAG V2.0\n" + b"\x00" * 100)
    with pytest.raises(InputError, match="bag of ROS"):
        read(tmp_path / "a.bag")


def test_a_library_that_is_missing_is_named(foot, tmp_path, monkeypatch):
    import sys

    (tmp_path / "a.ulg").write_bytes(b"ULog\x01\x12\x35" + b"\x00" * 50)
    monkeypatch.setitem(sys.modules, "pyulog", None)
    with pytest.raises(InputError, match=r"needs pyulog \(pip install 'footfall\[px4\]'\)"):
        read(tmp_path / "a.ulg")
    apdm(tmp_path / "a.h5", foot)
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(InputError, match="needs h5py"):
        read(tmp_path / "a.h5")
