"""Semantic tokens: what each word is, for colours beyond those of the grammar.

A token is five numbers: lines and characters behind the one before, length, type, modifiers.  What an edit changes of
them is short, as they are relative: `difference` finds it.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from lsprotocol import types

from nccompile.decoder.tables import AXES
from nccompile.lsp.document import Document
from nccompile.parser import Block, Header, Variable

__all__ = ["LEGEND", "difference", "tokens"]

_TYPES = [
    "namespace",
    "label",
    "keyword",
    "function",
    "property",
    "parameter",
    "event",
    "variable",
    "comment",
]

LEGEND = types.SemanticTokensLegend(token_types=_TYPES, token_modifiers=[])
"""Names of the token types; a token says its place in this list."""

_INDEX = {name: at for at, name in enumerate(_TYPES)}

_BY_LETTER = {
    **dict.fromkeys(AXES, _INDEX["property"]),
    "N": _INDEX["label"],
    "G": _INDEX["keyword"],
    "M": _INDEX["function"],
    "H": _INDEX["event"],
}
_PARAMETER, _VARIABLE = _INDEX["parameter"], _INDEX["variable"]

Token = tuple[int, int, int]
"""Start and end in a line, from 0, and type."""


def tokens(document: Document, first: int = 0, last: int | None = None) -> list[int]:
    """The tokens of the lines first to last, five numbers each."""
    data: list[int] = []
    line_before = start_before = 0
    text = document.text
    end = len(document.nodes) if last is None else min(last + 1, len(document.nodes))
    for line in range(max(first, 0), end):
        found = _of_line(document, line)
        if not found:
            continue
        if not text.lines[line].isascii():
            found = [(text.character(line, a), text.character(line, b), kind) for a, b, kind in found]
        for start, stop, kind in found:
            delta = line - line_before
            data += (delta, start if delta else start - start_before, stop - start, kind, 0)
            line_before, start_before = line, start
    return data


def _of_line(document: Document, line: int) -> list[Token]:
    """The tokens of a line in the order of the text; places count code points."""
    node = document.in_line(line)
    if isinstance(node, Header):
        return [(node.column - 1, node.end - 1, _INDEX["namespace"])]
    if not isinstance(node, Block):
        return []
    found: list[Token] = []
    for letter, value, text, _, column in node.words if node.number is None else (node.number, *node.words):
        start, stop, kind = column - 1, column - 1 + len(text), _BY_LETTER.get(letter, _PARAMETER)
        if isinstance(value, Variable):
            found += ((start, start + 1, kind), (start + 1, stop, _VARIABLE))
        else:
            found.append((start, stop, kind))
    if node.comments:
        found += ((c.span.column - 1, c.span.end - 1, _INDEX["comment"]) for c in node.comments)
        found.sort()
    return found


def difference(old: npt.NDArray[np.int32], new: npt.NDArray[np.int32]) -> list[types.SemanticTokensEdit]:
    """The one edit that makes the numbers of a text, shape (n,), those of another one; none if they are equal."""
    short = min(len(old), len(new))
    start = _same(old[:short], new[:short])
    rest = short - start
    end = _same(old[len(old) - rest :][::-1], new[len(new) - rest :][::-1])
    if start + end == len(old) == len(new):
        return []
    data = new[start : len(new) - end].tolist()
    return [types.SemanticTokensEdit(start=start, delete_count=len(old) - end - start, data=data)]


def _same(old: npt.NDArray[np.int32], new: npt.NDArray[np.int32]) -> int:
    """How many numbers at the start are equal."""
    differing = np.flatnonzero(old != new)
    return int(differing[0]) if len(differing) else len(old)
