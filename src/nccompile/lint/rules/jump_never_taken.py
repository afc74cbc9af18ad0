"""NC159 jump-never-taken."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.flow import jump_target
from nccompile.lint.program import Program, first

__all__ = ["JumpNeverTaken"]

_HELP = "remove it, or correct K or L"


class JumpNeverTaken(Rule):
    r"""A jump that is never taken, or leads nowhere else.

    What: G20 with the constant condition 0, or to the block that follows anyway.
    Why: it has no effect; usually the condition or the number is wrong.
    NC159: % a\nN10 G1 X1 F20\nN20 G20 L10 K0
    Okay: % a\nN10 G36 O$n$ D1\nN15 G1 X1 F20\nN20 G37 O$n$ D-1\nN30 G20 L15 K$n$
    """

    code = "NC159"
    name = "jump-never-taken"

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the condition and the target of jumps."""
        for at in program.jumps:
            block = program.blocks[at]
            condition = first(block, "K")
            if condition is not None and condition.value == 0.0:
                yield Finding(condition.span, "this jump is never taken: its condition is 0", _HELP)
            elif program.numbers.get(jump_target(program, at) or -1) == [at + 1]:
                yield Finding(block.span, "this jump leads to the next block", _HELP)
