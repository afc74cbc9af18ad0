"""NC252 tiny-arc."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program
from nccompile.lint.shapes import ARC_RADIUS, arcs

__all__ = ["TinyArc"]


class TinyArc(Rule):
    r"""An arc with a tiny radius.

    What: a radius below `min-radius` (0.005 mm).
    Why: it is rounding of the CAM system, not a contour; on it the feed falls to almost 0.
    NC252: % a\nN10 G0 X0 Y0\nN20 G3 X0.002 Y0 R0.001 F20
    Okay: % a\nN10 G0 X0 Y0\nN20 G3 X2 Y0 R1 F20
    """

    code = "NC252"
    name = "tiny-arc"
    needs_path = True

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the radius of arcs."""
        rows, radius = arcs(program.path, ARC_RADIUS)
        small = radius < program.config.min_radius
        for row, r in zip(rows[small], radius[small], strict=True):
            span = program.source.text_span(int(program.path.line[row]))
            yield Finding(span, f"the radius of this arc is only {r:.4g} mm", "program a line")
