"""NC355 loop-avoidance-alone."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program
from nccompile.lint.shapes import between, lines_of
from nccompile.toolpath.columns import Kind, Mark

__all__ = ["LoopAvoidanceAlone"]


class LoopAvoidanceAlone(Rule):
    r"""Loop avoidance around a positioning.

    What: G0 between G61 and G60.
    Why: the path is cut where it crosses itself (SoftMotion §6.2.4); moves in the air may be cut together with
    the contour.
    NC355: % a\nN10 G61\nN20 G1 X10 F20\nN30 G0 X20\nN40 G1 X30\nN50 G60
    Okay: % a\nN10 G61\nN20 G1 X10 F20\nN30 G1 X20\nN50 G60
    """

    code = "NC355"
    name = "loop-avoidance-alone"
    severity = Severity.NOTE
    needs_path = True

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at positionings inside marked regions."""
        path = program.path
        inside = between(path, Mark.LOOP, Mark.LOOP_STOP)
        for line in lines_of(path, inside & (path.kind == Kind.POSITIONING)):
            yield Finding(program.source.text_span(line), "G0 while loop avoidance is on", "end it with G60")
