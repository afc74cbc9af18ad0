"""avoid-loops: where the path crosses itself, the loop is cut out (SoftMotion §6.2.4, SMC_AvoidLoop; G61 .. G60).

    in        ┌───────┐              out
              │       │
    ●─────────x───────┘  ...         ●─────────x      the walk leaves row i at its first common point with a
              │ loop                           │      later row j, goes on with the rest of j, and so forth
              ●                                ●

What counts is a common point in X-Y at the same height (1e-6 mm), at least one of both rows inside of which it
is; two joints that touch do not cross, and rows that run on each other do not either.  A closed contour is no
loop.  M functions, dwells and switch points of a loop move to its crossing.

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

from nccompile.kernels import intersect as kernels
from nccompile.passes.base import Context, Pass, bounded, gather, region
from nccompile.passes.edit import Draft
from nccompile.passes.split import part_at, position_at
from nccompile.toolpath.columns import CURVE_PARAMETERS, Floats, Kind, Mark, Plane, Toolpath

__all__ = ["AvoidLoops", "cut_loops"]

_JOINT = 1e-7
"""[mm] A common point this near to ends of both rows is a joint."""

_LEVEL = 1e-6
"""[mm] Greatest difference in height at a crossing."""

_BEHIND = 1e-9
"""Share of a row by which the next crossing lies behind the last one."""


@dataclass(frozen=True)
class AvoidLoops(Pass):
    """The path without its loops.  window: rows a loop may have;  everywhere: not only between G61 and G60."""

    name: ClassVar[str] = "avoid-loops"
    window: int = 1_000_000
    everywhere: bool = False

    def __post_init__(self) -> None:
        bounded("window", self.window, 2, 1e9, "rows")

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module."""
        held: Toolpath | None = None
        inside = False
        for chunk in gather(chunks):
            held = chunk if held is None else Toolpath.join([held, chunk])
            done, flags = self._settled(held, inside)
            if done:
                yield self._without_loops(held.rows(0, done), flags[:done], context)
                _, inside = region(held.rows(0, done), int(Mark.LOOP), int(Mark.LOOP_STOP), inside)
                held = held.rows(done, len(held))
        if held is not None:
            _, flags = self._settled(held, inside)
            yield self._without_loops(held, flags, context)

    def _settled(
        self, path: Toolpath, inside: bool
    ) -> tuple[int, np.ndarray[tuple[int], np.dtype[np.bool_]]]:
        """How many leading rows no later row can change, and which rows may be cut."""
        flags, _ = region(path, int(Mark.LOOP), int(Mark.LOOP_STOP), inside)
        flags = (flags | self.everywhere) & _cuttable(path)
        outside = np.flatnonzero(~flags)
        return (int(outside[-1]) + 1 if len(outside) else 0), flags

    def _without_loops(
        self, path: Toolpath, flags: np.ndarray[tuple[int], np.dtype[np.bool_]], context: Context
    ) -> Toolpath:
        if not flags.any():
            return path.replace(mark=path.mark & ~np.uint16(Mark.LOOP))
        draft = Draft(path, int(Mark.LOOP))
        i = 0
        while i < len(path):
            if not flags[i]:
                draft.copy(i)
                i += 1
                continue
            last = i
            while last + 1 < len(path) and flags[last + 1]:
                last += 1
            context.report.counts["loops"] += cut_loops(draft, i, last + 1, self.window)
            i = last + 1
        return draft.build()


def _cuttable(path: Toolpath) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Shape (n,): feed rows in X-Y planes; waits inside a run of them go with it."""
    kinds = path.kind
    good = ((kinds >= Kind.LINE) & (kinds <= Kind.POLYNOMIAL) & (path.profile == 0)) | (kinds >= Kind.DWELL)
    curved = np.flatnonzero(path.curve >= 0)
    good[curved] &= path.curves.plane[path.curve[curved]] == Plane.XY
    return np.asarray(good, np.bool_)


def cut_loops(draft: Draft, first: int, end: int, window: int) -> int:
    """Writes the rows first..end - 1 of the draft's source without their loops; returns how many were cut."""
    path = draft.source
    n = end - first
    kinds = path.kind[first:end].copy()
    rows = np.zeros((n, CURVE_PARAMETERS))
    curved = np.flatnonzero(path.curve[first:end] >= 0)
    rows[curved] = path.curves.parameters[path.curve[first:end][curved]]
    begin = path.start if first == 0 else path.target[first - 1]
    points = np.vstack([begin[None, :], path.target[first:end]])
    size = 1
    while size < n:
        size *= 2
    tree = np.empty((2 * size, 4))
    m = kernels.box_tree(kinds, rows, points, tree)
    out = np.zeros(2)
    loops = 0
    i, u = 0, 0.0
    while i < n:
        after = max(u + _BEHIND, 0.0) if u > 0.0 else _BEHIND
        j = -1
        while kinds[i] <= Kind.POLYNOMIAL:
            j = kernels.first_crossing(kinds, rows, points, tree, m, i, after, _JOINT, window, out)
            if j < 0 or _level(path, first + i, first + j, out):
                break
            after = float(out[0]) + _BEHIND
        if j < 0:
            _write(draft, first + i, u, 1.0)
            i, u = i + 1, 0.0
        else:
            loops += 1
            _write(draft, first + i, u, float(out[0]))
            for wait in range(first + i + 1, first + j):
                if path.kind[wait] > Kind.SET_POSITION:
                    draft.add(int(path.kind[wait]), draft.target[-1], None, wait)
            i, u = j, float(out[1])
            if u >= 1.0 and i + 1 < n:
                i, u = i + 1, 0.0
    return loops


def _level(path: Toolpath, i: int, j: int, out: Floats) -> bool:
    """Whether both rows are at the same height at their common point."""
    one, two = position_at(path, i, float(out[0])), position_at(path, j, float(out[1]))
    return abs(float(one[2] - two[2])) <= _LEVEL


def _write(draft: Draft, i: int, u0: float, u1: float) -> None:
    """The part u0..u1 (curve parameters) of row i."""
    path = draft.source
    if u0 == 0.0 and u1 == 1.0:
        draft.copy(i)
    elif u1 > u0:
        shape, p0, p1 = part_at(path, i, u0, u1)
        target = path.target[i] if u1 == 1.0 else position_at(path, i, u1)
        draft.add(int(path.kind[i]), target, shape, i, p0, p1)
