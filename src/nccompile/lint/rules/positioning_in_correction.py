"""NC352 positioning-in-correction."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program
from nccompile.lint.shapes import between, lines_of
from nccompile.toolpath.columns import Kind, Mark

__all__ = ["PositioningInCorrection"]


class PositioningInCorrection(Rule):
    r"""Positioning while a correction is on.

    What: G0 between G41 or G42 and G40.
    Why: the corrected path then holds a positioning through the contour; the correction is to be ended first.
    NC352: % a\nN10 G41 D1\nN20 G1 X10 F20\nN30 G0 X20\nN40 G1 X30\nN50 G40
    Okay: % a\nN10 G41 D1\nN20 G1 X10 F20\nN30 G40\nN40 G0 X20
    """

    code = "NC352"
    name = "positioning-in-correction"
    needs_path = True

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at positionings inside marked regions."""
        path = program.path
        inside = between(path, Mark.TOOL_LEFT | Mark.TOOL_RIGHT, Mark.TOOL_STOP)
        first_one = (path.mark & (Mark.TOOL_LEFT | Mark.TOOL_RIGHT)) != 0
        for line in lines_of(path, inside & ~first_one & (path.kind == Kind.POSITIONING)):
            yield Finding(
                program.source.text_span(line), "G0 while tool radius correction is on", "end it with G40"
            )
