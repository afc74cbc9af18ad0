"""NC059 skip-mark-without-effect."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Edit, Finding, Fix, Rule
from nccompile.lint.program import Program
from nccompile.source import Span

__all__ = ["SkipMarkWithoutEffect"]


class SkipMarkWithoutEffect(Rule):
    r"""A skip mark on a block that does nothing.

    What: / before a block without words, or alone in a line.
    Why: there is nothing to skip; usually the / was meant for the next block.
    NC059: % a\n/N10 (rough)\nN20 G1 X1 F20
    NC059: % a\n/\nN20 G1 X1 F20
    Okay: % a\n/N10 G1 X1 F20\nN20 G1 X2
    Fix: removes the mark.
    """

    code = "NC059"
    name = "skip-mark-without-effect"

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at skipped blocks without words."""
        for block in program.blocks:
            if block.skip and not block.words and block.sound:
                at = program.source.line(block.line).index("/") + 1
                span = Span(block.line, at, at + 1)
                yield Finding(
                    span, "/ has no effect on a block without words", "remove it, or put it before the block meant",
                    Fix("Remove the skip mark", (Edit.of(span, ""),)),
                )  # fmt: skip
