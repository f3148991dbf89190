"""Pictures of the walker, where there is something to draw with, and its viewer, where there is a screen."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import gymnasium as gym
import mujoco
import numpy as np
import pytest
from PIL import Image

from footfall.errors import InputError
from footfall.models.policy import stock_policy
from footfall.models.route import Ground
from footfall.simulate.draw import SIDE_VIEW, Stage, has_screen
from footfall.simulate.episode import Episode
from footfall.simulate.plan import Plan
from footfall.simulate.render import _timed
from footfall.simulate.signals import signal_panels
from footfall.simulate.walker.walkers import N_ACTION
from tests.helpers.commands import expect_one_sentence

STILL = np.zeros(N_ACTION, dtype=np.float32)


def draw(output: Path, *options: str) -> subprocess.CompletedProcess[str]:
    """`footfall render` in a process of its own: MuJoCo chooses what it draws with when first imported."""
    command = [sys.executable, "-m", "footfall", "render", "straight", "-o", str(output), *options]
    result = subprocess.run(
        command, capture_output=True, text=True, env={**os.environ}, check=False, timeout=300
    )
    if "nothing to draw with" in result.stderr:
        assert result.returncode == 2
        assert not output.exists()
        pytest.skip("neither a screen nor EGL on this machine")
    return result


def test_a_strip_shows_a_walker_that_moves(tmp_path: Path) -> None:
    result = draw(tmp_path / "strip.png", "--skip", "3")
    assert result.returncode == 0, result.stderr
    strip = np.asarray(Image.open(tmp_path / "strip.png").convert("RGB")).astype(int)
    height, width, _ = strip.shape
    assert width > 5 * height / 2
    # The trousers are dark blue and below the middle; they are in each picture, and not at the same place.
    dark = (strip.sum(axis=2) < 250) & (strip[:, :, 2] > strip[:, :, 0] + 10)
    thirds = np.array_split(dark, 3, axis=1)
    assert all(part.sum() > 500 for part in thirds)
    assert not np.array_equal(thirds[0][:, :200], thirds[1][:, :200])


def test_signals_run_beside_a_moving_picture(tmp_path: Path) -> None:
    result = draw(tmp_path / "walk.webp", "--seconds", "0.6", "--signals")
    assert result.returncode == 0, result.stderr
    with Image.open(tmp_path / "walk.webp") as clip:
        assert (clip.n_frames, clip.size) == (20, (980, 420))


def test_the_panel_uncovers_what_the_imu_says() -> None:
    """An IMU that turns about z at 90 deg/s and rests otherwise; pictures of 10 of its 12 control steps."""
    t = 1e-3 * np.arange(12 * 30)
    half = np.radians(90) * t / 2
    pose = np.column_stack([np.zeros((len(t), 3)), np.cos(half), 0 * t, 0 * t, np.sin(half)])
    panels = signal_panels(list(pose.reshape(12, 30, 7)), 10, 560, 420)
    assert [panel.shape for panel in panels] == [(420, 560, 3)] * 10
    below = [panel[70:200, :400].astype(int) for panel in panels]  # of the legend
    coloured = [np.flatnonzero((np.ptp(panel, axis=2) > 60).any(axis=0)) for panel in below]
    ends = [columns.max() for columns in coloured[:6]]
    assert (np.diff(ends) > 10).all()  # each control step shows some more
    # z turns to the left: its line is above that of x and y, which do not turn.
    middle = panels[-1][:200, 300].astype(int)
    of_z = np.flatnonzero(middle[:, 2] - middle[:, 0] > 60)
    others = np.flatnonzero(middle[:, 1] - middle[:, 2] > 40)
    assert of_z.max() < others.min()


def test_times_stand_at_the_head_of_a_strip() -> None:
    strip = Image.new("RGB", (7 * 240, 420), "white")
    head = np.asarray(_timed(strip, 7).convert("L"))[:44]
    dark = [(part < 128).sum() for part in np.array_split(head, 7, axis=1)]
    assert min(dark) > 30


def test_a_moving_picture_has_frames(tmp_path: Path) -> None:
    result = draw(tmp_path / "walk.webp", "--seconds", "1")
    assert result.returncode == 0, result.stderr
    with Image.open(tmp_path / "walk.webp") as clip:
        assert clip.n_frames == 33
        clip.load()
        assert clip.info["duration"] == 30  # ms: as fast as it was walked


def test_other_endings_are_refused(tmp_path: Path) -> None:
    result = draw(tmp_path / "walk.gif")
    assert result.returncode == 2
    assert "expected a name that ends in .webp or .png" in result.stderr


# The environment's pictures


def moved(plan: Plan, x: float, y: float) -> Plan:
    return replace(plan, route=replace(plan.route, x=plan.route.x + x, y=plan.route.y + y))


def colours(picture: np.ndarray) -> dict[str, np.ndarray]:
    """Where it is the red of the shirt and the orange of the path."""
    red, green, blue = picture.astype(int).transpose(2, 0, 1)
    return {
        "shirt": (red > 1.6 * green) & (red > 1.6 * blue) & (red > 80),
        "path": (red > 150) & (red > 1.2 * green) & (green > 1.8 * blue),
    }


def test_the_environments_camera_follows_the_walker_and_shows_its_path(short_plan: Plan) -> None:
    env = gym.make("footfall/Walk-v0", render_mode="rgb_array", width=320, height=240)
    found = []
    for asked in (short_plan, moved(short_plan, 500.0, 300.0), None):
        env.reset(seed=1, options={"scenario": asked})
        env.step(STILL)
        try:
            picture = env.render()
        except InputError:
            pytest.skip("neither a screen nor EGL on this machine")
        assert isinstance(picture, np.ndarray)
        assert (picture.shape, picture.dtype) == ((240, 320, 3), np.uint8)
        found.append(colours(picture))
    env.close()
    here, there, commanded = found
    assert here["shirt"].sum() > 200
    across, down = (np.nonzero(here["shirt"])[axis].mean() for axis in (1, 0))
    assert 120 < across < 200
    assert 40 < down < 160
    assert np.mean(here["shirt"] != there["shirt"]) < 0.01
    assert here["path"].sum() > 50
    assert commanded["path"].sum() < 10


def ground_marks(stage: Stage) -> dict[str, np.ndarray]:
    """(n, 3) places of what lies on the ground: dashes of the path, halves of footprints."""
    scene = mujoco.MjvScene(stage.model, 1000)
    stage.decorate(scene)
    kinds = {"dash": mujoco.mjtGeom.mjGEOM_BOX, "print": mujoco.mjtGeom.mjGEOM_ELLIPSOID}
    marks = list(scene.geoms[: scene.ngeom])
    return {
        name: np.array([mark.pos for mark in marks if mark.type == kind]).reshape(-1, 3)
        for name, kind in kinds.items()
    }


def test_feet_that_stand_leave_prints_under_them_on_the_path(short_plan: Plan) -> None:
    episode = Episode(short_plan, stock_policy().feedback_gains, stand=5.0)
    route = episode.plan.route
    line = np.column_stack([route.x, route.y])
    stage = Stage(episode.walkers, episode.plan.subject.build, episode)
    assert len(ground_marks(stage)["print"]) == 0  # it has not touched the ground yet
    for _ in range(30):
        episode.walkers.step(STILL[None])
        episode.steer()
        stage.update()
    marks = ground_marks(stage)
    assert marks["print"].shape == (4, 3)  # two feet, heel and ball; still feet leave no more
    assert np.abs(marks["print"][:, 2]).max() < 0.02
    assert sorted(np.sign(marks["print"][:, 1])) == [-1, -1, 1, 1]
    off = [np.linalg.norm(line - dash[:2], axis=1).min() for dash in marks["dash"]]
    assert len(off) > 10
    assert max(off) < 0.1
    stage.restart()
    assert len(ground_marks(stage)["print"]) in (0, 4)
    episode.walkers.close()


def test_on_slopes_their_ground_alone_is_seen(short_plan: Plan) -> None:
    """Not a level plane as well, nor the planes that the feet tread on."""
    heights = np.tile(-0.05 * np.arange(-12.0, 40.0), (60, 1)).astype(np.float32)
    downhill = replace(short_plan, ground=Ground(-12.0, -12.0, 1.0, heights))
    for plan, expected in (
        (short_plan, mujoco.mjtGeom.mjGEOM_PLANE),
        (downhill, mujoco.mjtGeom.mjGEOM_HFIELD),
    ):
        episode = Episode(plan, stock_policy().feedback_gains, stand=1.0)
        stage = Stage(episode.walkers, episode.plan.subject.build, episode)
        scene = mujoco.MjvScene(stage.model, 1000)
        everything, option = mujoco.mjtCatBit.mjCAT_ALL.value, mujoco.MjvOption()
        camera = stage.camera(SIDE_VIEW)
        mujoco.mjv_updateScene(stage.model, stage.data, option, None, camera, everything, scene)
        seen = {geom.type for geom in scene.geoms[: scene.ngeom]}
        grounds = {mujoco.mjtGeom.mjGEOM_PLANE.value, mujoco.mjtGeom.mjGEOM_HFIELD.value}
        assert seen & grounds == {expected.value}
        episode.walkers.close()


# Viewers


def test_without_a_screen_nothing_is_viewed(cli, monkeypatch, tmp_path) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    if has_screen():
        pytest.skip("this system's screen does not show in its environment")
    expect_one_sentence(*cli("walk straight --view"), "no screen to open MuJoCo's viewer on")
    expect_one_sentence(*cli(f"walk straight --view -o {tmp_path}/w.parquet"), "no screen")
    assert not list(tmp_path.iterdir())
    env = gym.make("footfall/Walk-v0", render_mode="human")
    with pytest.raises(InputError, match="no screen"):
        env.reset(seed=1)
    env.close()


def test_a_walk_that_is_neither_written_nor_viewed_is_refused(cli) -> None:
    expect_one_sentence(*cli("walk straight"), "Missing option '--output' / '-o'")


@pytest.mark.skipif(not has_screen(), reason="no screen")
def test_on_a_screen_the_viewer_opens_follows_and_closes() -> None:
    env = gym.make("footfall/Walk-v0", render_mode="human")
    for scenario in (None, "straight"):
        env.reset(seed=1, options={"scenario": scenario})
        for _ in range(10):
            env.step(STILL)
    assert env.render() is None
    env.close()
    env.close()
