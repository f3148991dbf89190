"""How high the pelvis is over level ground in a pose of the reference motion."""

from __future__ import annotations

import mujoco
import numpy as np

from footfall.models import body, gait


def _lowest(model: mujoco.MjModel, data: mujoco.MjData, joints: np.ndarray) -> float:
    """Height of the pelvis over the sole that is lowest in this pose (m)."""
    touching = [model.geom(f"{part}_{side}").id for side in "rl" for part in ("sole_in", "sole_out", "toe")]
    data.qpos[:] = 0
    data.qpos[3] = 1
    data.qpos[7:] = joints
    mujoco.mj_kinematics(model, data)

    def reach(g: int) -> float:
        """Of a sphere or an ellipsoid below its centre."""
        size = model.geom_size[g]
        if model.geom_type[g] == mujoco.mjtGeom.mjGEOM_SPHERE:
            return float(size[0])
        return float(np.linalg.norm(size * data.geom_xmat[g].reshape(3, 3)[2]))

    return -min(data.geom_xpos[g][2] - reach(g) for g in touching)


def standing_height(model: mujoco.MjModel) -> float:
    """Pelvis height (m) of a body that stands on level ground."""
    joints = np.zeros(body.N_JOINTS)
    joints[body.SERVO_JOINT] = gait.STANDING
    return _lowest(model, mujoco.MjData(model), joints)


def gait_heights(model: mujoco.MjModel) -> np.ndarray:
    """Pelvis height (m) at 100 phases of the stride at which the lower foot touches level ground."""
    data, heights = mujoco.MjData(model), np.zeros(100)
    for i in range(len(heights)):
        phase = i / len(heights)
        joints = np.zeros(body.N_JOINTS)
        joints[body.SERVO_JOINT] = gait.reference_angles(np.array(phase), np.array(1.25))
        for side, offset in (("r", 0.0), ("l", 0.5)):
            if 0.3 < (phase + offset) % 1 < 0.63:  # the toe bends under a lifted heel
                flexion = [
                    joints[body.JOINTS.index(f"{name}_{side}")] for name in ("hip_flexion", "knee", "ankle")
                ]
                foot_pitch = flexion[0] - flexion[1] + flexion[2]
                joints[body.JOINTS.index(f"toe_{side}")] = np.clip(-foot_pitch, 0, 0.6)
        heights[i] = _lowest(model, data, joints)
    return heights
