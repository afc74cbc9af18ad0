"""Direction and curvature of the path at vertices where a spline begins or ends.

    ●--●--●--●--◆--●--●--●--●     at a joint ◆ (the feed changes, or the run is cut because it is long) a polynomial
                                  through ◆ fits the vertices on both sides; the splines on both sides take first
                                  and second derivative from it, so the path stays C2 across the joint

    P(s) = P + T s + B s² + C s³ + D s⁴,  s: way from ◆,  as far as it stays within half the tolerance

At a corner the direction is that of the chord at it; of the longer chord, for both sides, where only the lengths of
the chords break the run.  Own derivation.
"""

from math import sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = ["AROUND", "chord_direction", "joint_state"]

Floats = npt.NDArray[np.float64]

AROUND = 12
"""Vertices on each side of a joint that its direction depends on, at most."""

_PART = 0.5  # of the tolerance that the polynomial may be off


@kernel
def chord_direction(points: Floats, i: int, axes: npt.NDArray[np.int64], state: Floats) -> None:
    """Fills the direction of the chord from vertex i to i + 1 into a state (see `joint_state`)."""
    size = 0.0
    for c in range(3):
        d = float(points[i + 1, c] - points[i, c])
        size += d * d
    size = sqrt(size)
    for c in range(len(axes)):
        state[4 * c + 1] = float(points[i + 1, axes[c]] - points[i, axes[c]]) / size


@kernel
def joint_state(
    points: Floats, at: int, first: int, last: int, tolerance: float, axes: npt.NDArray[np.int64], state: Floats,
) -> None:  # fmt: skip
    """Fills direction (unit) and half the second derivative by the way at a vertex.

    Args:     points: Shape (n + 1, >= 3), vertices;  at: the vertex;  first, last: those around it that belong to
              the same smooth path, first < at < last;  axes: Shape (dims,), the coordinates that count;
              state: Shape (4 dims,), out: for each the position (not touched), the direction, half the second
              derivative, 0.
    """
    dims = len(axes)
    reach = min(at - first, last - at, AROUND)
    size = 2 * AROUND + 1
    way = np.zeros(size)
    shift = np.zeros((size, dims))
    matrix = np.zeros((4, 4))
    answer = np.zeros((4, dims))
    while True:
        count = 2 * reach + 1
        for k in range(1, count):
            d2 = 0.0
            for c in range(dims):
                d = float(points[at - reach + k, axes[c]] - points[at - reach + k - 1, axes[c]])
                d2 += d * d
            way[k] = float(way[k - 1]) + sqrt(d2)
        middle = float(way[reach])
        for k in range(count):
            way[k] -= middle
            for c in range(dims):
                shift[k, c] = float(points[at - reach + k, axes[c]] - points[at, axes[c]])
        degree = 4 if reach >= 4 else (3 if reach == 3 else 2)
        _polynomial(way, shift, count, degree, matrix, answer)
        off = 0.0
        for k in range(count):
            s = float(way[k])
            e2 = 0.0
            for c in range(dims):
                value = 0.0
                for d in range(degree - 1, -1, -1):
                    value = (value + float(answer[d, c])) * s
                e2 += (value - float(shift[k, c])) * (value - float(shift[k, c]))
            off = max(off, sqrt(e2))
        if off <= _PART * tolerance or reach == 1:
            break
        reach = max(reach * 2 // 3, 1)
        way[0] = 0.0
    speed = 0.0
    for c in range(dims):
        speed += float(answer[0, c]) * float(answer[0, c])
    speed = sqrt(speed)
    along = 0.0
    for c in range(dims):
        state[4 * c + 1] = float(answer[0, c]) / speed
        along += float(answer[1, c]) * float(state[4 * c + 1])
    for c in range(dims):
        state[4 * c + 2] = (float(answer[1, c]) - along * float(state[4 * c + 1])) / (speed * speed)
        state[4 * c + 3] = 0.0


@kernel
def _polynomial(way: Floats, shift: Floats, count: int, degree: int, matrix: Floats, answer: Floats) -> None:
    """Fills answer, Shape (4, dims), with the least squares coefficients of way, way², .. (none of way⁰)."""
    dims = shift.shape[1]
    unit = max(abs(float(way[0])), abs(float(way[count - 1])))
    powers = np.zeros(4)
    for d in range(4):
        for e in range(4):
            matrix[d, e] = 0.0
        for c in range(dims):
            answer[d, c] = 0.0
    for k in range(count):
        s = float(way[k]) / unit
        power = 1.0
        for d in range(degree):
            power *= s
            powers[d] = power
        for d in range(degree):
            for e in range(degree):
                matrix[d, e] += float(powers[d]) * float(powers[e])
            for c in range(dims):
                answer[d, c] += float(powers[d]) * float(shift[k, c])
    for d in range(degree):
        pivot = float(matrix[d, d])
        for e in range(d + 1, degree):
            factor = float(matrix[e, d]) / pivot
            for f in range(d, degree):
                matrix[e, f] -= factor * float(matrix[d, f])
            for c in range(dims):
                answer[e, c] -= factor * float(answer[d, c])
    for d in range(degree - 1, -1, -1):
        for c in range(dims):
            value = float(answer[d, c])
            for e in range(d + 1, degree):
                value -= float(matrix[d, e]) * float(answer[e, c])
            answer[d, c] = value / float(matrix[d, d])
    scale = 1.0
    for d in range(degree):
        scale *= unit
        for c in range(dims):
            answer[d, c] /= scale
