"""Text files as programs and apps write them: the names, preambles, units and clocks that are theirs."""

import numpy as np
import pytest

from footfall.conventions import GRAVITY
from footfall.formats.options import Reading
from tests.footfall.test_text_tables import DEG, foot, iso, same

__all__ = ["foot"]

NS = 1_700_000_000_000_000_000


def lines(foot, cells, head=(), joint=","):
    """A text: the head's lines, then `cells(t, gyro, accel)` a row."""
    body = (joint.join(cells(*row)) for row in zip(foot.t, foot.gyro, foot.accel, strict=True))
    return "\n".join([*head, *body]) + "\n"


def numbers(*values, places=6):
    return [f"{value:.{places}f}" for value in np.concatenate(values)]


def witmotion_bluetooth(foot):
    """Bluetooth sensors' app: tabs, a sensor's name in each row, times of day."""
    head = ["DeviceName\ttime\tAccX(g)\tAccY(g)\tAccZ(g)\tAsX(°/s)\tAsY(°/s)\tAsZ(°/s)\tAngleX(°)\tAngleY(°)"]
    return lines(
        foot,
        lambda t, w, f: ["WT901(c1)", iso(t, " ")[:-3], *numbers(f / GRAVITY, w / DEG), "0.1", "0.2"],
        head,
        "\t",
    )


def witmotion_usb(foot):
    """The PC program: a line with the start, then blanks between columns."""
    head = [
        "StartTime: 2024-02-29 23:59:50.000",
        "address Time(s) ax(g) ay(g) az(g) wx(deg/s) wy(deg/s) wz(deg/s) AngleX(deg) AngleY(deg) T(°)",
    ]
    return (
        lines(
            foot,
            lambda t, w, f: ["0x50", f"{t:.3f}", *numbers(f / GRAVITY, w / DEG), "1", "2", "25.1"],
            head,
            "\t",
        )
        .replace("address Time(s) ", "address\tTime(s)\t")
        .replace(") ", ")\t")
    )


def witmotion_wide(foot):
    """Its first programs: blanks, date and time in columns of their own, no units."""
    head = [
        "Start time: 2024-02-29 23:59:50.000",
        " Address Date Time ax ay az wx wy wz AngleX AngleY AngleZ T hx hy hz q0 q1 q2 q3",
    ]
    rest = ["1.1", "2.2", "3.3", "25.1", "12", "-40", "300", "1.0", "0.0", "0.0", "0.0"]
    return lines(
        foot,
        lambda t, w, f: ["0x50", *iso(t, " ")[:-3].split(), *numbers(f / GRAVITY, w / DEG), *rest],
        head,
        "  ",
    )


def witmotion_unpadded(foot):
    """Stamps without leading zeros, the last number in milliseconds."""
    head = ["time\tDeviceName\tAccX(g)\tAccY(g)\tAccZ(g)\tAsX(°/s)\tAsY(°/s)\tAsZ(°/s)\tAngleX(°)"]

    def stamp(t):
        ms = round(1000 * t) + 55_000
        return f"2024-2-29 9:{4 + ms // 60_000}:{ms // 1000 % 60}:{ms % 1000}"

    return lines(
        foot,
        lambda t, w, f: [stamp(t), "WT901", *numbers(f / GRAVITY, w / DEG), "0.1"],
        head,
        "\t",
    )


def witmotion_chip(foot):
    """The present PC program: two clocks, names in words."""
    names = ["Time", "Device name", "Chip Time()", *(f"Acceleration {a}(g)" for a in "XYZ")]
    names += [f"Angular velocity {a}(°/s)" for a in "XYZ"] + [f"Angle {a}(°)" for a in "XYZ"]
    names += [f"Magnetic field {a}(uT)" for a in "XYZ"] + [f"Quaternions {i}()" for i in range(4)]
    rest = ["0.1", "0.2", "0.3", "12", "-4", "40", "1", "0", "0", "0"]
    return lines(
        foot,
        lambda t, w, f: [
            " " + iso(t, " ")[11:-3],
            "WTSDCL(f5:e6)",
            " " + iso(t, " ")[:-3],
            *numbers(f / GRAVITY, w / DEG),
            *rest,
        ],
        [",".join(names)],
    )


def sensorlog(foot):
    """An iPhone's, which says -f."""
    names = ["loggingTime(txt)", "loggingSample(N)"]
    names += [f"accelerometerAcceleration{a}(G)" for a in "XYZ"]
    names += [f"motionRotationRate{a}(rad/s)" for a in "XYZ"]
    names += [f"motionUserAcceleration{a}(G)" for a in "XYZ"] + ["motionYaw(rad)", "label(N)"]
    return lines(
        foot,
        lambda t, w, f: [
            iso(t, " ")[:-3] + " +0100",
            str(round(200 * t)),
            *numbers(-f / GRAVITY, w, (f - [0, 0, GRAVITY]) / -GRAVITY),
            "0.1",
            "0",
        ],
        [",".join(names)],
    )


