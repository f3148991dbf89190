"""Names and units of the columns of files, for all that write and read them; docs/files.md says the same.

What a method adds to its track stands with the method, under names that are none of these.
"""

from __future__ import annotations

from collections.abc import Mapping

POSITION = ("px", "py", "pz")
QUATERNION = ("qw", "qx", "qy", "qz")
VELOCITY = ("vx", "vy", "vz")
GYRO = ("gyro_x", "gyro_y", "gyro_z")
ACCEL = ("accel_x", "accel_y", "accel_z")
PLACE = ("x", "y", "z")

_SAMPLES = {"t": "s", **dict.fromkeys(GYRO, "rad/s"), **dict.fromkeys(ACCEL, "m/s2")}

RECORDING: Mapping[str, str] = {**_SAMPLES, "temperature": "degC"}
FOOTFALLS: Mapping[str, str] = {"t": "s", **dict.fromkeys(PLACE, "m"), "heading": "rad"}
TRACK = FOOTFALLS  # what every track has, from whatever program
WALK: Mapping[str, str] = {
    "t": "s",
    **dict.fromkeys(POSITION, "m"),
    **dict.fromkeys(QUATERNION, ""),
    **dict.fromkeys(VELOCITY, "m/s"),
    **_SAMPLES,
    "contact": "body weight",
    "stance": "",
}
BUDGET: Mapping[str, str] = {"t": "s", "interval": "s", "total": "rad/s"}
CAUSE = "rad/s"  # of each of a budget's causes, which are columns, too
