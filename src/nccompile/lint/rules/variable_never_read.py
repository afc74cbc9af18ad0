"""NC154 variable-never-read."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.flow import variable_uses
from nccompile.lint.program import Program

__all__ = ["VariableNeverRead"]


class VariableNeverRead(Rule):
    r"""A variable that is written and never read.

    What: G36 or G37 on a variable that no word uses.
    Why: either its use was forgotten or its name is misspelt somewhere.
    NC154: % a\nN10 G36 O$depth$ D5\nN20 G1 X1 F20
    Okay: % a\nN10 G36 O$depth$ D5\nN20 G1 X1 Z$depth$ F20
    """

    code = "NC154"
    name = "variable-never-read"

    def check(self, program: Program) -> Iterator[Finding]:
        """Compares the names written with the names read."""
        uses = variable_uses(program)
        read = {use.name for use in uses if not use.writes}
        reported: set[str] = set()
        for use in uses:
            if use.writes and use.name not in read and use.name not in reported:
                reported.add(use.name)
                yield Finding(
                    use.word.span, f"variable {use.word.number} is never read",
                    "use it in a word, or remove the assignment",
                )  # fmt: skip
