"""The state of n walkers as one table of records, which the compiled control step reads and writes.

The laws of the control step (`_balance_kernels`, `_gait_kernels`, `_posture_kernels`) are written once, for
one walker `s`. Compiled, `s` is a record and every quantity a number; in plain numpy, `s` is `Columns` and
every quantity an array over the walkers: the twin that the tests compare the compiled code with.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from footfall.models import body

# Residual (rad) for an action of 1.
ACTION_SCALE = 3.3 * np.array([0.2, 0.2, 0.2] + [0.35, 0.25, 0.25, 0.35, 0.25, 0.15] * 2 + [0.2, 0.2])

CREEP = 0.30  # m/s at most, of a walker that wishes to stand and drifts backwards

# Places in `varied`: cadence, hip excursion (both relative), step width (m), toe-out of each foot (rad), how
# far the swinging foot turns out on its way (rad), excursion of knee and ankle (relative).
CADENCE, AMPLITUDE, WIDTH, TOE_OUT_RIGHT, TOE_OUT_LEFT, TWIST, BEND = range(7)
N_VARIED = 7
# Places in `level`.
OF_PLACEMENT, OF_CADENCE, OF_TOE_OUT = range(3)

WALKER = np.dtype(
    [
        ("dt", float),  # s, control interval
        # the body, after the last physics step
        ("qpos", float, 7 + body.N_JOINTS),
        ("qvel", float, 6 + body.N_JOINTS),
        ("sensor", float, body.N_SENSOR),
        ("fresh", bool),  # no physics yet, so no sensors
        ("up", float, 3),  # against gravity, in the frame of qpos
        ("ground", float),  # m, height under the pelvis
        ("gradient", float, 2),  # of the ground, x and y
        # commands
        ("heading", float),
        ("speed", float),
        ("speed_goal", float),
        ("turn", float),
        ("turn_goal", float),
        ("mean_velocity", float, 2),  # along and across the commanded heading: command and mean error
        # the gait
        ("phase", float),  # of the stride, 0 at the right heel strike
        ("advance", float),  # of the phase in this control step
        ("next_phase", float),
        ("residual", float, body.N_SERVOS),  # feedback and policy as applied, in units of ACTION_SCALE
        ("next_residual", float, body.N_SERVOS),
        ("feedback", float, body.N_SERVOS),  # rad, for right stance
        ("level", float, 3),  # of variability: of foot placement, cadence and toe-out
        ("slow", float),  # part of the cadence
        ("asymmetry", float),
        ("varied", float, N_VARIED),
        ("varied_goal", float, N_VARIED),
        ("varied_mean", float, N_VARIED),
        # standing
        ("gate", float),  # 0 stands, 1 walks
        ("gate_before", float),  # this control step
        ("closing", bool),  # has decided to stand, or stands
        ("stagger", float),  # rad, pose of the standing feet: one before the other
        ("spread", float),  # rad, apart
        ("out_right", float),  # rad, turned out
        ("out_left", float),
        ("capture", float),  # m, of the capture point before the standing point (4.6 cm before the ankles)
        ("waiting", float),  # s, for which it has stepped on the spot because no stand could begin
        ("stopping", bool),  # wishes to stand and is nearly there, or stands; not on steep slopes
        # setting out
        ("weight", float),  # N
        ("setting_out", bool),  # from the wish to walk in a stand until the first step has landed
        ("left_stands", bool),  # through the first step
        ("shift", float),  # s, for which the weight has been shifting
        # what observation, feedback and reward share: `posture`
        ("rotation", float, (3, 3)),  # body to world
        ("yaw", float),
        ("cos", float),
        ("sin", float),
        ("up_body", float, 3),
        ("pitch", float),  # nose down, relative to gravity
        ("roll", float),
        ("yaw_error", float),
        ("height", float),  # m, of the pelvis over the ground
        ("grade_forward", float),
        ("grade_left", float),
        ("tilt_forward", float),  # of the ground in the frame of qpos, where grade is that against gravity
        ("tilt_left", float),
        ("left_stance", bool),
        ("fallen", bool),  # down, toppled, turned away from the commanded heading, or not finite
    ],
    align=True,
)


class Columns:
    """Records as columns: attribute `name` has the shape of one record's field, then (n,)."""

    def __init__(self, records: np.ndarray) -> None:
        names = records.dtype.names or ()
        fields = {name: np.moveaxis(records[name], 0, -1) for name in names}
        object.__setattr__(self, "_fields", fields)

    def __getattr__(self, name: str) -> Any:
        return self._fields[name]

    def __setattr__(self, name: str, value: Any) -> None:
        self._fields[name][...] = value
