"""A toolpath as polylines and marks, vectorised: a million segments take about a second.

rapid    --- green     positionings (G0)                  Each is one array of points in X, Y, Z with NaN rows
feed     --- blue      all other motion                   between runs: one polyline for the plotter.
G92, dwells and M functions draw nothing; a jump starts a new run.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from math import pi
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from nccompile.geometry.sampling import sample_curves
from nccompile.kernels import curves as kernels
from nccompile.toolpath.columns import EventKind, Floats, Kind, Plane, Toolpath
from nccompile.toolpath.lengths import PLANE_AXES, THIRD_AXIS

__all__ = ["Drawing", "Spot", "draw", "thin"]

_STEP = pi / 72.0  # 2.5°: the sagitta is 2.4e-4 of the radius, a quarter pixel on the largest circle
_COUNTS = (4, 12, 36, 72, 144)
_CUBIC_POINTS = 72
_ROWS = 4096  # segments drawn at once: bounds the memory of sampled curves

_NOTHING, _RAPID, _FEED = 0, 1, 2


class Spot(NamedTuple):
    """A marked place: kind "switch" or "m", label ("H3", "H-3", "M10") and point X, Y, Z."""

    kind: str
    label: str
    point: tuple[float, float, float]


@dataclass(frozen=True)
class Drawing:
    """rapid, feed: Shape (r, 3), points with NaN rows between runs [mm]; spots in the order of the path;
    start, end: X, Y, Z."""

    rapid: Floats
    feed: Floats
    spots: tuple[Spot, ...]
    start: tuple[float, float, float]
    end: tuple[float, float, float]

    def box(self) -> tuple[Floats, Floats]:
        """Least and greatest X, Y, Z of all that is drawn."""
        ends = np.array([self.start, self.end])
        points = np.vstack([self.rapid, self.feed, ends])
        return np.nanmin(points, axis=0), np.nanmax(points, axis=0)


@dataclass
class _Pen:
    """Points and classes of the path so far: `cls` is that of the edge that ends at the point."""

    points: list[Floats] = field(default_factory=list)
    classes: list[npt.NDArray[np.uint8]] = field(default_factory=list)
    spots: list[Spot] = field(default_factory=list)


def draw(chunks: Iterable[Toolpath]) -> Drawing:
    """The drawing of a path; X, Y and Z only, as further axes have no place on paper."""
    pen = _Pen()
    start = end = np.zeros(3)
    first = True
    for chunk in chunks:
        if first:
            start, first = chunk.start[:3], False
            pen.points.append(start[None, :])
            pen.classes.append(np.zeros(1, np.uint8))
        end = chunk.end[:3]
        for at in range(0, len(chunk), _ROWS):
            _segments(pen, chunk.rows(at, at + _ROWS) if len(chunk) > _ROWS else chunk)
    points = np.vstack(pen.points) if pen.points else np.zeros((1, 3))
    classes = np.concatenate(pen.classes) if pen.classes else np.zeros(1, np.uint8)
    return Drawing(
        _runs(points, classes == _RAPID),
        _runs(points, classes == _FEED),
        tuple(pen.spots),
        _xyz(start),
        _xyz(end),
    )


def _xyz(point: Floats) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in point[:3])
    return x, y, z


def _segments(pen: _Pen, chunk: Toolpath) -> None:
    """Adds the points after the start of every segment: its end, or samples of its curve up to there."""
    counts = _point_counts(chunk)
    last = np.cumsum(counts) - 1
    points = np.empty((int(counts.sum()), 3))
    points[last] = chunk.target[:, :3]
    curved = np.flatnonzero(counts > 1)
    starts = chunk.starts()
    for count in np.unique(counts[curved]):
        rows = curved[counts[curved] == count]
        places = (last[rows, None] - count + 1) + np.arange(count - 1)
        points[places] = _sampled(chunk, starts, rows, int(count))
    cls = np.full(len(chunk), _NOTHING, np.uint8)
    cls[chunk.kind == Kind.POSITIONING] = _RAPID
    cls[(chunk.kind > Kind.POSITIONING) & (chunk.kind <= Kind.POLYNOMIAL)] = _FEED
    pen.points.append(points)
    pen.classes.append(np.repeat(cls, counts))
    pen.spots += _spots(chunk, starts)


def _point_counts(chunk: Toolpath) -> npt.NDArray[np.intp]:
    """How many points each segment gets; few different numbers, so that curves are sampled in groups."""
    counts = np.ones(len(chunk), np.intp)
    rows = np.flatnonzero(chunk.curve >= 0)
    p = chunk.curves.parameters[chunk.curve[rows]]
    kinds = chunk.kind[rows]
    sweep = np.abs(np.where(kinds == Kind.ARC, p[:, 4], 2.0 * p[:, 6]))
    wanted = np.minimum(sweep / _STEP, _COUNTS[-1])
    found = np.array(_COUNTS)[np.searchsorted(_COUNTS, wanted)]
    counts[rows] = np.where(kinds == Kind.POLYNOMIAL, _CUBIC_POINTS, found)
    return counts


def _sampled(chunk: Toolpath, starts: Floats, rows: npt.NDArray[np.intp], count: int) -> Floats:
    """Shape (m, count - 1, 3): inner points of curves; the third axis is drawn linear in the length,
    in the S-profile too."""
    table = chunk.curve[rows]
    planes = chunk.curves.plane[table]
    flat = sample_curves(chunk.kind[rows], chunk.curves.parameters[table], np.linspace(0.0, 1.0, count + 1))
    steps = np.sqrt((np.diff(flat[:, :, :2], axis=1) ** 2).sum(axis=2))
    way = np.cumsum(steps, axis=1)
    with np.errstate(invalid="ignore"):
        share = np.nan_to_num(way / way[:, -1:])[:, :-1]
    inner = np.empty((len(rows), count - 1, 3))
    for plane in np.unique(planes):
        here = planes == plane
        if plane == Plane.SPACE:
            inner[here] = flat[here, 1:-1]
            continue
        third = THIRD_AXIS[int(plane)]
        inner[np.ix_(here, range(count - 1), PLANE_AXES[int(plane)])] = flat[here, 1:-1, :2]
        a, b = starts[rows[here], third], chunk.target[rows[here], third]
        inner[here, :, third] = a[:, None] + (b - a)[:, None] * share[here]
    return inner


def _spots(chunk: Toolpath, starts: Floats) -> list[Spot]:
    """The switch points and M functions of a chunk."""
    e = chunk.events
    spots: list[Spot] = []
    for at in np.flatnonzero(e.kind != EventKind.DWELL).tolist():
        row, number = int(e.segment[at]), int(e.number[at])
        if e.kind[at] == EventKind.M_FUNCTION:
            spots.append(Spot("m", f"M{number}", _xyz(chunk.target[row])))
        else:
            spots.append(Spot("switch", f"H{number}", _place(chunk, starts, row, float(e.position[at]))))
    return spots


def _place(chunk: Toolpath, starts: Floats, row: int, share: float) -> tuple[float, float, float]:
    """The point at a share 0..1 of a segment's length."""
    point = starts[row, :3] + share * (chunk.target[row, :3] - starts[row, :3])
    at = int(chunk.curve[row])
    if at < 0:
        return _xyz(point)
    kind, p = int(chunk.kind[row]), chunk.curves.parameters[at]
    nodes_u, nodes_s = np.empty(kernels.NODES), np.empty(kernels.NODES)
    count = kernels.tabulate(kind, p, nodes_u, nodes_s)
    u = kernels.parameter(kind, p, nodes_u, nodes_s, count, share * float(nodes_s[count - 1]))
    if chunk.curves.plane[at] == Plane.SPACE:
        return kernels.point3(kind, p, u)
    point[list(PLANE_AXES[int(chunk.curves.plane[at])])] = kernels.point(kind, p, u)
    return _xyz(point)


