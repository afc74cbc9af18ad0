"""What the jerk of the axes leaves to the path: greatest path jerk, velocity and acceleration of rows; windows."""

from __future__ import annotations

from math import exp, inf, log, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curves import max_curvature
from nccompile.kernels.planes import least_in_plane, moves

__all__ = ["jerk_limits", "rest_caps"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
Kinds = npt.NDArray[np.uint8]

_SET_POSITION = 5

_BEND = 0.5  # on curves: greatest share of an axis's jerk for following the curve,
_ALONG = 0.35  # least share for changing the path acceleration


@kernel
def jerk_limits(
    kind: Kinds, start: Floats, target: Floats, curve: Ints, plane: Kinds, parameters: Floats, length: Floats,
    profile: npt.NDArray[np.uint16], j_axis: Floats, accel: Floats, decel: Floats, v_limit: Floats, jerk: Floats,
) -> None:  # fmt: skip
    """Writes the path jerk of every row; lowers v_limit, accel and decel to what it leaves.

    On a straight row an axis has the jerk q' j.  With v, a, j along the path and curvature c the jerk of a curve is
    j - c² v³ along it and 3 c v a across it, at right angles.  At constant velocity c² v³ is all there is and gets
    most of the axis's jerk J; a then has what leaves j its least share, and j the rest:

        (|j| + c² v³)² + (3 c v a)² <= J²

    The change of the curvature along ellipses and splines is not counted.
    """
    axes = target.shape[1]
    for i in range(len(kind)):
        if kind[i] >= _SET_POSITION or length[i] <= 0.0:
            continue
        run = float(length[i])
        row = int(curve[i])
        where = int(plane[row]) if row >= 0 else -1
        most = float(jerk[i])
        for a in range(axes):
            size = abs(target[i, a] - start[i, a]) / run
            if size > 0.0 and not moves(where, a):
                most = min(most, float(j_axis[a]) / float(size))
        if row >= 0:
            least = least_in_plane(j_axis, where)
            bend = max_curvature(int(kind[i]), parameters[row])
            if least < inf:
                if 0.0 < bend < inf:
                    v = min(float(v_limit[i]), exp(log(_BEND * least / (bend * bend)) / 3.0))
                    v_limit[i] = v
                    turn = bend * bend * v * v * v / least
                    ramp = sqrt(1.0 - (turn + _ALONG) * (turn + _ALONG)) * least / (3.0 * bend * v)
                    accel[i] = min(accel[i], ramp)
                    decel[i] = min(decel[i], ramp)
                    across = 3.0 * bend * v * max(accel[i], decel[i]) / least
                    least *= sqrt(1.0 - across * across) - turn
                most = min(most, least)
        jerk[i] = most


@kernel
def _stop_velocity(length: float, decel: float, jerk: float) -> float:
    """The velocity from which rest can be reached over `length`, with no acceleration at both ends."""
    if length * jerk * jerk <= decel * decel * decel:
        return exp(log(length * length * jerk) / 3.0)
    half = 0.5 * decel / jerk
    return decel * (sqrt(half * half + 2.0 * length / decel) - half)


@kernel
def rest_caps(length: Floats, decel: Floats, jerk: Floats, window: int, node: Floats) -> None:
    """Lowers node (n,), the caps behind rows, to velocities that can be braked to rest in the next `window` rows.

    Rows whose next `window` rows are not at hand keep their cap.
    """
    n = len(length)
    least_a, least_j = inf, inf
    for i in range(n):
        least_a = min(least_a, decel[i])
        least_j = min(least_j, jerk[i])
    ahead = 0.0  # length of the next `window` rows, to rounding
    for i in range(1, min(window, n)):
        ahead += length[i]
    for i in range(n - window):
        ahead += length[i + window]
        if i > 0:
            ahead -= length[i]
        cap = float(node[i])
        if cap <= 0.0 or (ahead > 0.0 and cap <= 0.999 * _stop_velocity(ahead, least_a, least_j)):
            continue
        run = 0.0
        a, j = inf, inf
        best = 0.0
        for k in range(i + 1, i + 1 + window):
            run += length[k]
            a = min(a, float(decel[k]))
            j = min(j, float(jerk[k]))
            best = max(best, _stop_velocity(run, a, j))
            if best >= cap:
                break
        node[i] = min(cap, best)
