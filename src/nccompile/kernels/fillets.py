r"""Arcs in corners: the kernel of the pass `round-corners`.

    ●────────a──V        two lines      |aV| = |Vb| = r tan(turn / 2)
              `.│        in one plane   the centre C is r away from both segments:
                b                       A(s) + r n(s) = C = B(s') + r n(s'),    Newton in (s, s')
                │        in space       two lines: cubics off the arc by less than a tolerance; with curves there is
                ●                       in general no such arc: the spline of `kernels.blends` between the same cuts

The corner is not farther than r from the path:  r / cos(turn / 2) - r  for turns up to 120 degrees; at sharper
ones the arc is smaller, with  |aV| tan(turn / 4) = r.
"""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt, tan

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.arcs import through
from nccompile.kernels.blends import blend_cuts
from nccompile.kernels.curve_points import ARC, POLYNOMIAL, Floats, put_hermite
from nccompile.kernels.curves import NODES, in_plane_length
from nccompile.kernels.legs import (
    CORNER,
    LEFT,
    SHARPEST,
    SHORTEST,
    STATE,
    Kinds,
    Wholes,
    common_plane,
    corner_states,
    cut_corner,
    row_at,
)
from nccompile.kernels.planes import SPACE, plane_axes

__all__ = ["round_corners"]


_STEPS = 30  # of Newton's method, which needs about five
_REACHED = 1e-12  # [mm] and of the radius: both ways to the centre lead to one point
_DIGITS = 2e-15  # of the coordinates, which have no more
_TRIES = 40  # of the search for the greatest arc that fits
_ENOUGH = 24
_SPLIT = 1e-3  # relative: the radius found is at most this much too small
_JUST = 1.0 + 1e-9
_FLAT = 1e-12  # determinant of Newton's matrix below which both segments are parallel

_QUARTER_MISS = (
    2.8e-4  # of the radius: a cubic is that far from an arc of 90 degrees; it falls with the 6th power
)
_MOST_PIECES = 32


@kernel
def _arc_row(one: Floats, two: Floats, plane: int, cx: float, cy: float, left: bool, out: Floats) -> None:
    """The arc between two states; its centre is moved onto their bisector, so that both ends are exact."""
    u, v = plane_axes(plane)
    x0 = float(one[u])
    y0 = float(one[v])
    x1 = float(two[u])
    y1 = float(two[v])
    dx = x1 - x0
    dy = y1 - y0
    off = ((cx - x0 - 0.5 * dx) * dx + (cy - y0 - 0.5 * dy) * dy) / (dx * dx + dy * dy)
    out[:] = 0.0
    through(x0, y0, x1, y1, cx - off * dx, cy - off * dy, left, out)


@kernel
def _pieces_of(radius: float, turn: float, tolerance: float) -> int:
    """How many cubics keep within the tolerance of an arc in space."""
    count = int(np.ceil(turn / (0.5 * pi) - 1e-9))
    while count < _MOST_PIECES:
        q = turn / (count * 0.5 * pi)
        square = q * q
        if _QUARTER_MISS * radius * square * square * square <= tolerance:
            break
        count += 1
    return count


@kernel
def _space_arc(one: Floats, two: Floats, turn: float, radius: float, count: int, rows: Floats) -> None:
    """Cubics for the arc from state `one` to `two` in a tilted plane: rows, Shape (>= count, 12).

    Tangents of length 4 tan(turn / 4) r at both ends, as powers: three times the distance of the control points.
    """
    part = turn / count
    size = 4.0 * tan(0.25 * part) * radius
    for c in range(3):
        along = float(one[3 + c])
        inward = (float(two[3 + c]) - along * cos(turn)) / sin(turn)
        center = float(one[c]) + radius * inward
        p0 = float(one[c])
        d0 = size * along
        for k in range(count):
            cosine = cos(part * (k + 1))
            sine = sin(part * (k + 1))
            p1 = float(two[c]) if k == count - 1 else center - radius * (cosine * inward - sine * along)
            d1 = size * (cosine * along + sine * inward)
            put_hermite(p0, d0, p1, d1, rows[k], 4 * c)
            p0 = p1
            d0 = d1


