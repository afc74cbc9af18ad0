# ruff: isort: skip_file
# Fifty imported numbers in fifty lines would hide the code.
"""Stops and single steps of third-order plans: tables of constant jerks that replace the plan.

    a    |\\              a stop from (v, a):   -J until -D,  hold,  +J until v = a = 0
         +-\\----------/-
            \\________/   a single step:         from rest to rest over the segment, seven phases

Deceleration and jerk are the least of the rows on the way, and the velocities are compared with the limits at every
end of a row before a stop begins.  Where it does not fit (the plan brakes harder into rows that allow less) the plan
goes on and is asked again in the next cycle.
"""

from __future__ import annotations

from math import sqrt

from nccompile.kernels import kernel
from nccompile.kernels.interpolator_rate import FITS, OPEN, TOO_SHARP, time_at
from nccompile.kernels.interpolator_rows import (
    CONTINUES, PHASE, PHASES, PHASE_COUNT, QUICK, Floats, Rows, State,
)  # fmt: skip
from nccompile.kernels.timelaw import jerk_distance, jerk_velocity

__all__ = ["brake_phases", "cube_root", "plan_step", "plan_stop", "step_phases"]

_SLACK = 1e-8


@kernel
def brake_phases(v: float, a: float, decel: float, jerk: float) -> tuple[bool, float, float, float, float]:
    """The shortest stop from velocity v and acceleration a:  (possible, t1, j1, t2, t3), jerks j1, 0, jerk.

    Peak -p without a hold:  v + a²/2J = p²/J.  With one:  p = D,  D t2 = v + dv1 - D²/2J.
    Not possible if the acceleration cannot come back to 0 before the velocity does:  v < a²/2J, a < 0.
    """
    if a < 0.0 and 2.0 * jerk * v < a * a * (1.0 - _SLACK):
        return False, 0.0, 0.0, 0.0, 0.0
    peak = sqrt(max(jerk * v + 0.5 * a * a, 0.0))
    if peak <= decel:
        t1 = max((a + peak) / jerk, 0.0)
        return True, t1, -jerk, 0.0, peak / jerk
    j1 = -jerk if a >= -decel else jerk
    t1 = (-decel - a) / j1
    slower = v + 0.5 * (a - decel) * t1 - 0.5 * decel * decel / jerk
    if slower < 0.0:
        return False, 0.0, 0.0, 0.0, 0.0
    return True, t1, j1, slower / decel, decel / jerk


@kernel
def _put(f: Floats, i: State, t: float, jerk: float) -> None:
    """Appends a phase to the table."""
    n = i[PHASE_COUNT]
    f[PHASES + 2 * n] = t
    f[PHASES + 2 * n + 1] = jerk
    i[PHASE_COUNT] = n + 1


@kernel
def _way(f: Floats, i: State, v: float, a: float) -> float:
    """The length of the table's motion from v and a."""
    s = 0.0
    for n in range(i[PHASE_COUNT]):
        t, jerk = f[PHASES + 2 * n], f[PHASES + 2 * n + 1]
        s += jerk_distance(t, v, a, jerk)
        v = jerk_velocity(t, v, a, jerk)
        a += t * jerk
    return s


@kernel
def _velocity_after(f: Floats, i: State, v: float, a: float, s: float) -> float:
    """The velocity of the table's motion after the path length s."""
    for n in range(i[PHASE_COUNT]):
        t, jerk = f[PHASES + 2 * n], f[PHASES + 2 * n + 1]
        covered = jerk_distance(t, v, a, jerk)
        if covered >= s:
            return jerk_velocity(time_at(s, v, a, jerk, t), v, a, jerk)
        s -= covered
        v = jerk_velocity(t, v, a, jerk)
        a += t * jerk
    return 0.0


@kernel
def _braking(rows: Rows, row: int, stop: int, quick_decel: float) -> float:
    """The deceleration of a stop on a row: a quick one may use what the axes have left."""
    if stop == QUICK:
        return float(max(rows.decel[row], min(quick_decel, rows.brake[row])))
    return float(rows.decel[row])


