"""Where ellipses and cubics are cut before planning, and the curves of the parts.

A cubic turns back on itself where its speed |P'(u)| is zero (a cusp).  Behind the cut its direction is the limit
from inside, so a cusp is a junction of 180 degrees like any other.  Elsewhere a curve is cut where its curvature
c allows velocities sqrt(a / c) that differ, so that one tight place does not slow down all of it:

    v  ______          ______       v  ______        ______      the parts start with a cut at each minimum of
             \\        /                   |_      _|            the speed, where curvature has its peaks, and are
              \\______/                      |____|              halved until their velocities differ little

A planner that follows the curvature itself has every curve cut in parts that turn by a small angle instead.
"""

from __future__ import annotations

from math import acos, ceil, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curves import (
    ARC,
    ELLIPSE,
    POLYNOMIAL,
    curvature,
    in_plane_length,
    is_cusp,
    point3,
    speed,
    speed_extremes,
    tangent3,
)
from nccompile.kernels.planes import SPACE, plane_axes

__all__ = ["PARTS", "curve_parts", "curve_piece", "cut_curves", "turn_round", "way_share"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
Kinds = npt.NDArray[np.uint8]

PARTS = 512
"""Greatest number of parts of one curve."""

_BENDS = 128  # of them where curvature decides

_ALIKE = 0.85  # velocities inside a part differ by less than this ratio
_SHORTEST = 1e-9  # mm: the length below which no part is cut
_PIECES = 8  # a curve that is no arc starts with so many equal parts where the angle decides
_LEAST = 1e-12  # of the parameter: parts are not halved below this


@kernel
def curve_piece(kind: int, p: Floats, u0: float, u1: float, out: Floats) -> None:
    """Writes the curve row (12,) of the part u0..u1 of a curve to out, which may be p."""
    out[:] = p
    if kind == ARC:
        out[3] = p[3] + p[4] * u0
        out[4] = p[4] * (u1 - u0)
    elif kind == ELLIPSE:
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
def turn_round(kinds: Kinds, rows: Floats) -> None:
    """Curves, kinds (m,) and rows (m, 12), run from their ends to their starts; in place."""
    for i in range(len(kinds)):
        curve_piece(int(kinds[i]), rows[i], 1.0, 0.0, rows[i])


@kernel
def way_share(kind: int, p: Floats, u: float) -> float:
    """The share 0..1 of the length in its plane up to the parameter u of a curve; u itself, in 0..1, of a line."""
    if u <= 0.0 or u >= 1.0 or kind <= ARC or kind > POLYNOMIAL:
        return min(max(u, 0.0), 1.0)
    part = p.copy()
    if kind == ELLIPSE:
        part[6] = float(p[6]) * u
    else:
        for c in range(3):
            part[4 * c + 1] = float(p[4 * c + 1]) * u
            part[4 * c + 2] = float(p[4 * c + 2]) * u * u
            part[4 * c + 3] = float(p[4 * c + 3]) * u * u * u
    whole = in_plane_length(kind, p)
    return in_plane_length(kind, part) / whole if whole > 0.0 else u


@kernel
def _velocities(
    kind: int, p: Floats, a: float, b: float, across: float, top: float, slow: float
) -> tuple[float, float]:
    """(least, greatest) velocity sqrt(across / curvature) within slow..top at five places of a..b."""
    low = top
    high = slow
    for i in range(5):
        bend = curvature(kind, p, a + 0.25 * i * (b - a))
        v = top
        if bend * top * top > across:
            v = max(sqrt(across / bend), slow)
        low = min(low, v)
        high = max(high, v)
    return low, high


@kernel
def _by_bend(
    kind: int, p: Floats, length: float, across: float, top: float, slow: float, gain: float, ends: Floats,
    cusps: Kinds,
) -> int:  # fmt: skip
    """Fills the ends of a curve's parts (PARTS,), ascending, 1 last, and which are cusps; returns their number."""
    places = np.empty(8)
    found = speed_extremes(kind, p, places)
    bends = top * top * _greatest(kind, p, places, found) > across
    stack = np.empty(_BENDS + 8)
    turns = np.zeros(_BENDS + 8, np.uint8)
    waiting = 1
    stack[0] = 1.0
    for i in range(found - 1, -1, -1):
        at = float(places[i])
        before = 0.5 * (at + (float(places[i - 1]) if i > 0 else 0.0))
        cusp = is_cusp(kind, p, at)
        if cusp or (bends and speed(kind, p, at) < speed(kind, p, before)):
            stack[waiting] = at
            turns[waiting] = 1 if cusp else 0
            waiting += 1
    count = 0
    a = 0.0
    while waiting > 0:
        b = float(stack[waiting - 1])
        half = 0.5 * (a + b)
        if bends and count + waiting < _BENDS and (b - a) * length > _SHORTEST:
            low, high = _velocities(kind, p, a, b, across, top, slow)
            run = speed(kind, p, half) * (b - a)
            if low < _ALIKE * high and run * (high - low) > gain * low * high:
                stack[waiting] = half
                turns[waiting] = 0
                waiting += 1
                continue
        ends[count] = b
        cusps[count] = turns[waiting - 1]
        count += 1
        waiting -= 1
        a = b
    return count


@kernel
def _turn(kind: int, p: Floats, u0: float, u1: float) -> float:
    """Angle between the tangents at two parameters [rad]."""
    x, y, z = tangent3(kind, p, u0)
    x2, y2, z2 = tangent3(kind, p, u1)
    return acos(min(max(x * x2 + y * y2 + z * z2, -1.0), 1.0))


@kernel
def _by_turn(kind: int, p: Floats, turn: float, ends: Floats, cusps: Kinds) -> int:
    """As `_by_bend`, with parts that turn by at most `turn` [rad]."""
    count = 0
    if kind == ARC:
        count = min(max(ceil(abs(float(p[4])) / turn - 1e-9), 2), PARTS)
        for i in range(count):
            ends[i] = (i + 1) / count
            cusps[i] = 0
        return count
    places = np.empty(8)
    found = speed_extremes(kind, p, places)
    a = 0.0
    step = 1.0 / _PIECES
    for i in range(found + 1):
        stop = 1.0 if i == found else float(places[i])
        if i < found and not is_cusp(kind, p, stop):
            continue
        while a < stop:
            b = min(a + step, stop)
            near = b
            if i < found and b == stop:
                near = stop - _LEAST  # at the cusp itself the direction is that behind it
            bend = max(_turn(kind, p, a, near), 2.0 * _turn(kind, p, a, 0.5 * (a + b)))
            if bend > turn and step > _LEAST and count < PARTS - 4 * _PIECES:
                step *= 0.5
                continue
            ends[count] = b
            cusps[count] = 1 if i < found and b == stop else 0
            count += 1
            a = b
            if count >= PARTS - 4 * _PIECES:
                step = 1.0 / _PIECES  # no room for more: the rest as it comes
            elif bend < 0.4 * turn and step < 1.0 / _PIECES:
                step *= 2.0
    return count


@kernel
def _greatest(kind: int, p: Floats, places: Floats, found: int) -> float:
    """The greatest curvature at 17 places and at the extremes of the speed [1/mm]."""
    best = 0.0
    for i in range(17):
        best = max(best, curvature(kind, p, i / 16.0))
    for i in range(found):
        best = max(best, curvature(kind, p, float(places[i])))
    return best


@kernel
def curve_parts(
    kind: Kinds, curve: Ints, parameters: Floats, length: Floats, whole: Kinds, across: Floats, top: Floats,
    slow: Floats, gain: float, turn: float, row: Ints, u0: Floats, u1: Floats, ends: Kinds,
) -> int:  # fmt: skip
    """Where the rows of a chunk are cut: one part of a row that is not.

    whole (n,): 1 where a row stays as it is; across, top, slow (n,): the acceleration [mm/s²] that curvature may
    take, the velocity [mm/s] that the row cannot exceed and the one that any bend may be run at; gain [s]: time
    that a cut has to save; turn [rad]: greatest turn of a part, 0: no such rule.

    Writes row, u0, u1 (m,), parameters of the curve, and ends (m,): bit 0 if the part starts at a cusp, bit 1 if
    it ends there.  Returns m; room is needed for PARTS a curve.
    """
    count = 0
    marks = np.empty(PARTS)
    cusps = np.empty(PARTS, np.uint8)
    for j in range(len(kind)):
        c = int(curve[j])
        shape = int(kind[j])
        pieces = 1
        marks[0] = 1.0
        cusps[0] = 0
        if c < 0 or whole[j] == 1:
            pieces = 1
        elif turn > 0.0:
            if length[j] > _SHORTEST:
                pieces = _by_turn(shape, parameters[c], turn, marks, cusps)
        elif shape != ARC:
            pieces = _by_bend(
                shape, parameters[c], float(length[j]), float(across[j]), float(top[j]), float(slow[j]), gain,
                marks, cusps,
            )  # fmt: skip
        a = 0.0
        before = 0
        for i in range(pieces):
            row[count] = j
            u0[count] = a
            u1[count] = marks[i]
            after = int(cusps[i])
            ends[count] = before + 2 * after
            count += 1
            a = float(marks[i])
            before = after
    return count


@kernel
def cut_curves(
    kind: Kinds, start: Floats, target: Floats, curve: Ints, plane: Kinds, parameters: Floats, row: Ints,
    u0: Floats, u1: Floats, ends: Kinds, p0: Floats, p1: Floats, out_target: Floats, out_parameters: Floats,
) -> None:  # fmt: skip
    """The parts of `curve_parts` as rows: shares p0, p1 (m,) of the length, targets (m, k), curve rows (m, 12).

    At a cusp the first derivative of the part is made 0, so that its tangent there is the limit from inside.
    """
    axes = target.shape[1]
    first = 0
    total = 0.0
    for i in range(len(row)):
        j = int(row[i])
        last = u1[i] >= 1.0
        p0[i] = 0.0
        p1[i] = 1.0
        out_target[i, :] = target[j]
        c = int(curve[j])
        if c < 0:
            continue
        if u0[i] == 0.0 and last:
            out_parameters[i, :] = parameters[c]
            continue
        shape = int(kind[j])
        out = out_parameters[i]
        curve_piece(shape, parameters[c], float(u0[i]), float(u1[i]), out)
        if ends[i] != 0:
            _still(out, int(ends[i]))
        if u0[i] == 0.0:
            first = i
            total = 0.0
        p0[i] = total
        total += in_plane_length(shape, out)
        p1[i] = total
        if not last:
            continue
        for n in range(first, i + 1):
            p0[n] /= total
            p1[n] = 1.0 if n == i else p1[n] / total
            if n < i:
                _end(
                    shape,
                    int(plane[c]),
                    out_parameters[n],
                    start[j],
                    target[j],
                    float(p1[n]),
                    out_target[n],
                    axes,
                )


@kernel
def _still(p: Floats, ends: int) -> None:
    """Makes the first derivative of a cubic 0 where it starts (bit 0) and ends (bit 1); both ends stay."""
    for k in range(0, 12, 4):
        way = p[k + 1] + p[k + 2] + p[k + 3]
        if ends & 1:
            p[k + 1] = 0.0
        if ends & 2:
            way -= p[k + 1]
            p[k + 2] = 3.0 * way + p[k + 1]
            p[k + 3] = -p[k + 1] - 2.0 * way
        else:
            p[k + 2] = way - p[k + 3]


@kernel
def _end(
    kind: int, plane: int, p: Floats, start: Floats, target: Floats, share: float, out: Floats, axes: int
) -> None:
    """Writes where a part ends (k,): on its curve, the other axes at their share of the way."""
    for a in range(axes):
        out[a] = start[a] + (target[a] - start[a]) * share
    x, y, z = point3(kind, p, 1.0)
    first, second = plane_axes(plane)
    out[first] = x
    out[second] = y
    if plane == SPACE:
        out[2] = z
