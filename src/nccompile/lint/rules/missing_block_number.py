"""NC051 missing-block-number."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Fix, Rule
from nccompile.lint.numbering import numbering_fix
from nccompile.lint.program import Program

__all__ = ["MissingBlockNumber"]

_HELP = "`nccompile fmt --renumber` numbers the blocks"


class MissingBlockNumber(Rule):
    r"""A block has no block number.

    What: a block with words and without N in a program whose other blocks have one; one finding for the whole
    program if none has.
    Why: the number is expected of every block (SoftMotion §3.2); drives, operators and jumps name blocks by it.
    NC051: % a\nN10 G1 X1 F20\nG1 X2
    Okay: % a\nN10 G1 X1 F20\nN20 G1 X2
    Fix: numbers all blocks anew; jumps follow their targets.
    """

    code = "NC051"
    name = "missing-block-number"
    severity = Severity.NOTE

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks for blocks without N."""
        missing = [block for block in program.blocks if block.number is None and block.words]
        if missing and all(block.number is None for block in program.blocks):
            yield Finding(missing[0].span, "no block has a block number", _HELP)
            return
        for block in missing:
            yield Finding(block.span, "this block has no block number", _HELP)

    def fix_all(self, program: Program) -> Fix | None:
        """New numbers."""
        return numbering_fix(program)
