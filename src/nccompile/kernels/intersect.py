"""Common points of two segments in X-Y, and the first one along a path, found through a tree of boxes.

    kinds: LINE or positioning (straight), ARC, ELLIPSE, POLYNOMIAL in X-Y;  rows: f8 (n, 12) curve rows;
    points: f8 (n + 1, >= 2), start position and ends

Lines and arcs meet in closed form.  An ellipse or a cubic is looked at as a chain of chords; where one of them
meets the other segment, Newton on P(u) = Q(v) finds the point itself.

The tree holds boxes of runs of 1, 2, 4 ... neighbouring segments.  Neighbours on a path are neighbours in space,
so few boxes overlap and a search takes about log n steps.
"""

from math import acos, atan2, floor, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curve_points import ARC, ELLIPSE, POLYNOMIAL, Floats, derivative, point

__all__ = ["box_tree", "distance_within", "first_crossing", "intersections"]

Kinds = npt.NDArray[np.uint8]

_TURN = 6.283185307179586
_CHORDS = 24
_SLACK = 1e-9  # [mm] by which a segment may be missed beyond its end
_SIZE = 48  # common points of two segments at most


@kernel
def _at(kind: int, p: Floats, a: Floats, b: Floats, u: float) -> tuple[float, float]:
    """The point at u."""
    if ARC <= kind <= POLYNOMIAL:
        return point(kind, p, u)
    return float(a[0]) + u * (float(b[0]) - float(a[0])), float(a[1]) + u * (float(b[1]) - float(a[1]))


@kernel
def _slope(kind: int, p: Floats, a: Floats, b: Floats, u: float) -> tuple[float, float]:
    """dP/du."""
    if ARC <= kind <= POLYNOMIAL:
        return derivative(kind, p, u)
    return float(b[0]) - float(a[0]), float(b[1]) - float(a[1])


@kernel
def _share(p: Floats, x: float, y: float) -> float:
    """Where on an arc, 0..1, the direction of a point from the centre is; beyond 1 if it is off the arc."""
    turn = atan2(y - float(p[1]), x - float(p[0])) - float(p[3])
    sweep = float(p[4])
    if sweep < 0.0:
        turn = -turn
    slack = _SLACK / float(p[2])
    turn -= _TURN * floor((turn + slack) / _TURN)
    return max(turn, 0.0) / abs(sweep)


@kernel
def _keep(us: Floats, vs: Floats, count: int, u: float, v: float, slack_u: float, slack_v: float) -> int:
    """Adds a common point if it is on both segments."""
    if -slack_u <= u <= 1.0 + slack_u and -slack_v <= v <= 1.0 + slack_v and count < _SIZE:
        us[count] = min(max(u, 0.0), 1.0)
        vs[count] = min(max(v, 0.0), 1.0)
        return count + 1
    return count


