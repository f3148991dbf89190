"""The ground under a path: a height grid that follows its elevation and stays smooth around corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from footfall.errors import InputError
from footfall.late import late
from footfall.models.route import Ground
from footfall.scenarios.path import Path, elevation, plan

interpolate, spatial = late("scipy.interpolate"), late("scipy.spatial")

# Two stretches of one path may come this close to each other only at the same height.
CLEARANCE_M = 3.0
STEP_M = 0.05
_NEIGHBOURS_M = 15.0  # along the path; what is closer belongs to the same bend

_SAMPLE_M = 0.5
_WIDTH_M = 0.5  # of the kernel, on the path
_WIDENING = 0.35  # kernel width per metre of distance from the path
_EXACT_M, _NEAR_M = 5.0, 8.0  # the fine answer alone; from here on the coarse one alone
_NEAREST = 48
_CHUNK = 4096
MAX_POINTS = 16_000_000  # 64 MB of heights
_COARSE_M = 8.0
_MARGIN_M = 12.0
_OVERRUN_M = 12.0  # an open path's ground goes on beyond its ends


@dataclass(frozen=True)
class Terrain(Ground):
    """A ground whose (ny, nx) float32 heights stand at (x0 + column cell, y0 + row cell)."""

    x0: float
    y0: float
    cell: float
    heights: np.ndarray

    def height(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Ground height at points.

        A cell's diagonal joins its least (x, y) with its greatest, as in MuJoCo.

        Parameters
        ----------
        x, y : m, of one shape

        Returns
        -------
        m, of the same shape

        Raises
        ------
        InputError
            A point off the grid.
        """
        u = (np.asarray(x, dtype=float) - self.x0) / self.cell
        v = (np.asarray(y, dtype=float) - self.y0) / self.cell
        ny, nx = self.heights.shape
        if not ((u >= 0) & (u <= nx - 1) & (v >= 0) & (v <= ny - 1)).all():
            raise InputError("terrain: a point lies off the grid")
        i, j = np.minimum(u.astype(int), nx - 2), np.minimum(v.astype(int), ny - 2)
        u, v, z = u - i, v - j, self.heights.astype(float)
        first, last = z[j, i], z[j + 1, i + 1]
        below = first + u * (z[j, i + 1] - first) + v * (last - z[j, i + 1])
        above = first + v * (z[j + 1, i] - first) + u * (last - z[j + 1, i])
        return np.where(u >= v, below, above)


def require_one_height(path: Path) -> None:
    """Refuse a path that crosses or nears itself at different heights.

    Raises
    ------
    InputError
        Two stretches within 3 m of each other differ by more than 5 cm.
    """
    if path.level:
        return
    r = path.route
    stride = max(1, round(_SAMPLE_M * (len(r.s) - 1) / r.length))
    s, z, points = r.s[::stride], r.z[::stride], np.column_stack([r.x, r.y])[::stride]
    i, j = spatial.cKDTree(points).query_pairs(CLEARANCE_M, output_type="ndarray").T
    along = np.abs(s[i] - s[j])
    if path.closed:
        along = np.minimum(along, r.length - along)
    bad = (along > _NEIGHBOURS_M) & (np.abs(z[i] - z[j]) > STEP_M)
    if bad.any():
        k = int(np.argmax(bad))
        a, b = sorted((i[k], j[k]))
        raise InputError(
            f"path.elements: {s[a]:.1f} m and {s[b]:.1f} m along it, the path comes within {CLEARANCE_M:g} m "
            f"of itself at heights of {z[a]:.2f} and {z[b]:.2f} m, which must agree to {STEP_M:g} m"
        )


