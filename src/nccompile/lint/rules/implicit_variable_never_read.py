"""NC155 implicit-variable-never-read."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program, first

__all__ = ["ImplicitVariableNeverRead"]


class ImplicitVariableNeverRead(Rule):
    r"""The implicit variable is set and never used.

    What: G36 or G37 without O in a program whose jumps all have a condition of their own, or that has none.
    Why: the implicit variable acts only as the condition of a jump without K (SoftMotion §3.2.8).
    NC155: % a\nN10 G36 D5\nN20 G1 X1 F20
    Okay: % a\nN10 G36 D2\nN20 G1 X1 F20\nN30 G37 D-1\nN40 G20 L20
    """

    code = "NC155"
    name = "implicit-variable-never-read"

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks for a jump without K."""
        if any(first(program.blocks[at], "K") is None for at in program.jumps):
            return
        for at, code in program.instructions(36, 37):
            if first(program.blocks[at], "O") is None:
                yield Finding(
                    program.blocks[at].span, f"G{code} sets the implicit variable, and no jump uses it",
                    "name a variable with O$name$, or jump without K",
                )  # fmt: skip
                return
