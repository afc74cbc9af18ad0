"""Definition, references and rename of block numbers and variables."""

from __future__ import annotations

import re
from collections.abc import Iterator

from lsprotocol import types

from nccompile.lint.flow import is_jump
from nccompile.lsp.convert import range_of
from nccompile.lsp.document import Document
from nccompile.lsp.features.words import Spot, number_of, spot_at
from nccompile.lsp.text import Place
from nccompile.parser import Block, Variable, Word
from nccompile.source import Span

__all__ = ["CannotRename", "definitions", "prepared", "references", "renamed"]

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_.]*")


class CannotRename(Exception):
    """Why a name cannot be changed; the message goes to the user."""


def definitions(document: Document, at: Place) -> list[types.Location]:
    """Where the block of a jump stands, or where a variable is set."""
    spot = spot_at(document, at)
    if spot is None:
        return []
    if spot.target is not None:
        found = [word for block, word in _numbers(document, spot.target) if word.letter == "N"]
    elif spot.variable is not None:
        found = [word for block, word in _variables(document, spot.variable) if _writes(block, word)]
    else:
        return []
    return _locations(document, [word.span for word in found])


def references(document: Document, at: Place, declaration: bool) -> list[types.Location]:
    """All words with a block number or a variable."""
    spot = spot_at(document, at)
    if spot is None:
        return []
    if spot.target is not None:
        words = [w for _, w in _numbers(document, spot.target) if declaration or w.letter != "N"]
    elif spot.variable is not None:
        words = [w for b, w in _variables(document, spot.variable) if declaration or not _writes(b, w)]
    else:
        return []
    return _locations(document, [word.span for word in words])


def prepared(document: Document, at: Place) -> types.Range | None:
    """The part of the word at a position that can be renamed."""
    spot = spot_at(document, at)
    if spot is None or spot.word is None or (spot.target is None and spot.variable is None):
        return None
    return range_of(document, _named(spot.word))


def renamed(document: Document, at: Place, new: str) -> list[types.TextEdit]:
    """The edits that rename a block number with its jumps, or a variable.

    Raises:   CannotRename: with the reason.
    """
    spot = spot_at(document, at)
    if spot is None or (spot.target is None and spot.variable is None):
        raise CannotRename("there is no block number and no variable here")
    words = _renamed_number(document, spot, new) if spot.target is not None else None
    if words is not None:
        text = str(int(new.strip().lstrip("NnLl")))
    else:
        assert spot.variable is not None
        text = new.strip().strip("$")
        if _NAME.fullmatch(text) is None:
            raise CannotRename(f"{new} is no name: letters, digits, _ and ., a letter first")
        if text.lower() != spot.variable and any(True for _ in _variables(document, text.lower())):
            raise CannotRename(f"there is a variable ${text}$ already")
        words = [word for _, word in _variables(document, spot.variable)]
    return [types.TextEdit(range_of(document, _named(word)), text) for word in words]


def _renamed_number(document: Document, spot: Spot, new: str) -> list[Word]:
    assert spot.target is not None
    digits = new.strip().lstrip("NnLl")
    if not (digits.isascii() and digits.isdigit()):
        raise CannotRename(f"{new} is no block number")
    if int(digits) != spot.target and any(w.letter == "N" for _, w in _numbers(document, int(digits))):
        raise CannotRename(f"there is a block N{int(digits)} already")
    return [word for _, word in _numbers(document, spot.target)]


def _named(word: Word) -> Span:
    """The digits of a number, or the name between two $."""
    inset = 2 if isinstance(word.value, Variable) else 1
    end = word.column + len(word.text) - (inset - 1)
    return Span(word.line, word.column + inset, end)


def _blocks(document: Document) -> Iterator[Block]:
    for line in range(len(document.nodes)):
        node = document.node(line)
        if isinstance(node, Block):
            yield node


def _numbers(document: Document, number: int) -> Iterator[tuple[Block, Word]]:
    """The N words with a number, and the L words that jump to it."""
    for block in _blocks(document):
        if block.number is not None and number_of(block.number) == number:
            yield block, block.number
        if is_jump(block):
            yield from ((block, w) for w in block.words if w.letter == "L" and number_of(w) == number)


def _variables(document: Document, name: str) -> Iterator[tuple[Block, Word]]:
    for block in _blocks(document):
        for word in block.words:
            if isinstance(word.value, Variable) and word.value.name.lower() == name:
                yield block, word


def _writes(block: Block, word: Word) -> bool:
    return word.letter == "O" and any(w.letter == "G" and w.value in {36.0, 37.0} for w in block.words)


def _locations(document: Document, spans: list[Span]) -> list[types.Location]:
    return [types.Location(document.uri, range_of(document, span)) for span in spans]