@kernel
def _lines(
    ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> tuple[float, float]:
    """u and v of the common point of the lines a-b and c-d; 9, 9 if they are parallel."""
    ex = bx - ax
    ey = by - ay
    fx = dx - cx
    fy = dy - cy
    det = ex * fy - ey * fx
    if abs(det) <= 1e-12 * sqrt((ex * ex + ey * ey) * (fx * fx + fy * fy)):
        return 9.0, 9.0
    gx = cx - ax
    gy = cy - ay
    return (gx * fy - gy * fx) / det, (gx * ey - gy * ex) / det


@kernel
def _line_arc(a: Floats, b: Floats, p: Floats, us: Floats, vs: Floats, swap: bool) -> int:
    """Common points of a line and an arc."""
    ex = float(b[0]) - float(a[0])
    ey = float(b[1]) - float(a[1])
    size = sqrt(ex * ex + ey * ey)
    if size == 0.0:
        return 0
    gx = float(a[0]) - float(p[0])
    gy = float(a[1]) - float(p[1])
    along = -(gx * ex + gy * ey) / size
    off = (gx * ey - gy * ex) / size
    r = float(p[2])
    square = (r - off) * (r + off)
    if square < 0.0:
        if square < -4.0 * r * _SLACK:
            return 0
        square = 0.0
    root = sqrt(square)
    count = 0
    slack = _SLACK / size
    for i in range(2):
        u = (along - root) / size if i == 0 else (along + root) / size
        x = float(a[0]) + u * ex
        y = float(a[1]) + u * ey
        v = _share(p, x, y)
        arc_slack = _SLACK / (r * abs(float(p[4])))
        if swap:
            count = _keep(us, vs, count, v, u, arc_slack, slack)
        else:
            count = _keep(us, vs, count, u, v, slack, arc_slack)
        if root == 0.0:
            break
    return count


@kernel
def _arcs(p: Floats, q: Floats, us: Floats, vs: Floats) -> int:
    """Common points of two arcs of different circles."""
    dx = float(q[0]) - float(p[0])
    dy = float(q[1]) - float(p[1])
    d = sqrt(dx * dx + dy * dy)
    r = float(p[2])
    s = float(q[2])
    if d <= _SLACK or d > r + s + _SLACK or d < abs(r - s) - _SLACK:
        return 0
    cosine = min(max((d * d + (r - s) * (r + s)) / (2.0 * d * r), -1.0), 1.0)
    side = acos(cosine)
    base = atan2(dy, dx)
    count = 0
    for i in range(2):
        w = base - side if i == 0 else base + side
        x = float(p[0]) + r * np.cos(w)
        y = float(p[1]) + r * np.sin(w)
        u = _share(p, x, y)
        v = _share(q, x, y)
        count = _keep(us, vs, count, u, v, _SLACK / (r * abs(float(p[4]))), _SLACK / (s * abs(float(q[4]))))
        if side == 0.0:
            break
    return count


@kernel
def intersections(
    kind: int, p: Floats, a: Floats, b: Floats, other: int, q: Floats, c: Floats, d: Floats, us: Floats, vs: Floats
) -> int:  # fmt: skip
    """The common points of two segments (from a to b, and from c to d) in X-Y.

    us, vs: Shape (48,), out: curve parameters 0..1 on the first and the second;  returns their number.  Parts
    that run on each other count as having none.
    """
    straight = kind < ARC or kind > POLYNOMIAL
    other_straight = other < ARC or other > POLYNOMIAL
    if straight and other_straight:
        u, v = _lines(
            float(a[0]), float(a[1]), float(b[0]), float(b[1]), float(c[0]), float(c[1]), float(d[0]), float(d[1])
        )  # fmt: skip
        if u == 9.0:
            return 0
        one = sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]))
        two = sqrt((d[0] - c[0]) * (d[0] - c[0]) + (d[1] - c[1]) * (d[1] - c[1]))
        return _keep(us, vs, 0, u, v, _SLACK / one, _SLACK / two)
    if straight and other == ARC:
        return _line_arc(a, b, q, us, vs, False)
    if kind == ARC and other_straight:
        return _line_arc(c, d, p, us, vs, True)
    if kind == ARC and other == ARC:
        return _arcs(p, q, us, vs)
    count = 0
    m = 1 if straight else _CHORDS
    n = 1 if other_straight else _CHORDS
    x0, y0 = _at(kind, p, a, b, 0.0)
    for i in range(m):
        x1, y1 = _at(kind, p, a, b, (i + 1.0) / m)
        z0, w0 = _at(other, q, c, d, 0.0)
        for j in range(n):
            z1, w1 = _at(other, q, c, d, (j + 1.0) / n)
            u, v = _lines(x0, y0, x1, y1, z0, w0, z1, w1)
            if -0.3 <= u <= 1.3 and -0.3 <= v <= 1.3:
                u = (i + u) / m
                v = (j + v) / n
                good = False
                for _ in range(16):
                    u = min(max(u, -0.02), 1.02)
                    v = min(max(v, -0.02), 1.02)
                    px, py = _at(kind, p, a, b, u)
                    qx, qy = _at(other, q, c, d, v)
                    ex = qx - px
                    ey = qy - py
                    good = abs(ex) + abs(ey) <= _SLACK
                    if abs(ex) + abs(ey) <= 1e-13 + 2e-16 * (abs(px) + abs(py)):
                        break
                    sx, sy = _slope(kind, p, a, b, u)
                    tx, ty = _slope(other, q, c, d, v)
                    det = sx * ty - sy * tx
                    if det == 0.0:
                        break
                    u += (ex * ty - ey * tx) / det
                    v += (ex * sy - ey * sx) / det
                for k in range(count):
                    if abs(us[k] - u) < 1e-7 and abs(vs[k] - v) < 1e-7:
                        good = False
                if good:
                    count = _keep(us, vs, count, u, v, 1e-9, 1e-9)
            z0 = z1
            w0 = w1
        x0 = x1
        y0 = y1
    return count


