"""Drawing of a walk: the walker, the path that it follows and its footprints, as pictures or in a window.

Everything here is in the units of the simulated body (models.subject). GL is loaded when something is drawn.
"""

from __future__ import annotations

import os
import sys
import threading
import time
import warnings
from collections import deque
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from footfall.errors import InputError
from footfall.models import body
from footfall.models.body import build_body
from footfall.models.route import Ground, Route
from footfall.models.subject import Build
from footfall.simulate.walker.walkers import CONTROL_INTERVAL, Walkers

if TYPE_CHECKING:
    from footfall.simulate.episode import Episode

# (azimuth from the walker's heading in degrees, elevation in degrees, distance in m)
View = tuple[float, float, float]
QUARTER_VIEW: View = (130.0, -16.0, 3.5)  # from the front, on the right, where the IMU is
SIDE_VIEW: View = (100.0, -8.0, 3.0)
_EYE_HEIGHT = 0.88  # m above the ground, of what the camera is turned to
_LOADED_N, _FLAT_M = 200.0, 0.02  # a foot that carries so much and is so flat leaves a print
_PRINT_SPACING = 0.25  # m between prints of one foot
_HEEL, _BALL = -0.03, 0.115  # m before the ankle
_PRINTS = 80
_DASH_EVERY, _DASH_NEAR = 0.5, 12.0  # m
_DASH_RGBA = (0.93, 0.60, 0.12, 1.0)
_PRINT_RGBA = (0.36, 0.36, 0.36, 1.0)
_IMU_RGBA = (1.0, 0.80, 0.0, 1.0)
_FOOTFALL_RGBA = (0.10, 0.36, 0.66, 1.0)  # of the foot that wears the IMU
_PATCH_M, _PATCH_CELL_M = 80.0, 1.0  # of the ground is drawn, each way; on a grid of at least this
_ABOVE = 0.006  # m by which what lies on the ground is lifted from it


class Stage:
    """One walker as it is drawn, with the line that it follows and the prints that it leaves.

    Parameters
    ----------
    walkers : the first of them is drawn; build : its body's
    episode : of it, with a route to show and the ground; or None

    Attributes
    ----------
    model, data : MuJoCo's, for drawing alone
    moves : how often the part of the ground that is drawn has moved
    """

    def __init__(self, walkers: Walkers, build: Build, episode: Episode | None = None) -> None:
        plan = None if episode is None else episode.plan
        self.walkers, self.moves = walkers, 0
        self._ground = None if plan is None else plan.ground
        patch = None if self._ground is None else _patch(self._ground, walkers.qpos[0])
        # Sloping, or a level plane would be seen too; the planes under the feet are not drawn.
        self.model = model = build_body(
            build,
            timestep=walkers.models[0].opt.timestep,
            mounts=() if plan is None else (plan.mount,),
            sloping=patch is not None,
            looks=True,
            scenery=patch,
        )
        if patch is not None:
            self._move_ground()
        # Clipping and shadows to the walker's scale, not to that of a landscape of a kilometre.
        model.stat.extent, model.stat.center[:] = 2.0, 0.0
        if self._ground is not None:  # which at the usual 4 would have speckles in its own shade
            model.vis.map.shadowclip = 12
        self.data = mujoco.MjData(model)
        self._dashes = None if plan is None else _dashes(plan.route)
        self._prints: deque[tuple[str, np.ndarray, np.ndarray]] = deque(maxlen=_PRINTS)
        imu = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, "imu_0")
        self._imu = imu
        self._instrumented = "" if imu < 0 else model.body(model.site_bodyid[imu]).name[-1]
        self.update()

    def update(self) -> None:
        """Take the walker's present pose and remember its prints: once a control step."""
        if self._ground is not None:
            middle = self.model.geom("scenery").pos
            if np.abs(self.walkers.qpos[0, :2] - middle[:2]).max() > _PATCH_M / 4:
                self._move_ground()
        self.data.qpos[:] = self.walkers.qpos[0]
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)
        force = self.walkers.sensor[0, body.SENSOR_TOUCH].reshape(2, 3).sum(axis=1)
        for side, load in zip("rl", force, strict=True):
            heel, ball = (self._sole(f"foot_{side}", x) for x in (_HEEL, _BALL))
            if load < _LOADED_N or abs(ball[2] - heel[2]) > _FLAT_M:
                continue
            last = next((place for foot, _, place in reversed(self._prints) if foot == side), None)
            if last is None or np.linalg.norm(ball - last) > _PRINT_SPACING:
                self._prints.append((side, heel, ball))

    def _move_ground(self) -> None:
        """Draw the part of the ground round the walker: the whole of it would take seconds a picture."""
        assert self._ground is not None
        patch = _patch(self._ground, self.walkers.qpos[0])
        low, high = float(self._ground.heights.min()), float(self._ground.heights.max())
        half = (np.array(patch.heights.shape[::-1]) - 1) * patch.cell / 2
        self.model.hfield_data[:] = ((patch.heights - low) / (high - low)).ravel()
        self.model.hfield_size[0, 2] = high - low
        self.model.geom("scenery").pos = patch.x0 + half[0], patch.y0 + half[1], low
        self.moves += 1

    def _sole(self, foot: str, x: float) -> np.ndarray:
        """(3,) m, a point of the sole, x m before the ankle."""
        frame = self.data.body(foot)
        return frame.xpos + frame.xmat.reshape(3, 3) @ [x, 0, -body.ANKLE_HEIGHT] + [0, 0, _ABOVE]

    def restart(self) -> None:
        """Forget the prints: the walker has been put elsewhere."""
        self._prints.clear()
        self.update()

    def camera(self, view: View) -> mujoco.MjvCamera:
        """A camera that goes along with the walker and turns with the heading that it is told."""
        walkers, camera = self.walkers, mujoco.MjvCamera()
        azimuth, camera.elevation, camera.distance = view
        camera.azimuth = np.degrees(walkers.heading[0]) + azimuth
        x, y, z = walkers.qpos[0, :3]
        # Not at the pelvis, with which the world would bob up and down.
        camera.lookat[:] = x, y, z - walkers.height[0] + _EYE_HEIGHT
        return camera

    def decorate(self, scene: Any) -> None:
        """Add the line and the prints to a MuJoCo scene."""
        if self._imu >= 0:  # the IMU is small: its box is drawn larger
            _add_box(scene, (0.034, 0.024, 0.016), self.data.site(self._imu), _IMU_RGBA)
        if self._dashes is not None:
            middle, heading, slope = self._dashes
            near = np.hypot(*(middle[:, :2] - self.data.qpos[:2]).T) < _DASH_NEAR
            box = mujoco.mjtGeom.mjGEOM_BOX
            for place, psi, rise in zip(middle[near], heading[near], slope[near], strict=True):
                _add(scene, box, (0.13, 0.022, 0.001), place, psi, rise, _DASH_RGBA)
        for side, heel, ball in self._prints:
            rgba = _FOOTFALL_RGBA if side == self._instrumented else _PRINT_RGBA
            along = ball - heel
            psi, length = float(np.arctan2(along[1], along[0])), float(np.hypot(*along[:2]))
            rise, round_ = along[2] / length, mujoco.mjtGeom.mjGEOM_ELLIPSOID
            _add(scene, round_, (0.085, 0.046, 0.002), ball, psi, rise, rgba)
            _add(scene, round_, (0.052, 0.034, 0.002), heel, psi, rise, rgba)


