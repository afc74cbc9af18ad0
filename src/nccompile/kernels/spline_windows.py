"""A window of a spline is solved anew, with its knots held or moving, while the rest stands still.

     a   |   |   | control points and knots are free |   |   |   b     three control points on each side are held,
     ────┴───┴───┴───────────────────────────────────┴───┴───┴────     so the joints to the rest stay C2

At an end of the run its own conditions hold.  How far the least squares are believed depends on the errors: errors
along the curve, and moves of knots, are damped by the errors around them (Levenberg-Marquardt).  Own derivation.
"""

from math import inf

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.spline_basis import span_basis, span_powers
from nccompile.kernels.spline_errors import chord_errors
from nccompile.kernels.spline_solve import assemble, fix, hold_knot, lead, solve

__all__ = ["FREE", "HELD", "LED", "damp_window", "measure_window", "solve_window"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

FREE, LED, HELD = 0, 1, 2
"""What is known at an end of a run besides the position: nothing, the direction, or first and second derivative."""

_DAMP = 1.0  # weight of errors along the curve, over error by span
_STIFF = 6.0  # squared tolerances that moving a knot by its span counts as,
_STIFF_DAMP = 0.3  # and squared errors
_REACH = 0.25  # part of a span that a knot moves by at most
_CROWD = 0.3  # a span is at least this part of its shorter neighbour


@kernel
def _held_place(row: Floats, origin: float, t: Floats, first: int, place: Floats) -> None:
    """Fills the control point of the knots t(first..first + 2) of the cubic with powers `row` of (u - origin)."""
    v1 = float(t[first]) - origin
    v2 = float(t[first + 1]) - origin
    v3 = float(t[first + 2]) - origin
    for c in range(len(place)):
        place[c] = (
            float(row[4 * c])
            + float(row[4 * c + 1]) * (v1 + v2 + v3) / 3.0
            + float(row[4 * c + 2]) * (v1 * v2 + v1 * v3 + v2 * v3) / 3.0
            + float(row[4 * c + 3]) * v1 * v2 * v3
        )


@kernel
def solve_window(
    data: Floats, u: Floats, weight: Floats, tangent: Floats, t: Floats, spans: int, rows: Floats, window: Ints,
    along: Floats, stiff: Floats, kinds: Ints, states: Floats,
) -> bool:  # fmt: skip
    """Solves spans anew: their powers in `rows`, or their knots in `t`; false if it cannot.

    window: Shape (4,): first and last span, every how manyth sample counts, whether it is for the knots (0, 1).
    """
    a = int(window[0])
    b = int(window[1])
    step = int(window[2])
    moving = window[3] > 0
    dims = data.shape[1]
    block = dims + 1
    m = b - a + 1
    local = t[a : b + 8]
    low = int(np.searchsorted(u, local[3]))
    high = int(np.searchsorted(u, local[m + 3], "right"))
    basis = np.zeros((m, 7, 4))
    span_basis(local, m, basis)
    size = (m + 3) * block
    band = np.zeros((size, 4 * block))
    right = np.zeros(size)
    assemble(
        data[low:high], u[low:high], weight[low:high], tangent[low:high], local, m, basis, along[a : b + 1],
        rows[a : b + 1], stiff[a : b + 1], moving, (step - low % step) % step, step, band, right,
    )  # fmt: skip
    place = np.zeros(dims)
    for side in range(2):
        at_end = a == 0 if side == 0 else b == spans - 1
        kind = int(kinds[side]) if at_end else HELD
        if kind == HELD:
            if at_end:
                row = states[side]
                origin = float(local[3] if side == 0 else local[m + 3])
            else:
                row = rows[a if side == 0 else b]
                origin = float(local[3] if side == 0 else local[m + 2])
            for k in range(3):
                point = k if side == 0 else m + k
                _held_place(row, origin, local, point + 1, place)
                fix(band, right, m, point, place)
            if moving:
                for k in range(1, 3):
                    knot = k if side == 0 else m - k
                    if 0 < knot < m:
                        hold_knot(band, right, m, dims, knot)
        else:
            for c in range(dims):
                place[c] = states[side, 4 * c]
            if kind == LED:
                direction = np.zeros(dims)
                for c in range(dims):
                    direction[c] = states[side, 4 * c + 1]
                lead(band, right, 1 if side == 0 else m + 1, place, direction)
            fix(band, right, m, 0 if side == 0 else m + 2, place)
    if not solve(band, right, size):
        return False
    if moving:
        _move_knots(local, m, block, right)
    else:
        span_powers(basis, m, dims, right, block, rows[a : b + 1])
    return True


@kernel
def _move_knots(t: Floats, spans: int, block: int, right: Floats) -> None:
    """Moves the knots of padded t by their unknowns, each by a part of a span at most; none crowds others."""
    wanted = np.zeros(spans + 1)
    for k in range(spans + 1):
        wanted[k] = t[k + 3]
        if 0 < k < spans:
            most = _REACH * min(float(t[k + 3] - t[k + 2]), float(t[k + 4] - t[k + 3]))
            wanted[k] += min(max(-float(right[(k + 2) * block - 1]), -most), most)
    for _ in range(3):
        crowded = False
        for k in range(spans):
            shorter = inf
            if k > 0:
                shorter = float(wanted[k] - wanted[k - 1])
            if k + 1 < spans:
                shorter = min(shorter, float(wanted[k + 2] - wanted[k + 1]))
            if float(wanted[k + 1] - wanted[k]) < _CROWD * shorter < inf:
                wanted[k] = t[k + 3]
                wanted[k + 1] = t[k + 4]
                crowded = True
        if not crowded:
            break
    for k in range(1, spans):
        t[k + 3] = wanted[k]


@kernel
def measure_window(
    places: Floats, data: Floats, u: Floats, tangent: Floats, t: Floats, spans: int, rows: Floats, errors: Floats,
    a: int, b: int,
) -> float:  # fmt: skip
    """The greatest error of the spans a..b; those beside them that share a chord with them are looked at too."""
    low = max(int(np.searchsorted(u, t[a + 3])) - 1, 0)
    high = min(int(np.searchsorted(u, t[b + 4], "right")), len(u) - 1)
    while a > 0 and t[a + 3] > u[low]:
        a -= 1
    while b < spans - 1 and t[b + 4] < u[high]:
        b += 1
    return chord_errors(
        places[low : high + 1], data[low : high + 1], t[a : b + 8], b - a + 1, rows[a : b + 1], u[low : high + 1],
        tangent[low : high + 1], errors[a : b + 1], spans > 0,
    )  # fmt: skip


@kernel
def damp_window(
    t: Floats, spans: int, errors: Floats, a: int, b: int, tolerance: float, least: float, along: Floats,
    stiff: Floats,
) -> None:  # fmt: skip
    """Fills how errors along the curve and moves of knots are weighted on the spans a..b, by the errors around."""
    for j in range(a, b + 1):
        error = float(errors[j])
        if j > 0:
            error = max(error, float(errors[j - 1]))
        if j + 1 < spans:
            error = max(error, float(errors[j + 1]))
        along[j] = min(1.0, least + _DAMP * error / float(t[j + 4] - t[j + 3]))
        stiff[j] = _STIFF * tolerance * tolerance + _STIFF_DAMP * error * error
