"""Gouges: places where the tool's centre path is nearer to the contour than the tool's radius.

contour ──┐   ┌──          depth = r - distance: how far the tool cuts into the contour, exactly for lines and arcs
          │ o │            (kernels.gouges); one finding for each source line, at its deepest place
          └───┘

Where loop avoidance is on (G61, or gouge=loops), avoid-loops cuts the loops out.  A path that begins or ends in a
gouge would leave it with the wrong side of a loop, so it is shortened to its first and last place that is free.  Then
the loops are cut out on a copy, by the function that avoid-loops uses, and what is left is checked again.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nccompile.diagnostics import Severity
from nccompile.kernels import gouges as kernels
from nccompile.kernels.boxes import box_tree, leaves
from nccompile.kernels.intersect import place
from nccompile.kernels.loops import intervals
from nccompile.kernels.offset import cut_curves
from nccompile.kernels.offset_emit import CHECKED
from nccompile.kernels.offset_joints import cut_piece
from nccompile.passes.avoid_loops import parts_left
from nccompile.passes.base import Context, Flags
from nccompile.passes.correction import Emitted, Moving, Offsets
from nccompile.passes.edit import Rows
from nccompile.toolpath.columns import Bytes, Floats, Kind, Toolpath

__all__ = ["Gouges", "Sections", "left_over", "report", "shorten"]

_DEEP = 1e-6
"""[mm] A path this much too near is rounding."""

_FREE = 1.5
"""Part of the tolerance by which the offset of an ellipse or spline may be too near, chords included."""

_SAG = 0.2
"""Part of the tolerance by which the chords of ellipses and splines may be off."""

_DIGITS = 1e-12
"""Part of the coordinates that rounding takes."""

_SAME = 1e-6
"""[mm] Ends of free stretches nearer than this are one crossing."""


class Sections(NamedTuple):
    """Lines and arcs of a path: columns as in `kernels.boxes`, and the row each one is of."""

    kinds: Bytes
    curve: Rows
    table: Floats
    ends: Floats
    owner: Rows


def sections(kinds: Bytes, curve: Rows, table: Floats, ends: Floats, sag: float) -> Sections:
    """Segments with chords in place of ellipses and cubics, within sag [mm]."""
    n = len(kinds)
    if not (kinds > Kind.ARC).any():
        return Sections(kinds, curve, table, ends, np.arange(n))
    room = n
    while True:
        out = Sections(
            np.empty(room, np.uint8),
            np.empty(room, np.int64),
            table,
            np.empty((room, 4)),
            np.empty(room, np.int64),
        )
        count = kernels.chords(kinds, curve, table, ends, sag, out.kinds, out.curve, out.ends, out.owner)
        if count <= room:
            return Sections(out.kinds[:count], out.curve[:count], table, out.ends[:count], out.owner[:count])
        room = count


class Gouges:
    """The contours of a stretch, ready to be compared with paths."""

    def __init__(self, moving: Moving, tolerance: float) -> None:
        self._sag = _SAG * tolerance
        self._rows = sections(moving.kinds, moving.curve, moving.table, moving.ends, self._sag)
        contour = moving.contour[self._rows.owner]
        self._radius = np.abs(moving.d[self._rows.owner])
        self._tree = np.empty((2 * leaves(len(contour)), 4))
        box_tree(*self._rows[:4], self._tree)
        numbers = np.arange(int(contour.max(initial=-1)) + 1)
        self._low, self._high = (np.searchsorted(contour, numbers, side=side) for side in ("left", "right"))
        self._least = np.full(len(numbers), _DEEP)
        free = np.unique(moving.contour[moving.kinds > Kind.ARC])
        self._least[free] += _FREE * tolerance
        size = np.zeros(len(numbers))
        np.maximum.at(size, moving.contour, np.abs(moving.ends).max(axis=1, initial=0.0))
        self._least += _DIGITS * size

    def depths(
        self, kinds: Bytes, curve: Rows, table: Floats, ends: Floats, contour: Rows
    ) -> tuple[Floats, Floats]:
        """How deep each segment cuts into its contour, Shape (k,) [mm], 0: it does not; and where, Shape (k, 2)."""
        depth, where = np.zeros(len(kinds)), np.zeros((len(kinds), 2))
        if not len(kinds):
            return depth, where
        path = sections(kinds, curve, table, ends, self._sag)
        of = contour[path.owner]
        least = self._least[of]
        found, places = np.empty(len(of)), np.empty((len(of), 2))
        kernels.deepest(
            *path[:4],
            self._low[of],
            self._high[of],
            *self._rows[:4],
            self._radius,
            self._tree,
            least,
            found,
            places,
        )
        if len(of) == len(kinds):
            return found, places
        order = np.lexsort((found, path.owner))
        last = order[np.searchsorted(path.owner[order], np.arange(len(kinds)), side="right") - 1]
        return found[last], places[last]

    def of_emitted(self, emitted: Emitted, offsets: Offsets) -> tuple[Floats, Floats]:
        """`depths` of new rows; those that need not keep their distance have none."""
        depth, where = np.zeros(len(emitted.kind)), np.zeros((len(emitted.kind), 2))
        row = np.flatnonzero(emitted.flags & CHECKED != 0)
        piece = emitted.piece[row]
        depth[row], where[row] = self.depths(
            offsets.kinds[piece],
            offsets.curve[piece],
            offsets.table,
            offsets.ends[piece],
            emitted.contour[row],
        )
        return depth, where


class _Walk:
    """The pieces of one contour in order, to find out which of its places are free of gouges."""

    def __init__(
        self, offsets: Offsets, moving: Moving, emitted: Emitted, gouges: Gouges, contour: int
    ) -> None:
        mine = (emitted.contour == contour) & (emitted.piece >= 0) & (emitted.piece < offsets.count)
        self.row = emitted.origin[mine]
        self.owner = np.searchsorted(moving.row, self.row)
        self.piece = emitted.piece[mine]
        columns = (
            offsets.kinds[self.piece],
            offsets.curve[self.piece],
            offsets.table,
            offsets.ends[self.piece],
        )
        self._kinds, self._curve, self._table, self._ends = columns
        tree = np.empty((2 * leaves(len(self.piece)), 4))
        box_tree(*columns, tree)
        room = 4 * len(self.piece) + 16
        while True:
            self.cut, self.parts, middle = np.empty(room, np.int64), np.empty((room, 2)), np.empty((room, 4))
            count = intervals(*columns, tree, self.cut, self.parts, middle)
            if count <= room:
                break
            room = count
        self.cut, self.parts, middle = self.cut[:count], self.parts[:count], middle[:count]
        line, none = np.ones(count, np.uint8), np.full(count, -1)
        self.free = gouges.depths(line, none, self._table, middle, np.full(count, contour))[0] == 0.0

    def _point(self, interval: int, side: int) -> Floats:
        k = int(self.cut[interval])
        row = self._table[max(int(self._curve[k]), 0)]
        return np.array(place(int(self._kinds[k]), row, self._ends[k], float(self.parts[interval, side])))

    def longest(self) -> tuple[tuple[int, float], tuple[int, float]] | None:
        """First and last place, piece and its parameter, of the longest way that is free; None if nothing is.

        A way goes on where a free stretch begins at the point at which the one before ends: a loop is between them.
        """
        edges = np.flatnonzero(np.diff(self.free, prepend=False, append=False))
        first, last = edges[::2], edges[1::2] - 1
        if not len(first):
            return None
        starts = np.array([self._point(i, 0) for i in first])
        ends = np.array([self._point(i, 1) for i in last])
        size = [
            float(np.sqrt(((self._point(i, 1) - self._point(i, 0)) ** 2).sum()))
            for i in range(len(self.free))
        ]
        way = np.concatenate([[0.0], np.cumsum(size)])
        open_ones = np.ones(len(first), np.bool_)
        best, found = -1.0, (0, 0)
        for begin in range(len(first)):
            at, length = begin, 0.0
            while open_ones[at]:
                open_ones[at] = False
                length += float(way[last[at] + 1] - way[first[at]])
                near = np.abs(starts[at + 1 :] - ends[at]).max(axis=1, initial=0.0) <= _SAME
                following = np.flatnonzero(near & open_ones[at + 1 :])
                if len(following):
                    at += 1 + int(following[-1])
            if length > best:
                best, found = length, (int(first[begin]), int(last[at]))
        one, two = found
        return (int(self.cut[one]), float(self.parts[one, 0])), (
            int(self.cut[two]),
            float(self.parts[two, 1]),
        )


def shorten(
    offsets: Offsets, moving: Moving, emitted: Emitted, gouges: Gouges, contours: Rows, loops: Flags
) -> bool:
    """Takes off contours that begin or end in a gouge what lies before and behind their longest free way.

    contours: their numbers;  loops: Shape (n,), source rows where loops are cut out.  Returns whether any changed.
    """
    changed = False
    for contour in contours:
        walk = _Walk(offsets, moving, emitted, gouges, int(contour))
        found = walk.longest()
        if found is None or (walk.free[0] and walk.free[-1]):
            continue
        end = len(walk.piece) - 1, 1.0
        first = found[0] if loops[walk.row[0]] else (0, 0.0)
        last = found[1] if loops[walk.row[-1]] else end
        _take_off(offsets, moving, walk, first, last)
        changed = True
    return changed


def _take_off(
    offsets: Offsets, moving: Moving, walk: _Walk, first: tuple[int, float], last: tuple[int, float]
) -> None:
    """Leaves of a contour what lies between two places, each a piece in its order and its parameter there."""
    one, two = (int(walk.owner[k]) for k, _ in (first, last))
    start, end = (int(walk.piece[k]) for k, _ in (first, last))
    mine = np.flatnonzero(moving.contour == moving.contour[one])
    offsets.dropped[mine[(mine < one) | (mine > two)]] = 1
    if end < offsets.stop[two] and end >= offsets.begin[two]:
        offsets.stop[two], offsets.connectors[two] = end + 1, 0
    else:
        offsets.connectors[two] = np.sign(offsets.connectors[two]) * (end - offsets.connector[two] + 1)
    if offsets.begin[one] <= start < offsets.stop[one]:
        offsets.begin[one] = start
    else:
        offsets.begin[one] = offsets.stop[one]
        offsets.connectors[one] -= start - offsets.connector[one]
        offsets.connector[one] = start
    ends = ((start, first[1], last[1]),) if start == end else ((start, first[1], 1.0), (end, 0.0, last[1]))
    for piece, u0, u1 in ends:
        cut_piece(piece, u0, u1, offsets.kinds, offsets.curve, offsets.table, offsets.ends, offsets.part)


def left_over(
    path: Toolpath,
    emitted: Emitted,
    offsets: Offsets,
    gouges: Gouges,
    loops: Flags,
    depth: Floats,
    where: Floats,
) -> tuple[Floats, Floats]:
    """What `depth` and `where` of new rows become when loops are cut out of the rows `loops`, all Shape (r, ...).

    path: the new rows.
    """
    depth, where = depth.copy(), where.copy()
    row, parts, _ = parts_left(path, loops, len(path))
    loopy = np.flatnonzero(loops & (depth > 0.0))
    depth[loopy] = 0.0
    for k in np.flatnonzero(
        np.isin(row, loopy) & (emitted.flags[row] & CHECKED != 0) & (parts[:, 1] > parts[:, 0])
    ):
        piece = emitted.piece[row[k]]
        kinds, ends, part = offsets.kinds[[piece]], offsets.ends[[piece]], parts[[k]]
        curve, table = np.minimum(offsets.curve[[piece]], 0), offsets.table[[piece]]
        x0, y0 = place(int(kinds[0]), table[0], ends[0], float(part[0, 0]))
        x1, y1 = place(int(kinds[0]), table[0], ends[0], float(part[0, 1]))
        if curve[0] >= 0:
            cut_curves(kinds, table, part, np.empty((1, 2)), np.empty((1, 2)))
        found, place_of = gouges.depths(
            kinds, curve, table, np.array([[x0, y0, x1, y1]]), emitted.contour[row[[k]]]
        )
        if found[0] > depth[row[k]]:
            depth[row[k]], where[row[k]] = found[0], place_of[0]
    return depth, where


def report(
    path: Toolpath,
    depth: Floats,
    where: Floats,
    loops: Flags,
    is_error: bool,
    said: set[int],
    context: Context,
) -> None:
    """NC302 for every source line of the new rows `path` with a depth above 0, at its deepest place.

    loops: Shape (r,), rows where the gouge is cut out later: there it is a warning;  said: lines that have their
    finding, added to.
    """
    deep = np.flatnonzero(depth > 0.0)
    context.report.counts["gouges left to avoid-loops"] += int(np.count_nonzero(loops[deep]))
    deep = deep[np.lexsort((-depth[deep], path.line[deep]))]
    for i in deep[np.diff(path.line[deep], prepend=-1) != 0]:
        if int(path.line[i]) in said:
            continue
        said.add(int(path.line[i]))
        severity = Severity.ERROR if is_error and not loops[i] else Severity.WARNING
        context.find(
            "NC302", severity,
            f"the tool would cut {depth[i]:.4g} mm into the contour at X{where[i, 0]:.4g} Y{where[i, 1]:.4g}",
            int(path.line[i]), "use a smaller tool, or cut such places out with G61 and avoid-loops",
        )  # fmt: skip
