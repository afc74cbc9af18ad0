"""NC151 feed-repeated."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Fix, Rule
from nccompile.lint.flow import without
from nccompile.lint.program import Program, first

__all__ = ["FeedRepeated"]


class FeedRepeated(Rule):
    r"""A feed that holds already.

    What: F with the value that is in force.
    Why: the word says nothing new; post-processors write it in every block, and a change of feed is hard to
    find among them.
    NC151: % a\nN10 G1 X1 F20\nN20 G1 X2 F20
    Okay: % a\nN10 G1 X1 F20\nN20 G1 X2
    Fix: removes the word, if the program has no jumps.
    """

    code = "NC151"
    name = "feed-repeated"
    severity = Severity.NOTE

    def check(self, program: Program) -> Iterator[Finding]:
        """Follows F through the blocks in written order."""
        if program.jumps:
            return
        before: object = None
        line = 0
        for at, word in program.words("F"):
            block = program.blocks[at]
            if program.codes[at] == 4 or first(block, "F") is not word:
                continue
            if block.skip or not isinstance(word.value, float):
                before = None
                continue
            if word.value == before and len(block.words) > 1:
                yield Finding(
                    word.span, f"the feed is {word.value:g} since line {line}", "remove the word",
                    Fix(f"Remove {word.text}", (without(program, word),)),
                )  # fmt: skip
            else:
                before, line = word.value, block.line
