"""From spans and findings to the types of the protocol."""

from __future__ import annotations

from itertools import groupby

from lsprotocol import types

from nccompile.diagnostics import Diagnostic, Severity, render
from nccompile.lint.base import Fix
from nccompile.lsp.document import Document
from nccompile.lsp.text import Place, common_ends, pieces, split
from nccompile.source import Source, Span

__all__ = ["diagnostic", "edits_of", "edits_to", "line_range", "place", "position", "range_of", "whole"]

_SEVERITIES = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    Severity.NOTE: types.DiagnosticSeverity.Information,
}

_UNNECESSARY = {"NC059", "NC105", "NC151", "NC153", "NC158"}
"""Findings about text that could go; editors show it faded."""


def position(at: Place) -> types.Position:
    """A position of the protocol."""
    return types.Position(*at)


def place(at: types.Position) -> Place:
    """Line and character of a position."""
    return at.line, at.character


def range_of(document: Document, span: Span) -> types.Range:
    """The range of a span."""
    start, end = document.text.places(span)
    return types.Range(position(start), position(end))


def line_range(document: Document, first: int, last: int) -> types.Range:
    """From the start of a line, from 0, to the end of another."""
    end = document.text.character(last, len(document.text.lines[last]))
    return types.Range(types.Position(first, 0), types.Position(last, end))


def whole(document: Document) -> types.Range:
    """The range of the whole text."""
    return types.Range(types.Position(0, 0), position(document.text.end()))


def diagnostic(document: Document, found: Diagnostic, source: Source | None) -> types.Diagnostic:
    """A finding; `data.rendered` is the text that `compile` and `lint` print for it."""
    tags = [types.DiagnosticTag.Unnecessary] if found.code in _UNNECESSARY else None
    return types.Diagnostic(
        range=range_of(document, found.span),
        message=found.message + (f"\nhelp: {found.help}" if found.help else ""),
        severity=_SEVERITIES[found.severity],
        code=found.code,
        source="nccompile",
        tags=tags,
        data=None if source is None else {"rendered": render(found, source)},
    )


def edits_to(document: Document, new: str) -> list[types.TextEdit]:
    """The edits that make the text another one, of the lines that differ only: cursors and folds elsewhere stay."""
    old, wanted = document.text.pieces(), pieces(*split(new))
    if len(old) == len(wanted):
        runs = [
            list(run)
            for differs, run in groupby(range(len(old)), lambda at: old[at] != wanted[at])
            if differs
        ]
        return [_replaced(document, run[0], run[-1] + 1, wanted[run[0] : run[-1] + 1]) for run in runs]
    start, end = common_ends(old, wanted)
    return [_replaced(document, start, len(old) - end, wanted[start : len(wanted) - end])]


def _replaced(document: Document, first: int, end: int, lines: list[str]) -> types.TextEdit:
    """New lines in place of those from `first` to before `end`, with their line ends."""
    last = types.Position(end, 0) if end < len(document.text.lines) else position(document.text.end())
    return types.TextEdit(types.Range(types.Position(first, 0), last), "".join(lines))


def edits_of(document: Document, fix: Fix) -> list[types.TextEdit]:
    """The edits of a fix."""
    edits = []
    for edit in fix.edits:
        start, end = document.text.places(edit)
        edits.append(types.TextEdit(types.Range(position(start), position(end)), edit.text))
    return edits