@kernel
def round_corners(
    kinds: Kinds, planes: Wholes, rows: Floats, points: Floats, length: Floats,
    room: Floats, may: npt.NDArray[np.bool_], wanted: Floats, is_distance: bool, tolerance: float, angle: float,
    before: Floats, after: Floats, found: Kinds, pieces: Wholes,
    piece_kind: Kinds, piece_plane: Wholes, piece_rows: Floats, piece_length: Floats,
) -> int:  # fmt: skip
    """Fills corners as `kernels.blends.blend_corners`, with arcs.

    Args:     wanted: Shape (n,), radius of the arc behind row i, or with is_distance the distance of the cuts [mm];
              tolerance: of arcs in tilted planes [mm];  the others as there.
    Returns:  number of pieces, -1 if there were more than the arrays hold.
    """
    nodes = np.empty((4, NODES))
    one = np.empty(STATE)
    two = np.empty(STATE)
    cuts = np.empty(4)
    count = 0
    for i in range(len(may)):
        if not may[i]:
            continue
        if count + _MOST_PIECES > len(piece_kind):
            return -1
        na, nb, turn = corner_states(kinds, planes, rows, points, length, i, nodes, one, two)
        if turn <= angle:
            continue
        found[i] = LEFT
        r = float(wanted[i])
        short = min(float(room[i]), float(room[i + 1]))
        if turn > SHARPEST or r <= 0.0 or short <= SHORTEST:
            continue
        half = tan(0.5 * turn)
        reach = min(r if is_distance else min(r * half, r / tan(0.25 * turn)), short)
        if reach <= SHORTEST:
            continue
        plane = common_plane(kinds, planes, points, i)
        number = 1
        if plane >= 0 and (na > 0 or nb > 0):
            if not _greatest(
                kinds, planes, rows, points, length, room, i, nodes, na, nb, plane, reach / half, r, one, two, cuts,
                piece_rows[count],
            ):  # fmt: skip
                continue
            at_a = float(cuts[0])
            at_b = float(cuts[1])
        else:
            at_a, at_b = cut_corner(
                kinds, planes, rows, points, length, room, i, nodes, na, nb, reach, one, two
            )
            if plane >= 0:
                u, v = plane_axes(plane)
                left = one[3 + u] * two[3 + v] - one[3 + v] * two[3 + u] > 0.0
                away = reach / half if left else -reach / half
                cx = float(one[u]) - away * float(one[3 + v])
                cy = float(one[v]) + away * float(one[3 + u])
                _arc_row(one, two, plane, cx, cy, left, piece_rows[count])
            elif na == 0 and nb == 0:
                number = _pieces_of(reach / half, turn, tolerance)
                _space_arc(one, two, turn, reach / half, number, piece_rows[count:])
            else:
                blend_cuts(one, two, at_a, at_b, piece_rows[count:])
                number = 3
        for k in range(number):
            piece_kind[count + k] = ARC if plane >= 0 else POLYNOMIAL
            piece_plane[count + k] = plane if plane >= 0 else SPACE
            piece_length[count + k] = in_plane_length(int(piece_kind[count + k]), piece_rows[count + k])
        count += number
        found[i] = CORNER
        pieces[i] = number
        before[i] = at_a
        after[i] = at_b
    return count


