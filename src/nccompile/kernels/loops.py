"""The walk along a path that leaves out its loops: where it crosses itself, it goes on behind the crossing.

    b0        Branch 1 comes along a0 and leaves along a1; branch 2, later on the path, comes along b0 and leaves
     |        along b1.  They cross at a common point if branch 2 comes from one side of branch 1 and leaves to
a0 --x-- a1   the other.  Where both run on each other for a while, the sides before and behind that stretch
     |        count.  Touching is no crossing, nor is a contour that closes in the direction in which it began.
    b1

Segments are columns as in `kernels.boxes`; they follow each other in X-Y (rows that stand there are left out).
Rays are compared by their direction and, where that is the same, by their curvature.
"""

from math import atan2, sqrt

import numpy as np

from nccompile.kernels import kernel
from nccompile.kernels.boxes import Kinds, Rows, next_leaf
from nccompile.kernels.curve_parts import way_share
from nccompile.kernels.curve_points import ARC, POLYNOMIAL, Floats, derivative, second, tangent
from nccompile.kernels.intersect import COMMON, intersections, own_crossing, place, plain_length

__all__ = ["intervals", "without_loops"]

_JOINT = 1e-7  # [mm] a common point this near to the end of a row is that end
_LEVEL = 1e-6  # [mm] greatest difference in height at a crossing
_BEHIND = 1e-9  # share of a row by which the next crossing lies behind the last one
_PARALLEL = 1e-7  # [rad] directions nearer than this are one
_SMOOTH = 1e-3  # [rad] a loop that comes back in the direction in which it left is a closed contour
_BENT = 1e-7  # [1/mm] curvatures nearer than this are one
_TINY = 1e-12  # [rad] stands for a difference in curvature
_MOST = 4096  # places at which one segment is cut
_TURN = 6.283185307179586


@kernel
def _forward(kind: int, p: Floats, e: Floats, u: float) -> tuple[float, float]:
    """(direction [rad], curvature [1/mm, + bends to the left]) of a segment at u."""
    if kind < ARC or kind > POLYNOMIAL:
        return atan2(float(e[3]) - float(e[1]), float(e[2]) - float(e[0])), 0.0
    tx, ty = tangent(kind, p, u)
    if kind == ARC:
        return atan2(ty, tx), (1.0 if p[4] > 0.0 else -1.0) / float(p[2])
    dx, dy = derivative(kind, p, u)
    sx, sy = second(kind, p, u)
    speed = sqrt(dx * dx + dy * dy)
    bend = (tx * sy - ty * sx) / (speed * speed) if speed > 0.0 else 0.0
    return atan2(ty, tx), bend


@kernel
def _between(q: float, q_bend: float, r: float, r_bend: float) -> float:
    """The angle [rad], 0 .. 2 pi, counter-clockwise from ray q to ray r; 0 if they are one."""
    turn = r - q
    while turn < 0.0:
        turn += _TURN
    while turn >= _TURN:
        turn -= _TURN
    if turn <= _PARALLEL or turn >= _TURN - _PARALLEL:
        if abs(r_bend - q_bend) <= _BENT * (1.0 + abs(q_bend)):
            return 0.0
        return _TINY if r_bend > q_bend else _TURN - _TINY
    return turn


@kernel
def _side(a0: float, k0: float, a1: float, k1: float, r: float, k: float) -> int:
    """On which side of a branch a ray is: 1 left, -1 right, 2 it is where the branch leaves, -2 where it came from.

    a0, k0: ray from the point back to where the branch came from;  a1, k1: where it leaves;  r, k: the ray.
    """
    whole = _between(a1, k1, a0, k0)
    turn = _between(a1, k1, r, k)
    if turn == 0.0:
        return 2
    if _between(a0, k0, r, k) == 0.0:
        return -2
    return 1 if turn < whole else -1


@kernel
def _rays(
    kinds: Kinds, curve: Rows, table: Floats, ends: Floats, run: Rows, i: int, u: float, out: Floats
) -> bool:  # fmt: skip
    """The rays of the path at u of segment i into out: back (direction, curvature), on (direction, curvature).

    Near an end the neighbour has one of them; False where the path begins or ends there.
    """
    before = i
    after = i
    u0 = u
    u1 = u
    x, y = place(int(kinds[i]), table[max(int(curve[i]), 0)], ends[i], u)
    if _near(float(ends[i, 2]), float(ends[i, 3]), x, y) and u > 0.5:
        after = i + 1
        u0 = 1.0
        u1 = 0.0
    elif _near(float(ends[i, 0]), float(ends[i, 1]), x, y) and u < 0.5:
        before = i - 1
        u0 = 1.0
        u1 = 0.0
    if before < 0 or after >= len(kinds) or run[before] != run[after]:
        return False
    angle, bend = _forward(int(kinds[before]), table[max(int(curve[before]), 0)], ends[before], u0)
    out[0] = angle + 0.5 * _TURN
    out[1] = -bend
    angle, bend = _forward(int(kinds[after]), table[max(int(curve[after]), 0)], ends[after], u1)
    out[2] = angle
    out[3] = bend
    return True


