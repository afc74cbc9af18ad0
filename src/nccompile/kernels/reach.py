"""Time-optimal velocities along a given path by reachability analysis (Pham and Pham 2018, TOPP-RA).

Every row is an interval of length D with constant path acceleration u; with x = v², x_next = x + 2 D u.
Axis a is inside its limit where |q' u + q'' x| <= A, asked at both ends of an interval:

    backward   K_i = greatest x_i from which some u leads into 0..K_i+1       (a linear program in u and x)
    forward    x_i+1 = the greatest that some u reaches from x_i, at most K_i+1

Both are solved for w = 2 D u, the change of x, with every limit divided by its bound: near a sharp bend D and the
radius of curvature may be as small as 1e-15 mm.

Every x between 0 and K is controllable, because the limits hold 0: scaling x and u by s < 1 scales what the
axes feel.  So a profile below x can be braked and accelerated again; `slack` says by how much at full x.
Straight intervals have q'' = 0 and one bound U on |u|.
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curves import derivative3, second3, tangent3
from nccompile.kernels.planes import SPACE, in_plane_share, plane_axes

__all__ = ["backward", "bend_at", "forward", "ramps", "slopes"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
Kinds = npt.NDArray[np.uint8]

_CONSTRAINTS = 20
_STILL = 1e-13  # speed over second derivative below which a curve stands: a cusp at its end (`tangent3`)
_FLOOR = 1e-3  # share of U that a row always has to accelerate or brake with, so that nothing can get stuck


@kernel
def bend_at(kind: int, plane: int, p: Floats, u: float, share: float, d1: Floats, d2: Floats) -> None:
    """Writes q' and q'' of X, Y, Z (3,) at the parameter u; the axis across the plane is left at 0.

    share: in-plane length over path length.  At a cusp q' is the limit and q'' is left at 0: the path is at rest
    there or comes and goes on one line.
    """
    tx, ty, tz = tangent3(kind, p, u)
    x, y, z = derivative3(kind, p, u)
    x2, y2, z2 = second3(kind, p, u)
    size2 = x * x + y * y + z * z
    d1[:] = 0.0
    d2[:] = 0.0
    along, bend = 0.0, 0.0
    if size2 > _STILL * _STILL * (x2 * x2 + y2 * y2 + z2 * z2):
        along = (x * x2 + y * y2 + z * z2) / size2
        bend = share * share / size2
    if plane == SPACE:
        d1[0], d1[1], d1[2] = tx, ty, tz
        d2[0], d2[1], d2[2] = (x2 - along * x) * bend, (y2 - along * y) * bend, (z2 - along * z) * bend
        return
    first, second = plane_axes(plane)
    d1[first] = share * tx
    d1[second] = share * ty
    d2[first] = (x2 - along * x) * bend
    d2[second] = (y2 - along * y) * bend


@kernel
def slopes(
    kind: Kinds, start: Floats, target: Floats, curve: Ints, plane: Kinds, parameters: Floats, length: Floats,
    solid: Kinds, top: Floats, a_axis: Floats, d1: Floats, d2: Floats, widest: Floats, share: Floats,
) -> None:  # fmt: skip
    """Writes d1, d2 (n, 2, 3): q' and q'' of X, Y, Z at both ends of the rows, 0 where a row is straight or solid.

    Also widest (n, 3), the greatest |q'| on the row, and share (n,): what part of the acceleration may be used so
    that the limits, asked at both ends, hold between them.  top (n,): greatest velocity of the rows; a_axis (3,).

    With l = 0..1 along the row q' and q'' leave the straight line between their ends by 4 l (1 - l) e1 and e2,
    and q'' x, both linear in l, by l (1 - l) 2 D u (q''_1 - q''_0):

        excess <= e1 U + e2 X + D U |q''_1 - q''_0| / 2

    and what `ramps` may add to u.  q' and q'' are at right angles, so u and x are what the acceleration has of
    either direction:  U = sum A |q'| / sum q'²,  X = sum A |q''| / sum q''².
    """
    mid1, mid2 = np.zeros(3), np.zeros(3)
    for j in range(len(kind)):
        c = int(curve[j])
        d1[j, :, :] = 0.0
        d2[j, :, :] = 0.0
        widest[j, :] = 0.0
        share[j] = 1.0
        if c < 0 or length[j] <= 0.0 or solid[j] == 1:
            continue
        across = int(plane[c])
        flat = 1.0
        if across != SPACE:
            flat = in_plane_share(start[j, 2 - across], target[j, 2 - across], length[j])
        p = parameters[c]
        bend_at(int(kind[j]), across, p, 0.0, flat, d1[j, 0], d2[j, 0])
        bend_at(int(kind[j]), across, p, 1.0, flat, d1[j, 1], d2[j, 1])
        bend_at(int(kind[j]), across, p, 0.5, flat, mid1, mid2)
        along = sum1 = across2 = sum2 = 0.0
        for a in range(3):
            e1 = abs(mid1[a] - 0.5 * (d1[j, 0, a] + d1[j, 1, a]))
            widest[j, a] = max(abs(d1[j, 0, a]), abs(d1[j, 1, a]), abs(mid1[a])) + e1
            if a_axis[a] < inf:
                along += a_axis[a] * abs(mid1[a])
                across2 += a_axis[a] * abs(mid2[a])
            sum1 += mid1[a] * mid1[a]
            sum2 += mid2[a] * mid2[a]
        most_u = along / sum1 if sum1 > 0.0 else 0.0
        most_x = top[j] * top[j]
        if sum2 * most_x > across2:
            most_x = across2 / sum2
        excess = 0.0
        for a in range(3):
            if a_axis[a] < inf:
                e1 = abs(mid1[a] - 0.5 * (d1[j, 0, a] + d1[j, 1, a]))
                e2 = abs(mid2[a] - 0.5 * (d2[j, 0, a] + d2[j, 1, a]))
                turn = 0.5 * length[j] * abs(d2[j, 1, a] - d2[j, 0, a])
                excess = max(excess, ((e1 + turn) * most_u + e2 * most_x) / a_axis[a])
        share[j] = 1.0 / (1.0 + excess + 1.1 * _FLOOR)


@kernel
def _along(lines: Floats, number: int, k: int) -> tuple[float, float, int]:
    """(x, w) with the greatest x on the boundary of constraint k inside the constraints before it."""
    a, b, c = lines[k, 0], lines[k, 1], lines[k, 2]
    norm = a * a + b * b
    if norm == 0.0:
        return 0.0, 0.0, 0
    w0, x0 = a * c / norm, b * c / norm
    dw, dx = -b, a
    low, high = -inf, inf
    for i in range(number):
        if i == k:
            continue
        slope = lines[i, 0] * dw + lines[i, 1] * dx
        room = lines[i, 2] - lines[i, 0] * w0 - lines[i, 1] * x0
        if abs(slope) <= 1e-14 * (abs(lines[i, 0]) + abs(lines[i, 1])) * sqrt(norm):
            if room < -1e-9 * abs(lines[i, 2]):
                return 0.0, 0.0, 0
            continue
        if slope > 0.0:
            high = min(high, room / slope)
        else:
            low = max(low, room / slope)
    t = high if dx > 0.0 else low
    if abs(dx) <= 1e-14 * abs(dw):  # all along it x is the same
        t = min(max(0.0, low), high)
    if low > high:
        t = 0.5 * (low + high)
    return x0 + t * dx, w0 + t * dw, 1


@kernel
def _fill(
    d1: Floats, d2: Floats, length: float, bound: float, share: float, a_axis: Floats, moved: float, lines: Floats
) -> int:  # fmt: skip
    """Constraints a w + b x <= c of an interval: axes at both ends, |u| <= bound; all have c = 1.

    moved: 1 where the end has x + w, 0 where it has x too.
    """
    number = 0
    for a in range(3):
        for end in range(2):
            if a_axis[a] < inf:
                slope = d1[end, a] / (2.0 * length * share * a_axis[a])
                bend = d2[end, a] / (share * a_axis[a])
                if end == 1:
                    slope += moved * bend
                if slope != 0.0 or bend != 0.0:
                    lines[number, 0], lines[number, 1], lines[number, 2] = slope, bend, 1.0
                    lines[number + 1, 0], lines[number + 1, 1], lines[number + 1, 2] = -slope, -bend, 1.0
                    number += 2
    if bound < inf:
        slope = 1.0 / (2.0 * length * bound)
        lines[number, 0], lines[number, 1], lines[number, 2] = slope, 0.0, 1.0
        lines[number + 1, 0], lines[number + 1, 1], lines[number + 1, 2] = -slope, 0.0, 1.0
        number += 2
    return number


@kernel
def _controllable(
    d1: Floats,
    d2: Floats,
    length: float,
    bound: float,
    share: float,
    a_axis: Floats,
    cap: float,
    after: float,
    lines: Floats,
) -> tuple[float, int]:
    """(greatest x at the start of an interval, whether what follows has no say in it).

    Linear program in two variables, constraints taken in one by one: one that cuts off the optimum so far has
    the new optimum on its boundary.
    """
    lines[0, 0], lines[0, 1], lines[0, 2] = 0.0, 1.0 / cap, 1.0
    lines[1, 0], lines[1, 1], lines[1, 2] = -1.0, -1.0, 0.0
    number = 2 + _fill(d1, d2, length, bound, share, a_axis, 1.0, lines[2:])
    lines[number, 0], lines[number, 1], lines[number, 2] = 1.0, 1.0, after
    x, w = cap, -cap
    free = 1
    for k in range(2, number + 1):
        if lines[k, 0] * w + lines[k, 1] * x > lines[k, 2] * (1.0 + 1e-12):
            x, w, found = _along(lines, k, k)
            if found == 0:
                return 0.0, 0
            if k == number:
                free = 0
    return min(max(x, 0.0), cap), free


@kernel
def backward(
    d1: Floats, d2: Floats, length: Floats, bound: Floats, share: Floats, a_axis: Floats, cap: Floats, known: int,
    complete: int, reach: Floats,
) -> int:  # fmt: skip
    """Writes reach (m,): the greatest x at the end of each interval from which the rest can be run.

    length, bound, share (m,): D, U of the intervals and the part of A they may use; cap (m,): greatest x at their
    ends; after the last one the path is at rest.  Returns the number of leading intervals that nothing after the
    `known` ones can change.
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
                after, free = _controllable(
                    d1[i], d2[i], length[i], bound[i], share[i], a_axis, top, reach[i], lines
                )
                if free == 1:
                    cap[i - 1] = after  # the geometry decides, not what follows
    return settled


