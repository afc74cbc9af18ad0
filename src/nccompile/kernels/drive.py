"""The virtual drives: limit checks and a first-order lag, cycle by cycle for all axes.

    set position --> [checks] --> actual += share * (set - actual)      share = 1 - exp(-cycle / lag)

A drive sees only set positions, as a real one does: velocity and acceleration are their differences, so a
check here does not share a formula with the planner.  Difference quotients over one cycle never exceed the
bounds of the continuous motion, and a junction's jump of velocity falls into one cycle or is spread over two.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = [
    "ACCELERATION", "ACTUAL", "ACTUAL_VELOCITY", "ALL", "FAULTED", "FOLLOWING", "MAX_DV", "MAX_ERROR", "MAX_POSITION",
    "MAX_VELOCITY", "MIN_POSITION", "RAMP", "SET", "SET_VELOCITY", "SHARE", "TRAVEL", "VELOCITY", "drive_step",
]  # fmt: skip

Floats = npt.NDArray[np.float64]

# Checks, as bits of `watch`; also the fault codes.
VELOCITY, ACCELERATION, TRAVEL, FOLLOWING = 1, 2, 4, 8
ALL = 15

# Rows of the state (5, axes)
SET, SET_VELOCITY, ACTUAL, ACTUAL_VELOCITY, FAULTED = 0, 1, 2, 3, 4

# Rows of the limits (7, axes): greatest velocity, change of velocity in a cycle, least and greatest position,
# following error; share of the way a drive makes up in a cycle; change of velocity of a faulted axis in a cycle.
MAX_VELOCITY, MAX_DV, MIN_POSITION, MAX_POSITION, MAX_ERROR, SHARE, RAMP = 0, 1, 2, 3, 4, 5, 6

_RELATIVE = 1e-6
"""Part of a limit that counts as rounding of the set positions."""

_ABSOLUTE = 1e-6
"""Velocity that counts as rounding [mm/s]: curves are exact to 1e-12 of their length, a cycle is >= 1e-4 s."""

_POSITION = 1e-9
"""Excess of travel and following error that counts as rounding [mm]."""


@kernel
def drive_step(
    setpoints: Floats, cycle: float, watch: int, state: Floats, limits: Floats, actual: Floats, fault: Floats
) -> int:
    """Runs the drives over m cycles; returns the index of the first cycle with a fault, or m.

    setpoints (m, axes) [mm]; cycle [s]; watch: bits of the checks that are on; state (5, axes) changed in
    place; limits (7, axes); actual (m, axes) is filled up to and including the cycle of the fault.
    fault (4,) gets axis, code, value and limit.  A faulted axis no longer follows: it brakes to a stop.
    """
    m: int = setpoints.shape[0]
    for j in range(m):
        code = 0
        for a in range(setpoints.shape[1]):
            s = setpoints[j, a]
            v = (s - state[SET, a]) / cycle
            dv = v - state[SET_VELOCITY, a]
            state[SET, a] = s
            state[SET_VELOCITY, a] = v
            if state[FAULTED, a] != 0.0:
                speed = max(abs(state[ACTUAL_VELOCITY, a]) - limits[RAMP, a], 0.0)
                if state[ACTUAL_VELOCITY, a] < 0.0:
                    speed = -speed
                state[ACTUAL_VELOCITY, a] = speed
                state[ACTUAL, a] += speed * cycle
                actual[j, a] = state[ACTUAL, a]
                continue
            before = state[ACTUAL, a]
            after = before + limits[SHARE, a] * (s - before)
            state[ACTUAL, a] = after
            state[ACTUAL_VELOCITY, a] = (after - before) / cycle
            actual[j, a] = after
            if code != 0:
                continue
            if watch & TRAVEL and (
                s < limits[MIN_POSITION, a] - _POSITION or s > limits[MAX_POSITION, a] + _POSITION
            ):
                code = TRAVEL
                fault[2] = s
                fault[3] = limits[MIN_POSITION, a] if s < limits[MIN_POSITION, a] else limits[MAX_POSITION, a]
            elif watch & VELOCITY and abs(v) > limits[MAX_VELOCITY, a] * (1.0 + _RELATIVE) + _ABSOLUTE:
                code = VELOCITY
                fault[2] = v
                fault[3] = limits[MAX_VELOCITY, a]
            elif watch & ACCELERATION and abs(dv) > limits[MAX_DV, a] * (1.0 + _RELATIVE) + 2.0 * _ABSOLUTE:
                code = ACCELERATION
                fault[2] = dv / cycle
                fault[3] = limits[MAX_DV, a] / cycle
            elif watch & FOLLOWING and abs(s - after) > limits[MAX_ERROR, a] + _POSITION:
                code = FOLLOWING
                fault[2] = s - after
                fault[3] = limits[MAX_ERROR, a]
            if code != 0:
                fault[0] = a
                fault[1] = code
                state[FAULTED, a] = 1.0
        if code != 0:
            return j
    return m
