# ruff: isort: skip_file
# Fifty imported numbers in fifty lines would hide the code.
"""Rows of third-order plans: how they begin, set off, stop, and what commands do to them.

    PLANNED --override--> SCALED           the plan at another rate           (`kernels.interpolator_rate`)
       |  <--------------   |
       +------stop----------+--> TABLE --> STOPPED --release--> SCALED at a rate that rises from 0
                                   ^          |
                                   +---step---+                               (`kernels.interpolator_stop`)

A stop acts as soon as one from the present velocity and acceleration fits, and once begun it is brought to rest.
An override up to 1 is the rate; it is taken over as soon as a change fits.  One above 1 raises the rate where the
plan does not accelerate, as far as the limits allow, and lets it back to 1 before the next ramp.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.interpolator_law import arrive, finish
from nccompile.kernels.interpolator_rate import (
    FITS, OPEN, TOO_SHARP, find_change, plan_time, rate_at, time_at,
)  # fmt: skip
from nccompile.kernels.interpolator_rows import (
    A0, A1, GO, IPO_ACCEL, IPO_CONSTANT, IPO_DECEL, JERK, MODE, PHASE, PHASES, PHASE_COUNT, PLANNED, PLAN_A,
    PLAN_V, RATE, RATE_BY, RATE_FROM, RATE_LEVEL, RATE_RAMP, RATE_TIME, ROW, RUNNING, S0, SCALED, SLOW, STARVED,
    STOPPED, STOPPING, T1, T2, T3, TABLE, TAU, V0, V1, A, Floats, Inputs, Rows, S, State, V,
)  # fmt: skip
from nccompile.kernels.interpolator_stop import plan_step, plan_stop
from nccompile.kernels.timelaw import constant_jerk, jerk_state, jerk_velocity

__all__ = [
    "begin_planned", "command_third", "leave", "pace", "phase_third", "run_table", "sense", "set_off",
    "take_plan",
]  # fmt: skip

_TRIES = 10
"""Changes of the rate that are tried in a cycle, each 0.7 times as sharp as the one before."""

_TRIES_AT_REST = 40
"""The same for setting off: something has to fit."""

_NEARLY = 0.9
"""Part of the rate that is set off to where the rate itself does not fit: below 1 there is always room."""

_GOALS, _LESS = 8, 0.5
"""Rates that are set off to, and the factor to the next where the rows for one are not there yet."""

_LANDING = 1e-9
"""Part of a row (and mm) by which a table may end beside the end of the row it was made for."""


@kernel
def begin_planned(rows: Rows, row: int, s: float, f: Floats, i: State) -> None:
    """The plan's constant jerk of a row, at path length s of it."""
    take_plan(rows.length[row], rows.v_end[row], rows.a_end[row], f)
    if s > 0.0:
        v0, a0, jerk = f[V0], f[A0], f[JERK]
        tau = time_at(s, v0, a0, jerk, f[T2])
        f[TAU], f[S] = tau, s
        f[V], f[A] = jerk_velocity(tau, v0, a0, jerk), a0 + tau * jerk
    i[RUNNING] = 1


@kernel
def take_plan(length: float, v1: float, a1: float, f: Floats) -> None:
    """Loads the plan's constant jerk of a row of `length` to the end (v1, a1), at the row's start."""
    v0, a0 = f[PLAN_V], f[PLAN_A]
    f[TAU] = f[T1] = f[T3] = f[S0] = f[S] = 0.0
    f[T2], f[JERK] = constant_jerk(length, v0, v1, a0, a1)
    f[V], f[A] = v0, a0
    f[V0], f[A0], f[V1], f[A1] = v0, a0, v1, a1


@kernel
def leave(rows: Rows, row: int, f: Floats) -> None:
    """The set position leaves a row: remembers how the plan does."""
    f[PLAN_V], f[PLAN_A] = rows.v_end[row], rows.a_end[row]


