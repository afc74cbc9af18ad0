"""NC354 radius-changes."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program
from nccompile.lint.shapes import between, lines_of
from nccompile.toolpath.columns import Mark

__all__ = ["RadiusChanges"]


class RadiusChanges(Rule):
    r"""D changes while a correction is on.

    What: another D between the start and the end of tool radius correction.
    Why: the distance to the contour jumps in the middle of the contour.
    NC354: % a\nN10 G41 D3\nN20 G1 X10 F20\nN30 G1 X20 D2\nN40 G40
    Okay: % a\nN10 G41 D3\nN20 G1 X10 F20\nN30 G1 X20\nN40 G40 D2
    """

    code = "NC354"
    name = "radius-changes"
    needs_path = True

    def check(self, program: Program) -> Iterator[Finding]:
        """Compares the radius of neighbours inside a region."""
        path = program.path
        starts = Mark.TOOL_LEFT | Mark.TOOL_RIGHT
        inside = between(path, starts, Mark.TOOL_STOP)
        flags = inside & ((path.mark & starts) == 0)
        flags[1:] &= path.radius[1:] != path.radius[:-1]
        for line in lines_of(path, flags):
            yield Finding(
                program.source.text_span(line), "the tool radius D changes while the correction is on",
                "end the correction before D changes",
            )  # fmt: skip