@kernel
def _box(kind: int, p: Floats, a: Floats, b: Floats, box: Floats) -> None:
    """Fills box with x low, y low, x high, y high of a segment."""
    box[0] = min(float(a[0]), float(b[0])) - _SLACK
    box[1] = min(float(a[1]), float(b[1])) - _SLACK
    box[2] = max(float(a[0]), float(b[0])) + _SLACK
    box[3] = max(float(a[1]), float(b[1])) + _SLACK
    if kind < ARC or kind > POLYNOMIAL:
        return
    n = 16
    reach = 0.0
    x0, y0 = point(kind, p, 0.0)
    for i in range(n):
        x1, y1 = point(kind, p, (i + 1.0) / n)
        reach = max(reach, sqrt((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0)))
        box[0] = min(float(box[0]), x1)
        box[1] = min(float(box[1]), y1)
        box[2] = max(float(box[2]), x1)
        box[3] = max(float(box[3]), y1)
        x0 = x1
        y0 = y1
    # Between two places the curve leaves the box of both by less than half their distance.
    box[0] -= 0.5 * reach
    box[1] -= 0.5 * reach
    box[2] += 0.5 * reach
    box[3] += 0.5 * reach


@kernel
def box_tree(kinds: Kinds, rows: Floats, points: Floats, tree: Floats) -> int:
    """Fills the tree: f8 (2 m, 4), m the next power of two of n; node k holds the box of 2k and 2k + 1, leaf m + i
    that of segment i; returns m."""
    n = len(kinds)
    m = 1
    while m < n:
        m *= 2
    for k in range(2 * m):
        tree[k, 0] = 1e300
        tree[k, 1] = 1e300
        tree[k, 2] = -1e300
        tree[k, 3] = -1e300
    for i in range(n):
        _box(int(kinds[i]), rows[i], points[i], points[i + 1], tree[m + i])
    for k in range(m - 1, 0, -1):
        for c in range(2):
            tree[k, c] = min(float(tree[2 * k, c]), float(tree[2 * k + 1, c]))
            tree[k, 2 + c] = max(float(tree[2 * k, 2 + c]), float(tree[2 * k + 1, 2 + c]))
    return m


@kernel
def first_crossing(
    kinds: Kinds, rows: Floats, points: Floats, tree: Floats, m: int, i: int, after: float, joint: float, most: int,
    out: Floats,
) -> int:  # fmt: skip
    """The first point of segment i behind `after` (0..1) that a later segment shares; -1 if there is none.

    joint: [mm] points nearer than this to an end of both segments do not count (joints of the path);
    most: later segments looked at;  out: Shape (2,), u on i and v on the returned segment, the last of several.
    """
    us = np.zeros(_SIZE)
    vs = np.zeros(_SIZE)
    stack = np.zeros(64, np.int64)
    stack[0] = 1
    top = 1
    best = 2.0
    found = -1
    n = len(kinds)
    low = tree[m + i]
    while top > 0:
        top -= 1
        node = int(stack[top])
        if (
            tree[node, 0] > low[2] or tree[node, 2] < low[0] or tree[node, 1] > low[3] or tree[node, 3] < low[1]
        ):  # fmt: skip
            continue
        if node < m:
            span = 1
            first = node
            while first < m:
                first *= 2
                span *= 2
            if first - m + span - 1 > i and first - m <= i + most:
                stack[top] = 2 * node
                stack[top + 1] = 2 * node + 1
                top += 2
            continue
        j = node - m
        if j <= i or j >= n or j > i + most:
            continue
        count = intersections(
            int(kinds[i]), rows[i], points[i], points[i + 1], int(kinds[j]), rows[j], points[j], points[j + 1], us, vs
        )  # fmt: skip
        for k in range(count):
            u = float(us[k])
            v = float(vs[k])
            if u <= after:
                continue
            x, y = _at(int(kinds[i]), rows[i], points[i], points[i + 1], u)
            at_end = _near(points[i + 1], x, y, joint) or _near(points[i], x, y, joint)
            at_other = _near(points[j + 1], x, y, joint) or _near(points[j], x, y, joint)
            if at_end and at_other:
                continue
            if u < best - 1e-12 or (u <= best + 1e-12 and j > found):
                best = u
                found = j
                out[0] = u
                out[1] = v
    return found


