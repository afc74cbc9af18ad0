"""Velocities at the junctions of segments: angle tolerance, velocity step of the axes, junction deviation.

Directions are the slopes q' of the axes along the path, so path velocity v moves axis a with v q'_a; at a
junction the slopes jump from t_end of one row to t_start of the next.
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = ["CIRCLE", "NO_DEVIATION", "PARABOLA", "junctions"]

Floats = npt.NDArray[np.float64]
Kinds = npt.NDArray[np.uint8]

_POSITIONING, _SET_POSITION = 0, 5

_SAME_SLOPE = 1e-9  # slopes that differ by less are tangent: rounding of directions, not a corner
_STRAIGHT = 0.999999  # cosine of a bend that the circle rule takes as none, as Klipper does

NO_DEVIATION, PARABOLA, CIRCLE = 0, 1, 2  # rules of the junction deviation


@kernel
def _bend(t_end: Floats, t_start: Floats, i: int, j: int) -> tuple[float, float]:
    """(square of the chord 2 sin(angle / 2), cosine) of the bend between rows i and j.

    Of the X-Y-Z directions; of all axes if neither row moves X, Y, Z; (inf, -1) if only one of them does.
    """
    axes = t_end.shape[1]
    first = min(3, axes)
    size_i = size_j = 0.0
    for a in range(first):
        size_i += t_end[i, a] * t_end[i, a]
        size_j += t_start[j, a] * t_start[j, a]
    if (size_i > 0.0) != (size_j > 0.0):
        return inf, -1.0
    low = 0
    high = first
    if size_i == 0.0:
        low = first
        high = axes
        for a in range(low, high):
            size_i += t_end[i, a] * t_end[i, a]
            size_j += t_start[j, a] * t_start[j, a]
        if size_i == 0.0 or size_j == 0.0:
            return inf, -1.0
    size_i = sqrt(size_i)
    size_j = sqrt(size_j)
    bend2 = 0.0
    cosine = 0.0
    for a in range(low, high):
        ti = t_end[i, a] / size_i
        tj = t_start[j, a] / size_j
        bend2 += (ti - tj) * (ti - tj)
        cosine += ti * tj
    return bend2, cosine


@kernel
def _step_velocity(
    t_end: Floats, t_start: Floats, i: int, j: int, steps: Floats, shorter: float, span: float, cycle: float
) -> float:
    """No axis may jump by more than its velocity step within one cycle T.

    Whether by one corner or by many short chords: with D = |q'_j - q'_i| of the axis and a step of size w,
    either of these is enough:

        one corner a cycle    v D <= w   and   v T <= the shorter of both segments
        many a cycle          v D <= w / 3   and   v² D T <= w span / 3,   span: half of both segments
    """
    v = inf
    for a in range(t_end.shape[1]):
        jump = abs(t_end[i, a] - t_start[j, a])
        if jump > _SAME_SLOPE and steps[a] < inf:
            alone = min(steps[a] / jump, shorter / cycle)
            many = min(steps[a] / (3.0 * jump), sqrt(steps[a] * span / (3.0 * cycle * jump)))
            v = min(v, max(alone, many))
    return v


@kernel
def _parabola_velocity(
    t_end: Floats, t_start: Floats, i: int, j: int, a_axis: Floats, deviation: float, shorter: float
) -> float:
    """The corner as a parabola that stays within `deviation` of it and within the axes' accelerations.

    A blend of duration T changes the velocity evenly by v (q'_j - q'_i), so T = v m with m = max |D_a| / a_a.
    It passes the corner at the distance v T |D| / 8, and takes v T / 2 of either segment:

        v² <= 8 d / (m |D|)     and     v² <= shorter / m
    """
    first = min(3, t_end.shape[1])
    m = 0.0
    size = 0.0
    for a in range(t_end.shape[1]):
        jump = abs(t_end[i, a] - t_start[j, a])
        if jump > _SAME_SLOPE:
            m = max(m, jump / a_axis[a])
        if a < first:
            size += jump * jump
    if m == 0.0:
        return inf
    v2 = shorter / m
    if size > 0.0:
        v2 = min(v2, 8.0 * deviation / (m * sqrt(size)))
    return sqrt(v2)


@kernel
def _circle_velocity(cosine: float, accel: float, deviation: float, shorter: float) -> float:
    """The centripetal model of grbl and Klipper (published in Klipper's Kinematics page), scalar acceleration.

    A circle that touches both segments and stays within `deviation` of the corner has the radius r; h is half
    of the angle between the incoming direction reversed and the outgoing one.  Klipper also asks that the
    segments themselves, taken as chords of a circle, respect the acceleration:

        v² <= a d sin h / (1 - sin h)     v² <= a (L / 2) tan h
    """
    if cosine >= _STRAIGHT:
        return inf
    sine = sqrt(0.5 * max(1.0 + cosine, 0.0))  # sin h = cos(bend / 2)
    other = sqrt(0.5 * (1.0 - cosine))
    return sqrt(min(accel * deviation * sine / (1.0 - sine), 0.5 * shorter * accel * sine / other))


@kernel
def junctions(
    kind: Kinds, length: Floats, v_limit: Floats, accel: Floats, t_start: Floats, t_end: Floats, a_axis: Floats,
    steps: Floats, chord: float, cycle: float, rule: int, deviation: float, rapid_stops: int, v_junction: Floats,
) -> int:  # fmt: skip
    """Writes to v_junction (n,) what the junction after each row allows; 0 after the last row.

    Bend above the angle tolerance, as chord 2 sin(angle / 2): 0.  Positionings (if rapid_stops), jumps, dwells
    and M functions stop before and after; rows without length do not count: the junction is between their
    neighbours and the rows themselves take its limit.  Returns the number of leading rows whose junction is
    known: the last row that moves waits for the next one.
    """
    n = len(kind)
    last = -1  # latest row that moves
    for j in range(n):
        v_junction[j] = 0.0
        if kind[j] >= _SET_POSITION:
            last = -1
            continue
        if length[j] <= 0.0:
            continue
        stops = rapid_stops == 1 and last >= 0 and (kind[last] == _POSITIONING or kind[j] == _POSITIONING)
        if last >= 0 and not stops:
            shorter = min(float(length[last]), float(length[j]))
            span = 0.5 * (float(length[last]) + float(length[j]))
            bend2, cosine = _bend(t_end, t_start, last, j)
            v = 0.0
            if bend2 <= chord * chord:
                v = _step_velocity(t_end, t_start, last, j, steps, shorter, span, cycle)
                if rule == PARABOLA:
                    v = min(v, _parabola_velocity(t_end, t_start, last, j, a_axis, deviation, shorter))
                elif rule == CIRCLE:
                    v = min(v, _circle_velocity(cosine, min(accel[last], accel[j]), deviation, shorter))
            v = min(v, float(v_limit[last]), float(v_limit[j]))
            for row in range(last, j):
                v_junction[row] = v
        last = j
    return last if last >= 0 else n