@kernel
def _set_rate(rate: float, f: Floats, i: State) -> None:
    f[RATE] = rate
    f[RATE_TIME] = -1.0
    i[MODE] = PLANNED if rate == 1.0 else SCALED


@kernel
def _change_rate(by: float, ramp: float, level: float, f: Floats, i: State) -> None:
    f[RATE_FROM], f[RATE_BY], f[RATE_RAMP], f[RATE_LEVEL], f[RATE_TIME] = f[RATE], by, ramp, level, 0.0
    i[MODE] = SCALED


@kernel
def _take_table(v: float, a: float, stop: int, f: Floats, i: State) -> None:
    """Begins to run the table, from the present place."""
    f[V], f[A] = v, a
    f[S0] = f[S]
    f[RATE_TIME] = -1.0
    f[RATE] = 0.0
    i[MODE] = TABLE
    i[STOPPING] = stop
    i[PHASE] = -1
    _next_phase(f, i)


@kernel
def _next_phase(f: Floats, i: State) -> bool:
    """Loads the next phase of the table; False: there is none, the motion is at rest."""
    n = i[PHASE] + 1
    i[PHASE] = n
    if n >= i[PHASE_COUNT]:
        f[V] = f[A] = 0.0
        i[MODE] = STOPPED
        return False
    f[TAU] = f[T1] = f[T3] = 0.0
    f[T2], f[JERK] = f[PHASES + 2 * n], f[PHASES + 2 * n + 1]
    f[V0], f[A0], f[S0] = f[V], f[A], f[S]
    return True


@kernel
def set_off(rows: Rows, inputs: Inputs, tail: int, complete: int, f: Floats, i: State) -> int:
    """At rest on a row: begins a single step, or the plan again.  OPEN: rows to come would have to be known."""
    row = i[ROW]
    i[STARVED] = 0
    if inputs.single_step == 1:
        found = plan_step(rows, row, f[S], inputs.override, tail, f, i)
        if found == FITS:
            _take_table(0.0, 0.0, GO, f, i)
        return found
    goal = min(inputs.override, 1.0)
    if complete == 0 and inputs.patient == 0 and rows.v_end[row] > 0.0:
        goal = _stoppable(rows, row, goal, inputs.cycle, tail, f, i)
        if goal == 0.0:
            i[STARVED] = 1
            return OPEN
    begin_planned(rows, row, f[S], f, i)
    if f[V] == 0.0 and f[A] == 0.0:  # the plan rests here too
        _set_rate(goal, f, i)
        return FITS
    f[RATE] = 0.0
    found = TOO_SHARP
    for part in range(_GOALS):
        found, ramp, level = find_change(
            rows,
            row,
            f[TAU],
            f[PLAN_V],
            f[PLAN_A],
            tail,
            complete,
            0.0,
            0.0,
            goal,
            inputs.cycle,
            _TRIES_AT_REST,
        )
        if found == OPEN and inputs.patient == 1:
            break
        if found == FITS or (found == OPEN and part == _GOALS - 1):
            _change_rate(goal, ramp, level, f, i)
            return FITS
        goal *= _NEARLY if found == TOO_SHARP else _LESS
    f[V] = 0.0
    return found


@kernel
def _stoppable(rows: Rows, row: int, rate: float, cycle: float, tail: int, f: Floats, i: State) -> float:
    """The rate, or the greatest of some below it, from which a stop a cycle behind a row fits into the rows at hand.

    0.0 if it does from none of them.
    """
    length = rows.length[row]
    for _ in range(_GOALS):
        v, a = rate * rows.v_end[row], rate * rate * rows.a_end[row]
        v, a = _next_at_most(rows, row, length, v, a, cycle, tail)
        if plan_stop(rows, row, length, v, a, SLOW, 0.0, v * cycle, tail, f, i) != OPEN:
            return rate
        rate *= _LESS
    return 0.0


