"""NC156 loop-condition-never-changes."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.flow import loops, variable_written
from nccompile.lint.program import Program

__all__ = ["LoopConditionNeverChanges"]


class LoopConditionNeverChanges(Rule):
    r"""A loop whose condition never changes.

    What: a jump back over blocks that do not write the variable of its condition.
    Why: once taken it is taken for ever; `compile` sees it only if the loop is entered.
    NC156: % a\nN10 G36 O$n$ D0\nN20 G1 X1 F20\nN30 G20 L20 K$n$
    Okay: % a\nN10 G36 O$n$ D2\nN20 G1 X1 F20\nN25 G37 O$n$ D-1\nN30 G20 L20 K$n$
    """

    code = "NC156"
    name = "loop-condition-never-changes"

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks for assignments between the target and the jump."""
        for loop in loops(program):
            changed = any(
                variable_written(program, at) == loop.variable for at in range(loop.begin, loop.end)
            )
            if loop.variable is not None and not changed:
                shown = f"${loop.variable}$" if loop.variable else "the implicit variable"
                yield Finding(
                    program.blocks[loop.end].span, f"no block of this loop changes {shown}",
                    "change it with G37 before the jump",
                )  # fmt: skip