def build_terrain(path: Path, cell: float = 0.5) -> Terrain | None:
    """The ground along a path, or None where it is level.

    Along straights and wide arcs the ground is level across the path and follows its elevation to a
    millimetre within 5 m of it. Around corners, where a point beside the path is near to several points of
    it, their heights are blended. Far from the path the ground only has to be smooth.

    Parameters
    ----------
    cell : m

    Raises
    ------
    InputError
        As `require_one_height`; or the path spans too much ground.
    """
    if path.level:
        return None
    require_one_height(path)
    over = 0.0 if path.closed else _OVERRUN_M
    n = round((path.route.length + 2 * over) / _SAMPLE_M) + 1
    s = np.linspace(-over, path.route.length + over, n)
    x, y, _, _ = plan(path.pieces, s)
    z = elevation(path.pieces, path.transition, s)
    line = _Line(np.column_stack([x, y]), z, np.gradient(np.column_stack([x, y, z]), s, axis=0))

    low = np.floor(line.points.min(axis=0)) - _MARGIN_M
    nx, ny = (np.ceil((line.points.max(axis=0) + _MARGIN_M - low) / cell).astype(int) + 1).tolist()
    if nx * ny > MAX_POINTS:
        raise InputError(
            f"path.elements: the ground under the path takes a grid of {nx} x {ny} points, "
            f"expected {MAX_POINTS} in all at most"
        )
    xs, ys = low[0] + cell * np.arange(nx), low[1] + cell * np.arange(ny)
    heights = _far(line, xs, ys)

    tree = spatial.cKDTree(line.points)
    grid = np.stack(np.meshgrid(xs, ys), axis=-1)
    distance = np.reshape(tree.query(grid.reshape(-1, 2), distance_upper_bound=_NEAR_M)[0], (ny, nx))
    near = distance < _NEAR_M
    wanted = grid[near]
    parts = np.array_split(wanted, len(wanted) // _CHUNK + 1)
    k = min(_NEAREST, n)
    exact = [_blend(line, at, np.asarray(tree.query(at, k=k)[1]), along=0.5) for at in parts]
    share = np.clip((_NEAR_M - distance[near]) / (_NEAR_M - _EXACT_M), 0, 1)
    share = share**2 * (3 - 2 * share)
    heights[near] += share * (np.concatenate(exact) - heights[near])
    return Terrain(float(low[0]), float(low[1]), cell, heights.astype(np.float32))


@dataclass(frozen=True)
class _Line:
    """Samples of a path: points (n, 2) m, z (n,) m and slope (n, 3), derivatives of x, y, z along it."""

    points: np.ndarray
    z: np.ndarray
    slope: np.ndarray


def _blend(line: _Line, at: np.ndarray, samples: np.ndarray, along: float) -> np.ndarray:
    """Average the heights of samples of the line, each by how near it is.

    The weight of a sample depends on its distance relative to the nearest one's, so that where two stretches
    are equally far (inside a corner) the ground passes smoothly from one to the other. Beside a straight the
    weights are a Gaussian along it. Each sample's height is carried towards `at` along the line with the
    share `along` of its own gradient: with one half a parabola, which is what vertical transitions are, comes
    out unsmoothed, since z(u) - u z'(u) / 2 = z(0) + u z'(0) / 2 and the last term averages to 0.

    Parameters
    ----------
    at : (m, 2) m
    samples : (m, k) indices of the samples that count at each point, or (k,) for all points

    Returns
    -------
    (m,) m
    """
    offset = at[:, None, :] - line.points[samples]
    square = (offset**2).sum(axis=-1)
    least = square.min(axis=1, keepdims=True)
    weight = np.exp((least - square) / (2 * (_WIDTH_M**2 + _WIDENING**2 * least)))
    height = line.z[samples]
    if along:
        slope = line.slope[samples]
        height = height + along * slope[..., 2] * (offset * slope[..., :2]).sum(axis=-1)
    return (weight * height).sum(axis=1) / weight.sum(axis=1)


def _far(line: _Line, xs: np.ndarray, ys: np.ndarray) -> np.ndarray:
    """(ny, nx) smooth heights away from the path: blended on a coarse grid, linear in between."""
    coarse = [np.arange(axis[0], axis[-1] + _COARSE_M, _COARSE_M) for axis in (xs, ys)]
    grid = np.stack(np.meshgrid(*coarse), axis=-1)
    every = np.arange(0, len(line.z), round(2 / _SAMPLE_M))
    heights = np.array([_blend(line, row, every, along=0.0) for row in grid])
    fine = interpolate.RegularGridInterpolator((coarse[1], coarse[0]), heights)
    return fine(tuple(np.meshgrid(ys, xs, indexing="ij")))
