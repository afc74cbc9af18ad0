"""The columns of tool radius correction: what moves, its offsets, the rows they become (drawing: tool_radius.py).

    path ──> Moving ──> Offsets ──> Emitted ──> path
             rows with    pieces and    new rows with their
             extent       connectors    origin and part

A contour is a run of rows with a distance; all contours of a stretch are worked on at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from nccompile.diagnostics import Severity
from nccompile.geometry.tolerance import COINCIDENT
from nccompile.kernels.offset import offset_rows, shares_along
from nccompile.kernels.offset_emit import LINKED, MOVED, emit_rows
from nccompile.kernels.offset_joints import join_offsets
from nccompile.passes.base import Context
from nccompile.passes.edit import Links, Rows, compose
from nccompile.toolpath.columns import CURVE_PARAMETERS, Bytes, Curves, Floats, Kind, Plane, Toolpath

__all__ = ["Emitted", "Moving", "Offsets", "Style", "build", "emit", "moving_rows", "offset"]

_LEADS = ("positioning", "line", "arc")

_ROOM = 16
"""Pieces that an ellipse or cubic gets room for at first."""


class Style(NamedTuple):
    """Options of `ToolRadius` that shape the path."""

    corner: str
    limit: float
    close: bool
    lead: str
    length: float
    tolerance: float


class Moving(NamedTuple):
    """Rows of contours with extent in X-Y.

    row: Shape (m,), source row;  kinds, curve, table, ends: as in `kernels.boxes`;  d: Shape (m,) [mm], to the left;
    contour: Shape (m,), its number;  of_row: Shape (n,), the contour of every source row, -1 outside.
    """

    row: Rows
    kinds: Bytes
    curve: Rows
    table: Floats
    ends: Floats
    d: Floats
    contour: Rows
    of_row: Rows


@dataclass
class Offsets:
    """Offset pieces of moving rows: begin..stop - 1 of each, then its connectors (fewer than 0: across the contour).

    kinds, curve, table, ends: the pieces as columns, with room for leads behind the first `count`;  part: Shape (.,
    2), parameters of the row they stand for;  dropped: Shape (m,), rows that are left out.
    """

    begin: Rows
    stop: Rows
    connector: Rows
    connectors: Rows
    count: int
    kinds: Bytes
    curve: Rows
    table: Floats
    ends: Floats
    part: Floats
    dropped: Bytes


class Emitted(NamedTuple):
    """The new rows: kind, source row, part 0..1 of it, piece or -1, X-Y, flags, linked part, contour or -1."""

    kind: Bytes
    origin: Rows
    part: Floats
    piece: Rows
    xy: Floats
    flags: Bytes
    link: Floats
    contour: Rows


def moving_rows(path: Toolpath, d: Floats, count: int, context: Context) -> Moving:
    """The first `count` rows with a distance d, Shape (n,), and extent in X-Y; NC303 for curves in other planes."""
    cutting = d[:count] != 0.0
    of_row = np.full(len(path), -1, np.int64)
    of_row[:count] = np.where(cutting, np.cumsum(np.diff(cutting, prepend=False) & cutting) - 1, -1)
    start = np.empty((count, 2))
    start[0], start[1:] = path.start[:2], path.target[: count - 1, :2]
    step = path.target[:count, :2] - start
    curve = path.curve[:count].astype(np.int64)
    curved = cutting & (curve >= 0)
    plane = np.zeros(count, np.uint8)
    plane[curved] = path.curves.plane[curve[curved]]
    for i in np.flatnonzero(plane != Plane.XY):
        what = "tool radius correction acts in X-Y only, this curve runs in another plane"
        context.find("NC303", Severity.ERROR, what, int(path.line[i]), "end it with G40 before")
    extent = np.where(curve >= 0, plane == Plane.XY, (step * step).sum(axis=1) > COINCIDENT * COINCIDENT)
    row = np.flatnonzero(cutting & (path.kind[:count] <= Kind.POLYNOMIAL) & extent)
    table = path.curves.parameters if len(path.curves) else np.zeros((1, CURVE_PARAMETERS))
    ends = np.hstack([start[row], path.target[row, :2]])
    return Moving(row, path.kind[row], curve[row], table, ends, d[row], of_row[row], of_row)


def offset(moving: Moving, style: Style) -> Offsets:
    """The offsets of moving rows, joined."""
    n = len(moving.row)
    curves = int(np.count_nonzero(moving.kinds > Kind.ARC))
    room = n + _ROOM * curves
    while True:
        # Untouched memory costs nothing: connectors take at most two rows behind each piece, leads two a contour.
        size = room + 2 * n + 1
        out = Offsets(
            np.empty(n + 1, np.int64), np.empty(0, np.int64), np.zeros(n, np.int64), np.zeros(n, np.int64), 0,
            np.empty(size, np.uint8), np.empty(size, np.int64), np.empty((size, CURVE_PARAMETERS)),
            np.empty((size, 4)), np.empty((size, 2)), np.zeros(n, np.uint8),
        )  # fmt: skip
        out.count = offset_rows(
            moving.kinds, moving.curve, moving.table, moving.ends, moving.d, style.tolerance, out.begin,
            out.kinds, out.curve, out.table, out.ends, out.part,
        )  # fmt: skip
        if out.count >= 0:
            break
        room *= 2
    out.begin, out.stop = out.begin[:-1].copy(), out.begin[1:].copy()
    out.count = join_offsets(
        moving.kinds, moving.curve, moving.table, moving.ends, moving.d, moving.contour, style.close,
        style.corner == "line", style.limit, style.tolerance, out.begin, out.stop, out.count,
        out.kinds, out.curve, out.table, out.ends, out.part, out.connector, out.connectors,
    )  # fmt: skip
    leads = out.count + 2 * (int(moving.contour.max(initial=-1)) + 1) - len(out.kinds)
    if leads > 0:
        for name in ("kinds", "curve", "table", "ends", "part"):
            column = getattr(out, name)
            setattr(out, name, np.concatenate([column, np.zeros((leads, *column.shape[1:]), column.dtype)]))
    return out


def emit(path: Toolpath, moving: Moving, offsets: Offsets, count: int, style: Style) -> Emitted:
    """The new rows of the first `count` source rows; adds leads to the pieces."""
    x, y = (np.concatenate([path.start[c : c + 1], path.target[:, c]]) for c in (0, 1))
    contours = int(moving.of_row.max(initial=-1)) + 1
    size = count + offsets.count + 4 * contours
    out = Emitted(
        np.empty(size, np.uint8), np.empty(size, np.int64), np.empty(size), np.empty(size, np.int64),
        np.empty((size, 2)), np.empty(size, np.uint8), np.empty((size, 2)), np.empty(size, np.int64),
    )  # fmt: skip
    n = emit_rows(
        count, path.kind, x, y, moving.of_row, moving.row, moving.d, offsets.dropped, offsets.begin, offsets.stop,
        offsets.connector, offsets.connectors, offsets.count, _LEADS.index(style.lead), style.length,
        offsets.kinds, offsets.curve, offsets.table, offsets.ends, offsets.part, *out,
    )  # fmt: skip
    out = Emitted._make(column[:n] for column in out)
    standing = (
        (out.piece < 0) & (out.flags & MOVED != 0) & (out.kind > Kind.ARC - 1) & (out.kind <= Kind.POLYNOMIAL)
    )
    out.kind[standing] = Kind.LINE
    free = np.flatnonzero((out.piece >= 0) & (out.flags & LINKED != 0) & (path.kind[out.origin] > Kind.ARC))
    if len(free):
        rows = path.curves.parameters[path.curve[out.origin[free]]]
        for column in (out.part, out.link[:, 0], out.link[:, 1]):
            values = column[free]
            shares_along(path.kind[out.origin[free]], rows, values)
            column[free] = values
    return out


def build(
    path: Toolpath, count: int, moving: Moving, emitted: Emitted, offsets: Offsets, clear: int
) -> Toolpath:
    """The new rows as a chunk; clear: marks that have been carried out."""
    source = path.rows(0, count)
    origin, part = emitted.origin, emitted.part[:, None]
    starts = source.starts()[origin]
    target = source.target[origin]
    inner = (part > 0.0) & (part < 1.0)
    target = np.where(inner, starts + part * (target - starts), np.where(part > 0.0, target, starts))
    moved = emitted.flags & MOVED != 0
    target[moved, :2] = emitted.xy[moved]
    curved = np.flatnonzero((emitted.piece >= 0) & (emitted.kind >= Kind.ARC))
    shape = np.where(emitted.piece < 0, source.curve[origin], -1).astype(np.int32)
    shape[emitted.kind < Kind.ARC] = -1
    shape[curved] = len(source.curves) + np.arange(len(curved), dtype=np.int32)
    curves = Curves(
        np.concatenate([source.curves.plane, np.full(len(curved), Plane.XY, np.uint8)]),
        np.concatenate([source.curves.parameters, offsets.table[emitted.piece[curved]]]),
    )
    links = _links(moving, emitted, offsets)
    return compose(source, origin, emitted.kind, target, shape, curves, links, clear=clear)


def _links(moving: Moving, emitted: Emitted, offsets: Offsets) -> Links:
    """Which part of a source row each new row stands for; what is left out goes to the end that is left."""
    row = np.flatnonzero(emitted.flags & LINKED != 0)
    origin, p0, p1 = emitted.origin[row], emitted.link[row, 0], emitted.link[row, 1]
    q0, q1 = np.zeros(len(row)), np.ones(len(row))
    gone = moving.row[offsets.dropped == 1]
    if len(gone):
        cut = row[emitted.piece[row] >= 0]
        after = np.searchsorted(emitted.origin[cut], gone)
        following = cut[np.minimum(after, len(cut) - 1)]
        is_before = (after < len(cut)) & (emitted.contour[following] == moving.of_row[gone])
        at = np.where(is_before, following, cut[np.maximum(after - 1, 0)])
        edge = np.where(is_before, 0.0, 1.0)
        origin, row = np.concatenate([origin, gone]), np.concatenate([row, at])
        p0, p1 = np.concatenate([p0, np.zeros(len(gone))]), np.concatenate([p1, np.ones(len(gone))])
        q0, q1 = np.concatenate([q0, edge]), np.concatenate([q1, edge])
    order = np.lexsort((p0, origin))
    return Links(origin[order], p0[order], p1[order], row[order], q0[order], q1[order])