def sensorlog_raw(foot):
    """With the gyros themselves, and a clock for each sensor."""
    names = ["loggingTime(txt)", "loggingSample(N)", "accelerometerTimestamp_sinceReboot(s)"]
    names += [f"accelerometerAcceleration{a}(G)" for a in "XYZ"] + ["gyroTimestamp_sinceReboot(s)"]
    names += [f"gyroRotation{a}(rad/s)" for a in "XYZ"] + ["motionYaw(rad)", "label(N)"]

    def cells(t, w, f):
        clock = f"{t + 4321.25:.6f}"
        first = [iso(t, " ")[:-3] + " +0100", str(round(200 * t)), clock]
        return [*first, *numbers(-f / GRAVITY), clock, *numbers(w), "0.1", "0"]

    return lines(foot, cells, [",".join(names)])


def shimmer_quoted(foot):
    """Consensys with commas: its first line stands in quotes."""
    names = ["Timestamp_Unix_CAL", *(f"Accel_WR_{a}_CAL" for a in "XYZ"), *(f"Gyro_{a}_CAL" for a in "XYZ")]
    head = [
        '"sep=,"',
        ",".join(f"S_Foot_{name}" for name in names) + ",",
        "ms,m/(s^2),m/(s^2),m/(s^2),deg/s,deg/s,deg/s,",
    ]
    return lines(foot, lambda t, w, f: [f"{1.7e12 + 1000 * t:.3f}", *numbers(f, w / DEG), ""], head)


def xsens_without_clock(foot):
    """MT Manager with columns of clocks that stay empty: the rate stands above."""
    head = [
        "// Start Time: Unknown",
        "// Update Rate: 200.0Hz",
        "// Filter Profile: human (46.1)",
        "// Firmware Version: 4.0.2",
        "PacketCounter\tSampleTimeFine\tYear\tMonth\tUTC_Nano\tUTC_Second\tUTC_Valid\tAcc_X\tAcc_Y\tAcc_Z"
        "\tGyr_X\tGyr_Y\tGyr_Z\tMag_X\tMag_Y\tMag_Z\tMat[1][1]\tMat[2][1]",
    ]
    return lines(
        foot,
        lambda t, w, f: [f"{3583 + round(200 * t):05d}", *[""] * 6, *numbers(f, w), *["0.5"] * 5],
        head,
        "\t",
    )


def shimmer(foot):
    """Consensys: sep=, names, units, tabs; wide range beside low noise, which ends at 2 g."""
    names = ["Timestamp_Unix_CAL", *(f"Accel_WR_{a}_CAL" for a in "XYZ")]
    names += [*(f"Accel_LN_{a}_CAL" for a in "XYZ"), *(f"Gyro_{a}_CAL" for a in "XYZ"), "Battery_CAL"]
    units = ["ms", *["m/(s^2)"] * 6, *["deg/s"] * 3, "mV"]
    head = ["sep=\t", "\t".join(f"Shimmer_8A2F_{name}" for name in names), "\t".join(units)]
    return lines(
        foot,
        lambda t, w, f: [
            f"{1.7e12 + 1000 * t:.3f}",
            *numbers(f, np.clip(f, -19.6, 19.6) + 0.3, w / DEG),
            "4012.5",
        ],
        [head[0], head[1] + "\t", head[2] + "\t"],
        "\t",
    )


def physics_toolbox(foot):
    return lines(
        foot,
        lambda t, w, f: [f"{t:.4f}", *numbers(f / GRAVITY, w), "12.1", "-3.2", "40.0"],
        ["time,gFx,gFy,gFz,wx,wy,wz,Bx,By,Bz"],
    )


def physics_toolbox_clock(foot):
    """With the time of day, and semicolons with decimal commas as phones of half of Europe write."""
    return lines(
        foot,
        lambda t, w, f: [cell.replace(".", ",") for cell in [f"{t:.4f}", *numbers(f / GRAVITY, w, [0.0])]],
        ["time;gFx;gFy;gFz;wx;wy;wz;TgF"],
        ";",
    )


def euroc(foot):
    axes = [f"w_RS_S_{a} [rad s^-1]" for a in "xyz"] + [f"a_RS_S_{a} [m s^-2]" for a in "xyz"]
    return lines(
        foot,
        lambda t, w, f: [str(NS + round(1e9 * t)), *numbers(w, f, places=9)],
        ["#timestamp [ns]," + ",".join(axes)],
    ).replace("\n", "\r\n")


def xsens(foot):
    """MT Manager: lines of //, tabs, a counter, a clock of 0.1 ms, acceleration without gravity beside."""
    head = [
        "// General information: ",
        "//  MT Manager version: 2022.2.0 ",
        "// Device settings: ",
        "//  Filter Profile: human(46.1)",
        "// Coordinate system: ENU",
        "PacketCounter\tSampleTimeFine\tAcc_X\tAcc_Y\tAcc_Z\tFreeAcc_E\tFreeAcc_N\tFreeAcc_U"
        "\tGyr_X\tGyr_Y\tGyr_Z\tRoll\tPitch\tYaw",
    ]
    return lines(
        foot,
        lambda t, w, f: [
            f"{round(200 * t) % 65536}",
            f"{round(1e4 * t) + 7_000_000}",
            *numbers(f, f - [0, 0, GRAVITY], w),
            *["1.0", "2.0", "-137.2"],
        ],
        head,
        "\t",
    )


