"""NC166 stop-without-start."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Rule
from nccompile.lint.flow import ENDS
from nccompile.lint.program import Program

__all__ = ["StopWithoutStart"]


class StopWithoutStart(Rule):
    r"""The end of a function that is not on.

    What: G40, G50 or G60 without its start before it, other than at the head of the program, where it is a
    customary reset.
    Why: it has no effect; often its start was deleted or never written.
    NC166: % a\nN10 G1 X10 F20\nN20 G50\nN30 G1 X20
    Okay: % a\nN10 G51 D1\nN20 G1 X10 F20\nN30 G1 X20\nN40 G50
    """

    code = "NC166"
    name = "stop-without-start"
    severity = Severity.NOTE

    def check(self, program: Program) -> Iterator[Finding]:
        """Follows the three functions; programs with jumps are left alone."""
        if program.jumps:
            return
        on: set[int] = set()
        moved = next((at for at, move in enumerate(program.moves) if move is not None), 0)
        for at, code in program.instructions(*ENDS, *ENDS.values()):
            if code in ENDS:
                on.add(ENDS[code])
            elif code in on:
                on.discard(code)
            elif at > moved:
                yield Finding(
                    program.blocks[at].span, f"G{code} ends nothing", "remove it, or write its start"
                )
