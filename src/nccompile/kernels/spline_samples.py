"""What a spline is fitted to: the middle of the band that chords leave to it, vertex by vertex and in between.

    vertices of chords lie on the outside of a bend, their      ●─ ─ ─ ─ ─ ─ ─●     sag
    middles on the inside:                                        ' - . _ . - '     half of it each way: · · ·

A vertex is moved inwards by half the sag, the middle of a chord outwards by as much; in between it is a parabola.
Sag: turn · chord / 8, with the shorter of both chords at the vertex.  Own derivation.
"""

from math import sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = ["count_samples", "fill_samples"]

Floats = npt.NDArray[np.float64]

_MOST_PARTS = 16  # of one chord
_LEAST_BAND = 0.3  # part of the tolerance: a narrower band weighs as much as this


@kernel
def _parts(size: float, spacing: float) -> int:
    return min(max(int(size / spacing) + 1, 1), _MOST_PARTS)


@kernel
def count_samples(way: Floats, spacing: float) -> int:
    """The number of samples of a run, its vertices and what cuts its chords to `spacing` [mm]; at most 16 a chord."""
    count = 1
    for i in range(1, len(way)):
        count += _parts(float(way[i] - way[i - 1]), spacing)
    return count


@kernel
def fill_samples(
    points: Floats, way: Floats, spacing: float, tolerance: float, places: Floats, data: Floats, u: Floats,
    weight: Floats, tangent: Floats,
) -> None:  # fmt: skip
    """Fills the samples of a run.

    Args:     points: Shape (n + 1, dims), vertices;  way: Shape (n + 1,), ascending;
              places, data: Shape (m, dims), out, on the chords and in the middle of the band;  u: Shape (m,), out,
              the way;  weight: Shape (m,), out, by the way and how narrow the band is;  tangent: Shape (m, dims),
              out, directions of the chords.
    """
    dims = points.shape[1]
    last = len(points) - 1
    before = np.zeros(dims)
    after = np.zeros(dims)
    count = 0
    for i in range(last):
        size = float(way[i + 1] - way[i])
        parts = _parts(size, spacing)
        for c in range(dims):
            before[c] = after[c]
            after[c] = 0.0
        if i + 2 <= last:
            following = float(way[i + 2] - way[i + 1])
            shorter = min(size, following) / 16.0
            for c in range(dims):
                turn = float(points[i + 2, c] - points[i + 1, c]) / following
                after[c] = shorter * (turn - float(points[i + 1, c] - points[i, c]) / size)
        for k in range(parts):
            s = k / parts
            u[count] = float(way[i]) + s * size
            side = 1.0 - 8.0 * s * (1.0 - s)
            for c in range(dims):
                step = float(points[i + 1, c] - points[i, c])
                place = float(points[i, c]) + s * step
                places[count, c] = place
                data[count, c] = place + side * (float(before[c]) + s * float(after[c] - before[c]))
                tangent[count, c] = step / size
            count += 1
    u[count] = way[last]
    for c in range(dims):
        places[count, c] = points[last, c]
        data[count, c] = points[last, c]
        tangent[count, c] = tangent[count - 1, c]
    for i in range(count + 1):
        apart = 0.0
        for c in range(dims):
            apart += float(data[i, c] - places[i, c]) * float(data[i, c] - places[i, c])
        band = max(1.0 - sqrt(apart) / tolerance, _LEAST_BAND)
        size = float(u[min(i + 1, count)] - u[max(i - 1, 0)])
        weight[i] = size / (band * band)
