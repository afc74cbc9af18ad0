"""The rate at which a third-order plan's time runs: overrides and setting off from a stop.

At rate r the path is run at r v, with acceleration r² a + r' v and jerk r³ j + 3 r r' a + r'' v (v, a, j: the plan's).
A constant rate of at most 1 is inside every limit that the plan keeps.  A change of rate is one S-shaped ramp

    r    r0 + dr  ______        r'' = k, 0, -k over ramp, level, ramp seconds;  k = dr / (ramp (ramp + level))
    r0  ____/

that begins only after the rows ahead have been asked: the motion with it is compared with the limits of every row
that it touches.  If the sharpest change does not fit, gentler ones are tried.
"""

from __future__ import annotations

from math import sqrt

from nccompile.kernels import kernel
from nccompile.kernels.interpolator_rows import Rows
from nccompile.kernels.timelaw import constant_jerk, jerk_distance, jerk_velocity

__all__ = ["FITS", "OPEN", "TOO_SHARP", "change_fits", "find_change", "plan_time", "rate_at", "time_at"]

FITS, TOO_SHARP, OPEN = 0, 1, 2
"""A change is inside the limits; it is not; the rows that would tell are still to come."""

_STEPS = 64
"""Places at which a change is compared with the limits, besides all ends of rows."""

_FEWEST = 3
"""Places that a change has to have before a stop of the plan: fewer cannot tell what happens on the way there."""

_SWING, _PLACES = 0.05, 32
"""Rows that swing the acceleration by more than this part of the limit are looked at in so many places each."""

_BESIDE = 1e-9
"""Part of a time by which a place is just before it."""

_ROOM = 0.05
"""Part of a change's own acceleration and jerk that is kept free for what happens between those places."""

_SLACK = 1e-8
"""Relative rounding room of a limit."""

_SPARE = 1e-4
"""Part of a limit that a change leaves, for the same reason as `_ROOM`."""

_GENTLER = 0.7
"""Factor from one try to the next."""


@kernel
def rate_at(t: float, r0: float, dr: float, ramp: float, level: float) -> tuple[float, float, float]:
    """Rate and its first two derivatives `t` seconds after the start of a change; after its end they are constant."""
    if t >= 2.0 * ramp + level:
        return r0 + dr, 0.0, 0.0
    slope = dr / (ramp + level)
    k = slope / ramp
    if t < ramp:
        return r0 + 0.5 * k * t * t, k * t, k
    if t < ramp + level:
        return r0 + slope * (t - 0.5 * ramp), slope, 0.0
    rest = 2.0 * ramp + level - t
    return r0 + dr - 0.5 * k * rest * rest, k * rest, -k


@kernel
def plan_time(t: float, r0: float, dr: float, ramp: float, level: float) -> float:
    """The plan's time that passes in the first `t` seconds of a change: the integral of `rate_at`."""
    whole = 2.0 * ramp + level
    if t >= whole:
        return (r0 + 0.5 * dr) * whole + (r0 + dr) * (t - whole)
    slope = dr / (ramp + level)
    k = slope / ramp
    if t < ramp:
        return t * (r0 + k * t * t / 6.0)
    if t < ramp + level:
        return r0 * t + slope * (0.5 * t * (t - ramp) + ramp * ramp / 6.0)
    rest = whole - t
    return (r0 + 0.5 * dr) * whole - rest * ((r0 + dr) - k * rest * rest / 6.0)


@kernel
def time_at(s: float, v0: float, a0: float, jerk: float, total: float) -> float:
    """The time at which a constant jerk has covered `s`, in 0..total; the velocity is not negative there."""
    low, high = 0.0, total
    t = 0.5 * total
    for _ in range(100):
        off = jerk_distance(t, v0, a0, jerk) - s
        if off > 0.0:
            high = t
        else:
            low = t
        v = jerk_velocity(t, v0, a0, jerk)
        nearer = t - off / v if v > 0.0 else low
        if not low < nearer < high:
            nearer = 0.5 * (low + high)
        if abs(nearer - t) <= 1e-15 * total:
            return nearer
        t = nearer
    return t


@kernel
def _inside(
    v: float, a: float, j: float, r: float, r1: float, r2: float,
    limit: float, accel: float, decel: float, jerk: float,
) -> bool:  # fmt: skip
    """Whether a plan's state at a rate is inside a row's limits; at a constant rate of at most 1 it is."""
    changes = r1 != 0.0 or r2 != 0.0
    if r <= 1.0 and not changes:
        return True
    if r > 1.0 and r * v > limit * (1.0 + _SLACK):
        return False
    part = 1.0 - _SPARE if changes else 1.0 + _SLACK
    own = r1 * v
    room = _ROOM * abs(own)
    reached = r * r * a + own
    if reached + room > accel * part or room - reached > decel * part:
        return False
    turn, bend = 3.0 * r * r1 * a, r2 * v
    room = _ROOM * (abs(turn) + abs(bend))
    return abs(r * r * r * j + turn + bend) + room <= jerk * part


