"""The modal state behind a block: instructions in force, F, E, D, position."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from typing import NamedTuple

from nccompile.decoder.tables import INSTRUCTIONS, Group
from nccompile.lint.program import Program
from nccompile.lsp.analysis import Analysis
from nccompile.parser import Word

__all__ = ["State", "state_behind"]

_SHOWN = (Group.DRIVE, Group.DISTANCE, Group.CENTRE, Group.TOOL, Group.CORNER, Group.LOOP)
_DEFAULTS = {Group.DISTANCE: 90, Group.CENTRE: 99}
_ENDS = {40, 50, 60}


class State(NamedTuple):
    """instructions: G codes in force;  feed, accel, decel, radius: as written, empty if none;  position by axis.

    Blocks count in written order, as if no jump were taken; the position is that of the toolpath.
    """

    instructions: tuple[int, ...]
    feed: str
    accel: str
    decel: str
    radius: str
    position: dict[str, float]


def state_behind(analysis: Analysis, line: int) -> State:
    """The state behind a line, from 1."""
    program = analysis.program
    at = bisect_right(program.blocks, line, key=lambda block: block.line) - 1
    in_force = []
    for group in _SHOWN:
        code = _last_of(program, group, at) or _DEFAULTS.get(group, 0 if group is Group.DRIVE else None)
        if code is not None and code not in _ENDS:
            in_force.append(code)
    return State(
        tuple(in_force),
        _last(program, "F", at, lambda word, code: code != 4),
        _last(program, "E", at, lambda word, _: not word.text[1:].startswith("-")),
        _last(program, "E", at, lambda word, _: word.text[1:].startswith("-")),
        _last(program, "D", at, lambda word, code: code not in {36, 37}),
        _position(analysis, line),
    )


def _last(program: Program, letter: str, at: int, counts: Callable[[Word, int | None], bool]) -> str:
    """The value of the last word of a letter up to block `at`, as written."""
    blocks, words = program.occurrences(letter)
    for place in range(bisect_right(blocks, at) - 1, -1, -1):
        if counts(words[place], program.codes[blocks[place]]):
            return words[place].number
    return ""


def _last_of(program: Program, group: Group, at: int) -> int | None:
    blocks, _ = program.occurrences("G")
    for place in range(bisect_right(blocks, at) - 1, -1, -1):
        code = program.codes[blocks[place]]
        if code is not None and code in INSTRUCTIONS and INSTRUCTIONS[code].group is group:
            return code
    return None


def _position(analysis: Analysis, line: int) -> dict[str, float]:
    """The position behind the last segment that stems from the line or one above it."""
    if not analysis.is_sound:
        return {}
    path = analysis.path
    rows = analysis.rows(line)
    if rows:
        values = path.target[rows[-1]]
    else:
        before = (path.line <= line).nonzero()[0]
        values = path.target[before[-1]] if len(before) else path.start
    return {letter: float(value) for letter, value in zip(path.axes, values, strict=True)}
