"""Inlay hints and code lenses: end positions, radii, times, and the length of the path.

N30 G91 ...
N40 G1 X5 Y-2      → X25 Y8   0.24 s       end position where the block does not say it
N50 G3 X5 I2 J0    R2   0.3 s              radius of an arc that is programmed by its centre
"""

from __future__ import annotations

from bisect import bisect_right

import numpy as np
from lsprotocol import types

from nccompile.lint.shapes import ARC_RADIUS
from nccompile.lsp.analysis import Analysis
from nccompile.lsp.document import Document
from nccompile.lsp.features.outline import parts_of
from nccompile.parser import Block, Variable
from nccompile.toolpath.columns import AXIS_LETTERS, Kind

__all__ = ["hints", "lenses"]

_MOST_LENSES = 200


def hints(document: Document, analysis: Analysis, first: int, last: int) -> list[types.InlayHint]:
    """The hints of the lines first to last, from 0."""
    if not analysis.is_sound or not analysis.program.chunks:
        return []
    found = []
    for line in range(max(first, 0), min(last + 1, len(document.nodes))):
        node = document.node(line)
        if isinstance(node, Block) and node.words:
            text = "  ".join(_of_block(analysis, node))
            if text:
                end = document.text.character(line, len(document.text.lines[line].rstrip()))
                place = types.Position(line, end)
                found.append(types.InlayHint(place, text, padding_left=True))
    return found


def _of_block(analysis: Analysis, block: Block) -> list[str]:
    rows = analysis.rows(block.line)
    path = analysis.path
    if not rows or path.kind[rows[-1]] > Kind.POLYNOMIAL:
        return []
    parts = []
    row = rows[-1]
    axes = [word for word in block.words if word.letter in AXIS_LETTERS]
    if axes and (_is_relative(analysis, block) or any(isinstance(word.value, Variable) for word in axes)):
        moved = [letter for letter in path.axes if any(word.letter == letter for word in axes)]
        shown = (f"{letter}{path.target[row, path.axes.index(letter)]:.6g}" for letter in moved)
        parts.append("→ " + " ".join(shown))
    if path.kind[row] == Kind.ARC and not any(word.letter == "R" for word in block.words):
        parts.append(f"R{path.curves.parameters[path.curve[row], ARC_RADIUS]:.6g}")
    if analysis.times is not None:
        seconds = float(analysis.times.seconds[rows.start : rows.stop].sum())
        if seconds > 0.0:
            parts.append(_time(seconds))
    return parts


def _is_relative(analysis: Analysis, block: Block) -> bool:
    """Whether G91 is the last of G90 and G91 before a block, in written order."""
    places = analysis.distance_modes
    at = bisect_right(places, (block.line, 0)) - 1
    return at >= 0 and places[at][1] == 91


def _time(seconds: float) -> str:
    if seconds < 60.0:
        return f"{seconds:.3g} s"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min {rest:02} s"


def lenses(document: Document, analysis: Analysis) -> list[types.CodeLens]:
    """Length and time of the whole path at the header, and of every section at its comment."""
    if not analysis.is_sound or not analysis.program.chunks or not len(analysis.path):
        return []
    header = analysis.program.header
    first = 0 if header is None else header.line - 1
    found = [_lens(first, _totals(analysis, 0, 2**31 - 1))]
    sections = [part for part in parts_of(document) if part.kind == types.SymbolKind.Namespace]
    if len(sections) > 1:
        for part in sections[:_MOST_LENSES]:
            text = _totals(analysis, part.first + 1, part.last + 1)
            if text:
                found.append(_lens(part.first, text))
    return found


def _totals(analysis: Analysis, first: int, last: int) -> str:
    """Segments, length and time of the lines first to last, from 1."""
    path = analysis.path
    rows = np.flatnonzero((path.line >= first) & (path.line <= last))
    if not len(rows):
        return ""
    parts = [f"{len(rows)} segment{'s' * (len(rows) != 1)}", f"{path.length[rows].sum():.6g} mm"]
    if analysis.times is not None:
        inside = (analysis.times.lines >= first) & (analysis.times.lines <= last)
        parts.append(_time(float(analysis.times.seconds[inside].sum())))
    return " · ".join(parts)


def _lens(line: int, text: str) -> types.CodeLens:
    place = types.Position(line, 0)
    return types.CodeLens(types.Range(place, place), types.Command(text, ""))
