"""NC163 program-end-m."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["ProgramEndM"]


class ProgramEndM(Rule):
    r"""M2 or M30 is no end.

    What: M2 or M30, which end a program in ISO 6983.
    Why: here every M function waits until it is acknowledged (SoftMotion §3.2.2); the program ends with its last
    block. Without an acknowledge the run never ends.
    NC163: % a\nN10 G1 X1 F20\nN20 M30
    Okay: % a\nN10 G1 X1 F20
    """

    code = "NC163"
    name = "program-end-m"

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks for the two numbers."""
        for _, word in program.words("M"):
            if word.value in {2.0, 30.0}:
                yield Finding(
                    word.span, f"{word.text.upper()} does not end the program, it waits for an acknowledge",
                    "remove it if nothing acknowledges it",
                )  # fmt: skip
