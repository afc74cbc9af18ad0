"""Velocity caps for a smoothed path velocity, and cutting rows into parts.

The jerk-limited law runs the mean of the last T seconds of an acceleration-limited motion.  Where the mean is
at the place p, the window of the mean reaches at most c T / 2 to either side of p as long as it runs at most
at c there.  So a cap c that holds on an interval is kept by the mean if the motion itself keeps it c T / 2
before and after that interval too:

    cap      ____      ____            motion   ___            ___
                 \\____/          =>                \\__________/
                 | c  |                           | cT/2  cT/2 |
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curves import parameter, point, point3, tabulate

__all__ = ["PARTS", "cut_rows", "erode"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
Kinds = npt.NDArray[np.uint8]

PARTS = 9
"""Greatest number of parts that `erode` makes of a row."""

_STEPS = 4  # caps to either side that a row tells apart; the rest is taken as one
_KEPT = 32

_SET_POSITION = 5
_SPACE = 3
_ARC, _ELLIPSE = 2, 3


@kernel
def _look(
    length: Floats, top: Floats, v_junction: Floats, accel: Floats, decel: Floats, j: int, step: int, half: float,
    reach: Floats, cap: Floats, ramps: Floats,
) -> tuple[int, int]:  # fmt: skip
    """Caps below top[j] that reach into row j from one side (step -1: before it, 1: after it).

    Fills reach [mm into the row] and cap, returns their number and whether rows that are not yet known could
    add more.  ramps (2,): lowered to the least accel and decel met.
    """
    n = len(length)
    limit = top[j] * half
    count = 0
    away = 0.0
    k = j
    while True:
        at = k - 1 if step < 0 else k  # the junction crossed next
        if at < 0:
            return count, 0
        if at >= n - 1 and step > 0:
            return count, 1
        v = v_junction[at]
        if v <= 0.0:
            return count, 0  # a stop: the mean stands there as long as the motion does
        if v < top[j] and v * half > away and count < _KEPT:
            reach[count] = v * half - away
            cap[count] = v
            count += 1
        k += step
        if length[k] > 0.0:
            ramps[0] = min(ramps[0], accel[k])
            ramps[1] = min(ramps[1], decel[k])
            if top[k] < top[j] and top[k] * half > away and count < _KEPT:
                reach[count] = top[k] * half - away
                cap[count] = top[k]
                count += 1
            away += length[k]
        if away >= limit:
            return count, 0


@kernel
def _steps(reach: Floats, cap: Floats, count: int, edge: Floats, height: Floats) -> int:
    """The caps as rising steps: height[i] holds up to edge[i] into the row.  Returns their number."""
    steps = 0
    done = 0.0
    while steps < _STEPS:
        best = -1
        for i in range(count):
            if reach[i] > done and (best < 0 or cap[i] < cap[best]):
                best = i
        if best < 0:
            return steps
        height[steps] = cap[best]
        edge[steps] = reach[best]
        if steps == _STEPS - 1:
            for i in range(count):
                edge[steps] = max(edge[steps], reach[i])
        done = edge[steps]
        steps += 1
    return steps


@kernel
def erode(
    kind: Kinds, length: Floats, top: Floats, v_junction: Floats, accel: Floats, decel: Floats, half: float,
    begin: int, complete: int, solid: Kinds, row: Ints, p0: Floats, p1: Floats, cap: Floats, ramps: Floats,
) -> tuple[int, int]:  # fmt: skip
    """Parts of rows begin.. with the caps of the motion that is to be smoothed.

    top (n,): greatest velocity on each row; half: T / 2 [s].  Writes row (m,), p0, p1 (m,): shares of its
    length, cap (m,), ramps (m, 2): accel and decel.  Returns the number of parts and the row up to which
    they are complete: rows after it wait for more.  A row that lasts less than T / 2, or is solid (1), stays whole.
    """
    n = len(length)
    reach_l, cap_l, reach_r, cap_r = np.empty(_KEPT), np.empty(_KEPT), np.empty(_KEPT), np.empty(_KEPT)
    edge_l, height_l, edge_r, height_r = (
        np.empty(_STEPS),
        np.empty(_STEPS),
        np.empty(_STEPS),
        np.empty(_STEPS),
    )
    marks = np.empty(2 * _STEPS + 2)
    count = 0
    for j in range(begin, n):
        row[count] = j
        p0[count] = 0.0
        p1[count] = 1.0
        cap[count] = top[j]
        ramps[count, 0] = accel[j]
        ramps[count, 1] = decel[j]
        if length[j] <= 0.0 or kind[j] >= _SET_POSITION:
            count += 1
            continue
        left, _ = _look(length, top, v_junction, accel, decel, j, -1, half, reach_l, cap_l, ramps[count])
        right, waits = _look(length, top, v_junction, accel, decel, j, 1, half, reach_r, cap_r, ramps[count])
        if waits == 1 and complete == 0:
            return count, j
        run = length[j]
        if run <= top[j] * half or solid[j] == 1:
            for i in range(left):
                cap[count] = min(cap[count], cap_l[i])
            for i in range(right):
                cap[count] = min(cap[count], cap_r[i])
            count += 1
            continue
        steps_l = _steps(reach_l, cap_l, left, edge_l, height_l)
        steps_r = _steps(reach_r, cap_r, right, edge_r, height_r)
        marks[0] = 0.0
        number = 1
        for i in range(steps_l):
            if edge_l[i] < run:
                marks[number] = edge_l[i]
                number += 1
        for i in range(steps_r - 1, -1, -1):
            at = run - edge_r[i]
            if at > 0.0:
                k = number  # insertion keeps the marks ascending
                while marks[k - 1] > at:
                    marks[k] = marks[k - 1]
                    k -= 1
                marks[k] = at
                number += 1
        marks[number] = run
        a, d = ramps[count, 0], ramps[count, 1]
        for i in range(number):
            if marks[i + 1] - marks[i] <= 1e-9 * run and number > 1 and i + 1 < number:
                marks[i + 1] = marks[i]
                continue
            mid = 0.5 * (marks[i] + marks[i + 1])
            v = top[j]
            for k in range(steps_l):
                if edge_l[k] > mid:
                    v = min(v, height_l[k])
            for k in range(steps_r):
                if run - edge_r[k] < mid:
                    v = min(v, height_r[k])
            row[count] = j
            p0[count] = marks[i] / run
            p1[count] = 1.0 if i + 1 == number else marks[i + 1] / run
            cap[count] = v
            ramps[count, 0] = a
            ramps[count, 1] = d
            count += 1
    return count, n


@kernel
def _cut(kind: int, p: Floats, u0: float, u1: float, out: Floats) -> None:
    """The curve row of the part u0..u1 of a curve."""
    out[:] = p
    if kind == _ARC:
        out[3] = p[3] + p[4] * u0
        out[4] = p[4] * (u1 - u0)
    elif kind == _ELLIPSE:
        out[5] = p[5] + p[6] * u0
        out[6] = p[6] * (u1 - u0)
    else:
        h = u1 - u0
        for c in range(0, 12, 4):
            out[c] = p[c] + u0 * (p[c + 1] + u0 * (p[c + 2] + u0 * p[c + 3]))
            out[c + 1] = h * (p[c + 1] + u0 * (2.0 * p[c + 2] + u0 * 3.0 * p[c + 3]))
            out[c + 2] = h * h * (p[c + 2] + 3.0 * p[c + 3] * u0)
            out[c + 3] = h * h * h * p[c + 3]


@kernel
def cut_rows(
    kind: Kinds, start: Floats, target: Floats, curve: Ints, plane: Kinds, parameters: Floats, length: Floats,
    nodes_u: Floats, nodes_s: Floats, row: Ints, p0: Floats, p1: Floats, out_target: Floats,
    out_parameters: Floats, out_length: Floats,
) -> None:  # fmt: skip
    """Parts p0..p1 (shares of the path length) of rows: their ends, curves and lengths.

    row, p0, p1: Shape (m,); out_target (m, k); out_parameters (m, 12), of curved rows only; out_length (m,).
    A part that ends with its row ends at the row's target to the bit.
    """
    axes = target.shape[1]
    last = -1
    nodes = 0
    u_end = 0.0
    for i in range(len(row)):
        j = int(row[i])
        c = int(curve[j])
        out_length[i] = length[j] if p0[i] == 0.0 and p1[i] == 1.0 else length[j] * (p1[i] - p0[i])
        whole = p1[i] >= 1.0
        for a in range(axes):
            out_target[i, a] = target[j, a] if whole else start[j, a] + (target[j, a] - start[j, a]) * p1[i]
        if c < 0:
            continue
        p = parameters[c]
        if p0[i] == 0.0 and whole:
            out_parameters[i, :] = p
            continue
        if last != j:
            nodes = tabulate(int(kind[j]), p, nodes_u, nodes_s)
            u_end = 0.0
            last = j
        u0 = u_end
        u1 = 1.0 if whole else parameter(int(kind[j]), p, nodes_u, nodes_s, nodes, p1[i] * nodes_s[nodes - 1])
        u_end = u1
        _cut(int(kind[j]), p, u0, u1, out_parameters[i])
        if whole:
            continue
        if plane[c] == _SPACE:
            x, y, z = point3(int(kind[j]), p, u1)
            out_target[i, 0] = x
            out_target[i, 1] = y
            out_target[i, 2] = z
        else:
            x, y = point(int(kind[j]), p, u1)
            first, second = 0, 1
            if plane[c] == 1:
                first, second = 2, 0
            elif plane[c] == 2:
                first, second = 1, 2
            out_target[i, first] = x
            out_target[i, second] = y
