r"""Splines in corners, of continuous direction and curvature: the kernel of the pass `smooth-corners`.

●────────a──V        two lines     one cubic with the control points a, V, V, b: curvature 0 at both ends
          `, │                     P(t) = (1-t)³ a + 3 t (1-t) V + t³ b
            ', b     with curves   a cubic B-spline on the knots 0 0 0 0 1 2 3 3 3 3: six control points C, as many
             │                     as the conditions  P' = L/3 T,  P'' = (L/3)² K  at a and b,  L its length
             ●
    C0 = a    C1 = C0 + a'/3    C2 = C1 + (2 a' + a'')/3       C5 = b    C4 = C5 - b'/3    C3 = C4 - (2 b' - b'')/3

    Bezier points of the three cubics, from the blossom of the spline:
    C0 C1 (C1+C2)/2 . | . (2 C2+C3)/3 (C2+2 C3)/3 . | . (C3+C4)/2 C4 C5      . is the middle of its neighbours
"""

from __future__ import annotations

from math import sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curve_points import POLYNOMIAL, Floats
from nccompile.kernels.curves import NODES, in_plane_length
from nccompile.kernels.legs import STATE, common_plane, leg_at, reach_along, tabulate_leg, turn_between

__all__ = ["blend", "blend_corners"]

_SHORTEST = 1e-6  # [mm] cuts below this are not worth a segment
_SHARPEST = 3.1405926535897932  # a path that turns back has no spline around its corner
_CORNER, _LEFT = 1, 2
_SPACE = 3


@kernel
def _bezier(b0: float, b1: float, b2: float, b3: float, out: Floats, at: int) -> None:
    """Writes the power coefficients of a cubic with these control values."""
    out[at] = b0
    out[at + 1] = 3.0 * (b1 - b0)
    out[at + 2] = 3.0 * (b0 - 2.0 * b1 + b2)
    out[at + 3] = b3 - b0 + 3.0 * (b1 - b2)


@kernel
def blend(one: Floats, two: Floats, length: float, out: Floats) -> None:
    """Three cubics, C2 inside, from state `one` to state `two`: rows in space, Shape (3, 12).

    length: L of the module's drawing [mm]; the better it is met, the more even the speed of the parameter.
    """
    v = length / 3.0
    for c in range(3):
        a = v * one[3 + c]
        b = v * two[3 + c]
        c0 = one[c]
        c1 = c0 + a / 3.0
        c2 = c1 + (2.0 * a + v * v * one[6 + c]) / 3.0
        c5 = two[c]
        c4 = c5 - b / 3.0
        c3 = c4 - (2.0 * b - v * v * two[6 + c]) / 3.0
        low = (2.0 * c2 + c3) / 3.0
        high = (c2 + 2.0 * c3) / 3.0
        before = 0.5 * (c1 + c2)
        after = 0.5 * (c3 + c4)
        first = 0.5 * (before + low)
        second = 0.5 * (high + after)
        _bezier(c0, c1, before, first, out[0], 4 * c)
        _bezier(first, low, high, second, out[1], 4 * c)
        _bezier(second, after, c4, c5, out[2], 4 * c)


@kernel
def in_plane(row: Floats, plane: int) -> None:
    """Turns a row in space into one of a plane 0..2 to which it is parallel."""
    x = row[0:4].copy()
    y = row[4:8].copy()
    z = row[8:12].copy()
    if plane == 1:
        row[0:4] = z
        row[4:8] = x
    elif plane == 2:
        row[0:4] = y
        row[4:8] = z
    row[8:12] = 0.0