@kernel
def command_third(rows: Rows, inputs: Inputs, tail: int, complete: int, f: Floats, i: State) -> int:
    """Takes over the inputs at the start of a cycle on a row that runs as planned or at a rate.

    Returns OPEN if rows that are still to come would have to be known, else FITS.
    """
    row = i[ROW]
    r, r1 = f[RATE], 0.0
    if f[RATE_TIME] >= 0.0:
        r, r1, _ = rate_at(f[RATE_TIME], f[RATE_FROM], f[RATE_BY], f[RATE_RAMP], f[RATE_LEVEL])
    v = r * f[V]
    a = r * r * f[A] + r1 * f[V]
    stop = inputs.stop
    if stop == GO and inputs.single_step == 1:
        stop = SLOW
    if stop != GO:
        if v <= 0.0:
            return FITS
        found = plan_stop(rows, row, f[S], v, a, stop, inputs.quick_decel, 0.0, tail, f, i)
        if found == FITS:
            _take_table(v, a, stop, f, i)
        return OPEN if found == OPEN and complete == 0 else FITS
    if complete == 0 and inputs.patient == 0 and v > 0.0:
        v_next, a_next = _next_at_most(rows, row, f[S], v, a, inputs.cycle, tail)
        reserve = v_next * inputs.cycle
        if plan_stop(rows, row, f[S], v_next, a_next, SLOW, 0.0, reserve, tail, f, i) == OPEN and (
            plan_stop(rows, row, f[S], v, a, SLOW, 0.0, 0.0, tail, f, i) == FITS
        ):
            i[STARVED] = 1
            _take_table(v, a, SLOW, f, i)
            return FITS
    if f[RATE_TIME] >= 0.0:
        return FITS
    return _choose_rate(rows, inputs, tail, complete, f, i)


@kernel
def _next_at_most(
    rows: Rows, row: int, s: float, v: float, a: float, cycle: float, tail: int
) -> tuple[float, float]:
    """Velocity and acceleration that a cycle from path length s of a row on cannot exceed."""
    jerk, left = rows.jerk[row], rows.length[row] - s
    while True:
        a_next = a + jerk * cycle
        v_next = v + max(a_next, 0.0) * cycle
        if left >= v_next * cycle or row + 1 >= tail:
            return v_next, a_next
        row += 1
        left += rows.length[row]
        jerk = max(jerk, rows.jerk[row])


@kernel
def _choose_rate(rows: Rows, inputs: Inputs, tail: int, complete: int, f: Floats, i: State) -> int:
    """Begins a change of the rate where one is wanted and fits; from above 1 it goes back before it has to."""
    row, rate = i[ROW], f[RATE]
    top = max(f[V], f[V1])
    wanted = inputs.override
    if wanted > 1.0 and top > 0.0:
        wanted = max(1.0, min(wanted, rows.v_limit[row] / top))
    if rate > 1.0:
        cycle = inputs.cycle
        found, ramp, level = find_change(
            rows, row, f[TAU], f[PLAN_V], f[PLAN_A], tail, complete, cycle, rate, 1.0, cycle, _TRIES
        )
        if found == OPEN and inputs.patient == 1:
            return OPEN
        if found != FITS:  # it fitted a cycle ago, from here
            _change_rate(1.0 - rate, f[RATE_RAMP], f[RATE_LEVEL], f, i)
            return FITS
        f[RATE_RAMP], f[RATE_LEVEL] = ramp, level
    elif wanted > 1.0 and rate < 1.0:
        wanted = 1.0
    if wanted == rate or (wanted > 1.0 and (f[A] != 0.0 or f[JERK] != 0.0)):
        return FITS
    for part in range(3):
        goal = rate + (wanted - rate) * (1.0 - 0.4 * part)
        if part == 0:
            goal = wanted
        found, ramp, level = find_change(
            rows, row, f[TAU], f[PLAN_V], f[PLAN_A], tail, complete, 0.0, rate, goal, inputs.cycle, _TRIES
        )
        if found == OPEN and inputs.patient == 1:
            return OPEN
        if found == FITS:
            _change_rate(goal - rate, ramp, level, f, i)
            return FITS
        if found == TOO_SHARP and wanted <= max(rate, 1.0):
            break
    return FITS


