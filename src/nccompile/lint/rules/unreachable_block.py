"""NC158 unreachable-block."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program, first

__all__ = ["UnreachableBlock"]


class UnreachableBlock(Rule):
    r"""A block that is never reached.

    What: blocks after a jump that is always taken, up to the next block that a jump leads to.
    Why: they look as if they ran.
    NC158: % a\nN10 G1 X1 F20\nN20 G20 L40 K1\nN30 G1 X2\nN40 G1 X3
    Okay: % a\nN10 G36 O$n$ D1\nN20 G20 L40 K$n$\nN30 G1 X2 F20\nN40 G1 X3 F20
    """

    code = "NC158"
    name = "unreachable-block"

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks behind jumps with a constant condition."""
        for at in program.jumps:
            condition = first(program.blocks[at], "K")
            always = condition is not None and isinstance(condition.value, float) and condition.value != 0.0
            if not always or at + 1 >= len(program.blocks) or program.blocks[at].skip:
                continue
            block = program.blocks[at + 1]
            if block.words and at + 1 not in program.targets:
                yield Finding(
                    block.span, f"never reached: line {program.blocks[at].line} always jumps",
                    "remove the blocks, or give the jump a condition that can be 0",
                )  # fmt: skip