def movella_dot(foot):
    head = [
        "DeviceTag:,foot",
        "FirmwareVersion:,2.2.0",
        "AppVersion:,2023.6.0",
        "SyncStatus:,Unsynced",
        "OutputRate:,200Hz",
        "FilterProfile:,General",
        "Measurement Mode:,Custom mode 5",
        "StartTime:,2024-02-29_23-59-50",
        "",
        "PacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z,Status",
    ]
    return lines(
        foot,
        lambda t, w, f: [f"{round(200 * t) + 1}", f"{round(1e6 * t) + 99_000}", *numbers(f, w / DEG), "0"],
        head,
    )


def rostopic(foot):
    """`rostopic echo -p`."""
    three = [f"{{}}.{a}" for a in "xyz"]
    names = ["%time", "field.header.seq", "field.header.stamp", "field.header.frame_id"]
    names += [f"field.orientation.{a}" for a in "xyzw"] + [
        f"field.orientation_covariance{i}" for i in range(9)
    ]
    names += [name.format("field.angular_velocity") for name in three]
    names += [f"field.angular_velocity_covariance{i}" for i in range(9)]
    names += [name.format("field.linear_acceleration") for name in three]
    names += [f"field.linear_acceleration_covariance{i}" for i in range(9)]
    zeros = ["0.0"] * 9

    def cells(t, w, f):
        stamp = NS + round(1e9 * t)
        first = [str(stamp + 1_000_000), str(round(200 * t)), str(stamp), "imu_link", *["0.0"] * 3, "1.0"]
        return [*first, *zeros, *numbers(w), *zeros, *numbers(f), *zeros]

    return lines(foot, cells, [",".join(names)])


def gaitmap(foot):
    """Two feet in one frame, as pandas writes it: forces in m/s2, rates in deg/s."""
    names = [f"{kind}_{a}" for kind in ("acc", "gyr") for a in "xyz"]
    head = [
        "," + ",".join(["left_sensor"] * 6 + ["right_sensor"] * 6),
        "," + ",".join(2 * names),
        "time [s]" + "," * 12,
    ]
    return lines(foot, lambda t, w, f: [f"{t:.4f}", *numbers(f[::-1], w / DEG, f, w / DEG)], head)


def px4(foot):
    """`ulog2csv`."""
    names = ["timestamp", *(f"gyro_rad[{i}]" for i in range(3)), "gyro_integral_dt"]
    names += ["accelerometer_timestamp_relative", *(f"accelerometer_m_s2[{i}]" for i in range(3))]
    names += ["accelerometer_integral_dt", "accelerometer_clipping"]
    return lines(
        foot,
        lambda t, w, f: [f"{round(1e6 * t) + 12345}", *numbers(w), "5000", "0", *numbers(f), "5000", "0"],
        [",".join(names)],
    )


PROGRAMS = {
    "WitMotion, Bluetooth": witmotion_bluetooth,
    "WitMotion, PC": witmotion_usb,
    "WitMotion, first programs": witmotion_wide,
    "WitMotion, stamps without zeros": witmotion_unpadded,
    "WitMotion, two clocks": witmotion_chip,
    "SensorLog": sensorlog,
    "SensorLog, raw": sensorlog_raw,
    "Shimmer, quoted": shimmer_quoted,
    "Xsens without a clock": xsens_without_clock,
    "Shimmer Consensys": shimmer,
    "Physics Toolbox": physics_toolbox,
    "Physics Toolbox, decimal commas": physics_toolbox_clock,
    "EuRoC": euroc,
    "Xsens MT Manager": xsens,
    "Movella DOT": movella_dot,
    "rostopic -p": rostopic,
    "gaitmap": gaitmap,
    "PX4's CSV": px4,
}
NAMED = {
    "SensorLog": "sensorlog",
    "SensorLog, raw": "sensorlog",
    "Shimmer, quoted": "shimmer",
    "Xsens without a clock": "xsens",
    "Shimmer Consensys": "shimmer",
    "EuRoC": "euroc",
    "Xsens MT Manager": "xsens",
    "Movella DOT": "movella",
    "rostopic -p": "ros",
    "gaitmap": "gaitmap",
    "PX4's CSV": "px4",
}


@pytest.mark.parametrize("program", PROGRAMS)
def test_a_file_of_a_program(foot, tmp_path, program):
    (tmp_path / "a.csv").write_text(PROGRAMS[program](foot), encoding="utf-8", newline="")
    choice = Reading(sensor="right") if program == "gaitmap" else Reading()
    findings = same(tmp_path / "a.csv", foot, atol=1e-4, reading=choice)
    assert findings.format == NAMED.get(program, "csv")


def test_a_degree_sign_in_chinese_letters(foot, tmp_path):
    (tmp_path / "a.txt").write_bytes(witmotion_chip(foot).encode("gbk"))
    same(tmp_path / "a.txt", foot, atol=1e-4)
