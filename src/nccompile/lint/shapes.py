"""What path rules ask of a toolpath: lines of flagged segments, regions, arcs, bends."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from nccompile.toolpath.columns import Floats, Kind, Mark, Toolpath

__all__ = ["ARC_RADIUS", "ARC_SWEEP", "Flags", "arcs", "bends", "between", "lines_of"]

Flags: TypeAlias = npt.NDArray[np.bool_]
Rows: TypeAlias = npt.NDArray[np.intp]

ARC_RADIUS, ARC_START, ARC_SWEEP = 2, 3, 4
"""Columns of an arc's row in the curve table."""


def lines_of(path: Toolpath, flags: Flags) -> list[int]:
    """The source lines of flagged segments, each once, rising."""
    return sorted(set(path.line[flags].tolist()))


def between(path: Toolpath, start: Mark, stop: Mark) -> Flags:
    """Shape (n,): segments from one with a start mark to the next with a stop mark, both included."""
    rows = np.arange(len(path))
    opened = np.maximum.accumulate(np.where(path.mark & int(start), rows, -1))
    closed = np.maximum.accumulate(np.where(path.mark & int(stop), rows, -2))
    before = np.concatenate([[-2], closed[:-1]]) if len(path) else closed
    return np.asarray(opened > before) & (opened >= 0)


def arcs(path: Toolpath, column: int) -> tuple[Rows, Floats]:
    """The rows that are arcs, and one column of their curve table."""
    rows = np.flatnonzero(path.kind == Kind.ARC)
    return rows, path.curves.parameters[path.curve[rows], column]


def bends(path: Toolpath) -> tuple[Floats, Flags]:
    """Bend i lies between the segments i and i + 1.

    Returns:  angles [deg], shape (n - 1,), 0 where unknown; and where both neighbours are lines or arcs in X-Y-Z.
    """
    n = len(path)
    if n < 2:
        return np.zeros(0), np.zeros(0, np.bool_)
    leaving, entering, known = _tangents(path)
    cosine = np.einsum("ij,ij->i", leaving[:-1], entering[1:])
    both = known[:-1] & known[1:]
    return np.where(both, np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))), 0.0), both


def _tangents(path: Toolpath) -> tuple[Floats, Floats, Flags]:
    """Unit directions at the end and at the start of each segment, shape (n, 3), and where they are known."""
    chord = (path.target - path.starts())[:, :3]
    length = np.sqrt(np.einsum("ij,ij->i", chord, chord))
    known = (path.kind == Kind.LINE) & (length > 0.0)
    direction = chord / np.where(length > 0.0, length, 1.0)[:, None]
    leaving, entering = direction.copy(), direction
    rows = np.flatnonzero((path.kind == Kind.ARC) & (path.length > 0.0))
    if len(rows):
        table = path.curves.parameters[path.curve[rows]]
        flat = path.curves.plane[path.curve[rows]] == 0
        rows, table = rows[flat], table[flat]
        sign = np.sign(table[:, ARC_SWEEP])
        rise = chord[rows, 2] / path.length[rows]
        plane = np.sqrt(np.clip(1.0 - rise * rise, 0.0, 1.0)) * sign
        for angle, out in (
            (table[:, ARC_START], entering),
            (table[:, ARC_START] + table[:, ARC_SWEEP], leaving),
        ):
            out[rows] = np.stack([-np.sin(angle) * plane, np.cos(angle) * plane, rise], axis=1)
        known[rows] = True
    return leaving, entering, known