@kernel
def _near(ax: float, ay: float, x: float, y: float) -> bool:
    """Whether two points are one joint."""
    return abs(ax - x) <= _JOINT and abs(ay - y) <= _JOINT


@kernel
def _parting(
    kinds: Kinds, curve: Rows, table: Floats, ends: Floats, run: Rows, i: int, u: float, j: int, v: float, on: bool,
    rays: Floats, other: Floats,
) -> int:  # fmt: skip
    """On which side of branch 1 branch 2 is where they part, both followed from a common point: 1, -1, 0 unknown.

    i, u: on branch 1, followed in its direction;  j, v: on branch 2, followed in its direction if `on`.
    """
    n = len(kinds)
    for _ in range(2 * n):
        if not 0 <= i < n or not 0 <= j < n or run[i] != run[j] or (i >= j and not on):
            return 0
        one = plain_length(int(kinds[i]), table[max(int(curve[i]), 0)], ends[i])
        two = plain_length(int(kinds[j]), table[max(int(curve[j]), 0)], ends[j])
        if one == 0.0 or two == 0.0:
            return 0  # ellipses and cubics are not followed
        step = min(one * (1.0 - u), two * (1.0 - v if on else v))
        u += step / one
        v += step / two if on else -step / two
        u = 1.0 if one * (1.0 - u) <= _JOINT else u
        if not _rays(kinds, curve, table, ends, run, i, u, rays):
            return 0
        v = 1.0 if two * (1.0 - v) <= _JOINT else (0.0 if two * v <= _JOINT else v)
        if not _rays(kinds, curve, table, ends, run, j, v, other):
            return 0
        at = 2 if on else 0
        side = _side(
            float(rays[0]), float(rays[1]), float(rays[2]), float(rays[3]), float(other[at]), float(other[at + 1])
        )  # fmt: skip
        if abs(side) == 1:
            return side
        if side == -2:
            return 0
        if u == 1.0:
            i += 1
            u = 0.0
        if on and v == 1.0:
            j += 1
            v = 0.0
        elif not on and v == 0.0:
            j -= 1
            v = 1.0
    return 0


@kernel
def _crosses(
    kinds: Kinds, curve: Rows, table: Floats, ends: Floats, run: Rows, i: int, u: float, j: int, v: float,
    rays: Floats, other: Floats,
) -> bool:  # fmt: skip
    """Whether the path at v of j passes through the path at u of i, which have that point in common."""
    if not _rays(kinds, curve, table, ends, run, i, u, rays) or not _rays(
        kinds, curve, table, ends, run, j, v, other
    ):
        return False
    a0, k0, a1, k1 = float(rays[0]), float(rays[1]), float(rays[2]), float(rays[3])
    b0, m0, b1, m1 = float(other[0]), float(other[1]), float(other[2]), float(other[3])
    loop = abs(_between(a1, 0.0, b0 + 0.5 * _TURN, 0.0))
    if min(loop, _TURN - loop) <= _SMOOTH:
        return False
    comes = _side(a0, k0, a1, k1, b0, m0)
    leaves = _side(a0, k0, a1, k1, b1, m1)
    if abs(comes) == 1 and leaves == 2:
        leaves = _parting(kinds, curve, table, ends, run, i, u, j, v, True, rays, other)
    elif comes == 2 and abs(leaves) == 1:
        comes = _parting(kinds, curve, table, ends, run, i, u, j, v, False, rays, other)
    return comes * leaves == -1


@kernel
def _height(kind: int, p: Floats, heights: Floats, u: float) -> float:
    """The height [mm] of a segment at u; heights: Shape (2,), at its ends."""
    rise = float(heights[1]) - float(heights[0])
    return float(heights[0]) if rise == 0.0 else float(heights[0]) + way_share(kind, p, u) * rise


