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
)
from nccompile.kernels.planes import SPACE

__all__ = ["blend_corners", "blend_cuts"]


@kernel
def _bezier(b0: float, b1: float, b2: float, b3: float, out: Floats, at: int) -> None:
    """Writes the power coefficients of a cubic with these control values."""
    out[at] = b0
    out[at + 1] = 3.0 * (b1 - b0)
    out[at + 2] = 3.0 * (b0 - 2.0 * b1 + b2)
    out[at + 3] = b3 - b0 + 3.0 * (b1 - b2)


@kernel
def _blend(one: Floats, two: Floats, length: float, out: Floats) -> None:
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
def blend_cuts(one: Floats, two: Floats, at_a: float, at_b: float, out: Floats) -> None:
    """Three cubics in place of the lengths at_a and at_b [mm] before and behind a corner: rows, Shape (3, 12)."""
    chord = 0.0
    for c in range(3):
        chord += (two[c] - one[c]) * (two[c] - one[c])
    _blend(one, two, 0.5 * (at_a + at_b + sqrt(chord)), out)


@kernel
def _in_plane(row: Floats, plane: int) -> None:
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
    kinds: Kinds, planes: Wholes, rows: Floats, points: Floats, length: Floats,
    room: Floats, may: npt.NDArray[np.bool_], reach: Floats, angle: float, before: Floats, after: Floats,
    found: Kinds, pieces: Wholes, piece_kind: Kinds,
    piece_plane: Wholes, piece_rows: Floats, piece_length: Floats,
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
    cubics = np.empty((3, 12))
    count = 0
    for i in range(len(may)):
        if not may[i]:
            continue
        na, nb, turn = corner_states(kinds, planes, rows, points, length, i, nodes, one, two)
        if turn <= angle:
            continue
        found[i] = LEFT
        far = min(float(reach[i]), float(room[i]), float(room[i + 1]))
        if turn > SHARPEST or far <= SHORTEST:
            continue
        at_a, at_b = cut_corner(kinds, planes, rows, points, length, room, i, nodes, na, nb, far, one, two)
        plane = common_plane(kinds, planes, points, i)
        number = 1
        if na == 0 and nb == 0:
            for c in range(3):
                corner = float(points[i + 1, c])
                _bezier(one[c], corner, corner, two[c], cubics[0], 4 * c)
        else:
            blend_cuts(one, two, at_a, at_b, cubics)
            number = 3
        _put(cubics, number, plane, count, piece_kind, piece_plane, piece_rows, piece_length)
        count += number
        found[i] = CORNER
        pieces[i] = number
        before[i] = at_a
        after[i] = at_b
    return count


@kernel
def _put(
    cubics: Floats, number: int, plane: int, at: int, piece_kind: Kinds,
    piece_plane: Wholes, piece_rows: Floats, piece_length: Floats,
) -> None:  # fmt: skip
    """Writes the cubics of one corner from place `at` on."""
    for k in range(number):
        piece_length[at + k] = in_plane_length(POLYNOMIAL, cubics[k])
        piece_kind[at + k] = POLYNOMIAL
        piece_plane[at + k] = plane if plane >= 0 else SPACE
        if plane >= 0:
            _in_plane(cubics[k], plane)
        piece_rows[at + k] = cubics[k]
