"""compress: drop segments without length, merge lines that are one line.

    in    ●──●────●──●  ●         out   ●─────────●
          line line line line(0)        line

Two lines are one if feed, accelerations, D and S-profile are equal, no mark or stop lies between them, and
every dropped point is within 1e-9 mm of the point at the same share of the way, on all axes.  A line without
length stays if it carries a switch point or a mark, or follows a set position, which it puts out (SoftMotion
§3.2, G92).

Example:
    -p compress
    --- in
    % t
    N10 G1 X10 F50
    N20 G1 X10
    N30 G1 X20
    N40 G1 X30 F20
    --- out
    line 20 0 0 feed 50 source 2
    line 30 0 0 feed 20 source 5
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from nccompile.geometry.tolerance import COINCIDENT
from nccompile.kernels import compress as kernels
from nccompile.passes.base import Context, Flags, Pass, gather
from nccompile.passes.edit import STARTS, STOPS, Links, compose, linked
from nccompile.passes.measure import deviation
from nccompile.toolpath.columns import Kind, Toolpath

__all__ = ["Compress"]

_MOST = 1024
"""Lines merged into one at most: the check of a run costs its length for every line added."""


@dataclass(frozen=True)
class Compress(Pass):
    """Fewer segments on the same path: idempotent but for runs of more than 1024 lines."""

    name: ClassVar[str] = "compress"

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module."""
        held: Toolpath | None = None
        jumped = False
        for chunk in gather(chunks):
            before = jumped
            jumped = bool(len(chunk) and chunk.kind[-1] == Kind.SET_POSITION) if len(chunk) else jumped
            lean = _drop_standing(chunk, before)
            held = lean if held is None else Toolpath.join([held, lean])
            done, open_from = _merge(held, context)
            if open_from:
                yield done.rows(0, len(done) - 1)
                held = held.rows(open_from, len(held))
        if held is not None:
            yield _merge(held, context)[0]


def _drop_standing(path: Toolpath, jumped: bool) -> Toolpath:
    """The path without lines that stand; `jumped`: the row before the first is a set position."""
    n = len(path)
    after_jump = np.concatenate([[jumped], path.kind[:-1] == Kind.SET_POSITION])[:n]
    still: Flags = (path.kind == Kind.LINE) | (path.kind == Kind.POSITIONING)
    still &= np.all(path.target == path.starts(), axis=1) & ~after_jump & (path.mark == 0)
    still[path.events.segment] = False
    if not still.any():
        return path
    origin = np.flatnonzero(~still)
    return compose(
        path,
        origin,
        path.kind[origin],
        path.target[origin],
        path.curve[origin],
        path.curves,
        Links.copies(origin),
    )


def _joins(path: Toolpath) -> Flags:
    """Shape (n,): row i may be one with row i - 1, for all but its geometry."""
    n = len(path)
    joins = np.zeros(n, np.bool_)
    line = (path.kind == Kind.LINE) & (path.profile == 0)
    joins[1:] = line[1:] & line[:-1] & (path.mark[1:] & STARTS == 0) & (path.mark[:-1] & STOPS == 0)
    for column in (path.feed, path.accel, path.decel, path.radius):
        joins[1:] &= column[1:] == column[:-1]
    return joins


def _merge(path: Toolpath, context: Context) -> tuple[Toolpath, int]:
    """The path with its lines merged, and the row of `path` where the last run begins (it may still grow)."""
    n = len(path)
    if n == 0:
        return path, 0
    keep = np.empty(n, np.bool_)
    points = np.vstack([path.start[None, :], path.target])
    open_from = kernels.merge_runs(points, _joins(path), COINCIDENT, _MOST, keep)
    if keep.all():
        return path, open_from
    ends = np.flatnonzero(keep)
    links, firsts = linked(path, ends, np.ones(len(ends)))
    merged = compose(
        path, firsts, path.kind[firsts], path.target[ends], path.curve[firsts], path.curves, links
    )
    if context.measure:
        context.report.deviate(deviation(path, merged, links))
    return merged, open_from
