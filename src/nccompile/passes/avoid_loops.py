"""avoid-loops: where the path crosses itself, the loop is cut out (SoftMotion §6.2.4, SMC_AvoidLoop; G61 .. G60).

    in        ┌───────┐              out
              │       │
    ●─────────x───────┘  ...         ●─────────x      the walk leaves row i at its first crossing with a
              │ loop                           │      later row j, goes on with the rest of j, and so forth
              ●                                ●

What counts is a crossing in X-Y at the same height (1e-6 mm): the later part of the path comes from one side of the
earlier part and leaves to the other.  That holds for joints and for stretches on which both run on each other, too;
touching, running back on itself, and a contour that closes in the direction in which it began are no crossings
(kernels.loops, docs/decisions/079).  M functions, dwells and switch points of a loop move to its crossing.

Rows within reach of each other are found through a tree of boxes: about log n steps a row.  `window` limits how
many later rows a row is compared with.

Example:
    -p avoid-loops
    --- in
    % t
    N10 G61
    N20 G1 X10 F50
    N30 G1 Y5
    N40 G1 X5
    N50 G1 Y-5
    N60 G60
    --- out
    line 5 0 0 feed 50 source 3
    line 5 -5 0 feed 50 mark 64 source 6
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from nccompile.geometry.tolerance import COINCIDENT
from nccompile.kernels import expect_work
from nccompile.kernels.boxes import box_tree, leaves
from nccompile.kernels.loops import without_loops
from nccompile.kernels.offset import cut_curves
from nccompile.passes.base import Context, Flags, Pass, bounded, gather, region
from nccompile.passes.edit import Links, Rows, compose
from nccompile.passes.measure import deviation
from nccompile.toolpath.columns import CURVE_PARAMETERS, Curves, Floats, Kind, Mark, Plane, Toolpath

__all__ = ["AvoidLoops", "parts_left"]


@dataclass(frozen=True)
class AvoidLoops(Pass):
    """The path without its loops.  window: rows a loop may have;  everywhere: not only between G61 and G60."""

    name: ClassVar[str] = "avoid-loops"
    window: int = 1_000_000
    everywhere: bool = False

    def __post_init__(self) -> None:
        bounded("window", self.window, 2, 1e9, "rows")

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module.  A run of rows that may cross each other is held in memory until it ends."""
        held: list[tuple[Toolpath, Flags]] = []
        inside = False
        for chunk in gather(chunks):
            flags, inside = region(chunk, int(Mark.LOOP), int(Mark.LOOP_STOP), inside)
            flags = (flags | self.everywhere) & _cuttable(chunk)
            held.append((chunk, flags))
            outside = np.flatnonzero(~flags)
            if not len(outside):
                continue
            path, flags = _joined(held)
            done = len(path) - len(chunk) + int(outside[-1]) + 1
            yield self._without_loops(path.rows(0, done), flags[:done], context)
            held = [(path.rows(done, len(path)), flags[done:])] if done < len(path) else []
        if held:
            yield self._without_loops(*_joined(held), context)

    def _without_loops(self, path: Toolpath, flags: Flags, context: Context) -> Toolpath:
        clean = path.replace(mark=path.mark & ~np.uint16(Mark.LOOP))
        if not flags.any():
            return clean
        expect_work(len(path))
        row, parts, loops = parts_left(path, flags, self.window)
        context.report.counts["loops"] += loops
        if not loops:
            return clean
        out, links = _put_in(path, row, parts)
        if context.measure:
            context.report.deviate(deviation(path, out, links))
        return out


def _joined(held: list[tuple[Toolpath, Flags]]) -> tuple[Toolpath, Flags]:
    paths, flags = zip(*held, strict=True)
    return Toolpath.join(paths), np.concatenate(flags)


def _cuttable(path: Toolpath) -> Flags:
    """Shape (n,): feed rows in X-Y planes; waits inside a run of them go with it."""
    kinds = path.kind
    good = ((kinds >= Kind.LINE) & (kinds <= Kind.POLYNOMIAL) & (path.profile == 0)) | (kinds >= Kind.DWELL)
    curved = np.flatnonzero(path.curve >= 0)
    good[curved] &= path.curves.plane[path.curve[curved]] == Plane.XY
    return np.asarray(good, np.bool_)


