"""Time-optimal velocities along a given path by reachability analysis (Pham and Pham 2018, TOPP-RA).

The path is cut into intervals of length D with constant path acceleration u; with x = v², x_next = x + 2 D u.
Axis a is inside its limit where |q' u + q'' x| <= A, asked at both ends of an interval:

    backward   K_i = greatest x_i from which some u leads into 0..K_i+1       (a linear program in u and x)
    forward    x_i+1 = the greatest that some u reaches from x_i, at most K_i+1

Every x between 0 and K is controllable, because the limits hold 0: scaling x and u by s < 1 scales what the
axes feel.  So a profile below x can be braked and accelerated again; `slack` says by how much at full x.
Straight intervals have q'' = 0 and one bound U on |u|.
"""

from __future__ import annotations

from math import acos, ceil, inf, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curves import derivative3, second3, tabulate

__all__ = ["INTERVALS", "SHORT", "backward", "forward", "grid", "ramps"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
Kinds = npt.NDArray[np.uint8]

INTERVALS = 512
"""Greatest number of intervals of one curve."""

_ARC, _SET_POSITION, _SPACE = 2, 5, 3
_CONSTRAINTS = 20
SHORT = 1e-9  # curves below this length [mm] are taken as straight
_PIECES = 8  # a curve that is no arc starts with so many equal pieces
_LEAST = 1.0 / 4096.0  # of the parameter: pieces are not halved below this (a cusp)
_FLOOR = 1e-3  # share of U that a row always has to accelerate or brake with, so that nothing can get stuck


@kernel
def _slopes(kind: int, plane: int, p: Floats, u: float, share: float, d1: Floats, d2: Floats) -> None:
    """Writes q' and q'' of X, Y, Z (3,) at the parameter u; the axis across the plane is left at 0.

    share: in-plane length over path length.
    """
    x, y, z = derivative3(kind, p, u)
    x2, y2, z2 = second3(kind, p, u)
    size2 = x * x + y * y + z * z
    d1[:] = 0.0
    d2[:] = 0.0
    if size2 == 0.0:
        return
    size = sqrt(size2)
    along = (x * x2 + y * y2 + z * z2) / size2
    bend = share * share / size2
    if plane == _SPACE:
        d1[0], d1[1], d1[2] = x / size, y / size, z / size
        d2[0], d2[1], d2[2] = (x2 - along * x) * bend, (y2 - along * y) * bend, (z2 - along * z) * bend
        return
    first, second = 0, 1
    if plane == 1:
        first, second = 2, 0
    elif plane == 2:
        first, second = 1, 2
    d1[first] = share * x / size
    d1[second] = share * y / size
    d2[first] = (x2 - along * x) * bend
    d2[second] = (y2 - along * y) * bend


@kernel
def _turn(kind: int, p: Floats, u0: float, u1: float) -> float:
    """Angle between the tangents at two parameters [rad]."""
    x, y, z = derivative3(kind, p, u0)
    x2, y2, z2 = derivative3(kind, p, u1)
    size = sqrt((x * x + y * y + z * z) * (x2 * x2 + y2 * y2 + z2 * z2))
    if size == 0.0:
        return inf
    return acos(min(max((x * x2 + y * y2 + z * z2) / size, -1.0), 1.0))


@kernel
def _cuts(kind: int, p: Floats, turn: float, cuts: Floats) -> int:
    """Fills ascending parameters 0 .. 1 between which the curve turns by at most `turn`; returns intervals."""
    if kind == _ARC:
        count = min(max(ceil(abs(float(p[4])) / turn - 1e-9), 2), INTERVALS)
        for i in range(count + 1):
            cuts[i] = i / count
        return count
    count = 0
    a = 0.0
    step = 1.0 / _PIECES
    while a < 1.0:
        b = min(a + step, 1.0)
        bend = max(_turn(kind, p, a, b), 2.0 * _turn(kind, p, a, 0.5 * (a + b)))
        if bend > turn and step > _LEAST and count < INTERVALS - 2 * _PIECES:
            step *= 0.5
            continue
        cuts[count] = a
        count += 1
        a = b
        if bend < 0.4 * turn and step < 1.0 / _PIECES:
            step *= 2.0
    cuts[count] = 1.0
    return count


@kernel
def _length(kind: int, p: Floats, u0: float, u1: float) -> float:
    """Length of a short piece by Simpson's rule on four intervals."""
    total = 0.0
    for i in range(5):
        x, y, z = derivative3(kind, p, u0 + 0.25 * i * (u1 - u0))
        weight = 1.0 if i == 0 or i == 4 else (2.0 if i == 2 else 4.0)
        total += weight * sqrt(x * x + y * y + z * z)
    return total * (u1 - u0) / 12.0


@kernel
def grid(
    kind: Kinds, curve: Ints, plane: Kinds, parameters: Floats, length: Floats, solid: Kinds, turn: float,
    nodes_u: Floats, nodes_s: Floats, row: Ints, p0: Floats, p1: Floats, d1: Floats, d2: Floats,
) -> int:  # fmt: skip
    """Intervals of the rows: one of a straight or solid row, of curves as many as they turn.

    Writes row (m,), p0, p1 (m,) shares of the row's length, d1, d2 (m, 2, 3): q' and q'' of X, Y, Z at both
    ends, 0 where the interval is straight.  Returns m; room is needed for INTERVALS a curve.
    """
    count = 0
    cuts = np.empty(INTERVALS + 1)
    for j in range(len(kind)):
        c = int(curve[j])
        if c < 0 or length[j] <= SHORT or solid[j] == 1:
            row[count] = j
            p0[count] = 0.0
            p1[count] = 1.0
            d1[count, :, :] = 0.0
            d2[count, :, :] = 0.0
            count += 1
            continue
        p = parameters[c]
        shape = int(kind[j])
        pieces = _cuts(shape, p, turn, cuts)
        nodes = tabulate(shape, p, nodes_u, nodes_s)
        whole = nodes_s[nodes - 1]
        share = min(whole / length[j], 1.0)
        total = 0.0
        first = count
        for i in range(pieces):
            row[count] = j
            p0[count] = total
            total += _length(shape, p, cuts[i], cuts[i + 1])
            p1[count] = total
            _slopes(shape, int(plane[c]), p, cuts[i], share, d1[count, 0], d2[count, 0])
            _slopes(shape, int(plane[c]), p, cuts[i + 1], share, d1[count, 1], d2[count, 1])
            count += 1
        for i in range(first, count):
            p0[i] /= total
            p1[i] /= total
        p0[first] = 0.0
        p1[count - 1] = 1.0
    return count


@kernel
def _along(lines: Floats, number: int, k: int) -> tuple[float, float, int]:
    """(x, u) with the greatest x on the boundary of constraint k inside the constraints before it."""
    a, b, c = lines[k, 0], lines[k, 1], lines[k, 2]
    norm = a * a + b * b
    if norm == 0.0:
        return 0.0, 0.0, 0
    u0, x0 = a * c / norm, b * c / norm
    du, dx = -b, a
    low, high = -inf, inf
    for i in range(number):
        if i == k:
            continue
        slope = lines[i, 0] * du + lines[i, 1] * dx
        room = lines[i, 2] - lines[i, 0] * u0 - lines[i, 1] * x0
        if abs(slope) <= 1e-14 * (abs(lines[i, 0]) + abs(lines[i, 1])) * sqrt(norm):
            if room < -1e-9 * abs(lines[i, 2]):
                return 0.0, 0.0, 0
            continue
        if slope > 0.0:
            high = min(high, room / slope)
        else:
            low = max(low, room / slope)
    t = high if dx > 0.0 else low
    if dx == 0.0:
        t = min(max(0.0, low), high)
    if low > high:
        t = 0.5 * (low + high)
    return x0 + t * dx, u0 + t * du, 1


@kernel
def _fill(d1: Floats, d2: Floats, length: float, bound: float, a_axis: Floats, lines: Floats) -> int:
    """Constraints a u + b x <= c of an interval: axes at both ends, |u| <= bound."""
    number = 0
    for a in range(3):
        for end in range(2):
            slope = d1[end, a]
            bend = d2[end, a]
            if end == 1:
                slope += 2.0 * length * bend
            if (slope != 0.0 or bend != 0.0) and a_axis[a] < inf:
                lines[number, 0], lines[number, 1], lines[number, 2] = slope, bend, a_axis[a]
                lines[number + 1, 0], lines[number + 1, 1], lines[number + 1, 2] = -slope, -bend, a_axis[a]
                number += 2
    if bound < inf:
        lines[number, 0], lines[number, 1], lines[number, 2] = 1.0, 0.0, bound
        lines[number + 1, 0], lines[number + 1, 1], lines[number + 1, 2] = -1.0, 0.0, bound
        number += 2
    return number


@kernel
def _controllable(
    d1: Floats,
    d2: Floats,
    length: float,
    bound: float,
    a_axis: Floats,
    cap: float,
    after: float,
    lines: Floats,
) -> tuple[float, int]:
    """(greatest x at the start of an interval, whether what follows has no say in it).

    Linear program in two variables, constraints taken in one by one: one that cuts off the optimum so far has
    the new optimum on its boundary.
    """
    lines[0, 0], lines[0, 1], lines[0, 2] = 0.0, 1.0, cap
    lines[1, 0], lines[1, 1], lines[1, 2] = -2.0 * length, -1.0, 0.0
    number = 2 + _fill(d1, d2, length, bound, a_axis, lines[2:])
    lines[number, 0], lines[number, 1], lines[number, 2] = 2.0 * length, 1.0, after
    x, u = cap, -cap / (2.0 * length)
    free = 1
    for k in range(2, number + 1):
        if lines[k, 0] * u + lines[k, 1] * x > lines[k, 2] * (1.0 + 1e-12) + 1e-12:
            x, u, found = _along(lines, k, k)
            if found == 0:
                return 0.0, 0
            if k == number:
                free = 0
    return min(max(x, 0.0), cap), free


@kernel
def backward(
    d1: Floats, d2: Floats, length: Floats, bound: Floats, a_axis: Floats, cap: Floats, known: int, complete: int,
    reach: Floats,
) -> int:  # fmt: skip
    """Writes reach (m,): the greatest x at the end of each interval from which the rest can be run.

    length, bound (m,): D and U of the intervals; cap (m,): greatest x at their ends; after the last one the
    path is at rest.  Returns the number of leading intervals that nothing after the `known` ones can change.
    """
    m = len(length)
    lines = np.empty((_CONSTRAINTS, 3))
    settled = m if complete == 1 else 0
    after = 0.0
    for i in range(m - 1, -1, -1):
        reach[i] = min(cap[i], after)
        if settled == 0 and cap[i] <= after and i < known:
            settled = i + 1
        if i == 0:
            break
        top = cap[i - 1]
        after = reach[i]
        if length[i] > 0.0:
            if d1[i, 0, 0] == 0.0 and d1[i, 0, 1] == 0.0 and d1[i, 0, 2] == 0.0:
                after = reach[i] + 2.0 * bound[i] * length[i]
            elif top > 0.0:
                after, free = _controllable(d1[i], d2[i], length[i], bound[i], a_axis, top, reach[i], lines)
                if free == 1:
                    cap[i - 1] = after  # the geometry decides, not what follows
    return settled


@kernel
def _highest(
    d1: Floats, d2: Floats, length: float, bound: float, a_axis: Floats, x: float, lines: Floats
) -> tuple[float, float]:
    """(least, greatest) u of an interval at x."""
    number = _fill(d1, d2, length, bound, a_axis, lines)
    low, high = -inf, inf
    for k in range(number):
        a = lines[k, 0]
        room = lines[k, 2] - lines[k, 1] * x
        if a > 0.0:
            high = min(high, room / a)
        elif a < 0.0:
            low = max(low, room / a)
    return low, high


@kernel
def forward(
    d1: Floats, d2: Floats, length: Floats, bound: Floats, a_axis: Floats, before: float, reach: Floats
) -> None:
    """Lowers reach (m,) to what can be reached from x = before at the start."""
    lines = np.empty((_CONSTRAINTS, 3))
    x = before
    for i in range(len(length)):
        top = x
        if length[i] > 0.0:
            if d1[i, 0, 0] == 0.0 and d1[i, 0, 1] == 0.0 and d1[i, 0, 2] == 0.0:
                top = x + 2.0 * bound[i] * length[i]
            else:
                _, high = _highest(d1[i], d2[i], length[i], bound[i], a_axis, x, lines)
                top = max(x + 2.0 * high * length[i], 0.0)
        x = min(reach[i], top)
        reach[i] = x


@kernel
def ramps(
    d1: Floats, d2: Floats, length: Floats, bound: Floats, a_axis: Floats, before: float, x_end: Floats,
    accel: Floats, decel: Floats,
) -> None:  # fmt: skip
    """Writes accel and decel (m,): the planned u, or more where that is safe at any x up to the planned one.

    What is safe at x = 0 and at the planned x is safe between, since the limits are convex.
    """
    lines = np.empty((_CONSTRAINTS, 3))
    x = before
    for i in range(len(length)):
        if length[i] > 0.0:
            if d1[i, 0, 0] == 0.0 and d1[i, 0, 1] == 0.0 and d1[i, 0, 2] == 0.0:
                accel[i] = bound[i]
                decel[i] = bound[i]
            else:
                u = (x_end[i] - x) / (2.0 * length[i])
                _, most = _highest(d1[i], d2[i], length[i], bound[i], a_axis, 0.0, lines)
                low, high = _highest(d1[i], d2[i], 0.0, bound[i], a_axis, max(x, x_end[i]), lines)
                safe = max(min(most, high, -low), _FLOOR * most)
                accel[i] = max(safe, u)
                decel[i] = max(safe, -u)
        x = x_end[i]
