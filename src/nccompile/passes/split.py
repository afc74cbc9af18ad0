"""split: one segment becomes two at a share of its length (SoftMotion §3.3, split object).

    in    A ────────────────> B       out   A ──────> P ─────────> B      P at `at` of the way, e.g. 0.4

Segments are counted from 1 in the path as it reaches this pass, or found by their source line: the first moving
segment of that line is split.  Switch points keep their place.  A segment without length, or with an axis in the
S-profile, cannot be split.

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
from nccompile.kernels.legs import cut_legs
from nccompile.passes.base import Context, Pass, bounded
from nccompile.passes.edit import Links, Pieces, Rows, geometry, put_pieces
from nccompile.passes.measure import deviation
from nccompile.toolpath.columns import CURVE_PARAMETERS, Curves, Floats, Kind, Toolpath

__all__ = ["Split", "split_rows"]


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
            yield self._split(chunk, hits[:1], context)
        if not done:
            raise UsageError(f"split: the path has no moving segment for {self._what}")

    @property
    def _what(self) -> str:
        return f"line {self.line}" if self.line else f"segment {self.segment}"

    def _split(self, path: Toolpath, row: Rows, context: Context) -> Toolpath:
        if not 0.0 < self.at < 1.0:
            return path
        if path.profile[row].any() or not path.length[row].all():
            raise UsageError(f"split: {self._what} has no length, or an axis in the S-profile")
        out, links, _ = split_rows(path, row, self.at * path.length[row])
        if context.measure:
            context.report.deviate(deviation(path, out, links))
        return out


def split_rows(path: Toolpath, picked: Rows, at: Floats) -> tuple[Toolpath, Links, Rows]:
    """The path with some rows cut in two.

    Args:     picked: Shape (m,), ascending, rows with a length, without S-profile;  at: Shape (m,), where each is
              cut, from its start [mm].
    Returns:  the path;  what became of what;  Shape (m,), the rows that begin at the cuts.
    """
    m, length, start = len(picked), path.length[picked], path.starts()[picked]
    rows, point, end = np.empty((2 * m, CURVE_PARAMETERS)), np.empty((2 * m, 3)), np.empty((2 * m, 3))
    owner, heads = np.repeat(picked, 2), 2 * np.arange(m)
    share = np.stack([at / length, np.ones(m)], axis=1).ravel()
    cut_legs(
        *geometry(path), path.length, owner, np.stack([np.zeros(m), at], axis=1).ravel(),
        np.stack([at, length], axis=1).ravel(), rows, point, end,
    )  # fmt: skip
    target = path.target[owner]
    target[heads] = start + share[heads, None] * (path.target[picked] - start)
    target[heads, :3] = end[heads]
    planes = np.zeros(2 * m, np.uint8)
    curved = np.flatnonzero(path.curve[owner] >= 0)
    planes[curved] = path.curves.plane[path.curve[owner[curved]]]
    out, links = put_pieces(path, Pieces(owner, share, path.kind[owner], target, Curves(planes, rows)))
    return out, links, picked + np.arange(m) + 1
