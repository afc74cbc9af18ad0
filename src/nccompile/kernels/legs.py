"""The two segments next to a corner: point, direction and curvature at a length along them, and their parts.

    s = 0 ●────────────────● s = length          state, Shape (9,):  0..2  point X, Y, Z [mm]
          ──> t    |                                                 3..5  unit tangent t
                   v  k                                              6..8  curvature vector k [1/mm]

Lines, arcs, helices, ellipses and cubics by one function, so a corner asks both its neighbours the same way.
"""

from __future__ import annotations

from math import asin, atan2, cos, sin, sqrt
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curve_parts import curve_piece
from nccompile.kernels.curve_points import (
    ARC,
    POLYNOMIAL,
    Floats,
    derivative3,
    point3,
    second3,
    tangent3,
)
from nccompile.kernels.curves import NODES, parameter, tabulate
from nccompile.kernels.planes import SPACE, embed

__all__ = [
    "CORNER", "LEFT", "SHARPEST", "SHORTEST", "STATE", "common_plane", "corner_states", "cut_corner",
    "cut_legs", "row_at", "tabulate_row",
]  # fmt: skip

STATE = 9
"""Numbers of a state."""

CORNER, LEFT = 1, 2
"""What became of a corner: it was filled, or left as it is."""

SHORTEST = 1e-6
"""[mm] Cuts below this are not worth a segment."""

SHARPEST = 3.1405926535897932
"""[rad] A path that bends by more turns back: no arc and no spline fills its corner."""

Kinds: TypeAlias = npt.NDArray[np.uint8]
Wholes: TypeAlias = npt.NDArray[np.int64]

_HALVINGS = 50


@kernel
def _is_straight(kind: int) -> bool:
    """Whether a segment of this kind is a straight line."""
    return kind < ARC or kind > POLYNOMIAL


@kernel
def tabulate_row(kinds: Kinds, rows: Floats, i: int, nodes: Floats, table: int) -> int:
    """Fills nodes[table], nodes[table + 1], the arc-length table of row i; returns its rows, 0 for a line: none."""
    if _is_straight(int(kinds[i])):
        return 0
    return tabulate(int(kinds[i]), rows[i], nodes[table], nodes[table + 1])


@kernel
def _parameter_at(kind: int, p: Floats, nodes_u: Floats, nodes_s: Floats, count: int, share: float) -> float:
    """The curve parameter at a share 0..1 of the length."""
    if count == 0 or kind == ARC or share <= 0.0 or share >= 1.0:
        return min(max(share, 0.0), 1.0)
    return parameter(kind, p, nodes_u, nodes_s, count, share * float(nodes_s[count - 1]))


@kernel
def _curvature(kind: int, p: Floats, u: float) -> tuple[float, float, float]:
    """The curvature vector d²P/ds² = (P'' - (P''.T) T) / |P'|² [1/mm] in plane coordinates; 0 at a cusp."""
    dx, dy, dz = derivative3(kind, p, u)
    ex, ey, ez = second3(kind, p, u)
    square = dx * dx + dy * dy + dz * dz
    if square == 0.0:
        return 0.0, 0.0, 0.0
    along = (ex * dx + ey * dy + ez * dz) / square
    return (ex - along * dx) / square, (ey - along * dy) / square, (ez - along * dz) / square


