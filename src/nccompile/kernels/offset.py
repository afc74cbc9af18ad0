"""Segments at a distance from plane segments: lines and arcs exactly, ellipses and cubics as cubics in a tolerance.

     n                 d: distance to the left of the direction of motion, negative: to the right
·····^······· P + d n      line     both ends move by d n
     |                     arc      radius R - d for counter-clockwise, R + d for clockwise; below 0 the
─────P─────> T                      offset runs on the far side of the centre (the tool does not fit)
                           others   Q(u) = P(u) + d n(u),  Q' = P' (1 - d k), k: signed curvature

Ellipses and cubics are halved until the cubic with the values and derivatives of Q at both ends keeps to Q at inner
places.  Where P turns back on itself (a cusp), the offset is an arc about that point, on the outer side.
Segments are columns as in `kernels.boxes`.
"""

from math import atan2, cos, pi, sin, sqrt

import numpy as np

from nccompile.kernels import kernel
from nccompile.kernels.boxes import Kinds, Rows
from nccompile.kernels.curve_parts import curve_piece, way_share
from nccompile.kernels.curve_points import (
    ARC,
    POLYNOMIAL,
    Floats,
    derivative,
    point,
    put_hermite,
    second,
    tangent,
)

__all__ = ["cut_curves", "offset_rows", "put_arc", "put_line", "shares_along"]

_NO_RADIUS = 1e-9  # [mm] an offset arc of less is a point, its centre: a line without length
_FINEST = 1.0 / 16777216  # of a curve: less of it that turns is a cusp
_TURNED = 3.0  # [rad] a cusp turns by pi; which way is open, so the outer one is taken
_CHECKS = 9  # inner places at which a cubic is compared
_MARGIN = 0.8  # of the tolerance that is used


@kernel
def cut_curves(kinds: Kinds, table: Floats, parts: Floats, shares: Floats, points: Floats) -> None:
    """Cuts the rows of a table to parts u0..u1, in place;  shares: Shape (m, 2), out: of their length;  points:
    Shape (m, 2), out: where they end."""
    for i in range(len(kinds)):
        shares[i, 0] = way_share(int(kinds[i]), table[i], float(parts[i, 0]))
        shares[i, 1] = way_share(int(kinds[i]), table[i], float(parts[i, 1]))
        curve_piece(int(kinds[i]), table[i], float(parts[i, 0]), float(parts[i, 1]), table[i])
        x, y = point(int(kinds[i]), table[i], 1.0)
        points[i, 0] = x
        points[i, 1] = y


@kernel
def shares_along(kinds: Kinds, table: Floats, values: Floats) -> None:
    """Parameters u of curves become shares 0..1 of their length, in place;  kinds, table, values: Shape (m,) ..."""
    for i in range(len(kinds)):
        values[i] = way_share(int(kinds[i]), table[i], float(values[i]))


@kernel
def _beside(kind: int, p: Floats, d: float, u: float, out: Floats) -> None:
    """Q and dQ/du at u into out, Shape (4,)."""
    x, y = point(kind, p, u)
    tx, ty = tangent(kind, p, u)
    dx, dy = derivative(kind, p, u)
    sx, sy = second(kind, p, u)
    speed = sqrt(dx * dx + dy * dy)
    bend = (dx * sy - dy * sx) / (speed * speed * speed) if speed > 0.0 else 0.0
    out[0] = x - d * ty
    out[1] = y + d * tx
    out[2] = (1.0 - d * bend) * dx
    out[3] = (1.0 - d * bend) * dy


@kernel
def _hermite(q0: Floats, q1: Floats, h: float, row: Floats) -> None:
    """The cubic with the values of q0 and q1 and h times their derivatives at its ends into row, Shape (12,)."""
    for c in range(2):
        put_hermite(float(q0[c]), h * float(q0[2 + c]), float(q1[c]), h * float(q1[2 + c]), row, 4 * c)
    for c in range(8, 12):
        row[c] = 0.0


@kernel
def _miss(kind: int, p: Floats, d: float, u0: float, u1: float, row: Floats, q: Floats) -> float:
    """The greatest distance [mm] of a cubic from Q(u0..u1) at inner places;  q: room to work in."""
    worst = 0.0
    for i in range(1, _CHECKS + 1):
        v = i / (_CHECKS + 1.0)
        _beside(kind, p, d, u0 + v * (u1 - u0), q)
        x, y = point(POLYNOMIAL, row, v)
        worst = max(worst, (x - q[0]) * (x - q[0]) + (y - q[1]) * (y - q[1]))
    return sqrt(worst)


@kernel
def put_line(
    at: int, x0: float, y0: float, x1: float, y1: float, kind: Kinds, curve: Rows, ends: Floats
) -> None:
    """Piece `at` becomes a line."""
    kind[at] = 1
    curve[at] = -1
    ends[at, 0] = x0
    ends[at, 1] = y0
    ends[at, 2] = x1
    ends[at, 3] = y1


@kernel
def put_arc(
    at: int, cx: float, cy: float, x0: float, y0: float, x1: float, y1: float, sweep: float,
    kind: Kinds, curve: Rows, table: Floats, ends: Floats,
) -> None:  # fmt: skip
    """Piece `at` becomes an arc about (cx, cy)."""
    put_line(at, x0, y0, x1, y1, kind, curve, ends)
    kind[at] = ARC
    curve[at] = at
    for c in range(12):
        table[at, c] = 0.0
    dx = x0 - cx
    dy = y0 - cy
    table[at, 0] = cx
    table[at, 1] = cy
    table[at, 2] = sqrt(dx * dx + dy * dy)
    table[at, 3] = atan2(dy, dx)
    table[at, 4] = sweep


