"""Velocity planning over rows of segments: limits, look-ahead, durations; `kernels.corners` has the junctions.

Every function is a loop over the rows of a window; `passes.velocity` holds the window.  A segment moves along
q(s), s the path length; with v = ds/dt an axis has velocity q' v and acceleration q' a + q'' v².
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curves import max_curvature, tangent3
from nccompile.kernels.planes import SPACE, in_plane_share, least_in_plane, moves, plane_axes
from nccompile.kernels.timelaw import jerk_time, law_times

__all__ = ["durations", "look_ahead", "row_limits", "third_order_durations"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
Kinds = npt.NDArray[np.uint8]

_POSITIONING, _SET_POSITION = 0, 5

_S_SLOPE = 1.875  # greatest slope of 10 w³ - 15 w⁴ + 6 w⁵
_S_BEND = 5.773502691896258  # greatest second derivative of it, 10 / sqrt(3)

_TANGENTIAL = 0.6  # on curves: share of an axis's acceleration that changing the path velocity has at least;
#                    0.8 is left for following the curve, since 0.6² + 0.8² = 1 and both are at right angles


@kernel
def _bend_limits(
    bend: float,
    share: float,
    v_plane: float,
    a_plane: float,
    creep: float,
    peak: float,
    feed: float,
    programmed: float,
) -> tuple[float, float]:
    """Greatest path velocity and acceleration on a curve, by the least limits of the axes that it moves.

    bend: greatest curvature of the path;  share: in-plane length over path length;  programmed: acceleration.
    """
    v_top = v_plane / share
    # What the bend leaves at the row's feed: _TANGENTIAL where it is sharp, nearly all where it is slight.
    across = feed * feed * bend / a_plane
    along = max(sqrt(max(1.0 - across * across, 0.0)), _TANGENTIAL)
    a_top = along * a_plane / (share * peak)
    if bend > 0.0:
        wanted = min(programmed, a_top) * peak * share
        across = sqrt(max(a_plane * a_plane - wanted * wanted, 0.0))
        v_top = min(v_top, max(sqrt(across / bend), creep))
    return v_top, a_top


@kernel
def row_limits(
    kind: Kinds, start: Floats, target: Floats, curve: Ints, plane: Kinds, parameters: Floats, length: Floats,
    profile: npt.NDArray[np.uint16], v_axis: Floats, a_axis: Floats, rapid: Floats, creep: Floats, peak: float,
    straight: Kinds, feed: Floats, accel: Floats, decel: Floats, v_limit: Floats, t_start: Floats, t_end: Floats,
) -> None:  # fmt: skip
    """Per row: the slopes q' at both ends, and what the axes allow.

    start, target, t_start, t_end: Shape (n, k); v_axis, a_axis, rapid: Shape (k,), inf if not limited (rapid:
    if the machine leaves G0 to the program's F); straight u1 (n,): 1 where a curve's own limits are left out;
    peak: greatest over mean acceleration of the time law.
    Changes feed (of positionings), accel, decel; writes v_limit, t_start, t_end.

    On a curve of curvature c, the tangential share at and the normal share an of an axis's limit a hold
    at² + an² <= a²:  at is what an = c feed² leaves, at least 0.6 a;  v_limit = sqrt(an / c), and where the program
    accelerates less than at, an takes the rest (docs/decisions/077).
    creep (k,) [mm/s] is allowed at any curvature.
    """
    axes = target.shape[1]
    for i in range(len(kind)):
        v_limit[i] = inf
        for a in range(axes):
            t_start[i, a] = 0.0
            t_end[i, a] = 0.0
        if kind[i] >= _SET_POSITION or length[i] <= 0.0:
            continue
        run = float(length[i])
        bits = int(profile[i])
        row = int(curve[i])
        where = int(plane[row]) if row >= 0 else -1
        rapid_top = v_top = a_top = inf
        for a in range(axes):
            if moves(where, a):
                continue
            slope = (float(target[i, a]) - float(start[i, a])) / run
            if slope == 0.0:
                continue
            size = abs(slope)
            if (bits >> a) & 1:
                v_top = min(
                    v_top,
                    float(v_axis[a]) / (size * _S_SLOPE),
                    sqrt(0.5 * float(a_axis[a]) * run / (size * _S_BEND)),
                )
                a_top = min(a_top, 0.5 * float(a_axis[a]) / (size * _S_SLOPE * peak))
                rapid_top = min(rapid_top, float(rapid[a]) / (size * _S_SLOPE))
            else:
                t_start[i, a] = slope
                t_end[i, a] = slope
                v_top = min(v_top, float(v_axis[a]) / size)
                a_top = min(a_top, float(a_axis[a]) / (size * peak))
                rapid_top = min(rapid_top, float(rapid[a]) / size)
        if kind[i] == _POSITIONING and rapid_top < inf:
            feed[i] = min(rapid_top, v_top)
        if row >= 0:
            p = parameters[row]
            first, second = plane_axes(where)
            across = 2 - where
            share = 1.0
            if where != SPACE and not (bits >> across) & 1:
                share = in_plane_share(float(start[i, across]), float(target[i, across]), run)
            for end in range(2):
                dx, dy, dz = tangent3(int(kind[i]), p, float(end))
                slopes = t_end if end else t_start
                slopes[i, first] = share * dx
                slopes[i, second] = share * dy
                if where == SPACE:
                    slopes[i, 2] = dz
            if share > 0.0 and straight[i] == 0:
                v_bend, a_bend = _bend_limits(
                    share * share * max_curvature(int(kind[i]), p), share, least_in_plane(v_axis, where),
                    least_in_plane(a_axis, where), least_in_plane(creep, where), peak, float(feed[i]),
                    min(max(accel[i], decel[i]), a_top),
                )  # fmt: skip
                v_top = min(v_top, v_bend)
                a_top = min(a_top, a_bend)
        v_limit[i] = v_top
        accel[i] = min(accel[i], a_top)
        decel[i] = min(decel[i], a_top)


@kernel
def _rest_within(length: Floats, decel: Floats, first: int, last: int) -> float:
    """v² from which rows first..last brake to rest: the sum of 2 d L."""
    total = 0.0
    for j in range(first, last + 1):
        total += 2.0 * decel[j] * length[j]
    return total


@kernel
def look_ahead(
    kind: Kinds, length: Floats, feed: Floats, v_limit: Floats, v_junction: Floats, accel: Floats, decel: Floats,
    v_before: float, known: int, complete: int, window: int, v_end: Floats,
) -> int:  # fmt: skip
    """Writes the end velocities of a window and returns how many leading rows no later row can change.

        backward   v_end[j] <= min(cap[j], sqrt(v_end[j+1]² + 2 d L)) with d, L of row j+1: it can be braked
        forward    v_end[j] <= sqrt(v_end[j-1]² + 2 a L) with a, L of row j: it can be reached

    cap[j] is the junction's limit and the lower of both commanded velocities min(feed, v_limit).  The path
    after the rows at hand is unknown, so the last one ends at 0; from the last row whose cap, not the braking,
    decides, nothing before depends on what follows.  It must be one of the `known` junctions, and not be in the
    middle of rows without length, which share one.  v_before: velocity before row 0.

    window > 0: every row is planned as if the path ended at rest `window` rows after it, which is one more cap:
    v_end[j]² <= sum of 2 d L of rows j+1..j+window.  So a larger window is never slower, and rows with
    `window` known rows behind them are settled too.
    """
    n = len(length)
    settled = n if complete == 1 else 0
    after = 0.0
    ahead = 0.0  # sum of 2 d L of the next `window` rows, to rounding
    for j in range(n - 1, -1, -1):
        cap = 0.0
        brake = 0.0
        if j + 1 < n:
            cap = min(v_junction[j], feed[j], v_limit[j], feed[j + 1], v_limit[j + 1])
            if window > 0:
                ahead += 2.0 * decel[j + 1] * length[j + 1]
                if j + 1 + window < n:
                    ahead -= 2.0 * decel[j + 1 + window] * length[j + 1 + window]
                    if cap * cap > 0.999 * ahead:
                        cap = min(cap, sqrt(_rest_within(length, decel, j + 1, j + window)))
            brake = sqrt(after * after + 2.0 * decel[j + 1] * length[j + 1]) if length[j + 1] > 0.0 else after
            whole = length[j + 1] > 0.0 or kind[j + 1] >= _SET_POSITION
            settles = cap <= brake or (window > 0 and j + window < known)
            if settles and settled == 0 and j < known and whole:
                settled = j + 1
        after = min(cap, brake)
        v_end[j] = after
    v = v_before
    for j in range(n):
        if length[j] > 0.0:
            v = min(v_end[j], sqrt(v * v + 2.0 * accel[j] * length[j]))
        else:
            v = min(v_end[j], v)
        v_end[j] = v
    return settled


@kernel
def durations(
    kind: Kinds, length: Floats, feed: Floats, v_limit: Floats, v_end: Floats, accel: Floats, decel: Floats,
    v_before: float, out: Floats,
) -> None:  # fmt: skip
    """Writes the time [s] of every row at override 1; 0 for rows without length (a dwell's is in its event)."""
    v = v_before
    for j in range(len(kind)):
        out[j] = 0.0
        if length[j] > 0.0 and kind[j] < _SET_POSITION:
            top = min(feed[j], v_limit[j])
            t1, t2, t3, _, v = law_times(length[j], v, top, v_end[j], accel[j], decel[j])
            out[j] = t1 + t2 + t3
        else:
            v = float(v_end[j])


@kernel
def third_order_durations(
    kind: Kinds, length: Floats, v_end: Floats, a_end: Floats, v_before: float, out: Floats
) -> None:
    """Writes the time [s] of every row of a third-order plan that starts without acceleration; 0 without length."""
    v, a = v_before, 0.0
    for j in range(len(kind)):
        out[j] = 0.0
        v1, a1 = float(v_end[j]), float(a_end[j])
        if length[j] > 0.0 and kind[j] < _SET_POSITION:
            out[j] = jerk_time(length[j], v, v1, a, a1)
        v, a = v1, a1
