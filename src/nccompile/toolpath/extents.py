"""Least and greatest position of a chunk on every axis, bulges of curves included.

ellipse (an arc is one with a = b = r, direction 0), theta = start + sweep * u:
    u-axis  centre_u + a cos(theta) cos(phi) - b sin(theta) sin(phi)
    v-axis  centre_v + a cos(theta) sin(phi) + b sin(theta) cos(phi)
Each is centre + A cos(theta - peak): its extremes are centre +- A where peak or peak + pi is swept.

cubic c0 + c1 t + c2 t² + c3 t³: extremes where c1 + 2 c2 t + 3 c3 t² = 0 with 0 < t < 1.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from nccompile.toolpath.columns import Floats, Kind, Plane, Toolpath

__all__ = ["extents", "row_extents"]

Rows: TypeAlias = npt.NDArray[np.intp]

_AXES_OF_PLANE = {Plane.XY: (0, 1), Plane.ZX: (2, 0), Plane.YZ: (1, 2)}


def extents(chunk: Toolpath) -> tuple[Floats, Floats]:
    """The box of a chunk, its start included.

    Returns: least and greatest position, Shape (k,) each [mm or deg]; exact for straight segments, within
    rounding for curves.  Motion with the S-profile stays inside too: it only changes the time law of an axis.
    """
    low, high = row_extents(chunk)
    corners = np.vstack([chunk.start[None, :], low]), np.vstack([chunk.start[None, :], high])
    return corners[0].min(axis=0), corners[1].max(axis=0)


def row_extents(chunk: Toolpath) -> tuple[Floats, Floats]:
    """The box of every segment without its start point: least and greatest, Shape (n, k) each."""
    low, high = chunk.target.copy(), chunk.target.copy()
    for kind in (Kind.ARC, Kind.ELLIPSE):
        for plane, axes in _AXES_OF_PLANE.items():
            rows = _rows(chunk, kind, plane)
            if len(rows):
                parameters = _as_ellipse(chunk.curves.parameters[chunk.curve[rows]], kind)
                for which, axis in enumerate(axes):
                    _widen(low, high, rows, axis, *_ellipse_extremes(parameters, which))
    rows = np.flatnonzero(chunk.kind == Kind.POLYNOMIAL)
    if len(rows):
        table = chunk.curves.parameters[chunk.curve[rows]]
        planes = chunk.curves.plane[chunk.curve[rows]]
        for axis in range(3):
            bulging = (planes == Plane.SPACE) if axis == 2 else np.ones(len(rows), bool)
            extremes = _cubic_extremes(table[bulging, 4 * axis : 4 * axis + 4])
            _widen(low, high, rows[bulging], axis, *extremes)
    return low, high


def _rows(chunk: Toolpath, kind: Kind, plane: Plane) -> Rows:
    of_kind = chunk.kind == kind
    of_kind[of_kind] = chunk.curves.plane[chunk.curve[of_kind]] == plane
    return np.flatnonzero(of_kind)


def _widen(
    low: Floats,
    high: Floats,
    rows: Rows,
    axis: int,
    least: Floats,
    greatest: Floats,
) -> None:
    low[rows, axis] = np.minimum(low[rows, axis], least)
    high[rows, axis] = np.maximum(high[rows, axis], greatest)


def _as_ellipse(parameters: Floats, kind: Kind) -> Floats:
    """Rows centre_u, centre_v, a, b, direction, start, sweep."""
    if kind is Kind.ELLIPSE:
        return parameters[:, :7]
    centre_u, centre_v, radius, start, sweep = parameters[:, :5].T
    return np.column_stack([centre_u, centre_v, radius, radius, np.zeros_like(radius), start, sweep])


def _ellipse_extremes(rows: Floats, which: int) -> tuple[Floats, Floats]:
    """Least and greatest u (which 0) or v (which 1) at the extremes that are swept, else +inf and -inf."""
    main, sub, phi, start, sweep = rows[:, 2:7].T
    across = np.cos(phi) if which == 0 else np.sin(phi)
    along = -np.sin(phi) if which == 0 else np.cos(phi)
    amplitude = np.sqrt((main * across) ** 2 + (sub * along) ** 2)
    peak = np.arctan2(sub * along, main * across)
    centre = rows[:, which]
    least = np.where(_swept(start, sweep, peak + np.pi), centre - amplitude, np.inf)
    greatest = np.where(_swept(start, sweep, peak), centre + amplitude, -np.inf)
    return least, greatest


def _swept(start: Floats, sweep: Floats, angle: Floats) -> npt.NDArray[np.bool_]:
    """Whether an angle lies on the way from start to start + sweep, whole turns aside [rad]."""
    ahead = np.where(sweep >= 0, angle - start, start - angle)
    return np.mod(ahead, 2 * np.pi) <= np.abs(sweep)


def _cubic_extremes(rows: Floats) -> tuple[Floats, Floats]:
    """Least and greatest value of cubics (c0, c1, c2, c3) at their inner extremes, else +inf and -inf."""
    c1, c2, c3 = rows[:, 1], rows[:, 2], rows[:, 3]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        root = np.sqrt(c2 * c2 - 3 * c1 * c3)
        q = -(c2 + np.where(c2 < 0, -root, root))
        candidates = np.column_stack([q / (3 * c3), c1 / q])
    inside = (candidates > 0) & (candidates < 1)
    t = np.where(inside, candidates, 0.0)
    value = rows[:, :1] + t * (rows[:, 1:2] + t * (rows[:, 2:3] + t * rows[:, 3:4]))
    least = np.where(inside, value, np.inf).min(axis=1)
    greatest = np.where(inside, value, -np.inf).max(axis=1)
    return least, greatest
