"""NC157 loop-step-misses-zero."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.flow import loops, variable_written
from nccompile.lint.program import Program, first

__all__ = ["LoopStepMissesZero"]


class LoopStepMissesZero(Rule):
    r"""A loop step that may never meet 0.

    What: G37 with a fraction, such as 0.1, on the variable of a loop's condition.
    Why: a jump is taken until its condition is exactly 0; sums of fractions are not exact, so the loop may run
    past 0 and never end.
    NC157: % a\nN10 G36 O$n$ D0.2\nN20 G1 X1 F20\nN25 G37 O$n$ D-0.1\nN30 G20 L20 K$n$
    Okay: % a\nN10 G36 O$n$ D10\nN20 G1 X1 F20\nN25 G37 O$n$ D-1\nN30 G20 L20 K$n$
    """

    code = "NC157"
    name = "loop-step-misses-zero"

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the steps of loop variables; binary fractions such as 0.25 are exact."""
        for loop in loops(program):
            for at in range(loop.begin, loop.end):
                if program.codes[at] != 37 or variable_written(program, at) != loop.variable:
                    continue
                step = first(program.blocks[at], "D")
                if (
                    step is not None
                    and isinstance(step.value, float)
                    and not (step.value * 1024).is_integer()
                ):
                    yield Finding(
                        step.span, f"steps of {step.number} may miss 0, and the loop then never ends",
                        "count in whole numbers",
                    )  # fmt: skip
