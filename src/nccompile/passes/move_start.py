"""move-start: a closed contour begins at another of its segments.

    in    rapid ─> A ─1─ B ─2─ C ─3─ A        out (segment 2)   rapid ─> B ─2─ C ─3─ A ─1─ B

A contour is a run of feed segments; it is closed if it ends where it starts on all axes.  The move before it
now goes to the new start.  A move after the contour starts at the new end, so the next position is unchanged.

Example:
    -p move-start{segment=2}
    --- in
    % t
    N10 G1 X10 F50
    N20 G1 Y10
    N30 G1 X0 Y0
    --- out
    start 10 0 0
    line 10 10 0 feed 50 source 3
    line 0 0 0 feed 50 source 4
    line 10 0 0 feed 50 source 2
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from nccompile.errors import UsageError
from nccompile.geometry.tolerance import COINCIDENT
from nccompile.passes.base import Context, Pass
from nccompile.passes.edit import Links, compose, is_motion
from nccompile.passes.measure import deviation
from nccompile.toolpath.columns import Toolpath

__all__ = ["MoveStart"]


@dataclass(frozen=True)
class MoveStart(Pass):
    """Another first segment for the contour that holds it; segment: from 1, as the path reaches this pass.

    The whole path is held in memory.
    """

    name: ClassVar[str] = "move-start"
    segment: int

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module."""
        path = Toolpath.join(list(chunks))
        i = self.segment - 1
        if not (0 <= i < len(path) and is_motion(int(path.kind[i]))):
            raise UsageError(f"move-start: segment {self.segment} is not a feed segment of the path")
        first, last = i, i
        while first > 0 and is_motion(int(path.kind[first - 1])):
            first -= 1
        while last + 1 < len(path) and is_motion(int(path.kind[last + 1])):
            last += 1
        start = path.starts()[first]
        if np.abs(start - path.target[last]).max() > COINCIDENT:
            raise UsageError(f"move-start: the contour of segment {self.segment} is not closed")
        out = _rotated(path, first, i, last)
        if context.measure:
            count = last + 1 - first
            links = Links.moved((np.arange(count) - (i - first)) % count)
            before, after = (p.rows(first, last + 1) for p in (path, out))
            context.report.deviate(deviation(before, after, links))
        yield out


def _rotated(path: Toolpath, first: int, i: int, last: int) -> Toolpath:
    """The path whose rows first..last begin with row i; the row before them ends where that begins."""
    if i == first:
        return path
    origin = np.concatenate([
        np.arange(first), np.arange(i, last + 1), np.arange(first, i), np.arange(last + 1, len(path))
    ])  # fmt: skip
    target = path.target[origin]
    if first > 0:
        target[first - 1] = path.starts()[i]
    else:
        path = path.replace(start=path.starts()[i])
    links = Links.moved(np.argsort(origin))
    return compose(path, origin, path.kind[origin], target, path.curve[origin], path.curves, links)
