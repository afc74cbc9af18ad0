"""NC061 nameless-program."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["NamelessProgram"]


class NamelessProgram(Rule):
    r"""The header has no name.

    What: % without a program name after it.
    Why: the name is what queue files, reports and operators call the program by.
    NC061: %\nN10 G1 X1 F20
    Okay: % bracket\nN10 G1 X1 F20
    """

    code = "NC061"
    name = "nameless-program"
    severity = Severity.NOTE

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the header."""
        if program.header is not None and not program.header.name:
            yield Finding(program.header.span, "the program has no name", "write it after %, as in % bracket")
