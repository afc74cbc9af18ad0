"""NC167 function-without-move."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.flow import ENDS
from nccompile.lint.program import Program

__all__ = ["FunctionWithoutMove"]


class FunctionWithoutMove(Rule):
    r"""A function is ended before anything moves.

    What: G41, G42, G51, G52 or G61 and its end with no move between them.
    Why: it acts on nothing.
    NC167: % a\nN10 G1 X5 F20\nN20 G41 D3\nN30 G40\nN40 G1 X10
    Okay: % a\nN10 G1 X5 F20\nN20 G41 D3\nN40 G1 X10\nN50 G40
    """

    code = "NC167"
    name = "function-without-move"

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks for moves between a start and its end."""
        started: dict[int, int] = {}
        for at, code in program.instructions(*ENDS, *ENDS.values()):
            if code in ENDS:
                started[ENDS[code]] = at
                continue
            begin = started.pop(code, None)
            if begin is None or program.jumps:
                continue
            if all(move is None for move in program.moves[begin : at + 1]):
                block = program.blocks[begin]
                yield Finding(
                    block.span, f"nothing moves before line {program.blocks[at].line} ends this function",
                    "put the moves between them, or remove both",
                )  # fmt: skip
