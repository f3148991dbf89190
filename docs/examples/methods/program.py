"""The same dead reckoning as nav.cpp, as a program in Python that knows nothing of Footfall."""

import json
import math
import sys

import numpy as np

GRAVITY, REST_S = 9.80665, 25.0


def rotation(turn):
    """Rodrigues: the matrix of a rotation vector (rad)."""
    angle = math.sqrt(turn @ turn)
    s, c = (math.sin(angle) / angle, (1 - math.cos(angle)) / angle**2) if angle > 1e-12 else (1.0, 0.5)
    x, y, z = turn
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + s * cross + c * cross @ cross


def main(recording, track, start, params):
    rows = np.fromfile(recording, "<f8").reshape(-1, 7)
    with open(start) as one, open(params) as other:
        start, params = json.load(one), json.load(other)
    still_rate = params.get("still_rate", 1.0)
    t, gyro, accel = rows[:, 0], rows[:, 1:4], rows[:, 4:7]
    if t[-1] - t[0] < REST_S:
        sys.exit("too short: expected 25 s at rest and a walk")
    last = int(np.searchsorted(t - t[0], REST_S + 1e-6)) - 1
    gyro = gyro - gyro[1 : last + 1].mean(axis=0)
    up = accel[1 : last + 1].mean(axis=0)
    up /= np.linalg.norm(up)
    forward = np.array([1.0, 0.0, 0.0]) - up[0] * up
    forward /= np.linalg.norm(forward)
    heading = start["heading_rad"]
    level = np.array([forward, np.cross(up, forward), up])
    attitude = rotation(np.array([0.0, 0.0, heading])) @ level
    velocity, position = np.zeros(3), np.array(start["position_m"], dtype=float)
    still_since = told = t[last]
    lines = ["t,x,y,z,heading", ",".join(str(float(value)) for value in (told, *position, heading))]
    for k in range(last + 1, len(t)):
        dt = t[k] - t[k - 1]
        half = rotation(gyro[k] * dt / 2)
        middle = attitude @ half
        attitude = middle @ half
        before = velocity
        velocity = velocity + (middle @ accel[k] - np.array([0.0, 0.0, GRAVITY])) * dt
        position = position + (before + velocity) / 2 * dt
        if math.sqrt(gyro[k] @ gyro[k]) > still_rate or abs(math.sqrt(accel[k] @ accel[k]) - GRAVITY) > 4:
            still_since = t[k]
        if t[k] - still_since < 0.1:
            continue
        velocity = np.zeros(3)  # a foot that is at rest
        if told < still_since and t[k] - told > 0.4:
            told = t[k]
            heading += math.remainder(math.atan2(attitude[1, 0], attitude[0, 0]) - heading, 2 * math.pi)
            lines.append(",".join(str(float(value)) for value in (told, *position, heading)))
    with open(track, "w") as file:
        file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:5])
