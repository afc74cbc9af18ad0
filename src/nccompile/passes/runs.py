"""Runs of lines that a fit may replace: where they break, how a stream is cut, how the new rows are put in.

    ──●──●──●──●        a vertex breaks the run, and stays where it is, if
                │        - one of its segments is not a line, has no length in X, Y, Z, or an axis in S-profile
                ●──●     - feed, accelerations, D differ, or a mark or switch region begins or ends there
                 ↑       - the path bends by more than `angle`, or one segment is `ratio` times the other
              a break

A run of more than LONGEST segments is cut there, counted from its start, so the result does not depend on how
the path comes in chunks.
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
from nccompile.passes.base import Context, Flags, gather
from nccompile.passes.edit import STARTS, STOPS, Rows, compose, linked
from nccompile.passes.measure import deviation
from nccompile.toolpath.columns import Bytes, Curves, Floats, Ints, Kind, Toolpath

__all__ = ["LONGEST", "Pieces", "fit_stream", "put_in", "vertex_breaks"]

LONGEST = 16_384
"""Segments of a run at most: the memory a fit needs is bounded by it."""


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


def vertex_breaks(path: Toolpath, angle: float, ratio: float) -> Flags:
    """Shape (n + 1,): which vertices end a run; the first and the last do. angle [rad]."""
    n = len(path)
    breaks = np.ones(n + 1, np.bool_)
    steps = (path.target - path.starts())[:, :3]
    length = np.sqrt((steps * steps).sum(axis=1))
    plain = (path.kind == Kind.LINE) & (path.profile == 0) & (length > COINCIDENT)
    a, b = steps[:-1], steps[1:]
    la, lb = length[:-1], length[1:]
    joined = plain[1:] & plain[:-1] & (path.mark[1:] & STARTS == 0) & (path.mark[:-1] & STOPS == 0)
    for column in (path.feed, path.accel, path.decel, path.radius):
        joined &= column[1:] == column[:-1]
    joined &= (a * b).sum(axis=1) >= cos(angle) * la * lb
    joined &= (la <= ratio * lb) & (lb <= ratio * la)
    breaks[1:n] = ~joined
    return breaks


def fit_stream(
    chunks: Iterator[Toolpath], angle: float, ratio: float, context: Context
) -> Iterator[tuple[Toolpath, Flags]]:
    """The path in windows that end at breaks, each with the breaks of its vertices, Shape (n + 1,)."""
    held: Toolpath | None = None
    for chunk in gather(chunks):
        expect_work(context.report.segments_in)
        held = chunk if held is None else Toolpath.join([held, chunk])
        breaks = vertex_breaks(held, angle, ratio)
        _cut_long(breaks)
        n = len(held)
        open_from = int(np.flatnonzero(breaks[:n])[-1]) if n else 0
        if open_from:
            yield held.rows(0, open_from), breaks[: open_from + 1]
            held = held.rows(open_from, n)
    if held is not None:
        breaks = vertex_breaks(held, angle, ratio)
        _cut_long(breaks)
        yield held, breaks


def _cut_long(breaks: Flags) -> None:
    """Breaks every run after each LONGEST segments."""
    at = np.flatnonzero(breaks)
    for first, last in pairwise(at.tolist()):
        if last - first > LONGEST:
            breaks[np.arange(first + LONGEST, last, LONGEST)] = True


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
