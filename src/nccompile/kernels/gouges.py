"""How deep a tool's path cuts into a contour: exact distances between lines and arcs, found through a tree of boxes.

    path piece ──────x───          depth = r - distance, r: the radius with which that row of the contour is cut
                     | distance     the greatest of all rows counts, and the place x where it is
    contour ─────────x───

Two lines or arcs are nearest at an end of either of them, at a foot of a centre, on the line of both centres, or
where they cross.  Ellipses and cubics are chains of chords, within a sagitta that the caller chooses.
"""

from math import ceil, sqrt

import numpy as np

from nccompile.kernels import kernel
from nccompile.kernels.boxes import Kinds, Rows, segment_box
from nccompile.kernels.curve_points import ARC, ELLIPSE, POLYNOMIAL, Floats, point, second
from nccompile.kernels.intersect import COMMON, place, plain_intersections, plain_length, share_of

__all__ = ["chord_count", "chords", "deepest", "foot"]

_MOST = 2000  # chords of one curve


@kernel
def foot(kind: int, p: Floats, e: Floats, x: float, y: float) -> tuple[float, float]:
    """The place on a line or arc with the ends e that is nearest to (x, y)."""
    if kind == ARC:
        dx = x - float(p[0])
        dy = y - float(p[1])
        size = sqrt(dx * dx + dy * dy)
        if size > 0.0 and share_of(p, x, y) <= 1.0:
            return float(p[0]) + dx / size * float(p[2]), float(p[1]) + dy / size * float(p[2])
        ax = x - float(e[0])
        ay = y - float(e[1])
        bx = x - float(e[2])
        by = y - float(e[3])
        if ax * ax + ay * ay <= bx * bx + by * by:
            return float(e[0]), float(e[1])
        return float(e[2]), float(e[3])
    gx = float(e[2]) - float(e[0])
    gy = float(e[3]) - float(e[1])
    size = gx * gx + gy * gy
    t = ((x - float(e[0])) * gx + (y - float(e[1])) * gy) / size if size > 0.0 else 0.0
    t = min(max(t, 0.0), 1.0)
    if t == 1.0:
        return float(e[2]), float(e[3])
    return float(e[0]) + t * gx, float(e[1]) + t * gy


@kernel
def _gap(x: float, y: float, kind: int, p: Floats, e: Floats) -> float:
    """Distance [mm] of a point from a line or arc."""
    fx, fy = foot(kind, p, e, x, y)
    return sqrt((x - fx) * (x - fx) + (y - fy) * (y - fy))


@kernel
def _nearest(
    kind: int, p: Floats, e: Floats, other: int, q: Floats, f: Floats, us: Floats, vs: Floats, out: Floats
) -> float:  # fmt: skip
    """The least distance [mm] of two lines or arcs;  out: Shape (>= 2,), where on the first one it is."""
    best = 1e300
    for i in range(6):
        if i < 2:
            x, y = float(e[2 * i]), float(e[2 * i + 1])
        elif i < 4:
            x, y = foot(kind, p, e, float(f[2 * i - 4]), float(f[2 * i - 3]))
        elif kind != ARC and other != ARC:
            break
        elif kind == ARC and other == ARC:
            dx = float(q[0]) - float(p[0])
            dy = float(q[1]) - float(p[1])
            size = sqrt(dx * dx + dy * dy)
            if size == 0.0:
                break
            side = float(p[2]) / size if i == 4 else -float(p[2]) / size
            x, y = foot(kind, p, e, float(p[0]) + side * dx, float(p[1]) + side * dy)
        elif i == 5:
            break
        elif kind == ARC:
            x, y = foot(other, q, f, float(p[0]), float(p[1]))
            x, y = foot(kind, p, e, x, y)
        else:
            x, y = foot(kind, p, e, float(q[0]), float(q[1]))
        gap = _gap(x, y, other, q, f)
        if gap < best:
            best = gap
            out[0] = x
            out[1] = y
    # Where they cross, an end of the shorter one is within half of its length.
    is_near = best > 0.0 and 2.0 * best <= min(plain_length(kind, p, e), plain_length(other, q, f))
    if is_near and plain_intersections(kind, p, e, other, q, f, us, vs) > 0:
        x, y = place(kind, p, e, float(us[0]))
        out[0] = x
        out[1] = y
        return 0.0
    return best


@kernel
def _apart(e: Floats, f: Floats, reach: float) -> bool:
    """Whether two lines are surely not nearer than reach [mm]: seen along the line between their middles."""
    dx = 0.5 * ((float(f[0]) + float(f[2])) - (float(e[0]) + float(e[2])))
    dy = 0.5 * ((float(f[1]) + float(f[3])) - (float(e[1]) + float(e[3])))
    gap = sqrt(dx * dx + dy * dy)
    one = abs((float(e[2]) - float(e[0])) * dx + (float(e[3]) - float(e[1])) * dy)
    two = abs((float(f[2]) - float(f[0])) * dx + (float(f[3]) - float(f[1])) * dy)
    return gap * (gap - reach) > 0.5 * (one + two)


