"""NC160 mode-repeated."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["ModeRepeated"]


class ModeRepeated(Rule):
    r"""A mode that holds already.

    What: G90, G91, G98 or G99 while it is in force, other than as the first of its kind.
    Why: it has no effect; where it was meant to change something, the other one is missing.
    NC160: % a\nN10 G91\nN20 G1 X1 F20\nN30 G91\nN40 G1 X1
    Okay: % a\nN10 G91\nN20 G1 X1 F20\nN30 G90\nN40 G1 X1
    """

    code = "NC160"
    name = "mode-repeated"
    severity = Severity.NOTE

    def check(self, program: Program) -> Iterator[Finding]:
        """Follows the two modes; programs with jumps are left alone."""
        if program.jumps:
            return
        since: dict[bool, tuple[int, int]] = {}
        for at, code in program.instructions(90, 91, 98, 99):
            block, kind = program.blocks[at], code < 95
            before = since.get(kind)
            if before is not None and before[0] == code:
                yield Finding(block.span, f"G{code} is in force since line {before[1]}", "remove the block")
            elif block.skip:
                since.pop(kind, None)
            else:
                since[kind] = (code, block.line)