@kernel
def change_fits(
    rows: Rows, row: int, tau: float, v0: float, a0: float, tail: int, complete: int,
    hold: float, r0: float, dr: float, ramp: float, level: float,
) -> tuple[int, int, float, float, float]:  # fmt: skip
    """Whether a change of rate, begun after `hold` seconds at r0, keeps the limits of the rows it touches.

    From the plan's time `tau` in `row`, which the plan enters with v0 and a0.  Returns FITS, TOO_SHARP or OPEN, and
    where the plan is at the end of the change: row, time in it, its v0 and a0.  A change that reaches a stop of
    the plan fits, since at rest the rate may be anything, but it has to begin `_FEWEST` places before the stop.
    """
    v1, a1 = rows.v_end[row], rows.a_end[row]
    total, j = constant_jerk(rows.length[row], v0, v1, a0, a1)
    end = 2.0 * ramp + level
    tau += r0 * hold
    gone = -tau  # the plan's time at the start of the row, counted from now
    r, r1, r2 = r0, 0.0, 0.0
    t = 0.0
    places = 0
    while True:
        before, before1, before2 = r, r1, r2
        r, r1, r2 = rate_at(t, r0, dr, ramp, level)
        goal = plan_time(t, r0, dr, ramp, level)
        while goal - gone > total:
            # An end of a row between two places: what the change does at either of them may happen there.
            limit, up, down, most = rows.v_limit[row], rows.accel[row], rows.decel[row], rows.jerk[row]
            if not (
                _inside(v1, a1, j, before, before1, before2, limit, up, down, most)
                and _inside(v1, a1, j, r, r1, r2, limit, up, down, most)
            ):
                return TOO_SHARP, row, 0.0, 0.0, 0.0
            row += 1
            if v1 == 0.0 or (row >= tail and complete == 1):
                return FITS if places > _FEWEST or r0 == 0.0 else TOO_SHARP, row, 0.0, 0.0, 0.0
            if row >= tail:
                return OPEN, row, 0.0, 0.0, 0.0
            gone += total
            v0, a0, v1, a1 = v1, a1, rows.v_end[row], rows.a_end[row]
            total, j = constant_jerk(rows.length[row], v0, v1, a0, a1)
            limit, up, down, most = rows.v_limit[row], rows.accel[row], rows.decel[row], rows.jerk[row]
            if not (
                _inside(v0, a0, j, before, before1, before2, limit, up, down, most)
                and _inside(v0, a0, j, r, r1, r2, limit, up, down, most)
            ):
                return TOO_SHARP, row, 0.0, 0.0, 0.0
        at = goal - gone
        v = jerk_velocity(at, v0, a0, j)
        if not _inside(
            v, a0 + at * j, j, r, r1, r2, rows.v_limit[row], rows.accel[row], rows.decel[row], rows.jerk[row]
        ):
            return TOO_SHARP, row, 0.0, 0.0, 0.0
        if t >= end:
            break
        places += 1
        step = end / _STEPS
        if abs(a1 - a0) > _SWING * rows.accel[row]:
            step = min(step, total / _PLACES)
        # r'' jumps at the ends of the three parts of a change: a place just before each and one on it.
        edge = ramp if t < ramp else (ramp + level if t < ramp + level else end)
        beside = edge * (1.0 - _BESIDE)
        t = min(t + step, beside if t < beside else edge)
    goal = plan_time(end, r0, dr, ramp, level)
    return FITS, row, goal - gone, v0, a0


@kernel
def find_change(
    rows: Rows, row: int, tau: float, v0: float, a0: float, tail: int, complete: int,
    hold: float, r0: float, r1: float, cycle: float, tries: int,
) -> tuple[int, float, float]:  # fmt: skip
    """The sharpest change from rate r0 to r1 that fits of `tries`: FITS, TOO_SHARP or OPEN, ramp, level.

    The sharpest one uses all of the row's acceleration A and jerk J at the plan's velocity v:  r' = A / v,
    r'' = J / v.  To a rate above 1 the way back to 1 has to fit after it, two cycles later.
    """
    v1, a1 = rows.v_end[row], rows.a_end[row]
    _, j = constant_jerk(rows.length[row], v0, v1, a0, a1)
    v = max(jerk_velocity(tau, v0, a0, j), v0, v1)
    if v <= 0.0:
        return TOO_SHARP, 0.0, 0.0
    dr = r1 - r0
    share = 1.0 / (1.0 + 2.0 * _ROOM)
    for _ in range(tries):
        slope = share * min(rows.accel[row], rows.decel[row]) / v
        curve = share * share * rows.jerk[row] / v
        ramp = slope / curve
        level = abs(dr) / slope - ramp
        if level < 0.0:
            ramp = sqrt(abs(dr) / curve)
            level = 0.0
        found, row1, tau1, v01, a01 = change_fits(
            rows, row, tau, v0, a0, tail, complete, hold, r0, dr, ramp, level
        )
        if found == FITS and r1 > 1.0 and tau1 > 0.0:
            found = change_fits(
                rows, row1, tau1, v01, a01, tail, complete, 2.0 * cycle, r1, 1.0 - r1, ramp, level
            )[0]
        if found != TOO_SHARP:
            return found, ramp, level
        share *= _GENTLER
    return TOO_SHARP, 0.0, 0.0
