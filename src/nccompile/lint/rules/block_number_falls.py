"""NC053 block-number-falls."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Fix, Rule
from nccompile.lint.numbering import numbering_fix
from nccompile.lint.program import Program

__all__ = ["BlockNumberFalls"]


class BlockNumberFalls(Rule):
    r"""Block numbers do not rise.

    What: a block number below that of the block before.
    Why: operators look for a block by its number; falling numbers are usually left over from copied blocks.
    NC053: % a\nN20 G1 X1 F20\nN10 G1 X2
    Okay: % a\nN10 G1 X1 F20\nN20 G1 X2
    Fix: numbers all blocks anew; jumps follow their targets.
    """

    code = "NC053"
    name = "block-number-falls"
    severity = Severity.NOTE

    def check(self, program: Program) -> Iterator[Finding]:
        """Compares each number with the one before."""
        before = -1.0
        for block in program.blocks:
            number = block.number
            if number is None or not isinstance(number.value, float):
                continue
            if number.value < before:
                yield Finding(
                    number.span, f"the block number falls from N{before:.0f} to {number.text}",
                    "`nccompile fmt --renumber` numbers the blocks in steps",
                )  # fmt: skip
            before = number.value

    def fix_all(self, program: Program) -> Fix | None:
        """New numbers."""
        return numbering_fix(program)
