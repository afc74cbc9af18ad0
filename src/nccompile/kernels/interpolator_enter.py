# ruff: isort: skip_file
# Fifty imported numbers in fifty lines would hide the code.
"""Beginnings: how the set position comes onto a row, and how the path is put at rest somewhere on it."""

from __future__ import annotations

from nccompile.kernels import kernel
from nccompile.kernels.interpolator_law import arrive, begin
from nccompile.kernels.interpolator_rows import (
    EVENT, GO, HOLD, IPO_WAIT, LAW, MODE, M_ROW, OVERRIDE, PLANNED, PLAN_A, PLAN_V, RATE_TIME, ROW, RUNNING,
    STARTED, STARVED, STATUS, STOPPED, STOPPING, T1, T2, T3, TABLE_ROW, TAU, WANTED, A, Floats, Inputs, Rows, S,
    State, V,
)  # fmt: skip
from nccompile.kernels.interpolator_third import begin_planned, leave

__all__ = ["enter", "may_leave", "rest_at", "shift"]


@kernel
def shift(rows: Rows, head: int, i: State, sign: int) -> None:
    """Turns distances from the head into places in `rows` (sign 1), or back (-1).

    Between calls the state holds distances, because a ring buffer moves its rows.
    """
    i[ROW] += sign * head
    if i[M_ROW] >= 0:
        i[M_ROW] += sign * head
    if sign > 0 and i[TABLE_ROW] >= 0:
        i[TABLE_ROW] += head
    elif sign < 0:
        i[TABLE_ROW] = i[TABLE_ROW] - head if i[TABLE_ROW] >= head else -1
    if i[RUNNING] == 1:
        i[EVENT] += sign * rows.event_begin[head]


@kernel
def enter(
    rows: Rows, row: int, inputs: Inputs, f: Floats, i: State, nodes_u: Floats, nodes_s: Floats
) -> None:
    """Starts a row at its beginning; a third-order one from rest has to set off."""
    arrive(rows, row, i, nodes_u, nodes_s)
    if rows.jerk[row] <= 0.0:
        i[MODE] = PLANNED
        f[PLAN_V] = f[PLAN_A] = 0.0
        begin(rows, row, 0.0, f[V], inputs, f, i)
    elif f[V] == 0.0:
        f[S] = 0.0
        f[A] = 0.0
        i[RUNNING] = 1
        i[MODE] = STOPPED
    else:
        begin_planned(rows, row, 0.0, f, i)
        i[STOPPING] = inputs.stop


@kernel
def rest_at(
    rows: Rows, row: int, s: float, inputs: Inputs, f: Floats, i: State, nodes_u: Floats, nodes_s: Floats
) -> None:
    """Puts the path at rest at path length `s` of a row; s = 0 is the place before the row."""
    f[V] = f[A] = f[PLAN_V] = f[PLAN_A] = 0.0
    f[RATE_TIME] = -1.0
    f[S] = s
    i[ROW] = row
    i[STARTED] = 1
    i[RUNNING] = i[HOLD] = i[MODE] = i[STARVED] = 0
    i[M_ROW] = i[TABLE_ROW] = -1
    i[STATUS] = IPO_WAIT
    i[STOPPING] = GO
    if row > 0:
        leave(rows, row - 1, f)
    if s <= 0.0:
        return
    arrive(rows, row, i, nodes_u, nodes_s)
    while i[EVENT] < rows.event_end[row] and rows.event_position[i[EVENT]] * rows.length[row] <= s:
        i[EVENT] += 1
    i[RUNNING] = 1
    if rows.jerk[row] > 0.0:
        i[MODE] = STOPPED
    else:
        begin(rows, row, s, 0.0, inputs, f, i)


@kernel
def may_leave(rows: Rows, inputs: Inputs, f: Floats, i: State) -> bool:
    """Whether the next cycle may need later rows: not if its law goes on for longer, untouched by inputs."""
    if i[MODE] != PLANNED or i[RUNNING] == 0 or f[T1] + f[T2] + f[T3] - f[TAU] <= 2.0 * inputs.cycle:
        return True
    if f[OVERRIDE] != inputs.override or i[LAW] != inputs.law or i[STOPPING] != inputs.stop:
        return True
    return inputs.single_step == 1 or rows.v_now[i[ROW]] > f[WANTED]