@kernel
def _near(a: Floats, x: float, y: float, joint: float) -> bool:
    """Whether (x, y) is within `joint` of a point."""
    return abs(float(a[0]) - x) <= joint and abs(float(a[1]) - y) <= joint


@kernel
def _from_segment(kind: int, p: Floats, a: Floats, b: Floats, x: float, y: float) -> float:
    """Distance [mm] of (x, y) from a segment in X-Y; of an ellipse or cubic from its nearest place by search."""
    if kind == ARC:
        share = _share(p, x, y)
        if share <= 1.0:
            dx = x - float(p[0])
            dy = y - float(p[1])
            return abs(sqrt(dx * dx + dy * dy) - float(p[2]))
    elif kind == ELLIPSE or kind == POLYNOMIAL:
        best = 1e300
        at = 0.0
        for i in range(65):
            px, py = point(kind, p, i / 64.0)
            d = (px - x) * (px - x) + (py - y) * (py - y)
            if d < best:
                best = d
                at = i / 64.0
        width = 1.0 / 64.0
        while width > 1e-9:
            before = at
            for side in range(2):
                u = min(max(before + (width if side else -width), 0.0), 1.0)
                px, py = point(kind, p, u)
                d = (px - x) * (px - x) + (py - y) * (py - y)
                if d < best:
                    best = d
                    at = u
            if at == before:
                width *= 0.5
        return sqrt(best)
    else:
        ex = float(b[0]) - float(a[0])
        ey = float(b[1]) - float(a[1])
        size = ex * ex + ey * ey
        t = ((x - float(a[0])) * ex + (y - float(a[1])) * ey) / size if size > 0.0 else 0.0
        t = min(max(t, 0.0), 1.0)
        dx = x - float(a[0]) - t * ex
        dy = y - float(a[1]) - t * ey
        return sqrt(dx * dx + dy * dy)
    dx = min(
        (x - a[0]) * (x - a[0]) + (y - a[1]) * (y - a[1]), (x - b[0]) * (x - b[0]) + (y - b[1]) * (y - b[1])
    )
    return sqrt(dx)


@kernel
def distance_within(
    kinds: Kinds,
    rows: Floats,
    points: Floats,
    tree: Floats,
    m: int,
    sample: Floats,
    limit: float,
    out: Floats,
) -> None:
    """Distances [mm] of samples, Shape (s, 2), from the path, at most `limit`, into out, Shape (s,)."""
    stack = np.zeros(64, np.int64)
    n = len(kinds)
    for s in range(len(sample)):
        x = float(sample[s, 0])
        y = float(sample[s, 1])
        best = limit
        stack[0] = 1
        top = 1
        while top > 0:
            top -= 1
            node = int(stack[top])
            dx = max(float(tree[node, 0]) - x, 0.0, x - float(tree[node, 2]))
            dy = max(float(tree[node, 1]) - y, 0.0, y - float(tree[node, 3]))
            if dx * dx + dy * dy >= best * best:
                continue
            if node < m:
                stack[top] = 2 * node
                stack[top + 1] = 2 * node + 1
                top += 2
            elif node - m < n:
                i = node - m
                best = min(best, _from_segment(int(kinds[i]), rows[i], points[i], points[i + 1], x, y))
        out[s] = best
