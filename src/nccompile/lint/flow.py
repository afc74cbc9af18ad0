"""Jumps, loops and variables of a program, as far as they can be seen without running it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from nccompile.lint.base import Edit
from nccompile.lint.program import Program, first
from nccompile.parser import Block, Variable, Word

__all__ = [
    "ENDS",
    "Loop",
    "Use",
    "is_jump",
    "jump_target",
    "loops",
    "variable_uses",
    "variable_written",
    "without",
]

ENDS = {41: 40, 42: 40, 51: 50, 52: 50, 61: 60}
"""The end of each function by its start."""


class Use(NamedTuple):
    """A variable in a word: its name without case, and whether the block writes it."""

    name: str
    word: Word
    block: int
    writes: bool


class Loop(NamedTuple):
    """Blocks `begin` to `end`, the last of which jumps back to the first.

    variable: name of its condition without case, "" for the implicit one, None if the condition is a number.
    """

    begin: int
    end: int
    variable: str | None


def variable_uses(program: Program) -> list[Use]:
    """All variables in words, in written order; G37 writes and does not count as reading."""
    uses: list[Use] = []
    if "$" not in program.source.text:
        return uses
    for at, block in enumerate(program.blocks):
        for word in block.words:
            value = word.value
            if isinstance(value, Variable):
                writes = word.letter == "O" and program.codes[at] in {36, 37}
                uses.append(Use(value.name.lower(), word, at, writes))
    return uses


def variable_written(program: Program, at: int) -> str | None:
    """The name that the block at an index writes, "" for the implicit variable, None if it writes none."""
    if program.codes[at] not in {36, 37}:
        return None
    word = first(program.blocks[at], "O")
    if word is None:
        return ""
    return word.value.name.lower() if isinstance(word.value, Variable) else None


def is_jump(block: Block) -> bool:
    """Whether a block has G20."""
    return any(word.letter == "G" and word.value == 20.0 for word in block.words)


def jump_target(program: Program, at: int) -> int | None:
    """The block number that the jump at an index leads to; None if it is no number."""
    word = first(program.blocks[at], "L")
    value = None if word is None else word.value
    return int(value) if isinstance(value, float) and value.is_integer() else None


def loops(program: Program) -> Iterator[Loop]:
    """Jumps back to a block that is there once."""
    for at in program.jumps:
        places = program.numbers.get(jump_target(program, at) or -1, [])
        if len(places) != 1 or places[0] > at:
            continue
        word = first(program.blocks[at], "K")
        variable: str | None = ""
        if word is not None:
            variable = word.value.name.lower() if isinstance(word.value, Variable) else None
        yield Loop(places[0], at, variable)


def without(program: Program, word: Word) -> Edit:
    """Removes a word and the blanks before it."""
    text = program.source.line(word.line)
    begin = word.column - 1
    while begin > 0 and text[begin - 1] in " \t":
        begin -= 1
    end = word.column - 1 + len(word.text)
    glued = end < len(text) and text[end] not in " \t"
    return Edit(word.line, begin + 1, end + 1, " " if glued and begin > 0 else "")
