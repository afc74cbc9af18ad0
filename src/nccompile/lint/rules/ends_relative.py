"""NC161 ends-relative."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["EndsRelative"]


class EndsRelative(Rule):
    r"""The program ends with relative targets.

    What: G91 without G90 after it.
    Why: the control may keep the mode; the next program then starts with relative targets.
    NC161: % a\nN10 G91\nN20 G1 X1 F20
    Okay: % a\nN10 G91\nN20 G1 X1 F20\nN30 G90
    """

    code = "NC161"
    name = "ends-relative"
    severity = Severity.NOTE

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the last of G90 and G91."""
        last = None
        for at, code in program.instructions(90, 91):
            last = (at, code)
        if last is not None and last[1] == 91:
            yield Finding(program.blocks[last[0]].span, "G91 is still in force at the end", "end with G90")
