"""Document symbols and folding: sections by comments, loops, corrections, M functions.

(rough)            section, until the next comment that stands alone
N10 G41 D3         tool radius correction, until G40
N50 G20 L20        loop from N20
"""

from __future__ import annotations

from dataclasses import dataclass, field

from lsprotocol import types

from nccompile.decoder.tables import INSTRUCTIONS
from nccompile.lint.flow import ENDS, is_jump
from nccompile.lsp.convert import line_range
from nccompile.lsp.document import Document
from nccompile.lsp.features.words import number_of
from nccompile.parser import Block, Header

__all__ = ["Part", "foldings", "parts_of", "symbols"]


@dataclass
class Part:
    """A stretch of lines, from 0, both included."""

    name: str
    kind: types.SymbolKind
    first: int
    last: int
    detail: str = ""
    children: list[Part] = field(default_factory=list)


def parts_of(document: Document) -> list[Part]:
    """All parts in the order of their first lines, longer ones first; a part lies inside another or beside it."""
    nodes = [document.node(line) for line in range(len(document.nodes))]
    last = max((line for line, node in enumerate(nodes) if node is not None), default=0)
    parts = [*_sections(nodes, last), *_regions(nodes, last), *_loops(nodes), *_functions(nodes)]
    return sorted(parts, key=lambda part: (part.first, -part.last))


def _sections(nodes: list[Block | Header | None], last: int) -> list[Part]:
    heads = []
    before_was_head = False
    for line, node in enumerate(nodes):
        is_head = isinstance(node, Block) and bool(node.comments) and node.is_empty
        if is_head and not before_was_head:
            assert isinstance(node, Block)
            text = node.comments[0].text.strip()
            if text and not text.lower().startswith("nc:"):
                heads.append((line, text))
        before_was_head = is_head
    ends = [line - 1 for line, _ in [*heads[1:], (last + 1, "")]]
    return [
        Part(text, types.SymbolKind.Namespace, line, max(line, end))
        for (line, text), end in zip(heads, ends, strict=False)
    ]


def _regions(nodes: list[Block | Header | None], last: int) -> list[Part]:
    parts = []
    started: dict[int, tuple[int, int]] = {}
    for line, node in enumerate(nodes):
        for code in _codes(node):
            if code in ENDS:
                started.setdefault(ENDS[code], (line, code))
            elif code in started:
                begin, start = started.pop(code)
                parts.append(_region(begin, line, start))
    return parts + [_region(begin, last, start) for begin, start in started.values()]


def _region(begin: int, end: int, code: int) -> Part:
    return Part(f"G{code}", types.SymbolKind.Object, begin, max(begin, end), INSTRUCTIONS[code].group.value)


def _loops(nodes: list[Block | Header | None]) -> list[Part]:
    places: dict[int, int] = {}
    parts = []
    for line, node in enumerate(nodes):
        if not isinstance(node, Block):
            continue
        number = None if node.number is None else number_of(node.number)
        if number is not None:
            places.setdefault(number, line)
        if is_jump(node):
            targets = [number_of(word) for word in node.words if word.letter == "L"]
            begin = places.get(targets[0]) if targets and targets[0] is not None else None
            if begin is not None and begin < line:
                parts.append(Part(f"loop N{targets[0]}", types.SymbolKind.Array, begin, line))
    return parts


def _functions(nodes: list[Block | Header | None]) -> list[Part]:
    return [
        Part(word.text.upper(), types.SymbolKind.Event, line, line)
        for line, node in enumerate(nodes)
        if isinstance(node, Block)
        for word in node.words
        if word.letter == "M"
    ]


def _codes(node: Block | Header | None) -> list[int]:
    if not isinstance(node, Block):
        return []
    return [
        int(w.value)
        for w in node.words
        if w.letter == "G" and isinstance(w.value, float) and w.value.is_integer()
    ]


def symbols(document: Document) -> list[types.DocumentSymbol]:
    """The parts as a tree; one that would overlap another without lying in it ends with it."""
    root: list[Part] = []
    path: list[Part] = []
    for part in parts_of(document):
        part.children = []
        while path and path[-1].last < part.first:
            path.pop()
        if path:
            part.last = min(part.last, path[-1].last)
        (path[-1].children if path else root).append(part)
        path.append(part)
    return [_symbol(document, part) for part in root]


def _symbol(document: Document, part: Part) -> types.DocumentSymbol:
    return types.DocumentSymbol(
        name=part.name,
        kind=part.kind,
        range=line_range(document, part.first, part.last),
        selection_range=line_range(document, part.first, part.first),
        detail=part.detail or None,
        children=[_symbol(document, child) for child in part.children],
    )


def foldings(document: Document) -> list[types.FoldingRange]:
    """The parts of more than one line."""
    seen = set()
    ranges = []
    for part in parts_of(document):
        lines = (part.first, part.last)
        if part.last > part.first and lines not in seen:
            seen.add(lines)
            ranges.append(types.FoldingRange(start_line=part.first, end_line=part.last))
    return ranges
