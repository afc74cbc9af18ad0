"""Limits of turns that a machine file may add: corner angle in all axes, centripetal acceleration and its jump.

A path of curvature vector c(s) = q'' has the centripetal acceleration v² |c|.  Where c jumps from c_1 to c_2, as
where a line meets an arc, the acceleration jumps by v² |c_2 - c_1|:

    v² |c| <= a                      v <= sqrt(a / |c|) on a row
    v² |c_2 - c_1| <= jump           v <= sqrt(jump / |c_2 - c_1|) at a junction

(SoftMotion §6.2.7, SMC_LimitCircularVelocities, there for arcs only; the corner angle is OPENcontrol's MDA.)
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curves import max_curvature
from nccompile.kernels.planes import SPACE, in_plane_share
from nccompile.kernels.reach import bend_at

__all__ = ["turn_limits"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
Kinds = npt.NDArray[np.uint8]

_SET_POSITION = 5


@kernel
def _chord2(t_end: Floats, t_start: Floats) -> float:
    """Square of the chord 2 sin(angle / 2) between two directions of all axes."""
    before = after = 0.0
    for a in range(len(t_end)):
        before += t_end[a] * t_end[a]
        after += t_start[a] * t_start[a]
    if before == 0.0 or after == 0.0:
        return 0.0
    before, after = sqrt(before), sqrt(after)
    chord2 = 0.0
    for a in range(len(t_end)):
        step = t_end[a] / before - t_start[a] / after
        chord2 += step * step
    return chord2


@kernel
def turn_limits(
    kind: Kinds, start: Floats, target: Floats, curve: Ints, plane: Kinds, parameters: Floats, length: Floats,
    t_start: Floats, t_end: Floats, chord: float, accel: float, jump: float, v_limit: Floats, v_junction: Floats,
) -> None:  # fmt: skip
    """Lowers v_limit (n,) and v_junction (n,).

    t_start, t_end: Shape (n, k), slopes at both ends; chord: 2 sin(corner angle / 2), above which the path stops;
    accel, jump [mm/s²], inf where there is no such limit.
    """
    n = len(kind)
    slope, before, ahead, behind = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    last = -1
    for j in range(n):
        if kind[j] >= _SET_POSITION:
            last = -1
            continue
        if length[j] <= 0.0:
            continue
        ahead[:] = 0.0
        behind[:] = 0.0
        c = int(curve[j])
        if c >= 0:
            across, share = int(plane[c]), 1.0
            if across != SPACE:
                share = in_plane_share(start[j, 2 - across], target[j, 2 - across], length[j])
            p = parameters[c]
            bend = share * share * max_curvature(int(kind[j]), p)
            if accel < bend * v_limit[j] * v_limit[j]:
                v_limit[j] = sqrt(accel / bend)
            bend_at(int(kind[j]), across, p, 0.0, share, slope, ahead)
            bend_at(int(kind[j]), across, p, 1.0, share, slope, behind)
        if last >= 0:
            v = inf
            if _chord2(t_end[last], t_start[j]) > chord * chord:
                v = 0.0
            size2 = 0.0
            for a in range(3):
                step = ahead[a] - before[a]
                size2 += step * step
            if size2 > 0.0 and jump < inf:
                v = min(v, sqrt(jump / sqrt(size2)))
            v = min(v, float(v_limit[last]), float(v_limit[j]))
            for row in range(last, j):
                v_junction[row] = min(v_junction[row], v)
        before[:] = behind
        last = j
