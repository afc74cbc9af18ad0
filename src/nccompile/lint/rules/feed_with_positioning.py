"""NC171 feed-with-positioning."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["FeedWithPositioning"]


class FeedWithPositioning(Rule):
    r"""F beside G0 on a machine with rapids.

    What: F in a block with G0, if the machine file gives its axes a rapid velocity.
    Why: the positioning runs at the rapid velocity, and F holds from the next feed move on; a reader thinks the
    positioning is meant.
    NC171: % a\nN10 G0 X10 F20\nN20 G1 X20
    Okay: % a\nN10 G0 X10\nN20 G1 X20 F20
    Machine: rapid
    """

    code = "NC171"
    name = "feed-with-positioning"
    severity = Severity.NOTE

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at blocks with both words."""
        if all(axis.rapid is None for axis in program.machine.axes.values()):
            return
        for at, word in program.words("F"):
            if program.moves[at] == 0:
                yield Finding(
                    word.span, "F does not hold for this positioning", "write it in the first feed move"
                )
