"""Joints between the offsets of neighbouring segments: cut at their common point, or connected about the corner.

    e: end of the offset before    s: start of the offset after    r = |d|, t: bend of the contour

    convex     an arc about the corner from e to s, or e - tip - s along the tangents, if r / cos(t / 2) is within
               the limit; lines that bend by less than _TANGENT are extended to the tip, within the tolerance; a line
               that bends by what rounded directions do ends (begins) at s (e) of a curve
    concave    both are cut at their common point; where they have none, a straight line from e to s
    d changes  convex: an arc of the radius before, then straight to s;  concave: as above, each with its own d
    side       a straight line across the contour

Pieces and connectors are rows of one table (`offset_rows`); connectors stand behind the pieces.
"""

from math import atan2, cos, pi, sqrt

import numpy as np

from nccompile.kernels import kernel
from nccompile.kernels.boxes import Kinds, Rows
from nccompile.kernels.curve_parts import curve_piece
from nccompile.kernels.curve_points import ARC, Floats
from nccompile.kernels.intersect import COMMON, heading, intersections, place, slope
from nccompile.kernels.offset import put_arc, put_line

__all__ = ["cut_piece", "join_offsets"]

_COINCIDENT = 1e-9  # [mm], as geometry.tolerance.COINCIDENT
_TANGENT = 0.02  # [rad] lines that bend less are extended: they meet within 5e-5 r of the arc
_SLIGHT = 5e-7  # [mm] by which a line may be too near where it is moved to meet a curve: directions that were rounded
_BACK = 1e-9  # [rad] a contour that bends by this less than pi turns back on itself
_RETRACED = 1e-3  # [rad] the same where a contour closes: it is led in and out on one line
_TRIED = 6  # pieces at both sides of a concave corner that are tried for a common point
_ROOM = 3.0  # a piece is at least this many times as long as what is cut off it for a chamfer


@kernel
def cut_piece(
    at: int, u0: float, u1: float, kind: Kinds, curve: Rows, table: Floats, ends: Floats, part: Floats
) -> None:  # fmt: skip
    """Piece `at` becomes its part u0..u1; an end that stays is not computed anew."""
    row = table[max(int(curve[at]), 0)]
    x0, y0 = place(int(kind[at]), row, ends[at], u0)
    x1, y1 = place(int(kind[at]), row, ends[at], u1)
    if curve[at] >= 0:
        curve_piece(int(kind[at]), row, u0, u1, row)
    p0 = float(part[at, 0])
    p1 = float(part[at, 1])
    if u0 > 0.0:
        ends[at, 0] = x0
        ends[at, 1] = y0
        part[at, 0] = p0 + u0 * (p1 - p0)
    if u1 < 1.0:
        ends[at, 2] = x1
        ends[at, 3] = y1
        part[at, 1] = p0 + u1 * (p1 - p0)


@kernel
def _meet(
    a0: int, a1: int, b0: int, b1: int, kind: Kinds, curve: Rows, table: Floats, ends: Floats, part: Floats,
    us: Floats, vs: Floats, found: Rows,
) -> bool:  # fmt: skip
    """Cuts the pieces a0..a1 - 1 and b0..b1 - 1 at their common point nearest to the corner between them.

    found: Shape (2,), out: the last piece of the first ones and the first of the second ones that are left.
    """
    for back in range(min(_TRIED, a1 - a0)):
        for ahead in range(min(_TRIED, b1 - b0)):
            i = a1 - 1 - back
            j = b0 + ahead
            if i == j:
                continue
            count = intersections(
                int(kind[i]), table[max(int(curve[i]), 0)], ends[i], int(kind[j]), table[max(int(curve[j]), 0)],
                ends[j], us, vs,
            )  # fmt: skip
            best = -1
            for k in range(count):
                if best < 0 or vs[k] - us[k] < vs[best] - us[best]:
                    best = k
            if best >= 0 and us[best] > 0.0 and vs[best] < 1.0:
                u = float(us[best])
                v = float(vs[best])
                cut_piece(i, 0.0, u, kind, curve, table, ends, part)
                cut_piece(j, v, 1.0, kind, curve, table, ends, part)
                if kind[j] < ARC:
                    ends[j, 0] = ends[i, 2]
                    ends[j, 1] = ends[i, 3]
                found[0] = i
                found[1] = j
                return True
    return False


