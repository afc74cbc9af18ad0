"""NC169 starts-on-curve."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["StartsOnCurve"]


class StartsOnCurve(Rule):
    r"""The first move is a curve.

    What: an arc, ellipse, parabola or spline before any G0, G1 or G92.
    Why: its start is wherever the machine stands, by default 0; its shape depends on it.
    NC169: % a\nN10 G2 X10 Y0 I5 J0 F20
    Okay: % a\nN10 G0 X0 Y0\nN20 G2 X10 Y0 I5 J0 F20
    """

    code = "NC169"
    name = "starts-on-curve"

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the first move."""
        for at, block in enumerate(program.blocks):
            if program.codes[at] == 92:
                return
            if program.moves[at] is not None:
                if program.moves[at] not in {0, 1}:
                    yield Finding(
                        block.span, f"G{program.moves[at]} starts at a position that the program does not say",
                        "position with G0 first",
                    )  # fmt: skip
                return