@kernel
def _highest(
    d1: Floats, d2: Floats, length: float, bound: float, share: float, a_axis: Floats, x: float, moved: float,
    lines: Floats,
) -> tuple[float, float]:  # fmt: skip
    """(least, greatest) w of an interval at x; moved as in `_fill`."""
    number = _fill(d1, d2, length, bound, share, a_axis, moved, lines)
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
    d1: Floats,
    d2: Floats,
    length: Floats,
    bound: Floats,
    share: Floats,
    a_axis: Floats,
    before: float,
    reach: Floats,
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
                _, high = _highest(d1[i], d2[i], length[i], bound[i], share[i], a_axis, x, 1.0, lines)
                top = max(x + high, 0.0)
        x = min(reach[i], top)
        reach[i] = x


@kernel
def ramps(
    d1: Floats, d2: Floats, length: Floats, bound: Floats, share: Floats, a_axis: Floats, before: float, x_end: Floats,
    accel: Floats, decel: Floats,
) -> None:  # fmt: skip
    """Writes accel and decel (m,): the planned u, or more where that is safe at any x up to the planned one.

    What is safe at x = 0 and at the greater x of both ends is safe between, since the limits are convex: then the
    ramp is shorter than the interval, which runs on at its greatest x.
    """
    lines = np.empty((_CONSTRAINTS, 3))
    x = before
    for i in range(len(length)):
        if length[i] > 0.0:
            if d1[i, 0, 0] == 0.0 and d1[i, 0, 1] == 0.0 and d1[i, 0, 2] == 0.0:
                accel[i] = bound[i]
                decel[i] = bound[i]
            else:
                once = 2.0 * length[i]
                u = (x_end[i] - x) / once
                _, most = _highest(d1[i], d2[i], length[i], bound[i], share[i], a_axis, 0.0, 0.0, lines)
                low, high = _highest(
                    d1[i], d2[i], length[i], bound[i], share[i], a_axis, max(x, x_end[i]), 0.0, lines
                )
                safe = max(min(most, high, -low), _FLOOR * most) / once
                accel[i] = max(safe, u)
                decel[i] = max(safe, -u)
        x = x_end[i]
