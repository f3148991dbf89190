"""Files for other tools, and another tool's verdict on the same tracks."""

import numpy as np
import pytest

from footfall.conventions import heading_of
from footfall.errors import InputError
from footfall.hdr.methods import Reckoning, tracks
from footfall.models.imu import draw_unit, load_spec
from footfall.pdr.track import write_track
from footfall.scenarios.export import export, write_tum
from footfall.scenarios.judge.score import score
from footfall.scenarios.trial import start_pose
from footfall.simulate.record import record
from footfall.simulate.walk import write_walk
from tests.scenarios.test_score import elsewhere, planar_walk, reckoned

TURNED = 0.4


def test_poses_are_written_in_tums_order(tmp_path):
    walk = planar_walk(np.linspace(0, 2, 8))
    track = elsewhere(reckoned(walk, np.linspace(0, 0.3, 8)), TURNED, 3.0, -2.0)
    write_track(track, tmp_path / "track.parquet")
    write_walk(walk, tmp_path / "walk.parquet")
    assert export(tmp_path / "track.parquet", tmp_path / "track.tum") == 8
    assert export(tmp_path / "walk.parquet", tmp_path / "walk.tum") == len(walk.t)
    rows, truth = np.loadtxt(tmp_path / "track.tum"), np.loadtxt(tmp_path / "walk.tum")
    np.testing.assert_allclose(rows[:, :4], np.column_stack([track.t, track.position]), atol=1e-9)
    turned = heading_of(rows[:, [7, 4, 5, 6]])
    np.testing.assert_allclose(np.unwrap(turned - track.heading), 0, atol=1e-8)
    np.testing.assert_allclose(truth[:, 1:4], walk.position, atol=1e-9)
    np.testing.assert_allclose(truth[:, [7, 4, 5, 6]], walk.quaternion, atol=1e-9)


def test_kitti_and_csv_hold_the_same_poses(tmp_path):
    walk = planar_walk(np.linspace(0, 2, 8))
    write_walk(walk, tmp_path / "walk.parquet")
    for format, name in (("tum", "walk.tum"), ("kitti", "walk.kitti"), ("csv", "poses.csv")):
        assert export(tmp_path / "walk.parquet", tmp_path / name, format) == len(walk.t)
    rows = np.loadtxt(tmp_path / "walk.tum")
    np.testing.assert_array_equal(np.loadtxt(tmp_path / "poses.csv", delimiter=",", skiprows=1), rows)
    assert (tmp_path / "poses.csv").read_text().startswith("t,x,y,z,qx,qy,qz,qw\n")
    matrix = np.loadtxt(tmp_path / "walk.kitti").reshape(-1, 3, 4)
    np.testing.assert_allclose(matrix[:, :, 3], walk.position, atol=1e-9)
    forward = matrix[:, :, 0]  # of the body, in the world
    np.testing.assert_allclose(
        np.unwrap(np.arctan2(forward[:, 1], forward[:, 0])), heading_of(walk.quaternion), atol=1e-8
    )


def test_an_unknown_format_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"format 'kity' is unknown; did you mean kitti\?"):
        export(tmp_path / "walk.parquet", tmp_path / "walk.kml", "kity")


def evos_rmse(folder, track, walk, align):
    """Root mean square APE by evo (Grupp 2017) of the two TUM files, on the plane."""
    pytest.importorskip("evo")
    from evo.core import metrics, sync
    from evo.core.trajectory import Plane
    from evo.tools.file_interface import read_tum_trajectory_file

    write_tum(walk, folder / "walk.tum")
    write_tum(track, folder / "track.tum")
    truth, estimate = (read_tum_trajectory_file(folder / f"{name}.tum") for name in ("walk", "track"))
    truth, estimate = sync.associate_trajectories(truth, estimate, max_diff=1e-6)
    assert estimate.num_poses == len(track)
    for poses in (truth, estimate):
        poses.project(Plane.XY)
    if align == "rigid":
        estimate.align(truth)
    if align == "start":
        estimate.align_origin(truth)
    ape = metrics.APE(metrics.PoseRelation.translation_part)
    ape.process_data((truth, estimate))
    return ape.get_statistic(metrics.StatisticsType.rmse)


@pytest.mark.parametrize("align", ["none", "start", "rigid"])
def test_evo_finds_the_same_errors(tmp_path, align):
    walk = planar_walk(np.linspace(0, 3, 60))
    track = elsewhere(reckoned(walk, np.linspace(0.05, 0.9, 60), 1.01), TURNED, 3.0, -2.0)
    theirs = evos_rmse(tmp_path, track, walk, align)
    assert score(track, walk, align).position_rmse_m == pytest.approx(theirs, abs=1e-6)


def test_evo_finds_the_same_errors_of_a_simulated_walk(tmp_path, short_walk):
    recording = record(short_walk, draw_unit(load_spec("nimu"), 7), seed=7)
    for track in tracks(Reckoning(recording, start_pose(short_walk)), ["pdr", "hdr"]).values():
        for align in ("none", "rigid"):
            theirs = evos_rmse(tmp_path, track, short_walk, align)
            assert theirs > 0.01
            assert score(track, short_walk, align).position_rmse_m == pytest.approx(theirs, abs=1e-6)
