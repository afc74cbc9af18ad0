"""Building the rewritten rows of a stretch of path: columns, marks and events follow their segment.

    source row i    0 ────────p──── 1        a link says which part p0..p1 of a source segment became which
                    ╲         ╲     ╲        part q0..q1 of a new row; events move along the links, so they
    new row r       q0 ─────── q ──  q1      stay at the same fraction of the way

Start marks go to the first new row of their segment, stop marks to the last one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from nccompile.toolpath.columns import (
    CURVE_PARAMETERS,
    Bytes,
    Curves,
    EventKind,
    Events,
    Floats,
    Ints,
    Kind,
    Mark,
    Toolpath,
)
from nccompile.toolpath.lengths import path_lengths

__all__ = [
    "STARTS",
    "STOPS",
    "Geometry",
    "Links",
    "Pieces",
    "Rows",
    "compose",
    "cut_curves",
    "geometry",
    "is_motion",
    "linked",
    "place",
    "put_pieces",
]

STARTS = int(Mark.TOOL_LEFT | Mark.TOOL_RIGHT | Mark.SMOOTH | Mark.ROUND | Mark.LOOP)
"""Marks that act from the start of their segment."""

STOPS = int(Mark.TOOL_STOP | Mark.CORNER_STOP | Mark.LOOP_STOP)
"""Marks that act at the end of their segment."""

Rows: TypeAlias = npt.NDArray[np.intp]

_ROOM = 16
"""Pieces of a curve that there is room for at first."""


class Geometry(NamedTuple):
    """A path as kernels take it: kinds, planes, curve rows, Shape (n, 12), and X-Y-Z positions, Shape (n + 1, 3)."""

    kinds: Bytes
    planes: npt.NDArray[np.int64]
    rows: Floats
    points: Floats


def geometry(path: Toolpath) -> Geometry:
    """The geometry of a chunk, one row a segment; straight ones have rows of zeros."""
    n = len(path)
    planes = np.zeros(n, np.int64)
    rows = np.zeros((n, CURVE_PARAMETERS))
    curved = np.flatnonzero(path.curve >= 0)
    planes[curved] = path.curves.plane[path.curve[curved]]
    rows[curved] = path.curves.parameters[path.curve[curved]]
    points = np.vstack([path.start[None, :3], path.target[:, :3]])
    return Geometry(path.kind, planes, rows, np.ascontiguousarray(points))


@dataclass(frozen=True)
class Links:
    """Parts of source segments and the parts of new rows they became, ordered by (segment, p0).

    segment: i8 (m,) source row;  p0, p1: f8 (m,) its part 0..1;  row: i8 (m,) new row;  q0, q1: its part.
    """

    segment: Rows
    p0: Floats
    p1: Floats
    row: Rows
    q0: Floats
    q1: Floats

    @classmethod
    def copies(cls, origin: Rows) -> Links:
        """Every new row is the whole of its source row."""
        n = len(origin)
        zero, one = np.zeros(n), np.ones(n)
        return cls(origin, zero, one, np.arange(n), zero, one)

    @classmethod
    def moved(cls, row: Rows) -> Links:
        """Every source row is the whole of the new row named for it, Shape (n,)."""
        n = len(row)
        zero, one = np.zeros(n), np.ones(n)
        return cls(np.arange(n), zero, one, row, zero, one)

    @classmethod
    def merged(cls, parts: Sequence[Links]) -> Links:
        """All links of several parts, each in order; where two begin at one place, those of the first part first."""
        segment, row = (
            np.concatenate([getattr(part, name) for part in parts]) for name in ("segment", "row")
        )
        p0, p1, q0, q1 = (
            np.concatenate([getattr(part, name) for part in parts]) for name in ("p0", "p1", "q0", "q1")
        )
        order = np.argsort(segment + p0, kind="stable")
        return cls(segment[order], p0[order], p1[order], row[order], q0[order], q1[order])


def place(links: Links, segment: int, position: float) -> tuple[int, float]:
    """Where a point of a source segment went, as (row, position 0..1).

    A point in a gap (a loop that was cut) goes to the end of the part before it.
    """
    lo, hi = np.searchsorted(links.segment, [segment, segment + 1])
    if lo == hi:
        return (
            (int(links.row[lo - 1]), float(links.q1[lo - 1]))
            if lo
            else (int(links.row[0]), float(links.q0[0]))
        )
    at = int(lo)
    for j in range(int(lo), int(hi)):
        if links.p0[j] <= position:
            at = j
            if position <= links.p1[j]:
                break
    p0, p1 = float(links.p0[at]), float(links.p1[at])
    q0, q1 = float(links.q0[at]), float(links.q1[at])
    share = min(max((position - p0) / (p1 - p0), 0.0), 1.0) if p1 > p0 else 0.0
    return int(links.row[at]), min(max(q0 + share * (q1 - q0), 0.0), 1.0)


def compose(
    source: Toolpath, origin: Rows, kind: Bytes, target: Floats, shape: Ints, curves: Curves, links: Links,
    clear: int = 0, known: Floats | None = None,
) -> Toolpath:  # fmt: skip
    """A chunk of new rows that starts where `source` starts.

    Args:     origin: Shape (n,), source row whose feed, accelerations, D, S-profile and line each row takes;
              kind, target: as in Toolpath;  shape: Shape (n,), row in `curves` or -1;  links: for events;
              clear: marks that have been carried out;  known: lengths of curves (`path_lengths`).
    """
    n = len(origin)
    curved = np.flatnonzero(shape >= 0)
    curve = np.full(n, -1, np.int32)
    curve[curved] = np.arange(len(curved), dtype=np.int32)
    picked = shape[curved]
    path = Toolpath(
        axes=source.axes,
        start=source.start,
        kind=kind.astype(np.uint8),
        target=target,
        curve=curve,
        length=np.zeros(n),
        feed=source.feed[origin],
        accel=source.accel[origin],
        decel=source.decel[origin],
        mark=_marks(source, origin, clear),
        radius=source.radius[origin],
        profile=source.profile[origin],
        line=source.line[origin],
        curves=Curves(curves.plane[picked], curves.parameters[picked]),
        events=_events(source, links),
        first=source.first,
        names=source.names,
    )
    return path.replace(length=path_lengths(path, known))


def _marks(source: Toolpath, origin: Rows, clear: int) -> npt.NDArray[np.uint16]:
    """Marks of the new rows: starts on the first, stops on the last row of their origin."""
    mark = np.zeros(len(origin), np.uint16)
    kept = source.mark & np.uint16(0xFFFF & ~clear)
    if not kept.any() or not len(origin):
        return mark
    order = np.argsort(origin, kind="stable")
    ordered = origin[order]
    for i in np.flatnonzero(kept):
        lo, hi = np.searchsorted(ordered, [i, i + 1])
        if lo < hi:
            mark[order[lo]] |= kept[i] & np.uint16(STARTS)
            mark[order[hi - 1]] |= kept[i] & np.uint16(STOPS)
        elif lo < len(ordered):
            mark[order[lo]] |= kept[i] & np.uint16(STARTS)
        if lo == hi and lo > 0:
            mark[order[lo - 1]] |= kept[i] & np.uint16(STOPS)
    return mark


def _events(source: Toolpath, links: Links) -> Events:
    e = source.events
    rows = []
    for j in range(len(e)):
        row, position = place(links, int(e.segment[j]), float(e.position[j]))
        if e.kind[j] != EventKind.SWITCH:
            position = float(e.position[j])
        rows.append(
            (row, int(e.kind[j]), int(e.number[j]), position, float(e.k[j]), float(e.l[j]), int(e.o[j]))
        )
    return Events.from_rows(rows)


def linked(path: Toolpath, rows: Rows, parts: Floats) -> tuple[Links, Rows]:
    """The links of a stretch whose whole way is cut anew into pieces.

    Args:     rows, parts: Shape (m,), the source row in which each piece ends, and at which part 0..1 of it;
              ascending, the last is the end of the path.
    Returns:  the links, and the source row in which each piece begins.

    In a piece with events the parts are summed from its start, whatever lies before it, so that they do not depend
    on how the path comes in chunks; elsewhere a sum over the whole stretch is good enough to measure by.
    """
    inner = parts < 1.0
    row = np.concatenate([np.arange(len(path)), rows[inner]])
    p1 = np.concatenate([np.ones(len(path)), parts[inner]])
    order = np.lexsort((p1, row))
    row, p1 = row[order], p1[order]
    is_end = np.zeros(len(row), np.bool_)
    is_end[np.searchsorted(row + 0.5 * p1, rows + 0.5 * parts)] = True
    p0 = np.where(np.diff(row, prepend=-1) == 0, np.concatenate([[0.0], p1[:-1]]), 0.0)
    piece: Rows = np.cumsum(is_end) - is_end
    lasts = np.flatnonzero(is_end)
    firsts = np.concatenate([[0], lasts[:-1] + 1]).astype(np.intp)
    size = (p1 - p0) * path.length[row]
    way = np.cumsum(size)
    begin = (way - size)[firsts][piece]
    total = way[lasts][piece] - begin
    total = np.where(total > 0.0, total, 1.0)
    q0 = np.clip((way - size - begin) / total, 0.0, 1.0)
    q1 = np.clip((way - begin) / total, 0.0, 1.0)
    alone = (firsts == lasts)[piece]
    q0[alone], q1[alone] = 0.0, 1.0
    for r in np.unique(piece[np.isin(row, path.events.segment) & ~alone]):
        pick = slice(int(firsts[r]), int(lasts[r]) + 1)
        own = np.cumsum(size[pick])
        q1[pick] = own / own[-1]
        q0[pick] = np.concatenate([[0.0], q1[pick][:-1]])
    return Links(row, p0, p1, piece, q0, q1), row[firsts]


class Pieces(NamedTuple):
    """What some source rows become, in order.

    owner, share: Shape (m,), the source row, ascending, and at which part 0..1 of its way each piece ends, the last
    one of a row at 1;  kind: Shape (m,);  target: Shape (m, k);  curves: m rows, those of straight pieces unused.
    """

    owner: Rows
    share: Floats
    kind: Bytes
    target: Floats
    curves: Curves


def cut_curves(
    picked: Rows, most: int, widths: Sequence[int], fill: Callable[..., int]
) -> tuple[Rows, Floats, list[Floats]]:
    """What a kernel makes of curves, as many at a time as there is room for.

    Args:     picked: Shape (p,), ascending, rows of the curves;  most: pieces of one curve;  widths: of the further
              columns;  fill: called with the place in `picked` from which to go on, and the columns owner, share and
              further ones, of one length each; it returns the number of pieces it filled.
    Returns:  owner and share of `Pieces`, and the further columns, Shape (m, width).
    """
    room = most + _ROOM * len(picked)
    parts, begin = [], 0
    while begin < len(picked):
        columns = [np.empty(room, np.int64), np.empty(room), *(np.empty((room, width)) for width in widths)]
        count = fill(begin, *columns)
        parts.append([column[:count] for column in columns])
        begin = int(np.searchsorted(picked, columns[0][count - 1])) + 1
    owner, share, *further = (np.concatenate(column) for column in zip(*parts, strict=True))
    return owner, share, further


def put_pieces(path: Toolpath, pieces: Pieces) -> tuple[Toolpath, Links]:
    """The path with pieces for their rows, the others as they are; and what became of what."""
    n, m = len(path), len(pieces.owner)
    number = np.bincount(pieces.owner, minlength=n)
    origin = np.repeat(np.arange(n), np.maximum(number, 1))
    at = np.flatnonzero(number[origin])
    kind, target, shape = path.kind[origin], path.target[origin], path.curve[origin]
    kind[at], target[at] = pieces.kind, pieces.target
    shape[at] = np.where(pieces.kind >= Kind.ARC, len(path.curves) + np.arange(m), -1)
    curves = Curves(
        np.concatenate([path.curves.plane, pieces.curves.plane]),
        np.vstack([path.curves.parameters, pieces.curves.parameters]),
    )
    p0, p1 = np.zeros(len(origin)), np.ones(len(origin))
    p1[at] = pieces.share
    p0[at] = np.where(
        np.diff(pieces.owner, prepend=-1) == 0, np.concatenate([[0.0], pieces.share[:-1]])[:m], 0.0
    )
    links = Links(origin, p0, p1, np.arange(len(origin)), np.zeros(len(origin)), np.ones(len(origin)))
    return compose(path, origin, kind, target, shape, curves, links), links


def is_motion(kind: int) -> bool:
    """Whether a segment of this kind cuts: not a positioning, a jump or a wait."""
    return Kind.LINE <= kind <= Kind.POLYNOMIAL
