"""Common points of two segments in X-Y.

    kind   LINE or positioning (straight), ARC, ELLIPSE, POLYNOMIAL;  p: its curve row, f8 (12,), unused if straight
    e      f8 (4,): x and y of its start, x and y of its end

Lines and arcs meet in closed form; with an ellipse or cubic they do where its distance from them is 0.  Two ellipses
or cubics are looked at as chains of chords; where chords meet, Newton on P(u) = Q(v) finds the point itself, so two
points very near each other may be missed.
"""

from math import acos, atan2, floor, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curve_points import ARC, POLYNOMIAL, Floats, derivative, point, tangent

__all__ = [
    "COMMON",
    "Kinds",
    "heading",
    "intersections",
    "own_crossing",
    "place",
    "plain_intersections",
    "plain_length",
    "share_of",
    "slope",
]

Kinds = npt.NDArray[np.uint8]

_TURN = 6.283185307179586
_CHORDS = 24
_GOLDEN = 0.6180339887498949
_SLACK = 1e-9  # [mm] by which a segment may be missed beyond its end
COMMON = 48
"""Common points of two segments at most."""


@kernel
def place(kind: int, p: Floats, e: Floats, u: float) -> tuple[float, float]:
    """The point at u."""
    if ARC <= kind <= POLYNOMIAL:
        return point(kind, p, u)
    return float(e[0]) + u * (float(e[2]) - float(e[0])), float(e[1]) + u * (float(e[3]) - float(e[1]))


@kernel
def slope(kind: int, p: Floats, e: Floats, u: float) -> tuple[float, float]:
    """dP/du."""
    if ARC <= kind <= POLYNOMIAL:
        return derivative(kind, p, u)
    return float(e[2]) - float(e[0]), float(e[3]) - float(e[1])


@kernel
def heading(kind: int, p: Floats, e: Floats, u: float) -> tuple[float, float]:
    """Unit tangent at u; (0, 0) if the segment is a point."""
    if ARC <= kind <= POLYNOMIAL:
        return tangent(kind, p, u)
    dx = float(e[2]) - float(e[0])
    dy = float(e[3]) - float(e[1])
    size = sqrt(dx * dx + dy * dy)
    if size == 0.0:
        return 0.0, 0.0
    return dx / size, dy / size


@kernel
def plain_length(kind: int, p: Floats, e: Floats) -> float:
    """Length [mm] of a line or arc; 0 of others."""
    if kind == ARC:
        return float(p[2]) * abs(float(p[4]))
    if ARC < kind <= POLYNOMIAL:
        return 0.0
    dx = float(e[2]) - float(e[0])
    dy = float(e[3]) - float(e[1])
    return sqrt(dx * dx + dy * dy)


@kernel
def share_of(p: Floats, x: float, y: float) -> float:
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
    if -slack_u <= u <= 1.0 + slack_u and -slack_v <= v <= 1.0 + slack_v and count < COMMON:
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
def _line_arc(e: Floats, p: Floats, us: Floats, vs: Floats, swap: bool) -> int:
    """Common points of a line and an arc."""
    ex = float(e[2]) - float(e[0])
    ey = float(e[3]) - float(e[1])
    size = sqrt(ex * ex + ey * ey)
    if size == 0.0:
        return 0
    gx = float(e[0]) - float(p[0])
    gy = float(e[1]) - float(p[1])
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
        x = float(e[0]) + u * ex
        y = float(e[1]) + u * ey
        v = share_of(p, x, y)
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
        u = share_of(p, x, y)
        v = share_of(q, x, y)
        count = _keep(us, vs, count, u, v, _SLACK / (r * abs(float(p[4]))), _SLACK / (s * abs(float(q[4]))))
        if side == 0.0:
            break
    return count


