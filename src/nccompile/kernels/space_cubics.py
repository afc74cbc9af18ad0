"""Plane curves, helices too, as cubics in space: where a plane is tilted, no arc or ellipse row can hold them.

    P(b)                   Hermite cubic over the share a..b of the way, h = b - a:
   /  T(b)                     value and direction at both ends are those of the curve,
P(a)                           |derivative| = h L, the length of the part
  T(a)                     halved until it keeps within the tolerance at seven inner places
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from nccompile.kernels import kernel
from nccompile.kernels.curve_points import Floats, put_hermite
from nccompile.kernels.curves import NODES
from nccompile.kernels.legs import STATE, Kinds, Wholes, row_at, tabulate_row

__all__ = ["MOST", "space_cubics"]

MOST = 4096
"""Cubics of one curve at most."""

_CHECKS = (0.1, 0.22, 0.35, 0.5, 0.65, 0.78, 0.9)
_MARGIN = 0.9  # of the tolerance that is used


@kernel
def _off(row: Floats, v: float, state: Floats) -> float:
    """The distance [mm] of a cubic at v from the point of a state."""
    square = 0.0
    for c in range(3):
        p = float(row[4 * c]) + v * (
            float(row[4 * c + 1]) + v * (float(row[4 * c + 2]) + v * float(row[4 * c + 3]))
        )
        square += (p - state[c]) * (p - state[c])
    return sqrt(square)


@kernel
def space_cubics(
    kinds: Kinds, planes: Wholes, rows: Floats, points: Floats, length: Floats, picked: Wholes, begin: int,
    tolerance: float, owner: Wholes, share: Floats, ends: Floats, out_rows: Floats,
) -> int:  # fmt: skip
    """Cubics in space for the curves `picked`, Shape (p,), from the one at place `begin` on.

    Args:     columns of the path as in `kernels.distance`;  tolerance [mm];  owner, share: Shape (k,), out: the row
              and the part 0..1 of its way at which each cubic ends;  ends: Shape (k, 3), out, X, Y, Z;
              out_rows: Shape (k, 12), out.
    Returns:  the number of cubics; of those curves only for which there is room, at least MOST rows.
    """
    nodes = np.empty((2, NODES))
    one = np.empty(STATE)
    two = np.empty(STATE)
    inner = np.empty(STATE)
    todo = np.empty(64)
    count = 0
    for j in range(begin, len(picked)):
        i = int(picked[j])
        if count + MOST > len(owner):
            break
        whole = float(length[i])
        table = tabulate_row(kinds, rows, i, nodes, 0)
        row_at(kinds, planes, rows, points, length, i, nodes, 0, table, 0.0, one)
        low = 0.0
        todo[0] = 1.0
        top = 1
        while top > 0:
            high = float(todo[top - 1])
            row_at(kinds, planes, rows, points, length, i, nodes, 0, table, high * whole, two)
            row = out_rows[count]
            size = (high - low) * whole
            for c in range(3):
                put_hermite(
                    float(one[c]),
                    size * float(one[3 + c]),
                    float(two[c]),
                    size * float(two[3 + c]),
                    row,
                    4 * c,
                )
            worst = 0.0
            for v in _CHECKS:
                s = (low + v * (high - low)) * whole
                row_at(kinds, planes, rows, points, length, i, nodes, 0, table, s, inner)
                worst = max(worst, _off(row, v, inner))
            if worst > _MARGIN * tolerance and (high - low) * MOST > 1.0:
                todo[top] = 0.5 * (low + high)
                top += 1
                continue
            owner[count] = i
            share[count] = high
            for c in range(3):
                ends[count, c] = points[i + 1, c] if high == 1.0 else two[c]
            for c in range(STATE):
                one[c] = two[c]
            count += 1
            low = high
            top -= 1
    return count