@kernel
def _curve_at(
    kind: int, plane: int, p: Floats, a: Floats, b: Floats, length: float, nodes_u: Floats, nodes_s: Floats,
    count: int, s: float, out: Floats,
) -> None:  # fmt: skip
    """Writes the state at s [mm] of a segment from a to b, a curve, with its table of `tabulate`."""
    share = s / length if length > 0.0 else 0.0
    u = _parameter_at(kind, p, nodes_u, nodes_s, count, share)
    inside = float(nodes_s[count - 1])
    x = y = z = tx = ty = tz = kx = ky = kz = 0.0
    if kind == ARC:
        angle = float(p[3]) + float(p[4]) * u
        kx = cos(angle)
        ky = sin(angle)
        side = 1.0 if p[4] > 0.0 else -1.0
        x = float(p[0]) + float(p[2]) * kx
        y = float(p[1]) + float(p[2]) * ky
        tx = -side * ky
        ty = side * kx
        kx = -kx / float(p[2])
        ky = -ky / float(p[2])
    else:
        x, y, z = point3(kind, p, u)
        tx, ty, tz = tangent3(kind, p, u)
        kx, ky, kz = _curvature(kind, p, u)
    slant = 1.0
    if plane != SPACE:
        third = 2 - plane  # XY leaves Z over, ZX leaves Y, YZ leaves X
        rise = float(b[third]) - float(a[third])
        z = float(a[third]) + share * rise
        tz = rise / inside if inside > 0.0 else 0.0
        slant = inside / length if length > 0.0 else 1.0
    size = sqrt(tx * tx + ty * ty + tz * tz)
    if size > 0.0:
        tx /= size
        ty /= size
        tz /= size
    bend = slant * slant
    out[0], out[1], out[2] = embed(plane, x, y, z)
    out[3], out[4], out[5] = embed(plane, tx, ty, tz)
    out[6], out[7], out[8] = embed(plane, bend * kx, bend * ky, bend * kz)


@kernel
def row_at(
    kinds: Kinds, planes: Wholes, rows: Floats, points: Floats, length: Floats, i: int, nodes: Floats, table: int,
    count: int, s: float, out: Floats,
) -> None:  # fmt: skip
    """Writes the state at s [mm] of row i of a path; nodes[table], nodes[table + 1]: its table of `count` rows."""
    if count:
        _curve_at(
            int(kinds[i]), int(planes[i]), rows[i], points[i], points[i + 1], float(length[i]), nodes[table],
            nodes[table + 1], count, s, out,
        )  # fmt: skip
        return
    share = s / float(length[i]) if length[i] > 0.0 else 0.0
    size = 0.0
    for c in range(3):
        step = float(points[i + 1, c]) - float(points[i, c])
        size += step * step
    size = sqrt(size)
    for c in range(3):
        step = float(points[i + 1, c]) - float(points[i, c])
        out[c] = float(points[i, c]) + share * step
        out[3 + c] = step / size if size > 0.0 else 0.0
        out[6 + c] = 0.0


@kernel
def corner_states(
    kinds: Kinds, planes: Wholes, rows: Floats, points: Floats, length: Floats, i: int, nodes: Floats, one: Floats,
    two: Floats,
) -> tuple[int, int, float]:  # fmt: skip
    """Writes the states before and behind the corner at the end of row i.

    Args:     nodes: Shape (4, NODES), out: the tables of row i and of row i + 1.
    Returns:  rows of both tables, and the bend 0..pi [rad].
    """
    na = tabulate_row(kinds, rows, i, nodes, 0)
    nb = tabulate_row(kinds, rows, i + 1, nodes, 2)
    _cut_states(kinds, planes, rows, points, length, i, nodes, na, nb, 0.0, 0.0, one, two)
    return na, nb, _turn_between(one, two)


@kernel
def _cut_states(
    kinds: Kinds, planes: Wholes, rows: Floats, points: Floats, length: Floats, i: int, nodes: Floats, na: int, nb: int,
    at_a: float, at_b: float, one: Floats, two: Floats,
) -> None:  # fmt: skip
    """Writes the states where at_a [mm] is cut off the end of row i and at_b off the start of row i + 1."""
    row_at(kinds, planes, rows, points, length, i, nodes, 0, na, float(length[i]) - at_a, one)
    row_at(kinds, planes, rows, points, length, i + 1, nodes, 2, nb, at_b, two)


@kernel
def _turn_between(one: Floats, two: Floats) -> float:
    """The angle [rad] 0..pi from the direction of one state to that of another."""
    cx = one[4] * two[5] - one[5] * two[4]
    cy = one[5] * two[3] - one[3] * two[5]
    cz = one[3] * two[4] - one[4] * two[3]
    dot = one[3] * two[3] + one[4] * two[4] + one[5] * two[5]
    return atan2(sqrt(cx * cx + cy * cy + cz * cz), dot)


