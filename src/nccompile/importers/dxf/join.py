"""Coherent paths: pieces whose ends meet, in running order (SoftMotion §3.3, "one NC program for each coherent
segment").

    1  ends within COINCIDENT are one node; a node of exactly two ends continues a path
    2  an end that is still alone is joined to the nearest other lonely end within the gap tolerance
    3  what is then alone stays open; if another end is near it is reported

A node of three or more ends is a junction: paths end there, since nothing says which way goes on.  Polylines and
splines that end where they start are closed paths by themselves and take part in no junction.  Nothing is closed
silently: every gap above COINCIDENT gives a `Place`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from nccompile.importers.dxf.clean import Place
from nccompile.importers.dxf.grid import Indices, close_pairs, cluster
from nccompile.importers.dxf.pieces import PieceKind, Pieces, lengths, line_row, reverse, similar

__all__ = ["COINCIDENT", "Paths", "join_pieces", "meet"]

COINCIDENT = 1e-4
"""Ends closer than this [mm] are the same point: the last decimal of what is written."""

NEARBY = 20.0
"""An open end is reported if another end lies within this many gap tolerances."""

Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Paths:
    """m paths: rows first[i]..first[i + 1]-1 of `pieces` follow each other from end to start.

    first: i8 (m + 1,);  closed: bool (m,);  group: i8 (m,) layer or operation.
    """

    pieces: Pieces
    first: Indices
    closed: Flags
    group: Indices

    def __len__(self) -> int:
        return len(self.closed)

    def path(self, i: int) -> Pieces:
        """The pieces of path i."""
        return self.pieces.take(slice(self.first[i], self.first[i + 1]))

    def select(self, rows: Indices) -> Paths:
        """Some of the paths, in the order of `rows`."""
        counts = (self.first[1:] - self.first[:-1])[rows]
        first = np.concatenate([[0], np.cumsum(counts)])
        index = np.arange(first[-1]) - np.repeat(first[:-1] - self.first[:-1][rows], counts)
        return Paths(self.pieces.take(index), first, self.closed[rows], self.group[rows])


def join_pieces(pieces: Pieces, group: Indices, gap: float) -> tuple[Paths, list[Place]]:
    """The drawing as paths, and the gaps that were closed (NC607) and left open (NC608).

    Args: group: i8 (n,) pieces of different groups never meet;  gap: largest gap to close [mm].
    """
    tiny = (lengths(pieces) <= COINCIDENT) & (pieces.kind != PieceKind.POINT)
    pieces, group = pieces.take(~tiny), group[~tiny]
    if not len(pieces):
        return Paths(pieces, np.zeros(1, np.int64), np.zeros(0, bool), np.zeros(0, np.int64)), []
    edge = _runs(pieces)
    count = int(edge[-1]) + 1
    head = np.searchsorted(edge, np.arange(count))
    tail = np.append(head[1:], len(edge)) - 1
    ends = np.column_stack([pieces.start[head], pieces.end[tail]]).ravel()
    alone = np.abs(ends[0::2] - ends[1::2]) <= COINCIDENT
    partner = _nodes(ends, np.repeat(group[head], 2), np.repeat(alone, 2))
    long = np.bincount(edge, lengths(pieces)).astype(np.float64)
    places = _close_gaps(ends, np.repeat(group[head], 2), np.repeat(alone, 2), partner, long, gap)
    places = [p._replace(layer=int(pieces.layer[head[p.layer // 2]])) for p in places]
    order, flipped, first, closed = _walk(partner, alone)
    paths = _lay_out(pieces, head, tail, order, flipped, first, closed, group)
    return meet(paths, gap), places


def _runs(pieces: Pieces) -> Indices:
    """Shape (n,): numbers of the runs of pieces that follow each other inside one entity."""
    same = (pieces.entity[1:] == pieces.entity[:-1]) & (pieces.kind[1:] != PieceKind.POINT)
    meets = np.abs(pieces.start[1:] - pieces.end[:-1]) <= 2 * COINCIDENT
    numbers: Indices = np.concatenate([[0], np.cumsum(~(same & meets))])
    return numbers


def _nodes(ends: npt.NDArray[np.complex128], group: Indices, alone: Flags) -> Indices:
    """Shape (2 m,): the end that each end continues to, -1 if there is none (free) and -2 at a junction."""
    partner = np.full(len(ends), -1)
    free = np.flatnonzero(~alone)
    if not len(free):
        return partner
    point = cluster(ends[free], COINCIDENT)
    _, node = np.unique(np.column_stack([group[free], point]), axis=0, return_inverse=True)
    node = node.ravel()
    degree = np.bincount(node)
    order = np.argsort(node, kind="stable")
    pairs = order[degree[node[order]] == 2].reshape(-1, 2)
    partner[free[pairs[:, 0]]] = free[pairs[:, 1]]
    partner[free[pairs[:, 1]]] = free[pairs[:, 0]]
    partner[free[degree[node] > 2]] = -2
    return partner


def _close_gaps(
    ends: npt.NDArray[np.complex128],
    group: Indices,
    alone: Flags,
    partner: Indices,
    long: Floats64,
    gap: float,
) -> list[Place]:
    """Joins lonely ends, nearest first, in `partner`; the layer of a Place is the number of its end."""
    lonely = np.flatnonzero(~alone & (partner == -1))
    if not len(lonely) or gap <= 0.0:
        return []
    i, j = close_pairs(ends[lonely], gap * NEARBY)
    i, j = lonely[i], lonely[j]
    distance = np.abs(ends[i] - ends[j])
    own = (i // 2 == j // 2) & (long[i // 2] < 4 * distance)
    usable = (group[i] == group[j]) & ~own
    i, j, distance = i[usable], j[usable], distance[usable]
    places = []
    for k in np.lexsort((j, i, distance)):
        a, b = int(i[k]), int(j[k])
        if partner[a] != -1 or partner[b] != -1:
            continue
        middle = complex(0.5 * (ends[a] + ends[b]))
        if distance[k] <= gap:
            partner[a], partner[b] = b, a
            places.append(Place("NC607", middle, float(distance[k]), a))
        else:
            places.append(Place("NC608", middle, float(distance[k]), a))
            partner[a] = partner[b] = -2
    return places


def _walk(partner: Indices, alone: Flags) -> tuple[Indices, Flags, Indices, Flags]:
    """Edges in path order, whether each is run backwards, the first edge of every path, closed paths.

    Open paths are walked from an end without partner, then the rings; both in the order of the drawing.
    """
    to = partner.tolist()
    used = alone.tolist()
    order: list[int] = []
    flipped: list[bool] = []
    first: list[int] = []
    closed: list[bool] = []
    starts = [end for end, other in enumerate(to) if other < 0]
    for begin in sorted(starts, key=lambda end: end // 2) + list(range(0, len(to), 2)):
        edge = begin // 2
        if alone[edge]:
            if begin % 2 == 0 and used[edge]:
                used[edge] = False
                first.append(len(order))
                closed.append(True)
                order.append(edge)
                flipped.append(False)
            continue
        if used[edge]:
            continue
        first.append(len(order))
        at = begin
        while at >= 0 and not used[at // 2]:
            used[at // 2] = True
            order.append(at // 2)
            flipped.append(at % 2 == 1)
            at = to[at ^ 1]
        closed.append(at >= 0)
    return np.array(order), np.array(flipped, bool), np.array([*first, len(order)]), np.array(closed, bool)


def _lay_out(
    pieces: Pieces, head: Indices, tail: Indices, order: Indices, flipped: Flags, first: Indices,
    closed: Flags, group: Indices,
) -> Paths:  # fmt: skip
    """The pieces in the order of the paths, those of flipped edges backwards."""
    counts = (tail - head + 1)[order]
    begin = np.concatenate([[0], np.cumsum(counts)])
    within = np.arange(begin[-1]) - np.repeat(begin[:-1], counts)
    backwards = np.repeat(flipped, counts)
    index = np.where(
        backwards, np.repeat(tail[order], counts) - within, np.repeat(head[order], counts) + within
    )
    laid = reverse(pieces.take(index), backwards)
    rows = begin[first]
    return Paths(laid, rows, closed, group[index[rows[:-1]]] if len(rows) > 1 else np.zeros(0, np.int64))


def meet(paths: Paths, gap: float) -> Paths:
    """The paths with every piece starting exactly where the one before it ends.

    Both pieces at a gap are turned and scaled a little so that they meet half-way; where that would move a piece
    by more than the gap (a short one, an arc that is almost a circle) a line bridges the gap instead.
    """
    pieces = paths.pieces
    last = np.zeros(len(pieces), bool)
    last[paths.first[1:] - 1] = True
    follower = np.arange(1, len(pieces) + 1)
    follower[paths.first[1:] - 1] = np.where(paths.closed, paths.first[:-1], -1)
    joint = follower >= 0
    i, j = np.flatnonzero(joint), follower[joint]
    apart = np.abs(pieces.end[i] - pieces.start[j])
    i, j, apart = i[apart > 0], j[apart > 0], apart[apart > 0]
    start, end = pieces.start.copy(), pieces.end.copy()
    end[i] = start[j] = 0.5 * (pieces.end[i] + pieces.start[j])
    moved = np.abs(start - pieces.start) + np.abs(end - pieces.end)
    stretch = lengths(pieces) / np.maximum(np.abs(pieces.end - pieces.start), 1e-300)
    stiff = (moved > 0) & ((moved * np.maximum(1.0, stretch) > max(2 * gap, 0.0) + COINCIDENT)
                           | (moved * 4.0 > np.abs(pieces.end - pieces.start)))  # fmt: skip
    bridged = stiff[i] | stiff[j] | (i == j)
    end[i[bridged]], start[j[bridged]] = pieces.end[i[bridged]], pieces.start[j[bridged]]
    met = similar(pieces, start, end)
    lone = pieces.start == pieces.end
    met = met.replace(end=np.where(lone, met.start, end))
    return _bridge(Paths(met, paths.first, paths.closed, paths.group), i[bridged], j[bridged])


def _bridge(paths: Paths, after: Indices, to: Indices) -> Paths:
    """The paths with a line inserted after each piece `after`, to the start of the piece `to`."""
    if not len(after):
        return paths
    pieces = paths.pieces
    rows = [
        line_row(complex(pieces.end[a]), complex(pieces.start[b])) for a, b in zip(after, to, strict=True)
    ]
    lines = Pieces.from_rows(rows, pieces.layer[after], pieces.color[after], pieces.entity[after])
    order = np.argsort(np.concatenate([np.arange(len(pieces)) * 2, after * 2 + 1]), kind="stable")
    first = paths.first + np.searchsorted(np.sort(after), paths.first)
    return Paths(Pieces.join([pieces, lines]).take(order), first, paths.closed, paths.group)


Floats64 = npt.NDArray[np.float64]
