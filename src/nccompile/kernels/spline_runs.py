"""All runs of a stretch of path become splines: which coordinates count, what holds at the ends, where pieces end.

corner ●--●--●--●--◆--●--●--●--●--● corner        each run from break to break is fitted on its own; a corner
       |    run    |      run     |               gives its direction, a joint ◆ gives all that makes it C2
"""

from math import sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.fit_splines import HELD, LED, fit_spline
from nccompile.kernels.spline_joints import AROUND, chord_direction, joint_state

__all__ = ["CORNER", "JOINT", "LENGTHS", "fit_splines"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

JOINT, LENGTHS, CORNER = 1, 2, 3
"""Kinds of breaks: the path is smooth there; it is but one chord is many times as long as the other; it is not."""


@kernel
def _smooth_from(breaks: Ints, vertex: int, side: int) -> int:
    """The farthest vertex before (side 0) or after (1) a vertex at the end of a run that its direction depends on."""
    if breaks[vertex] == LENGTHS:
        return vertex - 1 if side == 0 else vertex + 1
    if breaks[vertex] == CORNER:
        return vertex
    at = vertex
    last = len(breaks) - 1
    for _ in range(AROUND):
        at += -1 if side == 0 else 1
        if breaks[at] > JOINT or at == 0 or at == last:
            break
    return at


@kernel
def _axes(points: Floats, first: int, last: int) -> Ints:
    """The coordinates of 0..2 that move between two vertices; two of them if fewer do."""
    axes = np.zeros(3, np.int64)
    still = np.zeros(3, np.int64)
    count = 0
    for c in range(3):
        still[c - count] = c
        for i in range(first + 1, last + 1):
            if points[i, c] != points[first, c]:
                axes[count] = c
                count += 1
                break
    for c in range(2 - count):
        axes[count + c] = still[c]
    return axes[: max(count, 2)]


@kernel
def _state(
    points: Floats, breaks: Ints, vertex: int, side: int, tolerance: float, axes: Ints, state: Floats
) -> int:
    """Fills what is known at the start (side 0) or end (1) of a run at a vertex; returns LED or HELD."""
    if breaks[vertex] == JOINT:
        low = _smooth_from(breaks, vertex, 0)
        high = _smooth_from(breaks, vertex, 1)
        joint_state(points, vertex, low, high, tolerance, axes, state)
        return HELD
    chord = vertex - side
    if breaks[vertex] == LENGTHS:
        before = 0.0
        after = 0.0
        for c in range(3):
            d = float(points[vertex, c] - points[vertex - 1, c])
            before += d * d
            d = float(points[vertex + 1, c] - points[vertex, c])
            after += d * d
        chord = vertex - 1 if before > after else vertex
    chord_direction(points, chord, axes, state)
    return LED


@kernel
def fit_splines(
    points: Floats, breaks: Ints, low: int, high: int, tolerance: float, least: int,
    ends: Ints, parts: Floats, targets: Floats, spatial: Ints, rows: Floats,
) -> int:  # fmt: skip
    """Turns the runs between the vertices low and high into splines; returns the number of pieces.

    Args:     points: Shape (n + 1, k), vertices and additional axes, those around low..high too;  breaks: Shape
              (n + 1,), 0 or the kind of a break;  least: lines a spline replaces at least;
              ends: Shape (high - low,), out, the segment (from `low`) in which a piece ends, parts: at which part of
              it;  targets: Shape (high - low, k), out, end positions;  spatial: Shape (high - low,), out: -1 for a
              segment as it is, 0 for a spline in X-Y, 1 for one in space;  rows: Shape (high - low, 12), out.
    """
    count = 0
    first = low
    while first < high:
        last = first + 1
        while last < high and breaks[last] == 0:
            last += 1
        found = 0
        if last - first >= least:
            found = _fit_run(
                points, breaks, first, last, tolerance, ends[count:], parts[count:], targets[count:],
                spatial[count:], rows[count:],
            )  # fmt: skip
        if found == 0:
            for i in range(first, last):
                ends[count] = i - low
                parts[count] = 1.0
                spatial[count] = -1
                for c in range(points.shape[1]):
                    targets[count, c] = points[i + 1, c]
                count += 1
        else:
            for i in range(found):
                ends[count + i] += first - low
            count += found
        first = last
    return count


@kernel
def _fit_run(
    points: Floats, breaks: Ints, first: int, last: int, tolerance: float, ends: Ints, parts: Floats,
    targets: Floats, spatial: Ints, rows: Floats,
) -> int:  # fmt: skip
    """The spline of the run first..last as in `fit_splines`, segments counted from `first`; 0 if there is none."""
    n = last - first
    k = points.shape[1]
    axes = _axes(points, _smooth_from(breaks, first, 0), _smooth_from(breaks, last, 1))
    dims = len(axes)
    places = np.zeros((n + 1, dims))
    extra = np.zeros((n + 1, k - 3))
    way = np.zeros(n + 1)
    for i in range(n + 1):
        square = 0.0
        for c in range(dims):
            places[i, c] = float(points[first + i, axes[c]] - points[first, axes[c]])
            if i > 0:
                square += float(places[i, c] - places[i - 1, c]) * float(places[i, c] - places[i - 1, c])
        for c in range(k - 3):
            extra[i, c] = float(points[first + i, 3 + c] - points[first, 3 + c])
        way[i] = (float(way[i - 1]) if i > 0 else 0.0) + sqrt(square)
    kinds = np.zeros(2, np.int64)
    states = np.zeros((2, 4 * dims))
    for side in range(2):
        vertex = first if side == 0 else last
        kinds[side] = _state(points, breaks, vertex, side, tolerance, axes, states[side])
        for c in range(dims):
            states[side, 4 * c] = places[vertex - first, c]
    most = max(n // 2, 1)
    stops = np.zeros(most + 1)
    powers = np.zeros((most, 4 * dims))
    found = fit_spline(places, extra, way, tolerance, kinds, states, stops, powers, most)
    if found == 0 or found >= n:
        return 0
    flat = 1
    for c in range(dims):
        if axes[c] == 2:
            flat = 0
    row = 0
    for j in range(found):
        stop = float(stops[j + 1])
        while row < n - 1 and way[row + 1] < stop:
            row += 1
        ends[j] = row
        parts[j] = min(max((stop - float(way[row])) / float(way[row + 1] - way[row]), 0.0), 1.0)
        spatial[j] = 1 - flat
        for c in range(12):
            rows[j, c] = 0.0
        for c in range(3):
            targets[j, c] = points[first, c]
            if c < 2 or flat == 0:
                rows[j, 4 * c] = points[first, c]
        for c in range(dims):
            end = float(points[first, axes[c]])
            for p in range(4):
                end += float(powers[j, 4 * c + p])
                rows[j, 4 * int(axes[c]) + p] += float(powers[j, 4 * c + p])
            targets[j, axes[c]] = end
        for c in range(k - 3):
            step = float(extra[row + 1, c] - extra[row, c])
            targets[j, 3 + c] = float(points[first, 3 + c]) + float(extra[row, c]) + float(parts[j]) * step
    ends[found - 1] = n - 1
    parts[found - 1] = 1.0
    for c in range(k):
        targets[found - 1, c] = points[last, c]
    return found
