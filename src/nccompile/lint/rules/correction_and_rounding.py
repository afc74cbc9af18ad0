"""NC353 correction-and-rounding."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program
from nccompile.lint.shapes import between, lines_of
from nccompile.toolpath.columns import Mark

__all__ = ["CorrectionAndRounding"]


class CorrectionAndRounding(Rule):
    r"""Tool radius correction together with rounding or smoothing.

    What: a path object for which G41 or G42 is on together with G51 or G52.
    Why: SoftMotion's preprocessing does not allow both at once (§3.6); D would be tool radius and rounding
    distance at the same time.
    NC353: % a\nN10 G41 D1\nN20 G51\nN30 G1 X10 F20\nN40 G1 Y10\nN50 G50\nN60 G40
    Okay: % a\nN20 G51 D1\nN30 G1 X10 F20\nN40 G1 Y10\nN50 G50
    """

    code = "NC353"
    name = "correction-and-rounding"
    needs_path = True

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at where both regions overlap; one finding a region."""
        path = program.path
        tool = between(path, Mark.TOOL_LEFT | Mark.TOOL_RIGHT, Mark.TOOL_STOP)
        both = tool & between(path, Mark.SMOOTH | Mark.ROUND, Mark.CORNER_STOP)
        begins = both & ~np.concatenate([[False], both[:-1]]) if len(both) else both
        for line in lines_of(path, begins):
            yield Finding(
                program.source.text_span(line), "tool radius correction and corner rounding are both on",
                "end one with G40 or G50 before the other starts",
            )  # fmt: skip