@kernel
def _first_crossing(
    kinds: Kinds, curve: Rows, table: Floats, ends: Floats, run: Rows, heights: Floats, tree: Floats, i: int,
    after: float, most: int, us: Floats, vs: Floats, rays: Floats, other: Floats, stack: Rows, out: Floats,
) -> int:  # fmt: skip
    """The first crossing of segment i behind `after` (0..1) with a later segment; -1 if there is none.

    most: later segments looked at;  out: Shape (2,), u on i and v on the returned segment, the last of several;
    us, vs, rays, other, stack: room to work in.
    """
    n = len(kinds)
    m = len(tree) // 2
    best = 2.0
    found = -1
    row = table[max(int(curve[i]), 0)]
    if kinds[i] == POLYNOMIAL and own_crossing(row, us) and us[0] > after:
        rise = _height(POLYNOMIAL, row, heights[i], float(us[1]))
        rise -= _height(POLYNOMIAL, row, heights[i], float(us[0]))
        if abs(rise) <= _LEVEL:
            best = float(us[0])
            found = i
            out[0] = us[0]
            out[1] = us[1]
    last = min(i + most + 1, n)
    stack[0] = 1
    top = 1
    while True:
        j, top = next_leaf(tree, tree[m + i], stack, top, i + 1, last)
        if j < 0:
            break
        if run[j] != run[i]:
            continue
        count = intersections(
            int(kinds[i]), row, ends[i], int(kinds[j]), table[max(int(curve[j]), 0)], ends[j], us, vs
        )  # fmt: skip
        for k in range(count):
            u = float(us[k])
            v = float(vs[k])
            if u <= after or u > best + 1e-12 or (u >= best - 1e-12 and j < found):
                continue
            x, y = place(int(kinds[i]), row, ends[i], u)
            if j == i + 1 and u > 0.5 and _near(float(ends[i, 2]), float(ends[i, 3]), x, y):
                continue
            one = _height(int(kinds[i]), row, heights[i], u)
            two = _height(int(kinds[j]), table[max(int(curve[j]), 0)], heights[j], v)
            if abs(one - two) <= _LEVEL and _crosses(kinds, curve, table, ends, run, i, u, j, v, rays, other):
                best = u
                found = j
                out[0] = u
                out[1] = v
    return found


@kernel
def without_loops(
    kinds: Kinds, curve: Rows, table: Floats, ends: Floats, run: Rows, heights: Floats, tree: Floats, most: int,
    rows: Rows, parts: Floats,
) -> int:  # fmt: skip
    """The parts of a path that are left when its loops are cut out, in order.

    Args:     run: Shape (n,), segments of one value follow each other and do not meet others;  heights: Shape (n, 2),
              third axis at the ends of each segment;  tree: their boxes;  most: segments of a loop;  rows: Shape
              (2 n,) and parts: Shape (2 n, 2), out: segment, and u at its start and end.
    Returns:  their number.  A loop was cut behind each part that ends where the next one does not begin.
    """
    n = len(kinds)
    us = np.zeros(COMMON)
    vs = np.zeros(COMMON)
    rays = np.zeros(4)
    other = np.zeros(4)
    stack = np.zeros(128, np.int64)
    out = np.zeros(2)
    count = 0
    i = 0
    u = 0.0
    while i < n:
        j = _first_crossing(
            kinds, curve, table, ends, run, heights, tree, i, u + _BEHIND, most, us, vs, rays, other, stack, out
        )  # fmt: skip
        rows[count] = i
        parts[count, 0] = u
        parts[count, 1] = 1.0 if j < 0 else out[0]
        count += 1
        if j < 0:
            i += 1
            u = 0.0
        else:
            i = j
            u = float(out[1])
            if u >= 1.0:
                rows[count] = i
                parts[count, 0] = 1.0
                parts[count, 1] = 1.0
                count += 1
                i += 1
                u = 0.0
    return count


@kernel
def intervals(
    kinds: Kinds, curve: Rows, table: Floats, ends: Floats, tree: Floats, owner: Rows, parts: Floats, middle: Floats
) -> int:  # fmt: skip
    """Segments cut wherever they meet another one, in order.

    owner: Shape (k,), parts: Shape (k, 2) and middle: Shape (k, 4), out: segment, u at start and end, and its middle
    as the ends of a segment.  Returns:  their number, more than there is room if that does not do.
    """
    n = len(kinds)
    m = len(tree) // 2
    us = np.zeros(COMMON)
    vs = np.zeros(COMMON)
    stack = np.zeros(128, np.int64)
    cuts = np.zeros(_MOST)
    count = 0
    for i in range(n):
        row = table[max(int(curve[i]), 0)]
        stack[0] = 1
        top = 1
        cut = 0
        while True:
            j, top = next_leaf(tree, tree[m + i], stack, top, 0, n)
            if j < 0:
                break
            if j == i:
                continue
            found = intersections(
                int(kinds[i]), row, ends[i], int(kinds[j]), table[max(int(curve[j]), 0)], ends[j], us, vs
            )  # fmt: skip
            for k in range(found):
                if cut < _MOST - 1:
                    cuts[cut] = us[k]
                    cut += 1
        cuts[cut] = 1.0
        cuts[:cut].sort()
        before = 0.0
        for k in range(cut + 1):
            u = float(cuts[k])
            if u - before <= _BEHIND:
                continue
            if count < len(owner):
                x, y = place(int(kinds[i]), row, ends[i], 0.5 * (before + u))
                owner[count] = i
                parts[count, 0] = before
                parts[count, 1] = u
                middle[count, 0] = x
                middle[count, 1] = y
                middle[count, 2] = x
                middle[count, 3] = y
            count += 1
            before = u
    return count
