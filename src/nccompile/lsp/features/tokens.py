"""Semantic tokens: what each word is, for colours beyond those of the grammar."""

from __future__ import annotations

from collections.abc import Iterator

from lsprotocol import types

from nccompile.decoder.tables import AXES
from nccompile.lsp.document import Document
from nccompile.parser import Block, Header, Variable
from nccompile.source import Span

__all__ = ["LEGEND", "tokens"]

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

_BY_LETTER = {"N": "label", "G": "keyword", "M": "function", "H": "event"}


def tokens(document: Document, first: int = 0, last: int | None = None) -> list[int]:
    """The tokens of the lines first to last, five numbers each, relative to the one before."""
    data: list[int] = []
    line_before = start_before = 0
    end = len(document.nodes) if last is None else min(last + 1, len(document.nodes))
    for line in range(max(first, 0), end):
        for span, kind in sorted(_of_line(document, line)):
            (_, start), (_, stop) = document.text.places(span)
            delta = line - line_before
            data += [delta, start - (0 if delta else start_before), stop - start, _INDEX[kind], 0]
            line_before, start_before = line, start
    return data


def _of_line(document: Document, line: int) -> Iterator[tuple[Span, str]]:
    node = document.node(line)
    if isinstance(node, Header):
        yield node.span, "namespace"
    if not isinstance(node, Block):
        return
    for comment in node.comments:
        yield comment.span, "comment"
    words = node.words if node.number is None else (node.number, *node.words)
    for word in words:
        kind = _BY_LETTER.get(word.letter) or ("property" if word.letter in AXES else "parameter")
        if isinstance(word.value, Variable):
            yield Span(word.line, word.column, word.column + 1), kind
            yield Span(word.line, word.column + 1, word.column + len(word.text)), "variable"
        else:
            yield word.span, kind