def _runs(points: Floats, edges: npt.NDArray[np.bool_]) -> Floats:
    """Polylines of the edges (i-1, i) that are marked: each run with its first point, a NaN row after it."""
    at = np.flatnonzero(edges)
    if not len(at):
        return np.empty((0, 3))
    breaks = np.concatenate([[True], np.diff(at) > 1])
    run = np.cumsum(breaks)
    place = np.arange(len(at)) + 2 * run - 1
    runs = np.full((len(at) + 2 * int(run[-1]), 3), np.nan)
    runs[place] = points[at]
    runs[place[breaks] - 1] = points[at[breaks] - 1]
    return runs


def thin(line: Floats, pixel: float) -> Floats:
    """A polyline without the points that fall on the same grid cell as the one before.

    Args:     line: Shape (r, 2), NaN rows between runs;  pixel: cell size, > 0.
    Returns:  Shape (<= r, 2); no point moves, and what is left out is nearer than a cell to what stays.
    """
    if not len(line):
        return line
    cell = np.floor(line / pixel)
    gap = np.isnan(line[:, 0])
    keep = np.ones(len(line), np.bool_)
    keep[1:] = (cell[1:] != cell[:-1]).any(axis=1) & ~(gap[1:] & gap[:-1])
    keep[:-1] |= gap[1:] & ~gap[:-1]
    return line[keep]
