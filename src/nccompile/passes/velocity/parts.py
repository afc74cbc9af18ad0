"""Rows cut into parts that the planner treats as rows of their own; the path stays the same."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nccompile.kernels.curves import NODES
from nccompile.kernels.cut_rows import cut_rows
from nccompile.kernels.interpolator import CONTINUES
from nccompile.toolpath.columns import CURVE_PARAMETERS, Curves, EventKind, Events, Floats, Ints, Toolpath
from nccompile.toolpath.lengths import path_lengths

__all__ = ["Parts", "assembled", "parted"]

_TAKEN = ("kind", "feed", "accel", "decel", "radius", "line")


@dataclass(frozen=True)
class Parts:
    """Parts of the rows of a chunk, in order: row i4 (m,); p0, p1 f8 (m,) shares of the row's length."""

    row: Ints
    p0: Floats
    p1: Floats


def parted(path: Toolpath, parts: Parts) -> Toolpath:
    """A limited chunk with its rows cut; switch points keep their place on the way.

    All parts but the last of a row carry the bit CONTINUES in `profile` and its v_limit as v_junction.
    """
    m = len(parts.row)
    if m == len(path):
        return path
    row = parts.row
    target = np.empty((m, len(path.axes)))
    parameters, length = np.zeros((m, CURVE_PARAMETERS)), np.empty(m)
    cut_rows(
        path.kind, path.starts(), path.target, path.curve, path.curves.plane, path.curves.parameters, path.length,
        np.empty(NODES), np.empty(NODES), row, parts.p0, parts.p1, target, parameters, length,
    )  # fmt: skip
    return assembled(path, parts, target, parameters, length)


def assembled(path: Toolpath, parts: Parts, target: Floats, parameters: Floats, length: Floats) -> Toolpath:
    """The parts as rows: target (m, k), parameters (m, 12) of their curves, length (m,), all else from their rows.

    A path without limits gives one without limits.
    """
    m, row = len(parts.row), parts.row
    curved = np.flatnonzero(path.curve[row] >= 0)
    curve = np.full(m, -1, np.int32)
    curve[curved] = np.arange(len(curved), dtype=np.int32)
    inner = np.append(row[1:] == row[:-1], False)
    if path.v_limit is not None and path.v_junction is not None:
        path = path.replace(
            v_limit=path.v_limit[row], v_junction=np.where(inner, path.v_limit[row], path.v_junction[row]),
            v_end=np.zeros(m),
        )  # fmt: skip
    out = path.replace(
        **{name: getattr(path, name)[row] for name in _TAKEN},
        target=target, curve=curve, length=length,
        curves=Curves(path.curves.plane[path.curve[row[curved]]], parameters[curved]),
        events=_events(path, parts),
        profile=path.profile[row] | (inner.astype(np.uint16) << np.uint16(CONTINUES)),
        mark=np.where(inner, 0, path.mark[row]).astype(np.uint16),
    )  # fmt: skip
    # A row that is not cut keeps its length to the bit, whatever else is in the chunk.
    uncut = (parts.p0 == 0.0) & (parts.p1 == 1.0)
    measured = path_lengths(out.replace(profile=out.profile & 0x7FFF))
    return out.replace(length=np.where(uncut | (path.length[row] <= 0.0), path.length[row], measured))


def _events(path: Toolpath, parts: Parts) -> Events:
    """The events at the parts where their positions lie."""
    e = path.events
    if not len(e):
        return e
    first = np.searchsorted(parts.row, e.segment)
    last = np.searchsorted(parts.row, e.segment, side="right") - 1
    part, position = first.copy(), e.position.copy()
    for i in np.flatnonzero((first < last) & (e.kind == EventKind.SWITCH)):
        inside = slice(int(first[i]), int(last[i]) + 1)
        part[i] += np.searchsorted(parts.p0[inside], e.position[i], side="right") - 1
        p0, p1 = parts.p0[part[i]], parts.p1[part[i]]
        position[i] = min(max((e.position[i] - p0) / (p1 - p0), 0.0), 1.0)
    return Events(part.astype(np.int32), e.kind, e.number, position, e.k, e.l, e.o)
