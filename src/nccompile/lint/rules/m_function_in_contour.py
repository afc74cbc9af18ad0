"""NC164 m-function-in-contour."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["MFunctionInContour"]


class MFunctionInContour(Rule):
    r"""An M function stops a contour.

    What: an M function between two feed moves.
    Why: the path stands until it is acknowledged (SoftMotion §3.2.2), with the tool in contact. A switch point
    (H) acts without a stop (§3.2.1).
    NC164: % a\nN10 G1 X5 F20\nN20 M8\nN30 G1 X10
    Okay: % a\nN10 G1 X5 F20\nN30 G1 X10 H8 O0
    """

    code = "NC164"
    name = "m-function-in-contour"
    severity = Severity.NOTE

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the moves before and after each M function."""
        for at, word in program.words("M"):
            before = next((m for m in reversed(program.moves[max(0, at - 20) : at]) if m is not None), 0)
            after = next((m for m in program.moves[at + 1 : at + 20] if m is not None), 0)
            if before and after:
                yield Finding(
                    word.span, f"the path stands at {word.text.upper()} with the tool in contact",
                    "move it to a positioning, or use a switch point H",
                )  # fmt: skip
