"""split: one segment becomes two at a share of its length (SoftMotion §3.3, split object).

    in    A ────────────────> B       out   A ──────> P ─────────> B      P at `at` of the way, e.g. 0.4

Segments are counted from 1 in the path as it reaches this pass, or found by their source line: the first moving
segment of that line is split.  Switch points keep their place.

Example:
    -p split{segment=1,at=0.25}
    --- in
    % t
    N10 H1 O0.5 G1 X20 F50
    --- out
    line 5 0 0 feed 50 source 2
    line 20 0 0 feed 50 source 2
      switch 1 at 0.333333
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from nccompile.errors import UsageError
from nccompile.geometry.parts import Way, cut
from nccompile.kernels.distance import place_on
from nccompile.passes.base import Context, Pass, bounded
from nccompile.passes.edit import Draft, Shape
from nccompile.toolpath.columns import Floats, Kind, Toolpath

__all__ = ["Split", "part_at", "part_of", "place_at", "position_at"]


@dataclass(frozen=True)
class Split(Pass):
    """Two segments instead of one.

    segment: which one, from 1;  line: or that of this source line;  at: share 0..1 of its length.
    """

    name: ClassVar[str] = "split"
    segment: int = 0
    line: int = 0
    at: float = 0.5

    def __post_init__(self) -> None:
        bounded("at", self.at, 0.0, 1.0, "")
        if (self.segment > 0) == (self.line > 0):
            raise UsageError("give either segment or line")

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module."""
        seen = 0
        done = False
        for chunk in chunks:
            rows = np.flatnonzero(chunk.kind <= Kind.POLYNOMIAL)
            hits = rows[chunk.line[rows] == self.line] if self.line else rows[seen + rows + 1 == self.segment]
            seen += len(chunk)
            if done or not len(hits):
                yield chunk
                continue
            done = True
            yield _split(chunk, int(hits[0]), self.at)
        if not done:
            what = f"line {self.line}" if self.line else f"segment {self.segment}"
            raise UsageError(f"split: the path has no moving segment for {what}")


def _split(path: Toolpath, i: int, at: float) -> Toolpath:
    if not 0.0 < at < 1.0:
        return path
    draft = Draft(path)
    for j in range(len(path)):
        if j != i:
            draft.copy(j)
            continue
        for p0, p1 in ((0.0, at), (at, 1.0)):
            target = place_at(path, i, p1)
            draft.add(int(path.kind[i]), target, part_of(path, i, p0, p1), i, p0, p1)
    return draft.build()


def place_at(path: Toolpath, i: int, share: float) -> Floats:
    """The position on all axes at a share 0..1 of the length of row i. Shape (k,)."""
    start = path.start if i == 0 else path.target[i - 1]
    end = path.target[i]
    if share >= 1.0:
        return np.array(end)
    out: Floats = np.asarray(start + share * (end - start))
    row = int(path.curve[i])
    if row >= 0 and share > 0.0:
        p, kind = path.curves.parameters[row], int(path.kind[i])
        u = Way(kind, p.tolist()).parameter(share)
        out[:3] = place_on(kind, int(path.curves.plane[row]), p, start, end, u)
    return out


def part_of(path: Toolpath, i: int, p0: float, p1: float) -> Shape | None:
    """The curve of the part p0..p1 (shares of the length) of row i, None if it is straight."""
    row = int(path.curve[i])
    if row < 0:
        return None
    kind, p = int(path.kind[i]), path.curves.parameters[row].tolist()
    way = Way(kind, p)
    return int(path.curves.plane[row]), cut(kind, p, way.parameter(p0), way.parameter(p1))


def part_at(path: Toolpath, i: int, u0: float, u1: float) -> tuple[Shape | None, float, float]:
    """The curve of the part u0..u1 (curve parameters) of row i, and the shares of the length it begins and ends at."""
    row = int(path.curve[i])
    if row < 0:
        return None, u0, u1
    kind, p = int(path.kind[i]), path.curves.parameters[row].tolist()
    way = Way(kind, p)
    return (int(path.curves.plane[row]), cut(kind, p, u0, u1)), way.share(u0), way.share(u1)


def position_at(path: Toolpath, i: int, u: float) -> Floats:
    """The position on all axes at curve parameter u of row i. Shape (k,)."""
    start = path.start if i == 0 else path.target[i - 1]
    end = path.target[i]
    row = int(path.curve[i])
    if row < 0:
        return np.asarray(start + u * (end - start))
    p, kind = path.curves.parameters[row], int(path.kind[i])
    share = Way(kind, p.tolist()).share(u)
    out: Floats = np.asarray(start + share * (end - start))
    out[:3] = place_on(kind, int(path.curves.plane[row]), p, start, end, u)
    return out