@kernel
def plain_intersections(
    kind: int, p: Floats, e: Floats, other: int, q: Floats, f: Floats, us: Floats, vs: Floats
) -> int:  # fmt: skip
    """`intersections` of lines and arcs only: what uses nothing else need not compile the rest."""
    straight = kind < ARC or kind > POLYNOMIAL
    other_straight = other < ARC or other > POLYNOMIAL
    if straight and other_straight:
        u, v = _lines(
            float(e[0]), float(e[1]), float(e[2]), float(e[3]), float(f[0]), float(f[1]), float(f[2]), float(f[3])
        )  # fmt: skip
        if u == 9.0:
            return 0
        one = sqrt((e[2] - e[0]) * (e[2] - e[0]) + (e[3] - e[1]) * (e[3] - e[1]))
        two = sqrt((f[2] - f[0]) * (f[2] - f[0]) + (f[3] - f[1]) * (f[3] - f[1]))
        return _keep(us, vs, 0, u, v, _SLACK / one, _SLACK / two)
    if straight and other == ARC:
        return _line_arc(e, q, us, vs, False)
    if kind == ARC and other_straight:
        return _line_arc(f, p, us, vs, True)
    return _arcs(p, q, us, vs)


@kernel
def _off(kind: int, p: Floats, e: Floats, other: int, q: Floats, v: float) -> float:
    """Distance [mm] of a place on an ellipse or cubic from a line (+: left of it) or a circle (+: outside)."""
    x, y = point(other, q, v)
    if kind == ARC:
        dx = x - float(p[0])
        dy = y - float(p[1])
        return sqrt(dx * dx + dy * dy) - float(p[2])
    ex = float(e[2]) - float(e[0])
    ey = float(e[3]) - float(e[1])
    return ((y - float(e[1])) * ex - (x - float(e[0])) * ey) / sqrt(ex * ex + ey * ey)


@kernel
def _root(kind: int, p: Floats, e: Floats, other: int, q: Floats, low: float, high: float) -> float:
    """Where between low and high `_off` changes its sign, by bisection."""
    at_low = _off(kind, p, e, other, q, low)
    for _ in range(60):
        middle = 0.5 * (low + high)
        if middle <= low or middle >= high:
            break
        if (_off(kind, p, e, other, q, middle) > 0.0) == (at_low > 0.0):
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@kernel
def _flattest(kind: int, p: Floats, e: Floats, other: int, q: Floats, low: float, high: float) -> float:
    """Where between low and high a curve comes nearest to a line or circle, by golden section."""
    for _ in range(45):
        a = high - _GOLDEN * (high - low)
        b = low + _GOLDEN * (high - low)
        if abs(_off(kind, p, e, other, q, a)) < abs(_off(kind, p, e, other, q, b)):
            high = b
        else:
            low = a
    return 0.5 * (low + high)


@kernel
def _add_free(
    kind: int, p: Floats, e: Floats, other: int, q: Floats, v: float, us: Floats, vs: Floats, count: int, swap: bool
) -> int:  # fmt: skip
    """Adds the place v of an ellipse or cubic if it is on the line or arc, and new."""
    x, y = point(other, q, v)
    if kind == ARC:
        u = share_of(p, x, y)
        slack = _SLACK / (float(p[2]) * abs(float(p[4])))
    else:
        ex = float(e[2]) - float(e[0])
        ey = float(e[3]) - float(e[1])
        size = ex * ex + ey * ey
        u = ((x - float(e[0])) * ex + (y - float(e[1])) * ey) / size
        slack = _SLACK / sqrt(size)
    for k in range(count):
        if abs((us[k] if swap else vs[k]) - v) < 1e-7:
            return count
    if swap:
        return _keep(us, vs, count, v, u, 0.0, slack)
    return _keep(us, vs, count, u, v, slack, 0.0)


@kernel
def _with_free(
    kind: int, p: Floats, e: Floats, other: int, q: Floats, us: Floats, vs: Floats, swap: bool
) -> int:  # fmt: skip
    """Common points of a line or arc with an ellipse or cubic: where its distance from them is 0.

    The distance is looked at in _CHORDS steps; where it comes near to 0 and turns back, its least value is sought,
    for there may be two common points, or one where they touch.
    """
    if kind != ARC and e[0] == e[2] and e[1] == e[3]:
        return 0
    count = 0
    before = _off(kind, p, e, other, q, 0.0)
    here = before
    if abs(before) <= _SLACK:
        count = _add_free(kind, p, e, other, q, 0.0, us, vs, count, swap)
    for i in range(1, _CHORDS + 1):
        v = i / _CHORDS
        last = v - 1.0 / _CHORDS
        after = _off(kind, p, e, other, q, v)
        if (after > 0.0) != (here > 0.0):
            count = _add_free(kind, p, e, other, q, _root(kind, p, e, other, q, last, v), us, vs, count, swap)
        if i == _CHORDS and abs(after) <= _SLACK:
            count = _add_free(kind, p, e, other, q, 1.0, us, vs, count, swap)
        is_same = (after > 0.0) == (here > 0.0) and (before > 0.0) == (here > 0.0)
        if is_same and abs(here) <= abs(before) and abs(here) <= abs(after):
            low = max(last - 1.0 / _CHORDS, 0.0)
            flat = _flattest(kind, p, e, other, q, low, v)
            least = _off(kind, p, e, other, q, flat)
            if (least > 0.0) != (here > 0.0):
                count = _add_free(
                    kind, p, e, other, q, _root(kind, p, e, other, q, low, flat), us, vs, count, swap
                )
                count = _add_free(
                    kind, p, e, other, q, _root(kind, p, e, other, q, flat, v), us, vs, count, swap
                )
            elif abs(least) <= _SLACK:
                count = _add_free(kind, p, e, other, q, flat, us, vs, count, swap)
        before = here
        here = after
    return count


