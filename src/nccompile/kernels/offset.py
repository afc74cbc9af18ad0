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
    second,
    tangent,
)

__all__ = ["cut_curves", "offset_rows", "shares_along"]

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
        step = float(q1[c]) - float(q0[c])
        a = h * float(q0[2 + c])
        b = h * float(q1[2 + c])
        row[4 * c] = q0[c]
        row[4 * c + 1] = a
        row[4 * c + 2] = 3.0 * step - 2.0 * a - b
        row[4 * c + 3] = a + b - 2.0 * step
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
def _cusp(kind: int, p: Floats, d: float, u0: float, u1: float, q0: Floats, row: Floats) -> bool:
    """The arc about a place where a curve turns back, into row; False if it hardly turns there."""
    ax, ay = tangent(kind, p, u0)
    bx, by = tangent(kind, p, u1)
    turn = atan2(ax * by - ay * bx, ax * bx + ay * by)
    if abs(turn) < 1e-6:
        return False
    if abs(turn) > _TURNED:
        turn = -abs(turn) if d > 0.0 else abs(turn)
    x, y = point(kind, p, 0.5 * (u0 + u1))
    dx = float(q0[0]) - x
    dy = float(q0[1]) - y
    for c in range(12):
        row[c] = 0.0
    row[0] = x
    row[1] = y
    row[2] = sqrt(dx * dx + dy * dy)
    row[3] = atan2(dy, dx)
    row[4] = turn
    return True


@kernel
def _offset_arc(p: Floats, d: float, row: Floats) -> bool:
    """The offset of an arc into row; False if it is a point."""
    radius = float(p[2]) - (d if p[4] > 0.0 else -d)
    if abs(radius) <= _NO_RADIUS:
        return False
    for c in range(12):
        row[c] = p[c]
    row[2] = abs(radius)
    if radius < 0.0:
        row[3] = float(p[3]) + pi
    return True


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
    q0 = np.zeros(4)
    q1 = np.zeros(4)
    q = np.zeros(4)
    todo = np.zeros(64)
    for i in range(len(kinds)):
        first[i] = count
        kind = int(kinds[i])
        side = float(d[i])
        if count >= room:
            return -1
        piece_part[count, 0] = 0.0
        piece_part[count, 1] = 1.0
        if kind < ARC or kind > POLYNOMIAL:
            dx = float(ends[i, 2]) - float(ends[i, 0])
            dy = float(ends[i, 3]) - float(ends[i, 1])
            size = sqrt(dx * dx + dy * dy)
            nx = -dy / size * side
            ny = dx / size * side
            piece_kind[count] = 1
            piece_curve[count] = -1
            piece_ends[count, 0] = ends[i, 0] + nx
            piece_ends[count, 1] = ends[i, 1] + ny
            piece_ends[count, 2] = ends[i, 2] + nx
            piece_ends[count, 3] = ends[i, 3] + ny
            count += 1
            continue
        p = table[int(curve[i])]
        row = piece_table[count]
        if kind == ARC:
            if _offset_arc(p, side, row):
                piece_kind[count] = ARC
                piece_curve[count] = count
                piece_ends[count, 0] = row[0] + row[2] * cos(row[3])
                piece_ends[count, 1] = row[1] + row[2] * sin(row[3])
                piece_ends[count, 2] = row[0] + row[2] * cos(row[3] + row[4])
                piece_ends[count, 3] = row[1] + row[2] * sin(row[3] + row[4])
            else:
                piece_kind[count] = 1
                piece_curve[count] = -1
                for c in range(4):
                    piece_ends[count, c] = p[c % 2]
            count += 1
            continue
        low = 0.0
        todo[0] = 1.0
        top = 1
        _beside(kind, p, side, 0.0, q0)
        while top > 0:
            if count >= room:
                return -1
            high = float(todo[top - 1])
            row = piece_table[count]
            _beside(kind, p, side, high, q1)
            _hermite(q0, q1, high - low, row)
            is_fine = high - low <= _FINEST
            if not is_fine and _miss(kind, p, side, low, high, row, q) > _MARGIN * tolerance:
                todo[top] = 0.5 * (low + high)
                top += 1
                continue
            is_arc = is_fine and _cusp(kind, p, side, low, high, q0, row)
            piece_kind[count] = ARC if is_arc else POLYNOMIAL
            piece_curve[count] = count
            piece_ends[count, 0] = q0[0]
            piece_ends[count, 1] = q0[1]
            piece_ends[count, 2] = q1[0]
            piece_ends[count, 3] = q1[1]
            piece_part[count, 0] = low
            piece_part[count, 1] = high
            count += 1
            top -= 1
            low = high
            for c in range(4):
                q0[c] = q1[c]
    first[len(kinds)] = count
    return count