@kernel
def common_plane(kinds: Kinds, planes: Wholes, points: Floats, i: int) -> int:
    """The plane 0..2 (X-Y, Z-X, Y-Z) parallel to which rows i and i + 1 both stay, -1 if there is none."""
    for plane in range(SPACE):
        third = 2 - plane
        flat = points[i, third] == points[i + 1, third] and points[i + 1, third] == points[i + 2, third]
        fits0 = _is_straight(int(kinds[i])) or planes[i] == plane
        fits1 = _is_straight(int(kinds[i + 1])) or planes[i + 1] == plane
        if flat and fits0 and fits1:
            return plane
    return -1


@kernel
def _reach_along(
    kinds: Kinds, planes: Wholes, rows: Floats, points: Floats, length: Floats, i: int, nodes: Floats, table: int,
    count: int, reach: float, room: float, at_end: bool, out: Floats,
) -> float:  # fmt: skip
    """The length [mm] to cut off row i so that the cut is `reach` from its end (or start), at most `room`.

    nodes, table, count: as in `row_at`;  out: Shape (STATE,), scratch.  A line and a flat arc have it in closed form,
    the others by bisection.
    """
    if count == 0:
        return min(reach, room)
    third = 2 - int(planes[i])
    if kinds[i] == ARC and points[i, third] == points[i + 1, third]:
        share = 0.5 * reach / float(rows[i, 2])
        return min(2.0 * float(rows[i, 2]) * asin(share), room) if share < 1.0 else room
    v = points[i + 1] if at_end else points[i]
    low = 0.0
    high = room
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        s = float(length[i]) - middle if at_end else middle
        row_at(kinds, planes, rows, points, length, i, nodes, table, count, s, out)
        square = 0.0
        for c in range(3):
            square += (out[c] - v[c]) * (out[c] - v[c])
        if square < reach * reach:
            low = middle
        else:
            high = middle
    return high


@kernel
def cut_corner(
    kinds: Kinds, planes: Wholes, rows: Floats, points: Floats, length: Floats, room: Floats, i: int, nodes: Floats,
    na: int, nb: int, reach: float, one: Floats, two: Floats,
) -> tuple[float, float]:  # fmt: skip
    """Cuts both rows `reach` [mm] from the corner behind row i, but not by more than their room.

    Returns:  the lengths cut off;  out: the states at the cuts.
    """
    at_a = _reach_along(
        kinds, planes, rows, points, length, i, nodes, 0, na, reach, float(room[i]), True, one
    )  # fmt: skip
    at_b = _reach_along(
        kinds, planes, rows, points, length, i + 1, nodes, 2, nb, reach, float(room[i + 1]), False, two
    )  # fmt: skip
    _cut_states(kinds, planes, rows, points, length, i, nodes, na, nb, at_a, at_b, one, two)
    return at_a, at_b


@kernel
def cut_legs(
    kinds: Kinds, planes: Wholes, rows: Floats, points: Floats, length: Floats, picked: Wholes, s0: Floats, s1: Floats,
    out_rows: Floats, out_starts: Floats, out_ends: Floats,
) -> None:  # fmt: skip
    """The parts s0..s1 [mm] of segments: curve rows, Shape (m, 12), their starts and ends X, Y, Z, Shape (m, 3).

    Args:     columns of the path as in `kernels.distance`;  picked: Shape (m,), which segments;  s0, s1: Shape (m,).
    """
    nodes = np.empty((2, NODES))
    state = np.empty(STATE)
    for j in range(len(picked)):
        i = int(picked[j])
        kind = int(kinds[i])
        count = tabulate_row(kinds, rows, i, nodes, 0)
        row_at(kinds, planes, rows, points, length, i, nodes, 0, count, float(s0[j]), state)
        for c in range(3):
            out_starts[j, c] = state[c]
        row_at(kinds, planes, rows, points, length, i, nodes, 0, count, float(s1[j]), state)
        for c in range(3):
            out_ends[j, c] = state[c]
        if count:
            scale = 1.0 / float(length[i]) if length[i] > 0.0 else 0.0
            u0 = _parameter_at(kind, rows[i], nodes[0], nodes[1], count, scale * float(s0[j]))
            u1 = _parameter_at(kind, rows[i], nodes[0], nodes[1], count, scale * float(s1[j]))
            curve_piece(kind, rows[i], u0, u1, out_rows[j])