def parts_left(path: Toolpath, flags: Flags, window: int) -> tuple[Rows, Floats, int]:
    """What is left of a path without its loops, in order.

    Args:     flags: Shape (n,), rows that may be cut; those with another row between them do not meet.
    Returns:  rows of the path, Shape (m,);  where each begins and ends, Shape (m, 2), curve parameters;  loops cut.
    """
    flags = flags & _cuttable(path)
    begin = path.starts()
    step = (path.target - begin)[:, :2]
    extent = (path.curve >= 0) | ((step * step).sum(axis=1) > COINCIDENT * COINCIDENT)
    moves = flags & (path.kind <= Kind.POLYNOMIAL) & extent
    moving = np.flatnonzero(moves)
    n = len(moving)
    kinds, curve = path.kind[moving], path.curve[moving].astype(np.int64)
    table = path.curves.parameters if len(path.curves) else np.zeros((1, CURVE_PARAMETERS))
    ends = np.hstack([begin[moving, :2], path.target[moving, :2]])
    heights = np.stack([begin[moving, 2], path.target[moving, 2]], axis=1)
    run = np.cumsum(~flags, dtype=np.int64)[moving]
    tree = np.empty((2 * leaves(n), 4))
    box_tree(kinds, curve, table, ends, tree)
    row, parts = np.empty(2 * n, np.int64), np.empty((2 * n, 2))
    count = without_loops(kinds, curve, table, ends, run, heights, tree, int(window), row, parts)
    row, parts = row[:count], parts[:count]
    jumps = (np.diff(row) != 1) | (parts[1:, 0] > 0.0) | (parts[:-1, 1] < 1.0)
    jump = np.flatnonzero(jumps & (run[row[1:]] == run[row[:-1]]))
    open_loops = np.zeros(n + 1, np.int64)
    np.add.at(open_loops, row[jump], 1)
    np.add.at(open_loops, row[jump + 1], -1)
    inside = np.cumsum(open_loops) > 0
    rest = np.flatnonzero(~moves)
    in_loop = inside[np.searchsorted(moving, rest) - 1] if n else np.zeros(len(rest), np.bool_)
    rest = rest[~in_loop | (path.kind[rest] > Kind.POLYNOMIAL)]
    kept = parts[:, 1] > parts[:, 0]
    row = np.concatenate([moving[row[kept]], rest])
    parts = np.concatenate([parts[kept], np.tile([0.0, 1.0], (len(rest), 1))])
    order = np.lexsort((parts[:, 0], row))
    return row[order], parts[order], len(jump)


def _put_in(path: Toolpath, row: Rows, parts: Floats) -> tuple[Toolpath, Links]:
    """The parts of rows as a path."""
    share = parts.copy()
    shape = path.curve[row].copy()
    curved = np.flatnonzero(shape >= 0)
    table = path.curves.parameters[shape[curved]].copy()
    points = np.empty((len(curved), 2))
    shares = share[curved].copy()
    cut_curves(path.kind[row[curved]], table, parts[curved].copy(), shares, points)
    share[curved] = shares
    shape[curved] = np.arange(len(curved), dtype=np.int32)
    begin, target = path.starts()[row], path.target[row].copy()
    short = parts[:, 1] < 1.0
    target[short] = (begin + share[:, 1:] * (target - begin))[short]
    at = curved[short[curved]]
    target[at, :2] = points[short[curved]]
    # Waits do not move: those of a loop are where it was cut.
    moved = np.maximum.accumulate(np.where(path.kind[row] > Kind.SET_POSITION, -1, np.arange(len(row))))
    target = np.where(moved[:, None] < 0, path.start, target[moved])
    links = Links(row, share[:, 0], share[:, 1], np.arange(len(row)), np.zeros(len(row)), np.ones(len(row)))
    curves = Curves(path.curves.plane[path.curve[row[curved]]], table)
    return compose(path, row, path.kind[row], target, shape, curves, links, clear=int(Mark.LOOP)), links
