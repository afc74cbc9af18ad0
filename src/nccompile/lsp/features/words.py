"""What stands at a position: a word, a variable in it, a jump target."""

from __future__ import annotations

from typing import NamedTuple

from nccompile.lint.flow import is_jump
from nccompile.lsp.document import Document
from nccompile.lsp.text import Place
from nccompile.parser import Block, Variable, Word

__all__ = ["Spot", "number_of", "spot_at"]


class Spot(NamedTuple):
    """A block, and the word of it at a position (its number, too); None between words."""

    block: Block
    word: Word | None

    @property
    def variable(self) -> str | None:
        """Name of the variable in the word, without case."""
        value = None if self.word is None else self.word.value
        return value.name.lower() if isinstance(value, Variable) else None

    @property
    def target(self) -> int | None:
        """The block number that the word is, or jumps to."""
        if self.word is None:
            return None
        if self.word.letter == "N" or (self.word.letter == "L" and is_jump(self.block)):
            return number_of(self.word)
        return None


def number_of(word: Word) -> int | None:
    """The whole number of a word."""
    return int(word.value) if isinstance(word.value, float) and word.value.is_integer() else None


def spot_at(document: Document, at: Place) -> Spot | None:
    """What stands at a position; the word to its left if it is between two."""
    line = at[0]
    node = document.node(line)
    if not isinstance(node, Block):
        return None
    column = document.text.index(line, at[1]) + 1
    words = node.words if node.number is None else (node.number, *node.words)
    touching = [word for word in words if word.column <= column <= word.column + len(word.text)]
    return Spot(node, touching[-1] if touching else None)