@kernel
def pace(cycle: float, f: Floats, i: State) -> float:
    """The plan's time that passes in this cycle, a part of the cycle; goes on with a change of the rate."""
    if i[MODE] != SCALED:
        return 1.0
    if f[RATE_TIME] < 0.0:
        return float(f[RATE])
    t, r0, dr, ramp, level = f[RATE_TIME], f[RATE_FROM], f[RATE_BY], f[RATE_RAMP], f[RATE_LEVEL]
    passed = plan_time(t + cycle, r0, dr, ramp, level) - plan_time(t, r0, dr, ramp, level)
    if t + cycle >= 2.0 * ramp + level:
        goal = r0 + dr
        _set_rate(1.0 if abs(goal - 1.0) < 1e-12 else goal, f, i)
    else:
        f[RATE_TIME] = t + cycle
        f[RATE] = rate_at(t + cycle, r0, dr, ramp, level)[0]
    return passed / cycle


@kernel
def phase_third(f: Floats, i: State) -> int:
    """The status of a running row: by the sign of the acceleration, also where the rate makes it."""
    a = f[A]
    if i[MODE] == SCALED and f[RATE_TIME] >= 0.0:
        r, r1, _ = rate_at(f[RATE_TIME], f[RATE_FROM], f[RATE_BY], f[RATE_RAMP], f[RATE_LEVEL])
        a = r * r * a + r1 * f[V]
    return sense(a)


@kernel
def sense(a: float) -> int:
    """The status of a third-order row that runs with the acceleration a."""
    if a == 0.0:
        return IPO_CONSTANT
    return IPO_ACCEL if a > 0.0 else IPO_DECEL


@kernel
def run_table(
    rows: Rows, left: float, tail: int, cycle: int, f: Floats, i: State, nodes_u: Floats, nodes_s: Floats,
    here: Floats, log: npt.NDArray[np.int64], logged: int,
) -> tuple[float, float, int]:  # fmt: skip
    """Runs the table for `left` seconds or to its end; returns the time that is left, the way, and the log's fill.

    At its end the motion is STOPPED on a row, or the row is done (RUNNING is 0).
    """
    covered = 0.0
    while i[MODE] == TABLE:
        tau = min(f[TAU] + left, f[T2])
        left -= tau - f[TAU]
        f[TAU] = tau
        way, f[V], f[A] = jerk_state(tau, f[V0], f[A0], f[JERK])
        s = f[S0] + way
        ends = tau >= f[T2]
        last = ends and i[PHASE] + 1 >= i[PHASE_COUNT]
        row = i[ROW]
        while s > rows.length[row] and row + 1 < tail:
            length = rows.length[row]
            if last and s - length <= _LANDING * (1.0 + length):
                break
            logged = finish(rows, row, cycle, i, here, log, logged)
            covered += length - f[S]
            leave(rows, row, f)
            f[S] = 0.0
            f[S0] -= length
            s -= length
            row += 1
            i[ROW] = row
            arrive(rows, row, i, nodes_u, nodes_s)
        s = min(max(s, f[S]), rows.length[row])
        covered += s - f[S]
        f[S] = s
        if not ends:
            return 0.0, covered, logged
        if not _next_phase(f, i):
            if rows.length[row] - s <= _LANDING * (1.0 + rows.length[row]):
                covered += rows.length[row] - s
                logged = finish(rows, row, cycle, i, here, log, logged)
                leave(rows, row, f)
                f[S] = 0.0
                i[ROW] = row + 1
                i[RUNNING] = 0
            return left, covered, logged
    return left, covered, logged