@kernel
def plan_stop(
    rows: Rows, row: int, s: float, v: float, a: float, stop: int, quick_decel: float, reserve: float,
    tail: int, f: Floats, i: State,
) -> int:  # fmt: skip
    """Makes the table of a stop from path length s of a row, velocity v and acceleration a.

    reserve: length of path that is to be left over.  Returns FITS; TOO_SHARP if it does not fit into the limits or
    the plan itself stops sooner; OPEN if rows that are still to come would have to be known.
    """
    decel, jerk = _braking(rows, row, stop, quick_decel), rows.jerk[row]
    far, ahead = row, rows.length[row] - s
    while True:
        possible, t1, j1, t2, t3 = brake_phases(v, a, decel, jerk)
        if not possible:
            return TOO_SHARP
        i[PHASE] = i[PHASE_COUNT] = 0
        _put(f, i, t1, j1)
        _put(f, i, t2, 0.0)
        _put(f, i, t3, jerk)
        way = _way(f, i, v, a)
        if way + reserve <= ahead:
            break
        if rows.v_end[far] == 0.0:
            return TOO_SHARP
        far += 1
        if far >= tail:
            return OPEN
        enters = way > ahead  # else it only has to be known
        ahead += rows.length[far]
        if enters:
            decel = min(decel, _braking(rows, far, stop, quick_decel))
            jerk = min(jerk, rows.jerk[far])
    peak = v + 0.5 * a * a / jerk if a > 0.0 else v
    top = _way_to_peak(v, a, jerk)
    begin, v_begin = -s, v
    for at in range(row, far + 1):
        end = begin + rows.length[at]
        v_after = _velocity_after(f, i, v, a, end) if end < way else 0.0
        most = peak if top >= begin and top <= end else max(v_begin, v_after)
        if most > rows.v_limit[at] * (1.0 + _SLACK) and most > v * (1.0 + _SLACK):
            return TOO_SHARP
        if end < way and v_after > rows.v_junction[at] * (1.0 + _SLACK):
            return TOO_SHARP
        begin, v_begin = end, v_after
    return FITS


@kernel
def _way_to_peak(v: float, a: float, jerk: float) -> float:
    """The path length after which a stop no longer speeds up."""
    return jerk_distance(a / jerk, v, a, -jerk) if a > 0.0 else 0.0


@kernel
def cube_root(x: float) -> float:
    """The cube root of a number above 0, by Newton's method."""
    y = sqrt(sqrt(x)) if x < 1.0 else x / 3.0 + 1.0
    for _ in range(200):
        nearer = (2.0 * y + x / (y * y)) / 3.0
        if abs(nearer - y) <= 1e-15 * y:
            return nearer
        y = nearer
    return y


@kernel
def step_phases(length: float, top: float, accel: float, jerk: float) -> tuple[float, float, float, float]:
    """The fastest motion from rest to rest:  (jerk of its ramps, their time, their hold, time at the top).

    A ramp to v with a hold lasts v/A + A/J, without one 2 sqrt(v/J); both cover v/2 times that.
    """
    v = top
    if v * jerk >= accel * accel:
        ramp = v / accel + accel / jerk
    else:
        ramp = 2.0 * sqrt(v / jerk)
    cruise = 0.0
    if v * ramp <= length:
        cruise = (length - v * ramp) / v
    else:
        # v (v/A + A/J) = L, or where there is no hold  2 J t³ = L
        t0 = accel / jerk
        v = 0.5 * accel * (sqrt(t0 * t0 + 4.0 * length / accel) - t0)
        if v * jerk < accel * accel:
            t = cube_root(0.5 * length / jerk)
            return jerk, t, 0.0, 0.0
    if v * jerk >= accel * accel:
        t = accel / jerk
        return jerk, t, v / accel - t, cruise
    t = sqrt(v / jerk)
    return jerk, t, 0.0, cruise


@kernel
def plan_step(rows: Rows, row: int, s: float, override: float, tail: int, f: Floats, i: State) -> int:
    """Makes the table of a motion from rest at path length s of a row to rest at the end of its segment.

    Returns FITS, or OPEN if the rest of the segment is still to come.
    """
    length = rows.length[row] - s
    top = min(override * rows.feed[row], rows.v_limit[row])
    accel, jerk = min(rows.accel[row], rows.decel[row]), rows.jerk[row]
    while (rows.profile[row] >> CONTINUES) & 1 == 1:
        if row + 1 >= tail:
            return OPEN
        top = min(top, rows.v_junction[row])
        row += 1
        length += rows.length[row]
        top = min(top, override * rows.feed[row], rows.v_limit[row])
        accel = min(accel, rows.accel[row], rows.decel[row])
        jerk = min(jerk, rows.jerk[row])
    j, ramp, hold, cruise = step_phases(length, top, accel, jerk)
    i[PHASE] = i[PHASE_COUNT] = 0
    _put(f, i, ramp, j)
    _put(f, i, hold, 0.0)
    _put(f, i, ramp, -j)
    _put(f, i, cruise, 0.0)
    _put(f, i, ramp, -j)
    _put(f, i, hold, 0.0)
    _put(f, i, ramp, j)
    return FITS
