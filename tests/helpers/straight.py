"""Some twenty strides straight ahead, walked once for all who ask."""

from functools import cache

import numpy as np
from scipy.spatial.transform import Rotation

from benchmarks.validation._gait_walks import Case, Motion, samples, walk_straight
from footfall.models.mount import MOUNTS
from footfall.recording import Recording


@cache
def walked() -> Motion:
    """The walker at every physics step."""
    return walk_straight(Case("reference", 1.3), 34.0)


@cache
def recorded(mount: str) -> Recording:
    """What a perfect IMU at a mount of the right foot says."""
    return samples(walked(), mount)


def site(mount: str) -> tuple[np.ndarray, Rotation]:
    """Where the IMU at a mount is, and the foot's attitude."""
    motion = walked()
    attitude = Rotation.from_quat(motion.foot[:, 3:], scalar_first=True)
    return motion.foot[:, :3] + attitude.apply(np.array(MOUNTS[mount].position) * motion.scale), attitude
