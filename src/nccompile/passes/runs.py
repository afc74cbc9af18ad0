"""Runs of lines that a fit may replace: where they break, how a stream is cut, how the new rows are put in.

    ──●──●──●──●        a vertex breaks the run, and stays where it is, if
                │        - one of its segments is not a line, has no length in X, Y, Z, or an axis in S-profile
                ●──●     - feed, accelerations, D differ, or a mark or switch region begins or ends there
                 ↑       - the path bends by more than `angle`, or one segment is `ratio` times the other
              a break

A break is a corner if the path is not smooth there; if only feed or marks differ, or the run is cut because it is
long, it is a joint.  A run of more than LONGEST segments is cut, counted from its start.  Each window of the path
comes with the rows around it that its joints depend on, so the result does not depend on how the path comes in
chunks.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import cos

import numpy as np
import numpy.typing as npt

from nccompile.geometry.tolerance import COINCIDENT
from nccompile.kernels import expect_work
from nccompile.kernels.spline_joints import AROUND
from nccompile.kernels.spline_runs import CORNER, JOINT, LENGTHS
from nccompile.passes.base import Context, Flags, gather
from nccompile.passes.edit import STARTS, STOPS, Rows, compose, linked
from nccompile.passes.measure import deviation
from nccompile.toolpath.columns import Bytes, Curves, Floats, Ints, Kind, Toolpath

__all__ = ["LONGEST", "Pieces", "Window", "fit_stream", "put_in", "vertex_breaks"]

LONGEST = 16_384
"""Segments of a run at most: the memory a fit needs is bounded by it."""

_PASSES = 20
"""How often a fit looks at each segment: a small path is already work for compiled kernels."""


@dataclass(frozen=True)
class Pieces:
    """What a fit made of a path.

    last: Shape (m,), the source row in which each piece ends, ascending;  part: Shape (m,), at which part 0..1 of
    it;  kind: Shape (m,), the kind of a new piece,
    or -1: the source row as it is;  target: Shape (m, k);  plane: Shape (m,) and rows: Shape (m, 12), the curves.
    """

    last: Rows
    part: Floats
    kind: npt.NDArray[np.int64]
    target: Floats
    plane: npt.NDArray[np.int64]
    rows: Floats


@dataclass(frozen=True)
class Window:
    """A stretch of path that ends at breaks.

    around: the path from some rows before the stretch to some rows after it;  low, high: its rows;  breaks: Shape
    (len(around) + 1,), 0 or what breaks a run at each vertex: JOINT, LENGTHS or CORNER.
    """

    around: Toolpath
    low: int
    high: int
    breaks: Rows

    @property
    def path(self) -> Toolpath:
        """The stretch itself."""
        return self.around.rows(self.low, self.high)


def vertex_breaks(path: Toolpath, angle: float, ratio: float) -> Rows:
    """Shape (n + 1,): what ends a run at each vertex; the first and the last do. angle [rad]."""
    n = len(path)
    breaks = np.full(n + 1, CORNER)
    steps = (path.target - path.starts())[:, :3]
    length = np.sqrt((steps * steps).sum(axis=1))
    plain = (path.kind == Kind.LINE) & (path.profile == 0) & (length > COINCIDENT)
    a, b = steps[:-1], steps[1:]
    la, lb = length[:-1], length[1:]
    same = (path.mark[1:] & STARTS == 0) & (path.mark[:-1] & STOPS == 0)
    for column in (path.feed, path.accel, path.decel, path.radius):
        same &= column[1:] == column[:-1]
    smooth = plain[1:] & plain[:-1] & ((a * b).sum(axis=1) >= cos(angle) * la * lb)
    even = (la <= ratio * lb) & (lb <= ratio * la)
    breaks[1:n] = np.where(~smooth, CORNER, np.where(~even, LENGTHS, np.where(same, 0, JOINT)))
    return breaks


def fit_stream(chunks: Iterator[Toolpath], angle: float, ratio: float, context: Context) -> Iterator[Window]:
    """The path in windows that end at breaks."""
    held: Toolpath | None = None
    low = 0
    for chunk in gather(chunks):
        expect_work(_PASSES * context.report.segments_in)
        held = chunk if held is None else Toolpath.join([held, chunk])
        breaks = _all_breaks(held, low, angle, ratio)
        high = _settled(breaks)
        if high > low:
            around = min(high + AROUND, len(held))
            yield Window(held.rows(0, around), low, high, breaks[: around + 1])
            rest = max(high - AROUND, 0)
            held, low = held.rows(rest, len(held)), high - rest
    if held is not None:
        yield Window(held, low, len(held), _all_breaks(held, low, angle, ratio))


def _settled(breaks: Rows) -> int:
    """The last break whose joint does not depend on what is still to come, 0 if there is none."""
    n = len(breaks) - 1
    known = np.flatnonzero(breaks[:n])
    corners = known[breaks[known] > JOINT]
    settled = known[(known + AROUND <= n) | (known <= (corners[-1] if len(corners) else 0))]
    return int(settled[-1]) if len(settled) else 0


def _all_breaks(path: Toolpath, low: int, angle: float, ratio: float) -> Rows:
    """The breaks of a path of which the rows before `low` are done, with every run cut after LONGEST segments."""
    breaks = vertex_breaks(path, angle, ratio)
    if breaks[low] == 0:  # the run was cut there
        breaks[low] = JOINT
    at = np.flatnonzero(breaks[low:]) + low
    for first, last in pairwise([low, *at[at > low].tolist()]):
        if last - first > LONGEST:
            breaks[np.arange(first + LONGEST, last, LONGEST)] = JOINT
    return breaks


def put_in(path: Toolpath, pieces: Pieces, context: Context) -> Toolpath:
    """The path with its pieces; columns come from the first source row of each, events move along."""
    links, firsts = linked(path, pieces.last, pieces.part)
    old = pieces.kind < 0
    kind: Bytes = np.where(old, path.kind[firsts], pieces.kind).astype(np.uint8)
    curves, shape = _curves(path, pieces, firsts, old)
    out = compose(path, firsts, kind, pieces.target, shape, curves, links)
    if context.measure and not old.all():
        context.report.deviate(deviation(path, out, links))
    return out


def _curves(path: Toolpath, pieces: Pieces, firsts: Rows, old: Flags) -> tuple[Curves, Ints]:
    """One table of the kept and the new curves, and the row of each piece in it."""
    shape = np.full(len(firsts), -1, np.int32)
    shape[old] = path.curve[firsts[old]]
    fresh = np.flatnonzero(pieces.kind >= Kind.ARC)
    shape[fresh] = len(path.curves) + np.arange(len(fresh), dtype=np.int32)
    planes = np.concatenate([path.curves.plane, pieces.plane[fresh].astype(np.uint8)])
    return Curves(planes, np.vstack([path.curves.parameters, pieces.rows[fresh]])), shape
