"""Boxes of segments in X-Y, and a tree of boxes over runs of 1, 2, 4 ... neighbouring segments.

    kinds: u1 (n,);  curve: i8 (n,), row of `table`, f8 (m, 12), or -1 if straight;  ends: f8 (n, 4), x and y of the
    start, x and y of the end

Neighbours on a path are neighbours in space, so few boxes overlap and a search takes about log n steps.
"""

from math import floor, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curve_points import ARC, POLYNOMIAL, Floats, point

__all__ = ["Rows", "box_tree", "leaves", "next_leaf", "segment_box"]

Kinds = npt.NDArray[np.uint8]
Rows = npt.NDArray[np.int64]

_SLACK = 1e-9  # [mm] a segment may be missed by this much beyond its end
_QUARTER = 1.5707963267948966
_PLACES = 16


def leaves(n: int) -> int:
    """The power of two of leaves that a tree over n segments has; it takes f8 (2 leaves, 4)."""
    m = 1
    while m < n:
        m *= 2
    return m


@kernel
def segment_box(kind: int, p: Floats, e: Floats, box: Floats) -> None:
    """Fills box with x low, y low, x high, y high of a segment with the ends e."""
    x0 = min(float(e[0]), float(e[2]))
    y0 = min(float(e[1]), float(e[3]))
    x1 = max(float(e[0]), float(e[2]))
    y1 = max(float(e[1]), float(e[3]))
    if kind == ARC:
        # Quarter turns n within the arc are the places where x or y is extreme.
        first = min(float(p[3]), float(p[3]) + float(p[4]))
        last = max(float(p[3]), float(p[3]) + float(p[4]))
        n = floor(first / _QUARTER) + 1
        while n * _QUARTER < last:
            turn = n % 4
            if turn == 0:
                x1 = max(x1, float(p[0]) + float(p[2]))
            elif turn == 1:
                y1 = max(y1, float(p[1]) + float(p[2]))
            elif turn == 2:
                x0 = min(x0, float(p[0]) - float(p[2]))
            else:
                y0 = min(y0, float(p[1]) - float(p[2]))
            n += 1
    elif ARC < kind <= POLYNOMIAL:
        reach = 0.0
        xa, ya = point(kind, p, 0.0)
        for i in range(_PLACES):
            xb, yb = point(kind, p, (i + 1.0) / _PLACES)
            reach = max(reach, sqrt((xb - xa) * (xb - xa) + (yb - ya) * (yb - ya)))
            x0 = min(x0, xb)
            y0 = min(y0, yb)
            x1 = max(x1, xb)
            y1 = max(y1, yb)
            xa = xb
            ya = yb
        # Between two places the curve leaves the box of both by less than half their distance.
        x0 -= 0.5 * reach
        y0 -= 0.5 * reach
        x1 += 0.5 * reach
        y1 += 0.5 * reach
    box[0] = x0 - _SLACK
    box[1] = y0 - _SLACK
    box[2] = x1 + _SLACK
    box[3] = y1 + _SLACK


@kernel
def box_tree(kinds: Kinds, curve: Rows, table: Floats, ends: Floats, tree: Floats) -> int:
    """Fills the tree: f8 (2 m, 4), m the next power of two of n; node k holds the box of 2k and 2k + 1, leaf m + i
    that of segment i; returns m."""
    n = len(kinds)
    m = len(tree) // 2
    for k in range(2 * m):
        tree[k, 0] = 1e300
        tree[k, 1] = 1e300
        tree[k, 2] = -1e300
        tree[k, 3] = -1e300
    for i in range(n):
        segment_box(int(kinds[i]), table[max(int(curve[i]), 0)], ends[i], tree[m + i])
    for k in range(m - 1, 0, -1):
        for c in range(2):
            tree[k, c] = min(float(tree[2 * k, c]), float(tree[2 * k + 1, c]))
            tree[k, 2 + c] = max(float(tree[2 * k, 2 + c]), float(tree[2 * k + 1, 2 + c]))
    return m


@kernel
def next_leaf(tree: Floats, box: Floats, stack: Rows, top: int, low: int, high: int) -> tuple[int, int]:
    """The next of the segments low..high - 1 whose box meets `box`, and the new `top`; -1 if no more does.

    stack: Shape (128,), nodes still to be looked at, `top` of them: node 1 alone when the search begins.
    """
    m = len(tree) // 2
    while top > 0:
        top -= 1
        node = int(stack[top])
        if (
            tree[node, 0] > box[2] or tree[node, 2] < box[0] or tree[node, 1] > box[3] or tree[node, 3] < box[1]
        ):  # fmt: skip
            continue
        first = node
        span = 1
        while first < m:
            first *= 2
            span *= 2
        if first - m + span <= low or first - m >= high:
            continue
        if node >= m:
            return node - m, top
        stack[top] = 2 * node
        stack[top + 1] = 2 * node + 1
        top += 2
    return -1, 0