@kernel
def _cusp(kind: int, p: Floats, d: float, u0: float, u1: float) -> float:
    """The angle [rad] by which the offset runs about a place u0..u1 where a curve turns back; 0 if it hardly does."""
    ax, ay = tangent(kind, p, u0)
    bx, by = tangent(kind, p, u1)
    turn = atan2(ax * by - ay * bx, ax * bx + ay * by)
    if abs(turn) < 1e-6:
        return 0.0
    if abs(turn) > _TURNED:
        return -abs(turn) if d > 0.0 else abs(turn)
    return turn


@kernel
def _put_offset_arc(
    at: int, p: Floats, d: float, kind: Kinds, curve: Rows, table: Floats, ends: Floats
) -> None:
    """Piece `at` becomes the offset of an arc; a line without length if that is a point."""
    radius = float(p[2]) - (d if p[4] > 0.0 else -d)
    if abs(radius) <= _NO_RADIUS:
        put_line(at, float(p[0]), float(p[1]), float(p[0]), float(p[1]), kind, curve, ends)
        return
    kind[at] = ARC
    curve[at] = at
    row = table[at]
    for c in range(12):
        row[c] = p[c]
    row[2] = abs(radius)
    if radius < 0.0:
        row[3] = float(p[3]) + pi
    ends[at, 0] = row[0] + row[2] * cos(row[3])
    ends[at, 1] = row[1] + row[2] * sin(row[3])
    ends[at, 2] = row[0] + row[2] * cos(row[3] + row[4])
    ends[at, 3] = row[1] + row[2] * sin(row[3] + row[4])


@kernel
def _put_offset_curve(
    at: int, most: int, source: int, p: Floats, d: float, tolerance: float,
    kind: Kinds, curve: Rows, table: Floats, ends: Floats, part: Floats,
) -> int:  # fmt: skip
    """Pieces `at` and following become the offset of an ellipse or cubic; returns the next one, -1 beyond `most`."""
    q0 = np.zeros(4)
    q1 = np.zeros(4)
    q = np.zeros(4)
    todo = np.zeros(64)
    low = 0.0
    todo[0] = 1.0
    top = 1
    _beside(source, p, d, 0.0, q0)
    while top > 0:
        if at >= most:
            return -1
        high = float(todo[top - 1])
        _beside(source, p, d, high, q1)
        _hermite(q0, q1, high - low, table[at])
        is_fine = high - low <= _FINEST
        if not is_fine and _miss(source, p, d, low, high, table[at], q) > _MARGIN * tolerance:
            todo[top] = 0.5 * (low + high)
            top += 1
            continue
        turn = _cusp(source, p, d, low, high) if is_fine else 0.0
        if turn != 0.0:
            cx, cy = point(source, p, 0.5 * (low + high))
            put_arc(
                at, cx, cy, float(q0[0]), float(q0[1]), float(q1[0]), float(q1[1]), turn, kind, curve, table, ends
            )  # fmt: skip
        else:
            put_line(at, float(q0[0]), float(q0[1]), float(q1[0]), float(q1[1]), kind, curve, ends)
            kind[at] = POLYNOMIAL
            curve[at] = at
        part[at, 0] = low
        part[at, 1] = high
        at += 1
        top -= 1
        low = high
        for c in range(4):
            q0[c] = q1[c]
    return at


@kernel
def offset_rows(
    kinds: Kinds, curve: Rows, table: Floats, ends: Floats, d: Floats, tolerance: float, first: Rows,
    piece_kind: Kinds, piece_curve: Rows, piece_table: Floats, piece_ends: Floats, piece_part: Floats,
) -> int:  # fmt: skip
    """The offsets of segments, each as pieces in order.

    Args:     d: Shape (n,) [mm];  tolerance [mm];  first: Shape (n + 1,), out: the first piece of each segment, then
              the number of pieces;  piece_kind, piece_curve, piece_ends: Shape (k,) ..., out, as columns;
              piece_table: Shape (k, 12), out;  the last 2 n rows are left free for connectors;  piece_part: Shape
              (k, 2), out: the parameters u of its segment it stands for.
    Returns:  the number of pieces, -1 if there is not enough room.
    """
    room = len(piece_kind) - 2 * len(kinds)
    count = 0
    for i in range(len(kinds)):
        first[i] = count
        kind = int(kinds[i])
        side = float(d[i])
        if count >= room:
            return -1
        piece_part[count, 0] = 0.0
        piece_part[count, 1] = 1.0
        if ARC < kind <= POLYNOMIAL:
            count = _put_offset_curve(
                count, room, kind, table[int(curve[i])], side, tolerance, piece_kind, piece_curve, piece_table,
                piece_ends, piece_part,
            )  # fmt: skip
            if count < 0:
                return -1
            continue
        if kind == ARC:
            _put_offset_arc(
                count, table[int(curve[i])], side, piece_kind, piece_curve, piece_table, piece_ends
            )
        else:
            x0, y0, x1, y1 = float(ends[i, 0]), float(ends[i, 1]), float(ends[i, 2]), float(ends[i, 3])
            dx = x1 - x0
            dy = y1 - y0
            size = sqrt(dx * dx + dy * dy)
            nx = -dy / size * side
            ny = dx / size * side
            put_line(count, x0 + nx, y0 + ny, x1 + nx, y1 + ny, piece_kind, piece_curve, piece_ends)
        count += 1
    first[len(kinds)] = count
    return count
