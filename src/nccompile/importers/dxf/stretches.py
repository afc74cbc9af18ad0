"""Parts of a path by their length: overcuts and tabs."""

from __future__ import annotations

import numpy as np

from nccompile.importers.dxf.job import Tabs
from nccompile.importers.dxf.pieces import PieceKind, Pieces, lengths, sample, split

__all__ = ["stretch", "tab_stretches"]

LEAST = 1e-4
"""[mm] Stretches shorter than this are left out."""


def stretch(path: Pieces, low: float, high: float) -> Pieces:
    """The pieces of the path from `low` to `high` mm along it, the first and last cut if need be."""
    size = lengths(path)
    ends = np.cumsum(size)
    begins = ends - size
    parts = []
    for i in np.flatnonzero((ends > low + LEAST) & (begins < high - LEAST)).tolist():
        piece = path.take([i])
        if high < ends[i] - LEAST:
            piece = split(piece, 0, _parameter(piece, (high - begins[i]) / size[i]))[0]
        if low > begins[i] + LEAST:
            whole = min(high, float(ends[i])) - float(begins[i])
            piece = split(piece, 0, _parameter(piece, (low - begins[i]) / whole))[1]
        parts.append(piece)
    return Pieces.join(parts)


def _parameter(piece: Pieces, share: float) -> float:
    """The parameter 0..1 at a share of a piece's length."""
    if piece.kind[0] in {PieceKind.LINE, PieceKind.ARC}:
        return float(share)
    u = np.linspace(0.0, 1.0, 257)
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(sample(piece, u)[0])))])
    return float(np.interp(share * along[-1], along, u))


def tab_stretches(path: Pieces, tabs: Tabs, tool_radius: float) -> list[tuple[Pieces, bool]]:
    """The path cut into stretches, each with whether a tab is left under it.

    Tabs stand in the middle of equal parts of the path.  The tool is lifted over their length and its own
    diameter, so what is left is as long as asked for.  Tabs that would touch each other become one.
    """
    total = float(lengths(path).sum())
    raised = tabs.length + 2.0 * tool_radius
    step = total / tabs.count
    if raised >= step:
        return [(path, True)]
    stretches, at = [], 0.0
    for k in range(tabs.count):
        middle = (k + 0.5) * step
        stretches.append((stretch(path, at, middle - raised / 2), False))
        at = middle + raised / 2
        stretches.append((stretch(path, middle - raised / 2, at), True))
    stretches.append((stretch(path, at, total), False))
    return [(part, up) for part, up in stretches if len(part)]
