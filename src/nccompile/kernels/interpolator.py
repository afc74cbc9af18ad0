# ruff: isort: skip_file
# Fifty imported numbers in fifty lines would hide the code.
"""The interpolator: from planned segments to one set position per cycle (SoftMotion §6.2.8).

    advance(rows, inputs, f, i, ..., out)     runs up to n cycles, returns how many and why it stopped

A cycle spends its time along the rows: it may finish several short ones; it ends early only where the set position
has to be seen by the outside: a jump (G92), an M function, the end, a wait.  The first cycle puts out the start
position.  State and rows are in `kernels.interpolator_rows`, places in `_place`, the laws of rows in `_law` and, for
third-order plans, in `_third`.

Whoever calls with the same rows, inputs and cycle time gets the same bits, whatever the number of cycles a
call: the offline sampler and the cyclic task differ only in who supplies rows.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curves import point
from nccompile.kernels.interpolator_enter import enter, may_leave, rest_at, shift
from nccompile.kernels.interpolator_law import arrive, begin, command, finish, fire, phase, take_law
from nccompile.kernels.interpolator_place import direction, locate
from nccompile.kernels.interpolator_rate import FITS, OPEN
from nccompile.kernels.interpolator_rows import (
    A0, A1, ABORT, ARC, AT_M, CONTINUES, ELLIPSE, EMERGENCY, EVENT, FINISHED, GO, HOLD, IPO_CONSTANT, IPO_FINISHED,
    IPO_INIT, IPO_WAIT, JERK, JUMPED, LAST_SWITCH, LAW, LINE_NO, LOG_FULL, MODE, M_FUNCTION, M_ROW, NEED_DATA, NODES,
    OVERRIDE, PLANNED, PLAN_A, PLAN_V, POLYNOMIAL, QUICK, RAN, RATE, ROW, RUNNING, S0, SCALED, SET_POSITION, SLOW,
    STARTED, STARVED, STATUS, STOPPED, STOPPING, SWITCHES, T1, T2, T3, TABLE, TABLE_ROW, TAU, V0, V1, VP, WANTED, A,
    Floats, Inputs, Rows, S, State, V, limit_ends, state_f, state_i,
)  # fmt: skip
from nccompile.kernels.interpolator_third import (
    command_third, leave, pace, phase_third, run_table, sense, set_off, take_plan,
)  # fmt: skip
from nccompile.kernels.planes import plane_axes
from nccompile.kernels.timelaw import jerk_state, law_state

__all__ = [
    "ABORT", "AT_M", "CONTINUES", "EMERGENCY", "EVENT", "FINISHED", "GO", "IPO_FINISHED", "JUMPED", "LAST_SWITCH",
    "LINE_NO", "LOG_FULL", "MODE", "M_ROW", "NEED_DATA", "NODES", "OVERRIDE", "PLANNED", "QUICK", "RAN", "ROW",
    "RUNNING", "SLOW", "STARTED", "STARVED", "STATUS", "STOPPED", "SWITCHES", "TABLE", "TABLE_ROW", "Floats", "Inputs",
    "Rows", "S", "State", "V", "advance", "direction", "limit_ends", "locate", "rest_at", "shift", "state_f", "state_i",
]  # fmt: skip


@kernel
def advance(
    rows: Rows, head: int, tail: int, settled: int, complete: int, inputs: Inputs, n: int,
    f: Floats, i: State, nodes_u: Floats, nodes_s: Floats, here: Floats, out: Floats, velocity: Floats,
    line: npt.NDArray[np.int32], status: npt.NDArray[np.uint8], switches: npt.NDArray[np.uint32],
    log: npt.NDArray[np.int64],
) -> tuple[int, int, int, int]:  # fmt: skip
    """Runs up to n cycles; returns (cycles run, reason, rows in the switch log, rows that are done).

    rows head..tail-1 are at hand, of which the first `settled` have final end velocities (`limit_ends`);
    complete 1: no more will come.  `here` (k,) is the present set position, changed in place.  Per cycle j:
    out[j] set position, velocity[j] path length covered over the cycle time, line[j] source line, status[j],
    switches[j] bit b for switch b + 1.  The caller drops the rows that are done.
    """
    axes = out.shape[1]
    reason = RAN
    logged = 0
    shift(rows, head, i, 1)
    done = 0
    logged_before = 0
    patient = inputs.patient == 1 and complete == 0
    last = head + settled if patient else tail  # rows from here on are not entered
    f_before = f.copy()
    i_before = i.copy()
    here_before = here.copy()
    plain = inputs.stop == GO and inputs.single_step == 0
    watched = complete == 0 and inputs.patient == 0  # rows may run out
    while done < n and reason == RAN:
        if 2 * logged > log.shape[0]:
            reason = LOG_FULL
            break
        covered = 0.0
        left = inputs.cycle
        row = i[ROW]
        common = third = False
        if plain and i[RUNNING] == 1 and i[STOPPING] == GO and i[HOLD] == 0 and i[STATUS] != IPO_FINISHED:
            # The common cycle, on the way along the path: nothing to decide, no call that takes all rows, which
            # would cost more than the cycle (every array of a call is counted).
            third = rows.jerk[row] > 0.0
            if third:
                common = i[MODE] == PLANNED and inputs.override == 1.0 and not watched
            else:
                common = (
                    f[OVERRIDE] == inputs.override and i[LAW] == inputs.law and rows.v_now[row] <= f[WANTED]
                )
            common = common and rows.kind[row] < SET_POSITION and row < last
        fresh = not common
        total = f[T1] + f[T2] + f[T3]
        if patient and (f[TAU] + left >= total if common else may_leave(rows, inputs, f, i)):
            # a cycle that runs into rows that are not settled is taken back
            f_before[:] = f
            i_before[:] = i
            here_before[:] = here
            logged_before = logged
        if common:
            while f[TAU] + left >= total:
                # Through the end of the row, if the path goes on without a stop.
                ahead = row + 1
                common = f[V1] > 0.0 and ahead < last and rows.kind[ahead] < SET_POSITION
                common = common and rows.length[ahead] > 0.0 and (rows.jerk[ahead] > 0.0) == third
                if not common:
                    break
                if i[EVENT] < rows.event_end[row]:
                    logged = fire(rows, row, rows.length[row], done, i, log, logged)
                left -= total - f[TAU]
                covered += rows.length[row] - f[S]
                row = ahead
                i[ROW] = row
                if rows.kind[row] == ELLIPSE or rows.kind[row] == POLYNOMIAL:  # else all that `arrive` does
                    arrive(rows, row, i, nodes_u, nodes_s)
                else:
                    i[EVENT] = rows.event_begin[row]
                    i[LINE_NO] = rows.line[row]
                f[TAU] = f[S] = f[S0] = 0.0
                if third:
                    f[PLAN_V] = f[V1]
                    f[PLAN_A] = f[A1]
                    take_plan(rows.length[row], rows.v_end[row], rows.a_end[row], f)
                else:
                    f[WANTED] = rows.v_now[row]
                    take_law(
                        rows.length[row], f[V1], rows.feed[row], rows.v_limit[row], f[WANTED], rows.accel[row],
                        rows.decel[row], f,
                    )  # fmt: skip
                total = f[T1] + f[T2] + f[T3]
        if common:
            f[TAU] += left
            if third:
                s, f[V], f[A] = jerk_state(f[TAU], f[V0], f[A0], f[JERK])
                i[STATUS] = sense(f[A])
            else:
                way, f[V] = law_state(i[LAW], f[TAU], f[T1], f[T2], f[T3], f[V0], f[VP], f[V1])
                s = f[S0] + way
                i[STATUS] = phase(f)
            s = min(max(s, f[S]), rows.length[row])
            covered += s - f[S]
            f[S] = s
            curve = rows.curve[row]
            bent = curve >= 0 and rows.kind[row] != ARC
            if bent or rows.profile[row] & 0x7FFF != 0 or s >= rows.length[row]:
                locate(rows, row, s, nodes_u, nodes_s, i[NODES], here)
            else:
                w = s / rows.length[row]  # lines and arcs as in `locate`
                for a in range(axes):
                    start = rows.start[row, a]
                    here[a] = start + (rows.target[row, a] - start) * w
                if curve >= 0:
                    cu, cv = point(ARC, rows.parameters[curve], w)
                    first, second = plane_axes(rows.plane[curve])
                    here[first] = cu
                    here[second] = cv
            if i[EVENT] < rows.event_end[row]:
                logged = fire(rows, row, s, done, i, log, logged)
        else:
            reason, covered, logged, last = _cycle(
                rows, tail, last, complete, patient, inputs, done, fresh, left, covered, f, i, nodes_u, nodes_s, here,
                log, logged,
            )  # fmt: skip
            if patient and reason == NEED_DATA:
                f[:] = f_before
                i[:] = i_before
                here[:] = here_before
                logged = logged_before
                break
        for a in range(axes):
            out[done, a] = here[a]
        velocity[done] = covered / inputs.cycle
        line[done] = i[LINE_NO]
        status[done] = i[STATUS]
        switches[done] = i[SWITCHES]
        done += 1
    gone = i[ROW] - head
    shift(rows, i[ROW], i, -1)
    return done, reason, logged, gone


@kernel
def _cycle(
    rows: Rows, tail: int, last: int, complete: int, patient: bool, inputs: Inputs, cycle: int, fresh: bool,
    left: float, covered: float, f: Floats, i: State, nodes_u: Floats, nodes_s: Floats, here: Floats,
    log: npt.NDArray[np.int64], logged: int,
) -> tuple[int, float, int, int]:  # fmt: skip
    """A cycle in which anything may be asked for; returns (reason, way covered, rows in the log, last).

    fresh: the whole cycle, not what is `left` of one that has `covered` its way through ends of rows.  last: rows
    from there on are not entered.
    """
    reason = RAN
    if i[STARTED] == 0:
        i[STARTED] = 1
        i[STATUS] = IPO_INIT
    elif i[STATUS] == IPO_FINISHED:
        reason = FINISHED
    elif inputs.stop == ABORT:
        i[STATUS] = IPO_FINISHED
        i[RUNNING] = 0
        f[V] = 0.0
        reason = FINISHED
    elif inputs.stop == EMERGENCY:
        f[V] = 0.0
        i[STATUS] = IPO_WAIT
        i[STOPPING] = EMERGENCY
        if i[RUNNING] == 1 and rows.jerk[i[ROW]] > 0.0:
            f[A] = 0.0
            i[MODE] = STOPPED
    elif i[HOLD] > 0:
        i[HOLD] -= 1
        i[STATUS] = IPO_WAIT
    else:
        row = i[ROW]
        scale = 1.0
        if row < last and rows.jerk[row] > 0.0:
            if i[RUNNING] == 0 and f[V] > 0.0:
                enter(rows, row, inputs, f, i, nodes_u, nodes_s)
            if fresh and i[RUNNING] == 1 and i[MODE] <= SCALED:
                if command_third(rows, inputs, tail, complete, f, i) == OPEN and patient:
                    return NEED_DATA, covered, logged, last
                scale = pace(inputs.cycle, f, i)
        elif fresh:
            settled = command(rows, inputs, tail, complete, f, i)
            if patient and settled >= 0:
                last = settled
        reason, covered, logged = _along(
            rows, tail, last, complete, patient, inputs, cycle, left, scale, covered, f, i, nodes_u, nodes_s, here, log,
            logged,
        )  # fmt: skip
        if patient and reason == NEED_DATA:
            return reason, covered, logged, last
    if i[RUNNING] == 1 and rows.kind[i[ROW]] < SET_POSITION:
        locate(rows, i[ROW], f[S], nodes_u, nodes_s, i[NODES], here)
        logged = fire(rows, i[ROW], f[S], cycle, i, log, logged)
    return reason, covered, logged, last


@kernel
def _along(
    rows: Rows, tail: int, last: int, complete: int, patient: bool, inputs: Inputs, cycle: int, left: float,
    scale: float, covered: float, f: Floats, i: State, nodes_u: Floats, nodes_s: Floats, here: Floats,
    log: npt.NDArray[np.int64], logged: int,
) -> tuple[int, float, int]:  # fmt: skip
    """Spends the time that is `left` of a cycle along the rows; returns (reason, way covered, rows in the log).

    scale: at how many times the plan's time the rows of a third-order plan run.
    """
    while True:
        row = i[ROW]
        if row >= last and patient:
            return NEED_DATA, covered, logged
        if row >= tail:
            f[V] = 0.0
            if complete == 1:
                i[STATUS] = IPO_FINISHED
                return FINISHED, covered, logged
            i[STATUS] = IPO_WAIT
            return NEED_DATA, covered, logged
        kind = rows.kind[row]
        third = rows.jerk[row] > 0.0
        if i[RUNNING] == 0:
            if (inputs.stop != GO or inputs.wait_at_stop == 1) and f[V] == 0.0:
                i[STATUS] = IPO_WAIT
                return RAN, covered, logged
            enter(rows, row, inputs, f, i, nodes_u, nodes_s)
            if kind == M_FUNCTION:
                i[M_ROW] = row
                i[STATUS] = IPO_WAIT
                f[V] = 0.0
                return AT_M, covered, logged
        elif i[M_ROW] == row:
            if inputs.ack_m == 0:
                i[STATUS] = IPO_WAIT
                return RAN, covered, logged
            i[M_ROW] = -1
        if third and i[MODE] == STOPPED:
            if inputs.stop != GO:
                i[STATUS] = IPO_WAIT
                return RAN, covered, logged
            found = set_off(rows, inputs, tail, complete, f, i)
            if found != FITS:
                i[STATUS] = IPO_WAIT
                return NEED_DATA if found == OPEN and patient else RAN, covered, logged
            scale = f[RATE] if i[MODE] == SCALED else 1.0
            if i[MODE] == SCALED and left == inputs.cycle:
                scale = pace(inputs.cycle, f, i)
            i[STOPPING] = inputs.stop
        if third and i[MODE] == TABLE:
            left, way, logged = run_table(
                rows, left, tail, cycle, f, i, nodes_u, nodes_s, here, log, logged
            )  # fmt: skip
            i[STATUS] = phase_third(f, i)
            if i[MODE] == STOPPED:
                i[STATUS] = IPO_WAIT
                if i[RUNNING] == 0 and inputs.single_step == 1:
                    i[HOLD] = 1
            return RAN, covered + way, logged
        speed = scale if third else 1.0
        total = f[T1] + f[T2] + f[T3]
        if f[TAU] + left * speed < total:
            f[TAU] += left * speed
            if third:
                s, f[V], f[A] = jerk_state(f[TAU], f[V0], f[A0], f[JERK])
                i[STATUS] = phase_third(f, i)
            else:
                way, f[V] = law_state(i[LAW], f[TAU], f[T1], f[T2], f[T3], f[V0], f[VP], f[V1])
                s = f[S0] + way
                i[STATUS] = phase(f)
            s = min(max(s, f[S]), rows.length[row])
            covered += s - f[S]
            f[S] = s
            return RAN, covered, logged
        left -= (total - f[TAU]) / speed if speed > 0.0 else 0.0
        f[V] = f[V1]
        if third:
            f[A] = f[A1]
            leave(rows, row, f)
        elif (i[STOPPING] == SLOW or i[STOPPING] == QUICK) and f[V1] == 0.0 and kind < SET_POSITION:
            s = f[S0] + 0.5 * f[V0] * f[T3]
            if s < rows.length[row] * (1.0 - 1e-12):
                # Stopped on the way: wait here until released.
                s = max(s, f[S])
                covered += s - f[S]
                f[S] = s
                f[S0] = s
                f[TAU] = f[T1] = f[T2] = f[T3] = f[V0] = f[VP] = 0.0
                i[STATUS] = IPO_WAIT
                if inputs.stop != GO:
                    return RAN, covered, logged
                begin(rows, row, s, 0.0, inputs, f, i)
                continue
        covered += rows.length[row] - f[S]
        f[S] = 0.0
        i[RUNNING] = 0
        i[ROW] = row + 1
        logged = finish(rows, row, cycle, i, here, log, logged)
        if kind == SET_POSITION:
            i[STATUS] = IPO_CONSTANT
            return JUMPED, covered, logged
        if inputs.single_step == 1 and f[V] == 0.0 and rows.length[row] > 0.0:
            i[HOLD] = 1
            i[STATUS] = IPO_WAIT
            return RAN, covered, logged