@kernel
def _greatest(
    kinds: Kinds, planes: Wholes, rows: Floats, points: Floats, length: Floats, room: Floats, i: int, nodes: Floats,
    na: int, nb: int, plane: int, radius: float, most: float, one: Floats, two: Floats, cuts: Floats, out: Floats,
) -> bool:  # fmt: skip
    """The greatest arc up to `radius` that touches rows i and i + 1 within their room, at most `most` from the corner.

    Fills cuts[0..1], what it cuts off them, and its row; False if no arc down to a trifle was found.
    """
    good = False
    low = 0.0
    high = radius
    trial = radius
    for tries in range(_TRIES):
        if _touch(
            kinds, planes, rows, points, length, room, i, nodes, na, nb, plane, trial, most, one, two, cuts, out
        ):  # fmt: skip
            good = True
            cuts[0] = cuts[2]
            cuts[1] = cuts[3]
            low = trial
            if trial == high:
                break
        else:
            high = trial
        if good and (high - low <= _SPLIT * high or tries > _ENOUGH):
            break
        trial = 0.5 * (low + high)
        if trial < SHORTEST:
            break
    return good


@kernel
def _touch(
    kinds: Kinds, planes: Wholes, rows: Floats, points: Floats, length: Floats, room: Floats, i: int, nodes: Floats,
    na: int, nb: int, plane: int, radius: float, most: float, one: Floats, two: Floats, cuts: Floats, out: Floats,
) -> bool:  # fmt: skip
    """The arc of this radius: fills cuts[2..3] and its row, False if Newton does not find one that is allowed."""
    x, y = plane_axes(plane)
    la, lb = float(length[i]), float(length[i + 1])
    room_a, room_b = float(room[i]), float(room[i + 1])
    v = points[i + 1]
    row_at(kinds, planes, rows, points, length, i, nodes, 0, na, la, one)
    row_at(kinds, planes, rows, points, length, i + 1, nodes, 2, nb, 0.0, two)
    bend = one[3 + x] * two[3 + y] - one[3 + y] * two[3 + x]
    side = 1.0 if bend > 0.0 else -1.0
    turn = atan2(abs(bend), one[3 + x] * two[3 + x] + one[3 + y] * two[3 + y])
    cut = min(radius * tan(0.5 * turn), room_a, room_b)
    sa = la - cut
    sb = cut
    for _ in range(_STEPS):
        row_at(kinds, planes, rows, points, length, i, nodes, 0, na, sa, one)
        row_at(kinds, planes, rows, points, length, i + 1, nodes, 2, nb, sb, two)
        ax = -side * float(one[3 + y])
        ay = side * float(one[3 + x])
        bx = -side * float(two[3 + y])
        by = side * float(two[3 + x])
        mx = one[x] + radius * ax - two[x] - radius * bx
        my = one[y] + radius * ay - two[y] - radius * by
        if max(abs(mx), abs(my)) <= _REACHED * (1.0 + radius) + _DIGITS * max(abs(one[x]), abs(one[y])):
            if not (la - room_a <= sa < la and 0.0 < sb <= room_b):
                return False
            cx = 0.5 * (one[x] + radius * ax + two[x] + radius * bx)
            cy = 0.5 * (one[y] + radius * ay + two[y] + radius * by)
            row = np.empty(12)
            _arc_row(one, two, plane, cx, cy, side > 0.0, row)
            missed = sqrt((row[0] - v[x]) * (row[0] - v[x]) + (row[1] - v[y]) * (row[1] - v[y])) - row[2]
            if abs(row[4]) >= pi or missed > most * _JUST:
                return False
            out[:] = row
            cuts[2] = la - sa
            cuts[3] = sb
            return True
        f = 1.0 - radius * (one[6 + x] * ax + one[6 + y] * ay)
        g = radius * (two[6 + x] * bx + two[6 + y] * by) - 1.0
        jax = one[3 + x] * f
        jay = one[3 + y] * f
        jbx = two[3 + x] * g
        jby = two[3 + y] * g
        det = jax * jby - jay * jbx
        if abs(det) < _FLAT:
            return False
        sa = min(max(sa - (mx * jby - my * jbx) / det, la - 2.0 * room_a), la)
        sb = min(max(sb - (jax * my - jay * mx) / det, 0.0), lb)
    return False
