"""The interpolator: from planned segments to one set position per cycle (SoftMotion §6.2.8).

    advance(rows, inputs, f, i, ..., out)     runs up to n cycles, returns how many and why it stopped

State is two small arrays, so a snapshot is a copy.  `f` holds the law of the running segment (times from
`law_times`, start offset S0, the end velocity WANTED), `i` the row, the event pointer and the flags.  A cycle
spends its time along the rows: it may finish several short ones; it ends early only where the set position
has to be seen by the outside: a jump (G92), an M function, the end, a wait.  The first cycle puts
out the start position.

Smoothing (planner `jerk`): the motion above is the leader; what is put out, the follower, has covered the mean
of the leader's way over the last `smoothing` seconds.  Its velocity is a mean of the leader's, its
acceleration is (v(t) - v(t - T)) / T and its jerk (a(t) - a(t - T)) / T, whatever overrides and stops the leader
goes through.  Where the leader stops at the end of a row it rests until the follower has arrived.

    v    leader  ____            follower    ___
            ___/    \\___                __/   \\__      events, lines and positions are the follower's

Whoever calls with the same rows, inputs and cycle time gets the same bits, whatever the number of cycles a
call: the offline sampler and the cyclic task differ only in who supplies rows.
"""

from __future__ import annotations

from math import ceil, cos, sin, sqrt
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curves import derivative, derivative3, parameter, point, point3, tabulate
from nccompile.kernels.timelaw import law_distance, law_times, law_velocity

