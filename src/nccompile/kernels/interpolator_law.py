# ruff: isort: skip_file
# Fifty imported numbers in fifty lines would hide the code.
"""The law of a running row: how it begins, what phase it is in, and what a change of the inputs does to it.

Rows of second order; what third-order rows have of their own is in `kernels.interpolator_third`.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curves import tabulate
from nccompile.kernels.interpolator_rows import (
    CONTINUES, DWELL, ELLIPSE, EVENT, GO, IPO_ACCEL, IPO_CONSTANT, IPO_DECEL, LAST_SWITCH, LAW, LINE_NO, M_FUNCTION,
    M_ROW, NODES, OVERRIDE, POLYNOMIAL, QUICK, ROW, RUNNING, S0, SET_POSITION, SLOW, STOPPING, SWITCHES,
    SWITCH_NUMBERS, T1, T2, T3, TABLE_ROW, TAU, V0, V1, VP, WANTED, Floats, Inputs, Rows, S, State, V, limit_ends,
)  # fmt: skip
from nccompile.kernels.timelaw import law_times

__all__ = ["arrive", "begin", "command", "finish", "fire", "phase", "take_law"]


@kernel
def begin(rows: Rows, row: int, s0: float, v0: float, inputs: Inputs, f: Floats, i: State) -> None:
    """Sets the law for the rest of a row from path length s0 and velocity v0 on."""
    f[TAU] = 0.0
    f[S0] = s0
    f[S] = s0
    f[V] = v0
    i[RUNNING] = 1
    i[STOPPING] = inputs.stop
    length = rows.length[row] - s0
    kind = rows.kind[row]
    if kind == DWELL:
        f[T1] = f[T3] = f[V0] = f[VP] = f[V1] = 0.0
        f[T2] = rows.event_k[rows.event_begin[row]]
        return
    if length <= 0.0 or kind >= SET_POSITION:
        f[T1] = f[T2] = f[T3] = 0.0
        f[V0] = f[VP] = f[V1] = v0
        return
    decel = rows.decel[row]
    if inputs.stop == SLOW or inputs.stop == QUICK:
        if inputs.stop == QUICK:
            decel = max(decel, min(inputs.quick_decel, rows.brake[row]))
        rest2 = v0 * v0 - 2.0 * decel * length
        f[T1] = f[T2] = 0.0
        f[V0] = f[VP] = v0
        f[V1] = sqrt(rest2) if rest2 > 0.0 else 0.0
        f[T3] = (v0 - f[V1]) / decel
        return
    v_end = rows.v_now[row]
    f[WANTED] = v_end
    if inputs.single_step == 1 and (rows.profile[row] >> CONTINUES) & 1 == 0:
        v_end = 0.0
    take_law(length, v0, rows.feed[row], rows.v_limit[row], v_end, rows.accel[row], decel, f)


@kernel
def take_law(
    length: float, v0: float, feed: float, v_limit: float, v_end: float, accel: float, decel: float, f: Floats
) -> None:
    """Loads the law over `length` from v0 to v_end, as fast as the feed with its override and v_limit allow."""
    v_top = min(f[OVERRIDE] * feed, v_limit)
    f[T1], f[T2], f[T3], f[VP], f[V1] = law_times(length, v0, v_top, v_end, accel, decel)
    f[V] = f[V0] = v0


@kernel
def arrive(rows: Rows, row: int, i: State, nodes_u: Floats, nodes_s: Floats) -> None:
    """The set position comes to a row: tabulates its curve, rewinds its events."""
    kind = rows.kind[row]
    if (kind == ELLIPSE or kind == POLYNOMIAL) and i[TABLE_ROW] != row:
        i[NODES] = tabulate(kind, rows.parameters[rows.curve[row]], nodes_u, nodes_s)
        i[TABLE_ROW] = row
    i[EVENT] = rows.event_begin[row]
    i[LINE_NO] = rows.line[row]
    i[M_ROW] = -1


@kernel
def fire(
    rows: Rows, row: int, s: float, cycle: int, i: State, log: npt.NDArray[np.int64], logged: int
) -> int:  # fmt: skip
    """Sets the switches whose position is reached at path length `s`; returns the new fill of the log.

    A log row is (cycle of this call, switch number, source line).
    """
    share = 1.0 if s >= rows.length[row] else s / rows.length[row]
    e = i[EVENT]
    while e < rows.event_end[row]:
        if rows.event_kind[e] == 0:
            if rows.event_position[e] > share:
                break
            number = int(rows.event_number[e])
            i[LAST_SWITCH] = number
            if 0 < number <= SWITCH_NUMBERS:
                i[SWITCHES] |= 1 << (number - 1)
            elif -SWITCH_NUMBERS <= number < 0:
                i[SWITCHES] &= ~(1 << (-number - 1))
            if logged < log.shape[0]:
                log[logged, 0] = cycle
                log[logged, 1] = number
                log[logged, 2] = rows.line[row]
                logged += 1
        e += 1
    i[EVENT] = e
    return logged


@kernel
def finish(
    rows: Rows, row: int, cycle: int, i: State, here: Floats, log: npt.NDArray[np.int64], logged: int
) -> int:  # fmt: skip
    """The set position comes to the end of a row: fires its last switches; returns the new fill of the log."""
    kind = rows.kind[row]
    if kind != DWELL and kind != M_FUNCTION:
        for a in range(len(here)):
            here[a] = rows.target[row, a]
    return fire(rows, row, rows.length[row], cycle, i, log, logged)


@kernel
def phase(f: Floats) -> int:
    """The status a running law has at its present time."""
    if f[TAU] < f[T1]:
        return IPO_ACCEL if f[VP] >= f[V0] else IPO_DECEL
    if f[TAU] <= f[T1] + f[T2]:
        return IPO_CONSTANT
    return IPO_DECEL


@kernel
def command(rows: Rows, inputs: Inputs, tail: int, complete: int, f: Floats, i: State) -> int:
    """Takes over changed inputs at the start of a cycle.

    A stop or its release acts at once, and so do rows that came late (the end velocity may rise again).
    Override and velocity mode wait until no ramp is in progress (SoftMotion §6.2.8): in cruise, or at rest.
    Returns the row up to which end velocities are settled after a new override, else -1.
    """
    row = i[ROW]
    settled = -1
    moving = i[RUNNING] == 1 and rows.kind[row] < SET_POSITION
    again = False
    if f[OVERRIDE] != inputs.override or i[LAW] != inputs.law:
        cruising = f[T2] > 0.0 and f[TAU] >= f[T1] and f[TAU] <= f[T1] + f[T2]
        if f[V] == 0.0 or i[RUNNING] == 0 or cruising:
            f[OVERRIDE] = inputs.override
            i[LAW] = inputs.law
            settled = row + limit_ends(rows, row, tail, complete, f[OVERRIDE])
            again = True
    if not moving:
        return settled
    if i[STOPPING] != inputs.stop:
        again = True
    elif inputs.stop == GO:
        if inputs.single_step == 1 and f[V1] > 0.0 and (rows.profile[row] >> CONTINUES) & 1 == 0:
            again = again or f[V] * f[V] <= 2.0 * rows.decel[row] * (rows.length[row] - f[S])
        elif rows.v_now[row] > f[WANTED]:
            again = True
    if again and f[S] < rows.length[row]:
        begin(rows, row, f[S], f[V], inputs, f, i)
    return settled