@kernel
def _chamfer(
    i: int, j: int, gap: float, kind: Kinds, curve: Rows, table: Floats, ends: Floats, part: Floats
) -> bool:  # fmt: skip
    """Cuts `gap` [mm] off the end of piece i and off the start of piece j; False if they are too short."""
    x, y = slope(int(kind[i]), table[max(int(curve[i]), 0)], ends[i], 1.0)
    one = sqrt(x * x + y * y)
    x, y = slope(int(kind[j]), table[max(int(curve[j]), 0)], ends[j], 0.0)
    two = sqrt(x * x + y * y)
    if one < _ROOM * gap or two < _ROOM * gap:
        return False
    cut_piece(i, 0.0, 1.0 - gap / one, kind, curve, table, ends, part)
    cut_piece(j, gap / two, 1.0, kind, curve, table, ends, part)
    return True


@kernel
def _convex(
    i: int, j: int, cx: float, cy: float, d: float, after: float, turn: float, line: bool, limit: float,
    tolerance: float, at: int, kind: Kinds, curve: Rows, table: Floats, ends: Floats,
) -> int:  # fmt: skip
    """Connects the end of piece i and the start of piece j about the corner (cx, cy); returns the connectors written
    from `at` on: 0, 1 or 2.  d, after: distances before and behind the corner [mm]."""
    ex, ey = float(ends[i, 2]), float(ends[i, 3])
    sx, sy = float(ends[j, 0]), float(ends[j, 1])
    sweep = -abs(turn) if d > 0.0 else abs(turn)
    if d != after:
        if abs(turn * d) <= _COINCIDENT:
            put_line(at, ex, ey, sx, sy, kind, curve, ends)
            return 1
        mx = cx + (sx - cx) * (d / after)
        my = cy + (sy - cy) * (d / after)
        put_arc(at, cx, cy, ex, ey, mx, my, sweep, kind, curve, table, ends)
        put_line(at + 1, mx, my, sx, sy, kind, curve, ends)
        return 2
    reach = 1.0 / max(cos(0.5 * turn), 1e-9)
    tx = cx + ((ex - cx) + (sx - cx)) / (1.0 + cos(turn)) if reach < 1e6 else cx
    ty = cy + ((ey - cy) + (sy - cy)) / (1.0 + cos(turn)) if reach < 1e6 else cy
    if abs(turn) <= _TANGENT and kind[i] < ARC and kind[j] < ARC and abs(d) * (reach - 1.0) <= tolerance:
        ends[i, 2] = tx
        ends[i, 3] = ty
        ends[j, 0] = tx
        ends[j, 1] = ty
        return 0
    if 0.5 * abs(d) * turn * turn <= _SLIGHT:
        if kind[i] < ARC:
            ends[i, 2] = sx
            ends[i, 3] = sy
            return 0
        if kind[j] < ARC:
            ends[j, 0] = ex
            ends[j, 1] = ey
            return 0
    if line and reach <= limit:
        put_line(at, ex, ey, tx, ty, kind, curve, ends)
        put_line(at + 1, tx, ty, sx, sy, kind, curve, ends)
        return 2
    put_arc(at, cx, cy, ex, ey, sx, sy, sweep, kind, curve, table, ends)
    return 1


