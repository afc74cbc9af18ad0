"""NC255 lonely-spline."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["LonelySpline"]


class LonelySpline(Rule):
    r"""A spline of a single point.

    What: one G5 between positionings or at the ends of the path.
    Why: a cardinal spline takes its tangents from its neighbours (SoftMotion §3.2.6); without any it is a line.
    NC255: % a\nN10 G0 X0 Y0\nN20 G5 X10 Y5 F20\nN30 G0 Z5
    Okay: % a\nN10 G0 X0 Y0\nN20 G5 X10 Y5 F20\nN25 G5 X20 Y0\nN30 G0 Z5
    """

    code = "NC255"
    name = "lonely-spline"

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the moves around single G5 blocks in written order."""
        if 5 not in program.moves:
            return
        moves = [(at, move) for at, move in enumerate(program.moves) if move is not None]
        for place, (at, move) in enumerate(moves):
            before = moves[place - 1][1] if place else 0
            after = moves[place + 1][1] if place + 1 < len(moves) else 0
            if move == 5 and before == 0 and after == 0:
                yield Finding(
                    program.blocks[at].span, "a spline of one point without neighbours is a line",
                    "program more points, or G1",
                )  # fmt: skip