__all__ = ["Inputs", "Rows", "advance", "direction", "limit_ends", "locate", "state_f", "state_i"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

# Segment kinds, as toolpath.Kind numbers them.
POSITIONING, LINE, ARC, ELLIPSE, POLYNOMIAL, SET_POSITION, DWELL, M_FUNCTION = 0, 1, 2, 3, 4, 5, 6, 7
SPACE = 3

# SMC_INT_STATUS (SoftMotion §6.2.8)
IPO_INIT, IPO_ACCEL, IPO_CONSTANT, IPO_DECEL, IPO_FINISHED, IPO_WAIT = 1, 2, 3, 4, 5, 6

# Why `advance` returned.
RAN, NEED_DATA, JUMPED, AT_M, FINISHED, LOG_FULL = 0, 1, 2, 3, 4, 5

# Stop commands, weakest first.
GO, SLOW, QUICK, EMERGENCY, ABORT = 0, 1, 2, 3, 4

# State f
TAU, T1, T2, T3, V0, VP, V1, S0, OVERRIDE, S, V, WANTED, REST, FOLLOWER_S, COVERED = (
    0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14
)  # fmt: skip
F_SIZE = 15

# State i
ROW, EVENT, STARTED, RUNNING, HOLD, STATUS, SWITCHES, LAST_SWITCH, M_ROW, LAW, TABLE_ROW, NODES, STOPPING, LINE_NO = (
    0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13
)  # fmt: skip
SMOOTH, TRAIL_AT, FOLLOWER = 14, 15, 16
I_SIZE = 17

SWITCH_NUMBERS = 32

CONTINUES = 15
"""Bit of the column `profile`: the row after this one is a part of the same segment."""


class Rows(NamedTuple):
    """Planned segments as the interpolator reads them; rows head..tail-1 are valid.

    kind u1 (n,); start, target f8 (n, k); curve i4 (n,) row of `plane` u1 (m,) and `parameters` f8 (m, 12) or
    -1; length, feed, v_limit, v_junction, v_end, a_end, accel, decel, jerk f8 (n,), jerk 0 where the plan is not of
    third order; profile u2 (n,); line i4 (n,);
    events: event_begin, event_end i4 (n,) range of a row in event_kind u1, event_number i4, event_position,
    event_k f8.  v_now f8 (n,) is scratch: the end velocities in force (see `limit_ends`).
    """

    kind: npt.NDArray[np.uint8]
    start: Floats
    target: Floats
    curve: Ints
    plane: npt.NDArray[np.uint8]
    parameters: Floats
    length: Floats
    feed: Floats
    v_limit: Floats
    v_junction: Floats
    v_end: Floats
    a_end: Floats
    accel: Floats
    decel: Floats
    jerk: Floats
    profile: npt.NDArray[np.uint16]
    line: Ints
    event_begin: Ints
    event_end: Ints
    event_kind: npt.NDArray[np.uint8]
    event_number: Ints
    event_position: Floats
    event_k: Floats
    v_now: Floats


class Inputs(NamedTuple):
    """What the caller commands during a call of `advance`.

    stop: GO, SLOW, QUICK, EMERGENCY or ABORT; quick_decel mm/s²; override >= 0.01; law TRAPEZOID or SIGMOID;
    wait_at_stop, single_step, ack_m: 0 or 1; patient 1: return NEED_DATA instead of braking when rows that are
    still to come would change the velocity; cycle: seconds; smoothing: duration of the mean [s], 0 for none,
    taken over at the start of the path.
    """

    stop: int
    quick_decel: float
    override: float
    law: int
    wait_at_stop: int
    single_step: int
    ack_m: int
    patient: int
    cycle: float
    smoothing: float = 0.0


def state_f() -> Floats:
    """A fresh float state."""
    f = np.zeros(F_SIZE)
    f[OVERRIDE] = 1.0
    return f


def state_i() -> npt.NDArray[np.int64]:
    """A fresh integer state."""
    i = np.zeros(I_SIZE, np.int64)
    i[STATUS] = IPO_INIT
    i[EVENT] = i[M_ROW] = i[TABLE_ROW] = i[LINE_NO] = -1
    return i


@kernel
def limit_ends(rows: Rows, head: int, tail: int, complete: int, override: float) -> int:
    """Fills `rows.v_now`: end velocities from which the path can still be braked within the rows at hand.

    Backward over tail-1..head:  v_now[j] = min(cap[j], sqrt(v_now[j+1]² + 2 d L) of row j+1), the last row's
    is 0.  cap is the planned velocity at override 1, else the junction's limit and both rows' commanded
    velocities.  If the path is `complete` the planned ends need no such care.  Returns the number of leading
    rows whose v_now does not depend on rows still to come.
    """
    if complete == 1 and override == 1.0:
        for j in range(head, tail):
            rows.v_now[j] = rows.v_end[j]
        return tail - head
    settled = 0
    v_after = 0.0
    open_end = complete == 0
    for j in range(tail - 1, head - 1, -1):
        if j + 1 < tail:
            brake = sqrt(v_after * v_after + 2.0 * rows.decel[j + 1] * rows.length[j + 1])
        else:
            brake = 0.0
        if override == 1.0:
            cap = rows.v_end[j]
        else:
            cap = min(rows.v_junction[j], rows.v_limit[j], override * rows.feed[j])
            if j + 1 < tail:
                cap = min(cap, rows.v_limit[j + 1], override * rows.feed[j + 1])
        if cap <= brake:
            if open_end:
                settled = j + 1 - head
                open_end = False
            v_after = cap
        else:
            v_after = brake
        rows.v_now[j] = v_after
    if complete == 1:
        return tail - head
    return settled


@kernel
def locate(rows: Rows, row: int, s: float, nodes_u: Floats, nodes_s: Floats, count: int, out: Floats) -> None:
    """Writes the position at path length `s` of a row to `out` (k,); the row's very end is its target.

    X-Y (the curve's plane) run on the curve, all other axes linearly in path length, or where the S-profile
    is on with 10 w³ - 15 w⁴ + 6 w⁵ of w = s / L, which starts and ends at rest (SoftMotion §6.2.8).
    """
    axes = rows.target.shape[1]
    length = rows.length[row]
    if s >= length:
        for a in range(axes):
            out[a] = rows.target[row, a]
        return
    w = s / length
    bits = rows.profile[row]
    for a in range(axes):
        share = w
        if (bits >> a) & 1:
            share = w * w * w * (10.0 + w * (6.0 * w - 15.0))
        begin = rows.start[row, a]
        out[a] = begin + (rows.target[row, a] - begin) * share
    curve = rows.curve[row]
    if curve < 0:
        return
    p = rows.parameters[curve]
    kind = rows.kind[row]
    plane = rows.plane[curve]
    if kind == ARC:
        angle = p[3] + p[4] * w
        cu = p[0] + p[2] * cos(angle)
        cv = p[1] + p[2] * sin(angle)
    else:
        u = parameter(kind, p, nodes_u, nodes_s, count, w * nodes_s[count - 1])
        if plane == SPACE:
            x, y, z = point3(kind, p, u)
            out[0] = x
            out[1] = y
            out[2] = z
            return
        cu, cv = point(kind, p, u)
    if plane == 1:  # planes XY, ZX, YZ are axes (0, 1), (2, 0), (1, 2)
        out[2] = cu
        out[0] = cv
    else:
        out[plane // 2] = cu
        out[plane // 2 + 1] = cv


@kernel
def direction(
    rows: Rows, row: int, s: float, nodes_u: Floats, nodes_s: Floats, count: int, out: Floats
) -> None:
    """Writes the unit direction of the path in X, Y, Z at path length `s` of a row to `out` (3,)."""
    length = rows.length[row]
    w = min(s / length, 1.0) if length > 0.0 else 1.0
    bits = rows.profile[row]
    for a in range(3):
        slope = rows.target[row, a] - rows.start[row, a]
        if (bits >> a) & 1:
            slope *= 30.0 * w * w * (1.0 - w) * (1.0 - w)
        out[a] = slope
    curve = rows.curve[row]
    if curve >= 0:
        p = rows.parameters[curve]
        kind = rows.kind[row]
        plane = rows.plane[curve]
        if kind == ARC:
            in_plane = p[2] * abs(p[4])
            u = w
        else:
            in_plane = nodes_s[count - 1]
            u = parameter(kind, p, nodes_u, nodes_s, count, w * in_plane)
        if plane == SPACE:
            out[0], out[1], out[2] = derivative3(kind, p, u)
        else:
            du, dv = derivative(kind, p, u)
            size = sqrt(du * du + dv * dv)
            scale = in_plane / size if size > 0.0 else 0.0
            if plane == 1:
                out[2] = du * scale
                out[0] = dv * scale
            else:
                out[plane // 2] = du * scale
                out[plane // 2 + 1] = dv * scale
    size = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2])
    for a in range(3):
        out[a] = out[a] / size if size > 0.0 else 0.0


@kernel
def _begin(
    rows: Rows, row: int, s0: float, v0: float, inputs: Inputs, f: Floats, i: npt.NDArray[np.int64]
) -> None:
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
            decel = max(decel, inputs.quick_decel)
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
    v_top = min(f[OVERRIDE] * rows.feed[row], rows.v_limit[row])
    f[T1], f[T2], f[T3], f[VP], f[V1] = law_times(length, v0, v_top, v_end, rows.accel[row], decel)
    f[V0] = v0


@kernel
def _arrive(rows: Rows, row: int, i: npt.NDArray[np.int64], nodes_u: Floats, nodes_s: Floats) -> None:
    """The set position comes to a row: tabulates its curve, rewinds its events."""
    kind = rows.kind[row]
    if (kind == ELLIPSE or kind == POLYNOMIAL) and i[TABLE_ROW] != row:
        i[NODES] = tabulate(kind, rows.parameters[rows.curve[row]], nodes_u, nodes_s)
        i[TABLE_ROW] = row
    i[EVENT] = rows.event_begin[row]
    i[LINE_NO] = rows.line[row]


@kernel
def _enter(
    rows: Rows, row: int, v0: float, inputs: Inputs, f: Floats, i: npt.NDArray[np.int64],
    nodes_u: Floats, nodes_s: Floats,
) -> None:  # fmt: skip
    """Starts a row at its beginning."""
    if i[SMOOTH] == 0 or i[FOLLOWER] == row:
        _arrive(rows, row, i, nodes_u, nodes_s)
    i[M_ROW] = -1
    _begin(rows, row, 0.0, v0, inputs, f, i)


@kernel
def _fire(
    rows: Rows, row: int, s: float, cycle: int, i: npt.NDArray[np.int64], log: npt.NDArray[np.int64], logged: int
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
def _phase(f: Floats) -> int:
    """The status a running law has at its present time."""
    if f[TAU] < f[T1]:
        return IPO_ACCEL if f[VP] >= f[V0] else IPO_DECEL
    if f[TAU] <= f[T1] + f[T2]:
        return IPO_CONSTANT
    return IPO_DECEL


@kernel
def _command(
    rows: Rows, inputs: Inputs, tail: int, complete: int, f: Floats, i: npt.NDArray[np.int64]
) -> int:
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
        _begin(rows, row, f[S], f[V], inputs, f, i)
    return settled


@kernel
def _start(inputs: Inputs, i: npt.NDArray[np.int64], trail: Floats) -> None:
    """The first cycle: the number of cycles in the mean, rounded up so that no jerk is above the plan's."""
    i[STARTED] = 1
    i[STATUS] = IPO_INIT
    i[FOLLOWER] = i[ROW]
    if inputs.smoothing > 0.0:
        i[SMOOTH] = max(1, min(ceil(inputs.smoothing / inputs.cycle - 1e-9), len(trail)))
        trail[:] = 0.0


@kernel
def _catch_up(
    rows: Rows, covered: float, cycle: int, f: Floats, i: npt.NDArray[np.int64], nodes_u: Floats,
    nodes_s: Floats, trail: Floats, log: npt.NDArray[np.int64], logged: int,
) -> int:  # fmt: skip
    """Moves the follower by the mean of the leader's last ways; returns the new fill of the log."""
    m = i[SMOOTH]
    trail[i[TRAIL_AT]] = covered
    i[TRAIL_AT] = (i[TRAIL_AT] + 1) % m
    way = 0.0
    for n in range(m):
        way += trail[n]
    way /= m
    row = i[FOLLOWER]
    s = f[FOLLOWER_S] + way
    while row < i[ROW] and s >= rows.length[row]:
        logged = _fire(rows, row, rows.length[row], cycle, i, log, logged)
        if row + 1 == i[ROW] and i[RUNNING] == 0:
            s = rows.length[row]  # the leader has not entered the next row
            break
        s -= rows.length[row]
        row += 1
        _arrive(rows, row, i, nodes_u, nodes_s)
    if row == i[ROW]:
        s = min(s, f[S])
    i[FOLLOWER] = row
    f[FOLLOWER_S] = s
    f[COVERED] = way
    return logged


@kernel
def _meet(
    rows: Rows, cycle: int, f: Floats, i: npt.NDArray[np.int64], here: Floats, log: npt.NDArray[np.int64],
    logged: int,
) -> int:  # fmt: skip
    """The leader has rested long enough at the end of a row: the follower is there, to the bit."""
    for row in range(i[FOLLOWER], i[ROW]):
        if row > i[FOLLOWER]:
            i[EVENT] = rows.event_begin[row]
            i[LINE_NO] = rows.line[row]
        logged = _fire(rows, row, rows.length[row], cycle, i, log, logged)
        for a in range(here.shape[0]):
            here[a] = rows.target[row, a]
    i[FOLLOWER] = i[ROW]
    f[FOLLOWER_S] = 0.0
    return logged


@kernel
def _freeze(rows: Rows, inputs: Inputs, f: Floats, i: npt.NDArray[np.int64], trail: Floats) -> None:
    """Emergency stop: the leader comes back to where the follower stands."""
    ahead = i[ROW] != i[FOLLOWER] or f[S] != f[FOLLOWER_S]
    trail[:] = 0.0
    f[REST] = 0.0
    f[COVERED] = 0.0
    if ahead:
        i[ROW] = i[FOLLOWER]
        _begin(rows, i[ROW], f[FOLLOWER_S], 0.0, inputs, f, i)


@kernel
def _may_leave(rows: Rows, inputs: Inputs, f: Floats, i: npt.NDArray[np.int64]) -> bool:
    """Whether the next cycle may end the running row: not if its law goes on for longer, untouched by inputs."""
    if i[RUNNING] == 0 or f[T1] + f[T2] + f[T3] - f[TAU] <= 2.0 * inputs.cycle or f[REST] > 0.0:
        return True
    if f[OVERRIDE] != inputs.override or i[LAW] != inputs.law or i[STOPPING] != inputs.stop:
        return True
    return inputs.single_step == 1 or rows.v_now[i[ROW]] > f[WANTED]


@kernel
def advance(
    rows: Rows, head: int, tail: int, settled: int, complete: int, inputs: Inputs, n: int,
    f: Floats, i: npt.NDArray[np.int64], nodes_u: Floats, nodes_s: Floats, trail: Floats, here: Floats,
    out: Floats, velocity: Floats, line: npt.NDArray[np.int32], status: npt.NDArray[np.uint8],
    switches: npt.NDArray[np.uint32], log: npt.NDArray[np.int64],
) -> tuple[int, int, int]:  # fmt: skip
    """Runs up to n cycles; returns (cycles run, reason, rows in the switch log).

    rows head..tail-1 are at hand, of which the first `settled` have final end velocities (`limit_ends`);
    complete 1: no more will come.  `here` (k,) is the present set position, changed in place.  Per cycle j:
    out[j] set position, velocity[j] path length covered over the cycle time, line[j] source line, status[j],
    switches[j] bit b for switch b + 1.  The caller drops rows before i[ROW] after the call.
    """
    axes = out.shape[1]
    reason = RAN
    logged = 0
    if i[STARTED] == 0:
        i[ROW] = head
    done = 0
    logged_before = 0
    patient = inputs.patient == 1 and complete == 0
    last = head + settled if patient else tail  # rows from here on are not entered
    f_before = f.copy()
    i_before = i.copy()
    here_before = here.copy()
    plain = i[STARTED] == 1 and i[SMOOTH] == 0 and inputs.stop == GO and inputs.single_step == 0
    while done < n and reason == RAN:
        if 2 * logged > log.shape[0]:
            reason = LOG_FULL
            break
        if plain and i[RUNNING] == 1 and i[STOPPING] == GO and i[HOLD] == 0 and i[STATUS] != IPO_FINISHED:
            # The common cycle, on the way through a row: nothing to decide, no call that takes all rows.
            row = i[ROW]
            total = f[T1] + f[T2] + f[T3]
            same = f[OVERRIDE] == inputs.override and i[LAW] == inputs.law and rows.v_now[row] <= f[WANTED]
            if same and f[TAU] + inputs.cycle < total and rows.kind[row] < SET_POSITION and row < last:
                f[TAU] += inputs.cycle
                s = f[S0] + law_distance(i[LAW], f[TAU], f[T1], f[T2], f[T3], f[V0], f[VP], f[V1])
                s = max(s, f[S])
                s = min(s, rows.length[row])
                velocity[done] = (s - f[S]) / inputs.cycle
                f[S] = s
                f[V] = law_velocity(i[LAW], f[TAU], f[T1], f[T2], f[T3], f[V0], f[VP], f[V1])
                i[STATUS] = _phase(f)
                curve = rows.curve[row]
                bent = curve >= 0 and rows.kind[row] != ARC
                if bent or rows.profile[row] != 0 or s >= rows.length[row]:
                    locate(rows, row, s, nodes_u, nodes_s, i[NODES], here)
                else:  # as `locate` does
                    w = s / rows.length[row]
                    for a in range(axes):
                        begin = rows.start[row, a]
                        here[a] = begin + (rows.target[row, a] - begin) * w
                    if curve >= 0:
                        p = rows.parameters[curve]
                        angle = p[3] + p[4] * w
                        cu = p[0] + p[2] * cos(angle)
                        cv = p[1] + p[2] * sin(angle)
                        plane = rows.plane[curve]
                        if plane == 1:
                            here[2] = cu
                            here[0] = cv
                        else:
                            here[plane // 2] = cu
                            here[plane // 2 + 1] = cv
                if i[EVENT] < rows.event_end[row]:
                    logged = _fire(rows, row, s, done, i, log, logged)
                for a in range(axes):
                    out[done, a] = here[a]
                line[done] = i[LINE_NO]
                status[done] = i[STATUS]
                switches[done] = i[SWITCHES]
                done += 1
                continue
        if patient and _may_leave(rows, inputs, f, i):
            # a cycle that runs into rows that are not settled is taken back
            f_before[:] = f
            i_before[:] = i
            here_before[:] = here
            logged_before = logged
        covered = 0.0
        if i[STARTED] == 0:
            _start(inputs, i, trail)
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
            if i[SMOOTH] > 0:
                _freeze(rows, inputs, f, i, trail)
        elif i[HOLD] > 0:
            i[HOLD] -= 1
            i[STATUS] = IPO_WAIT
        else:
            fresh = _command(rows, inputs, tail, complete, f, i)
            if patient and fresh >= 0:
                last = fresh
            left = inputs.cycle
            while True:
                row = i[ROW]
                if f[REST] > 0.0:
                    if left < f[REST] - 1e-9 * inputs.cycle:
                        f[REST] -= left
                        break
                    left = max(left - f[REST], 0.0)
                    f[REST] = 0.0
                    logged = _meet(rows, done, f, i, here, log, logged)
                if row >= last and patient:
                    reason = NEED_DATA
                    break
                if row >= tail:
                    f[V] = 0.0
                    if complete == 1:
                        i[STATUS] = IPO_FINISHED
                        reason = FINISHED
                    else:
                        i[STATUS] = IPO_WAIT
                        reason = NEED_DATA
                    break
                if i[RUNNING] == 0:
                    kind = rows.kind[row]
                    if inputs.stop != GO and f[V] == 0.0:
                        i[STATUS] = IPO_WAIT
                        break
                    if inputs.wait_at_stop == 1 and f[V] == 0.0:
                        i[STATUS] = IPO_WAIT
                        break
                    _enter(rows, row, f[V], inputs, f, i, nodes_u, nodes_s)
                    if kind == M_FUNCTION:
                        i[M_ROW] = row
                        i[STATUS] = IPO_WAIT
                        f[V] = 0.0
                        reason = AT_M
                        break
                elif i[M_ROW] == row:
                    if inputs.ack_m == 0:
                        i[STATUS] = IPO_WAIT
                        break
                    i[M_ROW] = -1
                total = f[T1] + f[T2] + f[T3]
                if f[TAU] + left < total:
                    f[TAU] += left
                    s = f[S0] + law_distance(i[LAW], f[TAU], f[T1], f[T2], f[T3], f[V0], f[VP], f[V1])
                    s = max(s, f[S])
                    s = min(s, rows.length[row])
                    covered += s - f[S]
                    f[S] = s
                    f[V] = law_velocity(i[LAW], f[TAU], f[T1], f[T2], f[T3], f[V0], f[VP], f[V1])
                    i[STATUS] = _phase(f)
                    break
                left -= total - f[TAU]
                f[V] = f[V1]
                kind = rows.kind[row]
                if (i[STOPPING] == SLOW or i[STOPPING] == QUICK) and f[V1] == 0.0 and kind < SET_POSITION:
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
                            break
                        _begin(rows, row, s, 0.0, inputs, f, i)
                        continue
                covered += rows.length[row] - f[S]
                f[S] = 0.0
                i[RUNNING] = 0
                i[ROW] = row + 1
                if i[SMOOTH] == 0:
                    logged = _fire(rows, row, rows.length[row], done, i, log, logged)
                elif kind >= SET_POSITION or (f[V] == 0.0 and rows.length[row] <= 0.0 and i[FOLLOWER] == row):
                    logged = _meet(rows, done, f, i, here, log, logged)
                elif f[V] == 0.0:
                    f[REST] = i[SMOOTH] * inputs.cycle
                if kind != DWELL and kind != M_FUNCTION and (i[SMOOTH] == 0 or kind == SET_POSITION):
                    for a in range(axes):
                        here[a] = rows.target[row, a]
                if kind == SET_POSITION:
                    i[STATUS] = IPO_CONSTANT
                    reason = JUMPED
                    break
                if inputs.single_step == 1 and f[V] == 0.0 and rows.length[row] > 0.0:
                    i[HOLD] = 1
                    i[STATUS] = IPO_WAIT
                    break
        if patient and reason == NEED_DATA:
            f[:] = f_before
            i[:] = i_before
            here[:] = here_before
            logged = logged_before
            break
        if i[SMOOTH] > 0:
            if inputs.stop < EMERGENCY:
                logged = _catch_up(rows, covered, done, f, i, nodes_u, nodes_s, trail, log, logged)
                covered = f[COVERED]
            row = i[FOLLOWER]
            if row < i[ROW] or (i[RUNNING] == 1 and rows.kind[row] < SET_POSITION):
                locate(rows, row, f[FOLLOWER_S], nodes_u, nodes_s, i[NODES], here)
                logged = _fire(rows, row, f[FOLLOWER_S], done, i, log, logged)
        elif i[RUNNING] == 1 and rows.kind[i[ROW]] < SET_POSITION:
            locate(rows, i[ROW], f[S], nodes_u, nodes_s, i[NODES], here)
            logged = _fire(rows, i[ROW], f[S], done, i, log, logged)
        for a in range(axes):
            out[done, a] = here[a]
        velocity[done] = covered / inputs.cycle
        line[done] = i[LINE_NO]
        status[done] = IPO_DECEL if i[STATUS] == IPO_WAIT and covered > 0.0 else i[STATUS]
        switches[done] = i[SWITCHES]
        done += 1
    return done, reason, logged