@kernel
def intersections(
    kind: int, p: Floats, e: Floats, other: int, q: Floats, f: Floats, us: Floats, vs: Floats
) -> int:  # fmt: skip
    """The common points of two segments, e and f their ends.

    us, vs: Shape (COMMON,), out: curve parameters 0..1 on the first and the second;  returns their number.  Parts
    that run on each other count as having none.
    """
    straight = kind < ARC or kind > POLYNOMIAL
    other_straight = other < ARC or other > POLYNOMIAL
    if (straight or kind == ARC) and (other_straight or other == ARC):
        return plain_intersections(kind, p, e, other, q, f, us, vs)
    if straight or kind == ARC:
        return _with_free(kind, p, e, other, q, us, vs, False)
    if other_straight or other == ARC:
        return _with_free(other, q, f, kind, p, us, vs, True)
    count = 0
    m = n = _CHORDS
    x0, y0 = place(kind, p, e, 0.0)
    for i in range(m):
        x1, y1 = place(kind, p, e, (i + 1.0) / m)
        z0, w0 = place(other, q, f, 0.0)
        for j in range(n):
            z1, w1 = place(other, q, f, (j + 1.0) / n)
            u, v = _lines(x0, y0, x1, y1, z0, w0, z1, w1)
            if -0.3 <= u <= 1.3 and -0.3 <= v <= 1.3:
                u = (i + u) / m
                v = (j + v) / n
                good = False
                for _ in range(16):
                    u = min(max(u, -0.02), 1.02)
                    v = min(max(v, -0.02), 1.02)
                    px, py = place(kind, p, e, u)
                    qx, qy = place(other, q, f, v)
                    gx = qx - px
                    gy = qy - py
                    good = abs(gx) + abs(gy) <= _SLACK
                    if abs(gx) + abs(gy) <= 1e-13 + 2e-16 * (abs(px) + abs(py)):
                        break
                    sx, sy = slope(kind, p, e, u)
                    tx, ty = slope(other, q, f, v)
                    det = sx * ty - sy * tx
                    if det == 0.0:
                        break
                    u += (gx * ty - gy * tx) / det
                    v += (gx * sy - gy * sx) / det
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
def own_crossing(p: Floats, us: Floats) -> bool:
    """Whether a cubic crosses itself in X-Y; us: Shape (>= 2,), out: its two parameters there, ascending.

    P(s) = P(t), s <> t:  c1 + c2 (s + t) + c3 (s² + s t + t²) = 0 in x and in y.  With m = s + t and k = s t the
    cross product with c3 gives m, and then either equation m² - k.
    """
    x1, x2, x3 = float(p[1]), float(p[2]), float(p[3])
    y1, y2, y3 = float(p[5]), float(p[6]), float(p[7])
    across = x2 * y3 - y2 * x3
    cube = x3 * x3 + y3 * y3
    if across == 0.0 or cube == 0.0:
        return False
    m = -(x1 * y3 - y1 * x3) / across
    k = m * m + ((x1 + m * x2) * x3 + (y1 + m * y2) * y3) / cube
    square = m * m - 4.0 * k
    if square <= 0.0:
        return False
    us[0] = 0.5 * (m - sqrt(square))
    us[1] = 0.5 * (m + sqrt(square))
    return bool(us[0] >= 0.0 and us[1] <= 1.0 and us[1] - us[0] > 1e-9)