def _patch(ground: Ground, at: np.ndarray) -> Ground:
    """The ground round a place (m), coarser; as large wherever that is: beyond its edge it goes on level."""
    every = max(1, round(_PATCH_CELL_M / ground.cell))
    cell, count = every * ground.cell, round(_PATCH_M / (every * ground.cell))
    rows, columns = ground.heights.shape
    middle = np.round((at[:2] - [ground.x0, ground.y0]) / ground.cell).astype(int)
    column, row = middle - every * (count // 2)
    steps = every * np.arange(count + 1)
    j, i = np.clip(row + steps, 0, rows - 1), np.clip(column + steps, 0, columns - 1)
    x0, y0 = ground.x0 + column * ground.cell, ground.y0 + row * ground.cell
    return Ground(x0, y0, cell, ground.heights[np.ix_(j, i)])


def _dashes(route: Route) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Middles (m, 3), headings and rises (m,) of dashes along a route."""
    at = np.arange(0.0, route.length, _DASH_EVERY)
    columns = (route.x, route.y, route.z)
    points = np.stack([[np.interp(at + d, route.s, column) for column in columns] for d in (-0.1, 0.1)])
    step = (points[1] - points[0]).T  # (m, 3)
    length = np.maximum(np.hypot(step[:, 0], step[:, 1]), 1e-6)
    middle = points.mean(axis=0).T
    middle[:, 2] += _ABOVE
    return middle, np.arctan2(step[:, 1], step[:, 0]), step[:, 2] / length


def _add(
    scene: Any,
    kind: int,
    size: tuple[float, ...],
    place: np.ndarray,
    psi: float,
    rise: float,
    rgba: tuple[float, ...],
) -> None:
    """Add what lies on the ground, along `psi` and as steep as `rise`."""
    if scene.ngeom >= scene.maxgeom:
        return
    forward = np.array([np.cos(psi), np.sin(psi), rise]) / np.hypot(1, rise)
    left = np.array([-np.sin(psi), np.cos(psi), 0.0])
    frame = np.stack([forward, left, np.cross(forward, left)], axis=1)
    geom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(geom, kind, np.array(size), place, frame.ravel(), np.array(rgba, np.float32))
    scene.ngeom += 1


def _add_box(scene: Any, size: tuple[float, ...], site: Any, rgba: tuple[float, ...]) -> None:
    """Add a box at a site of the model."""
    if scene.ngeom < scene.maxgeom:
        box = mujoco.mjtGeom.mjGEOM_BOX
        mujoco.mjv_initGeom(
            scene.geoms[scene.ngeom], box, np.array(size), site.xpos, site.xmat, np.array(rgba, np.float32)
        )
        scene.ngeom += 1


def has_screen() -> bool:
    """Whether a window may be opened: on Linux, whether the environment names a display."""
    return sys.platform != "linux" or any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))


class Painter:
    """Pictures of a stage, without a window.

    MuJoCo chooses the renderer by the environment variable MUJOCO_GL; where that is not set and there is no
    screen, it is EGL.

    Raises
    ------
    InputError
        There is nothing to draw with.
    """

    def __init__(self, stage: Stage, width: int, height: int) -> None:
        self.stage, self._moves = stage, stage.moves
        self._rect = mujoco.MjrRect(0, 0, width, height)
        whole = stage.model.vis.global_
        whole.offwidth, whole.offheight = max(width, whole.offwidth), max(height, whole.offheight)
        self._gl: Any = None
        self._context: Any = None
        try:
            self._gl = _gl_context(width, height)
            self._gl.make_current()
            self._scene = mujoco.MjvScene(stage.model, maxgeom=1000)
            self._context = mujoco.MjrContext(stage.model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
        except Exception as error:  # each way to draw has failures of its own
            self.close()
            raise InputError(f"nothing to draw with: {error!s:.200}") from None
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)

    def paint(self, view: View) -> np.ndarray:
        """(height, width, 3) uint8."""
        stage, rect = self.stage, self._rect
        self._gl.make_current()
        if self._moves != stage.moves:
            mujoco.mjr_uploadHField(stage.model, self._context, 0)
            self._moves = stage.moves
        everything = mujoco.mjtCatBit.mjCAT_ALL.value
        option, camera = mujoco.MjvOption(), stage.camera(view)
        mujoco.mjv_updateScene(stage.model, stage.data, option, None, camera, everything, self._scene)
        stage.decorate(self._scene)
        mujoco.mjr_render(rect, self._scene, self._context)
        picture = np.empty((rect.height, rect.width, 3), np.uint8)
        mujoco.mjr_readPixels(picture, None, rect, self._context)
        return picture[::-1].copy()

    def close(self) -> None:
        """Free what it draws with."""
        if self._context is not None:
            self._gl.make_current()
            self._context.free()
            self._context = None
        if self._gl is not None:
            self._gl.free()
            self._gl = None


def _gl_context(width: int, height: int) -> Any:
    if has_screen() or os.environ.get("MUJOCO_GL"):
        from mujoco.gl_context import GLContext
    else:
        from mujoco.egl import GLContext
    return GLContext(width, height)


class Window:
    """MuJoCo's viewer on a stage, in real time; the view can be moved with the mouse.

    Parameters
    ----------
    interval : s between two `show`

    Raises
    ------
    InputError
        There is no screen, or none that MuJoCo can draw on.
    """

    def __init__(self, stage: Stage, interval: float = CONTROL_INTERVAL) -> None:
        _require_window()
        import mujoco.viewer

        self.stage, self._interval, self._due = stage, interval, time.monotonic()
        self._moves = stage.moves
        others = set(threading.enumerate())
        self._viewer = mujoco.viewer.launch_passive(
            stage.model, stage.data, show_left_ui=False, show_right_ui=False
        )
        self._threads = set(threading.enumerate()) - others
        with self._viewer.lock():
            camera, follow = self._viewer.cam, stage.camera(QUARTER_VIEW)
            camera.type = mujoco.mjtCamera.mjCAMERA_TRACKING
            camera.trackbodyid = stage.model.body("pelvis").id
            camera.azimuth, camera.elevation, camera.distance = (
                follow.azimuth,
                follow.elevation,
                follow.distance,
            )

    def show(self) -> bool:
        """Take the walker's pose and show it when its time has come; False once the window is closed."""
        if not self._viewer.is_running():
            return False
        with self._viewer.lock():
            self.stage.update()
            self._viewer.user_scn.ngeom = 0
            self.stage.decorate(self._viewer.user_scn)
        if self._moves != self.stage.moves:
            self._viewer.update_hfield(0)
            self._moves = self.stage.moves
        self._viewer.sync()
        self._due += self._interval
        # Late by more than a blink (a slow machine, a debugger): do not race to catch up.
        self._due = max(self._due, time.monotonic() - 0.2)
        time.sleep(max(0.0, self._due - time.monotonic()))
        return True

    def close(self) -> None:
        """Close the window."""
        self._viewer.close()
        # Python must not end while it draws.
        for thread in self._threads:
            thread.join(timeout=5)


def _require_window() -> None:
    """Try to open a window: MuJoCo's viewer, opened in a thread, would wait for ever where it fails."""
    if not has_screen():
        raise InputError(
            "there is no screen to open MuJoCo's viewer on (DISPLAY and WAYLAND_DISPLAY are not set)"
        )
    import glfw

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        window = None
        if glfw.init():
            glfw.window_hint(glfw.VISIBLE, glfw.FALSE)
            window = glfw.create_window(64, 64, "footfall", None, None)
            glfw.default_window_hints()
        if window:
            glfw.destroy_window(window)
    if not window:
        raise InputError(
            "MuJoCo's viewer cannot open a window on this screen (no OpenGL window could be made)"
        )