@kernel
def join_offsets(
    kinds: Kinds, curve: Rows, table: Floats, ends: Floats, d: Floats, group: Rows, close: bool, line: bool,
    limit: float, tolerance: float, begin: Rows, stop: Rows, count: int,
    piece_kind: Kinds, piece_curve: Rows, piece_table: Floats, piece_ends: Floats, piece_part: Floats,
    connector: Rows, connectors: Rows,
) -> int:  # fmt: skip
    """Makes the offsets of neighbouring segments meet.

    Args:     kinds, curve, table, ends, d: the segments, as in `offset_rows`;  group: Shape (n,), the contour of each;
              close: whether a closed contour gets its start corner connected;  line, limit: of convex corners;
              begin, stop: Shape (n,), the range of pieces of each segment, changed where some are cut off whole;
              count: pieces, the next row of the table is the first connector;  connector, connectors: Shape (n,),
              out: the first one behind each segment and how many; below 0 where the side changes.
    Returns:  pieces and connectors.
    """
    us = np.zeros(COMMON)
    vs = np.zeros(COMMON)
    found = np.zeros(2, np.int64)
    n = len(kinds)
    one = -1
    for k in range(2 * n):
        # Every joint with the row before, and behind the last row of a contour the joint with its first row.
        two = k // 2
        is_closing = k % 2 == 1
        if is_closing:
            if two + 1 < n and group[two + 1] == group[two]:
                continue
            one = two
            while two > 0 and group[two - 1] == group[one]:
                two -= 1
            gap = max(abs(ends[one, 2] - ends[two, 0]), abs(ends[one, 3] - ends[two, 1]))
            if gap > _COINCIDENT or d[one] != d[two]:
                continue
        else:
            connectors[two] = 0
            if one >= 0 and group[one] != group[two]:
                one = -1
        if begin[two] >= stop[two]:
            continue
        if one < 0:
            one = two
            continue
        last = one
        one = k // 2
        if begin[last] >= stop[last]:
            continue
        i = int(stop[last]) - 1
        j = int(begin[two])
        ex, ey = float(piece_ends[i, 2]), float(piece_ends[i, 3])
        sx, sy = float(piece_ends[j, 0]), float(piece_ends[j, 1])
        if max(abs(ex - sx), abs(ey - sy)) <= _COINCIDENT:
            continue
        connector[last] = count
        if d[last] * d[two] < 0.0:
            put_line(count, ex, ey, sx, sy, piece_kind, piece_curve, piece_ends)
            connectors[last] = -1
            count += 1
            continue
        ax, ay = heading(int(kinds[last]), table[max(int(curve[last]), 0)], ends[last], 1.0)
        bx, by = heading(int(kinds[two]), table[max(int(curve[two]), 0)], ends[two], 0.0)
        turn = atan2(ax * by - ay * bx, ax * bx + ay * by)
        is_next = is_closing or last + 1 == two
        if is_next and (turn * d[last] < 0.0 or abs(turn) > pi - _BACK):
            if is_closing and (not close or abs(turn) > pi - _RETRACED):
                continue
            connectors[last] = _convex(
                i, j, float(ends[last, 2]), float(ends[last, 3]), float(d[last]), float(d[two]), turn, line, limit,
                tolerance, count, piece_kind, piece_curve, piece_table, piece_ends,
            )  # fmt: skip
            count += int(connectors[last])
            continue
        if _meet(
            int(begin[last]), int(stop[last]), int(begin[two]), int(stop[two]), piece_kind, piece_curve, piece_table,
            piece_ends, piece_part, us, vs, found,
        ):  # fmt: skip
            stop[last] = found[0] + 1
            begin[two] = found[1]
            continue
        if is_closing:
            continue
        gap = sqrt((ex - sx) * (ex - sx) + (ey - sy) * (ey - sy))
        is_small = is_next and d[last] == d[two] and gap * abs(turn) <= 2.0 * _SLIGHT
        if is_small and _chamfer(i, j, gap, piece_kind, piece_curve, piece_table, piece_ends, piece_part):
            ex, ey = float(piece_ends[i, 2]), float(piece_ends[i, 3])
            sx, sy = float(piece_ends[j, 0]), float(piece_ends[j, 1])
        put_line(count, ex, ey, sx, sy, piece_kind, piece_curve, piece_ends)
        connectors[last] = 1
        count += 1
    return count