@kernel
def blend_corners(
    kinds: npt.NDArray[np.uint8], planes: npt.NDArray[np.int64], rows: Floats, points: Floats, length: Floats,
    room: Floats, may: npt.NDArray[np.bool_], reach: Floats, angle: float, before: Floats, after: Floats,
    found: npt.NDArray[np.uint8], pieces: npt.NDArray[np.int64], piece_kind: npt.NDArray[np.uint8],
    piece_plane: npt.NDArray[np.int64], piece_rows: Floats, piece_length: Floats,
) -> int:  # fmt: skip
    """Fills the corners behind the rows of which `may` is set and which bend by more than `angle` [rad].

    Args:     columns of the path as in `kernels.distance`;  room: Shape (n,), what a corner may cut off a row [mm];
              reach: Shape (n,), distance of the cut from the corner behind row i [mm].
    Returns:  number of pieces;  out: before, after: Shape (n,), cut off row i and row i + 1 [mm];  found: Shape (n,),
              0: no corner, 1: filled, 2: left as it is;  pieces: Shape (n,), their number;  piece_*: one row a piece,
              with its length [mm].
    """
    nodes = np.empty((4, NODES))
    one = np.empty(STATE)
    two = np.empty(STATE)
    scratch = np.empty(STATE)
    cubics = np.empty((3, 12))
    count = 0
    for i in range(len(may)):
        if not may[i]:
            continue
        j = i + 1
        ka = int(kinds[i])
        kb = int(kinds[j])
        pa = int(planes[i])
        pb = int(planes[j])
        la = float(length[i])
        lb = float(length[j])
        na = tabulate_leg(ka, rows[i], nodes[0], nodes[1])
        nb = tabulate_leg(kb, rows[j], nodes[2], nodes[3])
        leg_at(ka, pa, rows[i], points[i], points[j], la, nodes[0], nodes[1], na, la, one)
        leg_at(kb, pb, rows[j], points[j], points[j + 1], lb, nodes[2], nodes[3], nb, 0.0, two)
        turn = turn_between(one, two)
        if turn <= angle:
            continue
        found[i] = _LEFT
        far = min(float(reach[i]), float(room[i]), float(room[j]))
        if turn > _SHARPEST or far <= _SHORTEST:
            continue
        at_a = reach_along(
            ka,
            pa,
            rows[i],
            points[i],
            points[j],
            la,
            nodes[0],
            nodes[1],
            na,
            far,
            float(room[i]),
            True,
            scratch,
        )
        at_b = reach_along(
            kb,
            pb,
            rows[j],
            points[j],
            points[j + 1],
            lb,
            nodes[2],
            nodes[3],
            nb,
            far,
            float(room[j]),
            False,
            scratch,
        )
        leg_at(ka, pa, rows[i], points[i], points[j], la, nodes[0], nodes[1], na, la - at_a, one)
        leg_at(kb, pb, rows[j], points[j], points[j + 1], lb, nodes[2], nodes[3], nb, at_b, two)
        plane = common_plane(ka, pa, kb, pb, points[i], points[j], points[j + 1])
        number = 1
        if na == 0 and nb == 0:
            for c in range(3):
                corner = float(points[j, c])
                _bezier(one[c], corner, corner, two[c], cubics[0], 4 * c)
        else:
            chord = 0.0
            for c in range(3):
                chord += (two[c] - one[c]) * (two[c] - one[c])
            blend(one, two, 0.5 * (at_a + at_b + sqrt(chord)), cubics)
            number = 3
        _put(cubics, number, plane, count, piece_kind, piece_plane, piece_rows, piece_length)
        count += number
        found[i] = _CORNER
        pieces[i] = number
        before[i] = at_a
        after[i] = at_b
    return count


@kernel
def _put(
    cubics: Floats, number: int, plane: int, at: int, piece_kind: npt.NDArray[np.uint8],
    piece_plane: npt.NDArray[np.int64], piece_rows: Floats, piece_length: Floats,
) -> None:  # fmt: skip
    """Writes the cubics of one corner from place `at` on."""
    for k in range(number):
        piece_length[at + k] = in_plane_length(POLYNOMIAL, cubics[k])
        piece_kind[at + k] = POLYNOMIAL
        piece_plane[at + k] = plane if plane >= 0 else _SPACE
        if plane >= 0:
            in_plane(cubics[k], plane)
        piece_rows[at + k] = cubics[k]
