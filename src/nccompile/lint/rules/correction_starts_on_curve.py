"""NC351 correction-starts-on-curve."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program
from nccompile.lint.shapes import lines_of
from nccompile.toolpath.columns import Kind, Mark

__all__ = ["CorrectionStartsOnCurve"]

_HELP = "lead in and out on a line of at least the tool radius"


class CorrectionStartsOnCurve(Rule):
    r"""Tool radius correction starts or ends on a curve.

    What: G41, G42 or G40 next to an arc, ellipse, parabola or spline.
    Why: the correction is built up on the first path object and taken back on the last (SoftMotion §6.2.3); that
    needs a line, on a curve the tool cuts into the contour.
    NC351: % a\nN10 G0 X0 Y0\nN20 G41 D1\nN30 G3 X10 Y0 R5 F20\nN40 G1 X20\nN50 G40
    Okay: % a\nN10 G0 X0 Y0\nN20 G41 D1\nN30 G1 X5 Y0 F20\nN40 G3 X15 Y0 R5\nN45 G1 X25\nN50 G40
    """

    code = "NC351"
    name = "correction-starts-on-curve"
    needs_path = True

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the segments with the marks."""
        path = program.path
        curved = (path.kind >= Kind.ARC) & (path.kind <= Kind.POLYNOMIAL)
        marks = Mark.TOOL_LEFT | Mark.TOOL_RIGHT
        for line in lines_of(path, curved & ((path.mark & marks) != 0)):
            yield Finding(program.source.text_span(line), "tool radius correction starts on a curve", _HELP)
        for line in lines_of(path, curved & ((path.mark & Mark.TOOL_STOP) != 0)):
            yield Finding(program.source.text_span(line), "tool radius correction ends on a curve", _HELP)
