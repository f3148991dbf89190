"""What a column's name says: which axis of which sensor, in which unit, as people and loggers write it.

A name is cut into words. One of them is the quantity, one the axis, the others unit, sensor, or what makes
it another quantity: `gyro_x_deg_s`, `Acc Y [g]`, `field.angular_velocity.x`, `Shimmer_8A2F_Gyro_X_CAL`,
`left_gyr_x`, `w_RS_S_x [rad s^-1]`, `accelerometer_m_s2[0]`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from footfall.formats.units import INCREMENTS, unit_size

AXES = ("x", "y", "z")
_QUANTITIES = {
    "gyro": "gyroscope gyro gyros gyr gyrorotation angularrate angularvelocity angularspeed angvel angrate "
    "rotationrate rateofturn turnrate rotation omega drehrate winkelgeschwindigkeit gyroskop as w g",
    "accel": "accelerometer accelerometers accel acceleration accelerations acc specificforce "
    "totalacceleration linearacceleration useracceleration accelerometeracceleration linearaccel lacc force "
    "beschleunigung beschl gf a f",
    "gyro increment": "deltatheta deltaangle dtheta dangle thetainc angleinc",
    "accel increment": "deltav deltavelocity deltavel dvel dv velinc velocityincrement",
}
_WORDS = {word: quantity for quantity, words in _QUANTITIES.items() for word in words.split()}
_TIME = {"t", "time", "timestamp", "timestamps", "stamp", "ts", "epoch", "epoc", "elapsed", "clock", "zeit"}
# Words beside the quantity that change nothing, or tell how good it is: the lower the better.
_PLAIN = {
    *("cal", "calibrated", "scaled", "comp", "data", "value", "values", "axis", "sensor", "field", "field's"),
    *("reading", "rs", "s", "b", "body", "motion", "signal"),
}
_RANKS = {"wr": -1, "ln": 1, "raw": 2, "uncal": 2, "uncalibrated": 2, "linear": 3}
# Gravity is missing from these: they are taken only where there is nothing else, and physics says why not.
_WITHOUT_GRAVITY = {"user", "free", "useracceleration", "lacc"}
_OTHERS = {
    *(
        "mag",
        "magnetometer",
        "bias",
        "biases",
        "covariance",
        "cov",
        "variance",
        "var",
        "std",
        "noise",
        "mean",
    ),
    *("jerk", "norm", "magnitude", "gravity", "quat", "euler", "offset", "scale", "temp", "temperature"),
}
_PLACES = {"left", "right", "l", "r", "lf", "rf", "foot", "heel", "instep", "toe", "shank", "ankle", "shoe"}
_CLOCK = {
    *("unix", "sys", "system", "sensor", "device", "header", "since", "start", "in", "utc", "gps", "local"),
    *("host", "log", "logging", "sample", "fine", "of", "from", "chip", "cal", "rel", "relative", "field"),
}
ID_WORDS = {
    *("sensor", "sensorid", "device", "devicename", "deviceid", "id", "node", "imu", "foot", "side", "tag"),
    *("mac", "address", "serial", "frame", "topic", "location", "placement", "name", "sensorname", "imuid"),
}


@dataclass(frozen=True)
class Named:
    """What a name says.

    Attributes
    ----------
    channel : "gyro_x", ..., "accel_z", "t" or "temperature"
    size : of its unit in SI; None where the name states none
    sensor : words that tell one sensor from another; "" for none
    rank : of several such columns of a sensor, the lowest is meant
    increment : whether it is what a rate or force adds up to over an interval
    """

    channel: str
    size: float | None = None
    sensor: str = ""
    rank: int = 0
    increment: bool = False


def understood(name: str, first: int = 0) -> Named | None:
    """What a column of this name holds; None where it is none of an IMU's channels.

    first : index of the x axis, where axes are numbered
    """
    name = name.strip()
    if match := re.fullmatch(r"gF([xyz])", name):  # Physics Toolbox
        return Named(f"accel_{match[1]}", unit_size("accel", "g"), rank=-1)
    bracket = re.search(r"[\[(](?!\d*[\])])(.*)[\])]\s*$", name)
    text = name[: bracket.start()] if bracket else name
    stated = bracket[1] if bracket else None
    words = _words(text)
    if not words:
        return None
    return _moved(words, stated, first) or _timed(words, stated) or _warm(words, stated)


def _words(text: str) -> list[str]:
    text = re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])|(?<=[a-z]{3})(?=\d+$)", " ", text)
    found: list[str] = []
    for word in re.findall(r"[a-z0-9°']+", text.lower().replace("ω", "w")):
        # "gx", "accy" and "zgyro" are two words.
        if word[-1] in AXES and word[:-1] in _WORDS:
            found += [word[:-1], word[-1]]
        elif word[0] in AXES and len(word) > 3 and word[1:] in _WORDS:
            found += [word[1:], word[0]]
        else:
            found.append(word)
    return found


def _moved(words: list[str], stated: str | None, origin: int) -> Named | None:
    """A gyro's or an accelerometer's axis."""
    if _OTHERS & set(words):
        return None
    found = _quantity(words)
    if found is None:
        return None
    quantity, first, last = found
    kind, _, increment = quantity.partition(" ")
    before, after = words[:first], words[last:]
    axes = {**dict(zip(AXES, AXES, strict=True)), **{str(origin + i): name for i, name in enumerate(AXES)}}
    axis = next((word for word in reversed(after) if word in axes), None)
    if axis is None:
        axis = next((word for word in before if word in AXES), None)
        if axis is None:
            return None
        before = [word for word in before if word != axis]
    else:
        at = len(after) - 1 - after[::-1].index(axis)
        after = after[:at] + after[at + 1 :]
    axis = axes[axis]
    size, after, known = _size(kind, stated, after, bool(increment))
    if not known or any(not _beside(word) for word in after):
        return None
    others = [*before, *words[first:last], *after]
    rank = sum(_RANKS.get(word, 0) for word in others) + 9 * bool(_WITHOUT_GRAVITY & set(others))
    rank += 3 * any("linear" in word for word in words[first:last])
    return Named(f"{kind}_{axis}", size, _sensor(before, after), rank, bool(increment))


def _quantity(words: list[str]) -> tuple[str, int, int] | None:
    """The longest quantity, and the words that name it; single letters only beside their axis."""
    for length in (3, 2, 1):
        for first in range(len(words) - length + 1):
            joined = "".join(words[first : first + length])
            if joined not in _WORDS or (length == 1 and len(joined) == 1):
                continue
            return _WORDS[joined], first, first + length
    for first, word in enumerate(words[:-1]):
        beside = words[first + 1] in AXES or words[first + 1 : first + 3] == ["rs", "s"]
        if len(word) == 1 and word in _WORDS and beside:
            return _WORDS[word], first, first + 1
    return None


def _size(
    kind: str, stated: str | None, words: list[str], increment: bool
) -> tuple[float | None, list[str], bool]:
    """Size of the unit, the words left, and whether what is stated is a unit at all."""
    units = {"units": INCREMENTS} if increment else {}
    if stated is not None:
        size = unit_size(kind, stated, **units)
        return size, words, size is not None or not stated.strip()
    for length in range(len(words), 0, -1):
        for first in range(len(words) - length + 1):
            size = unit_size(kind, "_".join(words[first : first + length]), **units)
            if size is not None:
                return size, words[:first] + words[first + length :], True
    if kind == "gyro" and words in (["rad"], ["deg"]) and not increment:  # PX4: gyro_rad[0]
        return unit_size(kind, words[0] + "/s"), [], True
    return None, words, True


def _beside(word: str) -> bool:
    return word in _PLAIN or word in _RANKS or word in _PLACES or word.isdigit()


def _sensor(before: list[str], after: list[str]) -> str:
    silent = {*_PLAIN, *_RANKS, *_WITHOUT_GRAVITY, "imu"}
    return "_".join(word for word in (*before, *after) if word not in silent)


def _timed(words: list[str], stated: str | None) -> Named | None:
    places = [place for place, word in enumerate(words) if word in _TIME]
    if not places:
        # A unit alone, "ms": a single s may be anything.
        alone = unit_size("t", words[0]) if len(words) == 1 and len(words[0]) > 1 and stated is None else None
        return None if alone is None else Named("t", alone, rank=2)
    size = None if stated is None else unit_size("t", stated)
    last, rank, sensor = places[-1], 1, []
    for place, word in enumerate(words):
        # "S_Foot_Timestamp" is no time in seconds.
        unit = unit_size("t", word) if word not in _TIME and (len(word) > 1 or place > places[0]) else None
        if unit is not None:
            size = size or unit
        elif word in _TIME or word in _CLOCK:
            rank -= word in ("header", "fine", "elapsed")
        elif place < last:
            sensor.append(word)
        else:
            return None
    return Named("t", size, "_".join(sensor), rank)


def _warm(words: list[str], stated: str | None) -> Named | None:
    if not {"temp", "temperature"} & set(words):
        return None
    left = [word for word in words if word not in ("temp", "temperature")]
    size, left, known = _size("temperature", stated, left, False)
    return Named("temperature", size, _sensor(left, [])) if known and len(left) < 2 else None
