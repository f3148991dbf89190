"""Real feet: strides counted, footprints and ends met. Bounds are about twice what was measured.

The recordings stand still for seconds, not for 25, so the static bias is averaged over what there is.
"""

from pathlib import Path

import numpy as np
import pytest

from footfall.hdr.methods import METHODS, Reckoning, tracks
from footfall.pdr.pdr import PdrParams, dead_reckon
from footfall.recording import Recording

G = 9.80665


def xio(folder: Path, name: str) -> Recording:
    """NGIMU, 400 Hz, deg/s and g; about 1 % of the rows are there twice."""
    rows = np.loadtxt(folder / "xio" / f"{name}.csv", delimiter=",", skiprows=1)
    rows = rows[np.diff(rows[:, 0], prepend=-1.0) > 0]
    return Recording(t=rows[:, 0], gyro=np.radians(rows[:, 1:4]), accel=G * rows[:, 4:7])


def openshoe(folder: Path, run: int) -> Recording:
    """3DM-GX2 in the sole, 250 Hz, g and rad/s; stamps jitter, samples do not."""
    rows = np.loadtxt(folder / "openshoe" / f"data_inert_{run}.txt", skiprows=4, usecols=range(1, 7))
    return Recording(t=np.arange(len(rows)) / 250.0, gyro=rows[:, 3:].copy(), accel=G * rows[:, :3])


def gdin(folder: Path, experiment: int) -> tuple[Recording, np.ndarray]:
    """3DM-GX5 mounted z down, 200-250 Hz, and its footprints: t, x, y, the first before the walk."""
    path = folder / "gdin" / f"SensorConnectData_{experiment}.csv"
    with path.open() as file:
        names = [name.split(":", 1)[-1] for name in file.readline().strip().split(",")]
    accel, gyro, unit = (
        ("scaledAccel", "scaledGyro", 9.8029)
        if experiment <= 40
        else ("estCompensatedAccel", "estAngularRate", 1.0)
    )
    columns = [0, *(names.index(kind + axis) for kind in (gyro, accel) for axis in "XYZ")]
    rows = np.loadtxt(path, delimiter=",", skiprows=1, usecols=columns)
    prints = np.loadtxt(
        path.with_name(f"{path.stem}_strideIndex_timestamp_gcpX_gcpY.csv"), delimiter=",", skiprows=1
    )[:, 1:]
    prints[:, 2] *= -1  # their frame is z down
    return Recording(t=rows[:, 0], gyro=rows[:, 1:4].copy(), accel=unit * rows[:, 4:7]), prints


@pytest.mark.parametrize(("name", "strides"), [("short_walk", 16), ("long_walk", 37)])
def test_xio_walks_return_to_their_start(real_data, name, strides):
    found = dead_reckon(xio(real_data, name), PdrParams(bias_s=10.0))
    assert len(found) - 1 == strides
    end = found.position[-1] - found.position[0]
    assert np.hypot(*end[:2]) < 0.01 * found.distance.sum()


@pytest.mark.parametrize(("run", "strides", "bias_s"), [(31, 50, 1.0), (44, 44, 2.0)])
def test_openshoe_figures_of_eight_close(real_data, run, strides, bias_s):
    """The 50 strides at 5 km/h are the recorder's count, the 44 at 7 km/h are what was found."""
    found = dead_reckon(openshoe(real_data, run), PdrParams(bias_s=bias_s))
    assert len(found) - 1 == strides
    assert found.distance.sum() == pytest.approx(78.0, rel=0.01)
    end = found.position[-1] - found.position[0]
    assert np.hypot(*end[:2]) < 0.01 * found.distance.sum()


@pytest.mark.parametrize(("experiment", "bias_s"), [(32, 1.0), (36, 2.0), (45, 1.0)])
def test_gdin_footprints_are_met(real_data, experiment, bias_s):
    recording, prints = gdin(real_data, experiment)
    found = dead_reckon(recording, PdrParams(bias_s=bias_s))
    assert len(found) == len(prints)  # one footfall a footprint
    assert np.abs(found.t - prints[:, 0])[1:-1].max() < 0.5

    walked = np.hypot(*np.diff(prints[:, 1:], axis=0).T).sum()
    assert found.distance.sum() == pytest.approx(walked, rel=0.02)  # the paper: 1-2 % of the distance
    # The footprints' frame is turned by an unknown angle: compare after the best rigid fit.
    ours = found.position[:, :2] @ [1, 1j]
    theirs = prints[:, 1:] @ [1, 1j]
    ours, theirs = ours - ours.mean(), theirs - theirs.mean()
    turn = np.vdot(ours, theirs)
    off = np.abs(ours * turn / abs(turn) - theirs)
    assert np.sqrt(np.mean(off**2)) < 0.8


def test_every_method_runs_on_a_real_recording(real_data):
    found = tracks(Reckoning(xio(real_data, "long_walk"), pdr=PdrParams(bias_s=10.0)), METHODS)
    for track in found.values():
        assert np.isfinite(track.position).all()
        assert len(track) == 38