@kernel
def chord_count(kind: int, p: Floats, sag: float) -> int:
    """Chords of equal steps of u that stay within `sag` [mm] of an ellipse or cubic: n² = max |P''| / (8 sag)."""
    if kind == ELLIPSE:
        bend = max(abs(float(p[2])), abs(float(p[3]))) * float(p[6]) * float(p[6])
    else:
        x, y = second(kind, p, 0.0)
        bend = sqrt(x * x + y * y)
        x, y = second(kind, p, 1.0)
        bend = max(bend, sqrt(x * x + y * y))
    return max(1, min(_MOST, ceil(sqrt(bend / (8.0 * sag)))))


@kernel
def chords(
    kinds: Kinds, curve: Rows, table: Floats, ends: Floats, sag: float,
    out_kinds: Kinds, out_curve: Rows, out_ends: Floats, owner: Rows,
) -> int:  # fmt: skip
    """The same segments with chords for ellipses and cubics; returns how many, more than there is room if that
    does not do."""
    count = 0
    for i in range(len(kinds)):
        kind = int(kinds[i])
        if not ARC < kind <= POLYNOMIAL:
            if count < len(out_kinds):
                out_kinds[count] = kind
                out_curve[count] = curve[i]
                out_ends[count] = ends[i]
                owner[count] = i
            count += 1
            continue
        p = table[int(curve[i])]
        n = chord_count(kind, p, sag)
        x, y = float(ends[i, 0]), float(ends[i, 1])
        for k in range(n):
            if count < len(out_kinds):
                out_kinds[count] = 1
                out_curve[count] = -1
                out_ends[count, 0] = x
                out_ends[count, 1] = y
                x, y = point(kind, p, (k + 1.0) / n)
                if k == n - 1:
                    x, y = float(ends[i, 2]), float(ends[i, 3])
                out_ends[count, 2] = x
                out_ends[count, 3] = y
                owner[count] = i
            count += 1
    return count


@kernel
def deepest(
    kinds: Kinds, curve: Rows, table: Floats, ends: Floats, low: Rows, high: Rows,
    other_kinds: Kinds, other_curve: Rows, other_table: Floats, other_ends: Floats, radius: Floats, tree: Floats,
    least: Floats, depth: Floats, where: Floats,
) -> None:  # fmt: skip
    """How deep each piece of a path cuts into its contour; lines and arcs only.

    Args:     kinds, curve, table, ends: the pieces, Shape (k,);  low, high: Shape (k,), each one's contour: those of
              the other segments;  radius: Shape (n,) [mm] of these, tree: their boxes;  least: Shape (k,), depth
              that counts;
              depth: Shape (k,), out [mm], 0 where it is not above that;  where: Shape (k, 2), out: place.
    """
    us = np.zeros(COMMON)
    vs = np.zeros(COMMON)
    stack = np.zeros(128, np.int64)
    firsts = np.zeros(128, np.int64)
    spans = np.zeros(128, np.int64)
    spot = np.zeros(2)
    box = np.zeros(4)
    m = len(tree) // 2
    widest = 0.0
    for j in range(len(radius)):
        widest = max(widest, float(radius[j]))
    for i in range(len(kinds)):
        kind = int(kinds[i])
        p = table[max(int(curve[i]), 0)]
        e = ends[i]
        segment_box(kind, p, e, box)
        worst = float(least[i])
        depth[i] = 0.0
        stack[0] = 1
        firsts[0] = 0
        spans[0] = m
        top = 1
        while top > 0:
            top -= 1
            node = int(stack[top])
            dx = max(tree[node, 0] - box[2], 0.0, box[0] - tree[node, 2])
            dy = max(tree[node, 1] - box[3], 0.0, box[1] - tree[node, 3])
            reach = widest - worst
            if dx * dx + dy * dy >= reach * reach:
                continue
            if node < m:
                half = spans[top] // 2
                middle = firsts[top] + half
                if middle < high[i]:
                    stack[top] = 2 * node + 1
                    firsts[top] = middle
                    spans[top] = half
                    top += 1
                if middle > low[i]:
                    stack[top] = 2 * node
                    firsts[top] = middle - half
                    spans[top] = half
                    top += 1
                continue
            j = node - m
            if not low[i] <= j < high[i]:
                continue
            if kind != ARC and other_kinds[j] != ARC and _apart(e, other_ends[j], radius[j] - worst):
                continue
            gap = _nearest(
                kind, p, e, int(other_kinds[j]), other_table[max(int(other_curve[j]), 0)], other_ends[j], us, vs, spot
            )  # fmt: skip
            if radius[j] - gap > worst:
                worst = float(radius[j]) - gap
                depth[i] = worst
                where[i, 0] = spot[0]
                where[i, 1] = spot[1]
