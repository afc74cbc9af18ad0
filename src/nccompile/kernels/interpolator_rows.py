"""What the interpolator reads and remembers: planned rows, inputs, and a state of two small arrays.

`f` holds the law of the running segment (times from its start, start offset S0, end velocity WANTED), `i` the row,
the event pointer and the flags; a snapshot is a copy.  Rows of a third-order plan (jerk > 0) have further slots:

    PLAN_V, PLAN_A   planned velocity and acceleration at the start of the running row
    A0, JERK, A1     its constant jerk;  A: present acceleration of the plan, or of a table
    RATE ..          how fast the plan's time runs, and a change of it in progress (`kernels.interpolator_rate`)
    PHASES ..        a table of constant jerks that replaces the plan: a stop, or a single step
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
State = npt.NDArray[np.int64]

# Segment kinds, as toolpath.Kind numbers them.
POSITIONING, LINE, ARC, ELLIPSE, POLYNOMIAL, SET_POSITION, DWELL, M_FUNCTION = 0, 1, 2, 3, 4, 5, 6, 7

# SMC_INT_STATUS (SoftMotion §6.2.8)
IPO_INIT, IPO_ACCEL, IPO_CONSTANT, IPO_DECEL, IPO_FINISHED, IPO_WAIT = 1, 2, 3, 4, 5, 6

# Why `advance` returned.
RAN, NEED_DATA, JUMPED, AT_M, FINISHED, LOG_FULL = 0, 1, 2, 3, 4, 5

# Stop commands, weakest first.
GO, SLOW, QUICK, EMERGENCY, ABORT = 0, 1, 2, 3, 4

# State f
TAU, T1, T2, T3, V0, VP, V1, S0, OVERRIDE, S, V, WANTED = 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11
PLAN_V, PLAN_A, A, A0, A1, JERK = 12, 13, 14, 15, 16, 17
RATE, RATE_FROM, RATE_BY, RATE_RAMP, RATE_LEVEL, RATE_TIME = 18, 19, 20, 21, 22, 23
PHASES = 24
MOST_PHASES = 7
F_SIZE = PHASES + 2 * MOST_PHASES

# State i
ROW, EVENT, STARTED, RUNNING, HOLD, STATUS, SWITCHES, LAST_SWITCH, M_ROW, LAW, TABLE_ROW, NODES, STOPPING, LINE_NO = (
    0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13
)  # fmt: skip
MODE, PHASE, PHASE_COUNT, STARVED = 14, 15, 16, 17
I_SIZE = 18

# MODE: how a row of third order is run.
PLANNED = 0  # as planned, the plan's time is the time
SCALED = 1  # as planned, at another rate or while the rate changes
TABLE = 2  # by the table of constant jerks
STOPPED = 3  # at rest where the plan need not rest

SWITCH_NUMBERS = 32

CONTINUES = 15
"""Bit of the column `profile`: the row after this one is a part of the same segment."""


class Rows(NamedTuple):
    """Planned segments as the interpolator reads them; rows head..tail-1 are valid.

    kind u1 (n,); start, target f8 (n, k); curve i4 (n,) row of `plane` u1 (m,) and `parameters` f8 (m, 12) or
    -1; length, feed, v_limit, v_junction, v_end, a_end, accel, decel, jerk f8 (n,), jerk 0 where the plan is not of
    third order; brake f8 (n,): greatest deceleration of a quick stop that the axes allow; profile u2 (n,);
    line i4 (n,);
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
    brake: Floats
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

    stop: GO, SLOW, QUICK, EMERGENCY or ABORT; quick_decel mm/s²; override >= 0.01; law: of ramps, see
    `kernels.timelaw`; wait_at_stop, single_step, ack_m: 0 or 1; patient 1: return NEED_DATA instead of braking when
    rows that are still to come would change the velocity; cycle: seconds.
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


def state_f() -> Floats:
    """A fresh float state."""
    f = np.zeros(F_SIZE)
    f[OVERRIDE] = f[RATE] = 1.0
    f[RATE_TIME] = -1.0
    return f


def state_i() -> State:
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
        if rows.jerk[j] > 0.0:  # planned to the end of the path: stops have their own care
            brake = cap = rows.v_end[j]
        elif override == 1.0:
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
