"""The largest deviation of a rewritten stretch from the one before, measured on samples of both.

    before  ●───────●───────●───────●        every sample of one path looks for the nearest place on the
             ╲ d     ╲       ╲       ╲       segments of the other around where the links say it went;
    after     ●───────────────●───────●      the greatest of all these distances is the deviation

Only points are compared: nothing of the computation that made the new path is used.  Segments that jump or
wait are left out.  SoftMotion has no such figure; own derivation.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from nccompile.geometry.frames import Frame
from nccompile.kernels import distance as kernels
from nccompile.passes.edit import Links, geometry
from nccompile.toolpath.columns import Floats, Kind, Toolpath

__all__ = ["deviation", "one_sided", "samples"]

Rows = npt.NDArray[np.int64]

_PER_LINE = 2
_PER_CURVE = 16
_MOST = 64
_REACH = 10


def deviation(before: Toolpath, after: Toolpath, links: Links, frame: Frame | None = None) -> float:
    """The greatest distance [mm] between two paths, both ways, in X, Y, Z.

    frame: the map by which the path was moved on purpose; way back its greatest stretch bounds the distance.
    """
    if not len(before) or not len(after) or not len(links.segment):
        return 0.0
    sample, owner, u = samples(before)
    sample = sample if frame is None else frame.points(sample)
    link = _at(links.segment + links.p0, owner + u)
    there = one_sided(sample, after, links.row[link])
    order = np.lexsort((links.q0, links.row))
    per_row = np.bincount(links.row, minlength=len(after))
    sample, owner, u = samples(after, np.minimum(2 * per_row, _MOST))
    link = order[_at((links.row + links.q0)[order], owner + u)]
    if frame is None:
        return max(there, one_sided(sample, before, links.segment[link]))
    back = one_sided(frame.inverse().points(sample), before, links.segment[link])
    return max(there, frame.stretch[1] * back)


def _at(keys: Floats, wanted: Floats) -> Rows:
    """The last of ascending keys at or before each wanted one."""
    return np.maximum(np.searchsorted(keys, wanted, side="right") - 1, 0).astype(np.int64)


def one_sided(sample: Floats, other: Toolpath, near: npt.NDArray[np.intp]) -> float:
    """The greatest distance [mm] of samples, Shape (m, 3), from `other`; near: a segment of it near each one."""
    if not len(sample):
        return 0.0
    return kernels.deviations(*geometry(other), sample, near.astype(np.int64), _REACH)


def samples(path: Toolpath, count: Rows | None = None) -> tuple[Floats, Rows, Floats]:
    """Points on the moving segments.

    Args:     count: samples a segment, at least. Shape (n,).
    Returns:  Shape (m, 3) [mm];  the segment of each, ascending;  its share 0..1 of the way (roughly, on curves).
    """
    number = np.where(path.curve >= 0, _PER_CURVE, _PER_LINE).astype(np.int64)
    if count is not None:
        number = np.maximum(number, count)
    number = np.where(path.kind <= Kind.POLYNOMIAL, number, 0)
    owner = np.repeat(np.arange(len(path), dtype=np.int64), number)
    first = np.cumsum(number) - number
    u: Floats = (np.arange(len(owner)) - first[owner]) / np.maximum(number[owner], 1)
    out = np.empty((len(owner), 3))
    kernels.sample_rows(*geometry(path), owner, u, out)
    steps = np.diff(out, axis=0, prepend=out[:1])
    way = np.cumsum(np.sqrt((steps * steps).sum(axis=1)))
    way -= way[first[owner]]
    length = np.where(path.length > 0.0, path.length, 1.0)[owner]
    return out, owner, np.where(path.curve[owner] >= 0, np.minimum(way / length, 1.0 - 1e-9), u)
