"""All runs of a stretch of path become splines: which coordinates count, what holds at the ends, where pieces end.

corner ●--●--●--●--◆--●--●--●--●--● corner        each run from break to break is fitted on its own; a corner
       |    run    |      run     |               gives its direction, a joint ◆ gives all that makes it C2
"""

from math import sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.fit_splines import fit_spline
from nccompile.kernels.spline_joints import AROUND, chord_direction, joint_state
from nccompile.kernels.spline_windows import HELD, LED

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
    k = points.shape[1]
    count = 0
    last = low
    while last < high:
        first = last
        last += 1
        while last < high and breaks[last] == 0:
            last += 1
        n = last - first
        axes = _axes(points, _smooth_from(breaks, first, 0), _smooth_from(breaks, last, 1))
        dims = len(axes)
        most = n // 2
        stops, powers = np.zeros(most + 1), np.zeros((most, 4 * dims))
        way = np.zeros(n + 1)
        found = 0
        if n >= least:
            places, extra = np.zeros((n + 1, dims)), np.zeros((n + 1, k - 3))
            _localize(points, first, axes, places, extra, way)
            kinds, states = np.zeros(2, np.int64), np.zeros((2, 4 * dims))
            for side in range(2):
                vertex = first if side == 0 else last
                kinds[side] = _state(points, breaks, vertex, side, tolerance, axes, states[side])
                for c in range(dims):
                    states[side, 4 * c] = places[vertex - first, c]
            found = fit_spline(places, extra, way, tolerance, kinds, states, stops, powers, most)
        if found == 0:
            for i in range(first, last):
                ends[count] = i - low
                parts[count] = 1.0
                spatial[count] = -1
                for c in range(k):
                    targets[count, c] = points[i + 1, c]
                count += 1
            continue
        row = 0
        for j in range(found):
            stop = float(stops[j + 1])
            while row < n - 1 and way[row + 1] < stop:
                row += 1
            part = min(max((stop - float(way[row])) / float(way[row + 1] - way[row]), 0.0), 1.0)
            ends[count + j] = first - low + row
            parts[count + j] = part
            spatial[count + j] = 0
            for c in range(12):
                rows[count + j, c] = 0.0
            for c in range(k):
                at = float(points[first + row, c])
                targets[count + j, c] = at + part * float(points[first + row + 1, c] - at)
            for c in range(3):
                rows[count + j, 4 * c] = points[first, c]
            for c in range(dims):
                axis = int(axes[c])
                end = float(points[first, axis])
                for p in range(4):
                    end += float(powers[j, 4 * c + p])
                    rows[count + j, 4 * axis + p] += float(powers[j, 4 * c + p])
                targets[count + j, axis] = end
                if axis == 2:
                    spatial[count + j] = 1
            if spatial[count + j] == 0:
                rows[count + j, 8] = 0.0
        count += found
        ends[count - 1] = last - 1 - low
        parts[count - 1] = 1.0
        for c in range(k):
            targets[count - 1, c] = points[last, c]
    return count


@kernel
def _localize(points: Floats, first: int, axes: Ints, places: Floats, extra: Floats, way: Floats) -> None:
    """Fills the coordinates that count, the additional axes, and the way, of a run, all from its first vertex on."""
    for i in range(len(way)):
        square = 0.0
        for c in range(len(axes)):
            places[i, c] = float(points[first + i, axes[c]] - points[first, axes[c]])
            if i > 0:
                square += float(places[i, c] - places[i - 1, c]) * float(places[i, c] - places[i - 1, c])
        for c in range(extra.shape[1]):
            extra[i, c] = float(points[first + i, 3 + c] - points[first, 3 + c])
        way[i] = (float(way[i - 1]) if i > 0 else 0.0) + sqrt(square)
