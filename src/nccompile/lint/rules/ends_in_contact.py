"""NC168 ends-in-contact."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["EndsInContact"]


class EndsInContact(Rule):
    r"""The program ends on a feed move.

    What: no positioning (G0) after the last feed move, which does not lead back to where the program began.
    Why: the tool stays where it cut last; the next program, or the operator, has to move it away.
    NC168: % a\nN10 G0 X5\nN20 G1 X10 F20
    Okay: % a\nN10 G0 X5\nN20 G1 X10 F20\nN30 G0 Z50
    Okay: % a\nN10 G0 X5\nN20 G1 X10 F20\nN30 G1 X0
    """

    code = "NC168"
    name = "ends-in-contact"
    severity = Severity.NOTE

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the last move."""
        if not any(move == 0 for move in program.moves):
            return  # a program without any positioning is a part of another one
        if _comes_back(program):
            return
        for at in range(len(program.moves) - 1, -1, -1):
            if program.moves[at] is not None:
                if program.moves[at] != 0:
                    block = program.blocks[at]
                    yield Finding(
                        block.span, f"the last move is G{program.moves[at]}: the program has no end position",
                        "end with a positioning, as in G0 Z50",
                    )  # fmt: skip
                return


def _comes_back(program: Program) -> bool:
    """Whether a program without errors ends where it began."""
    if program.diagnostics.errors or not program.chunks:
        return False
    return bool((program.chunks[0].start == program.chunks[-1].end).all())
