"""NC055 spacing."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nccompile.diagnostics import Severity
from nccompile.lint.base import Edit, Finding, Fix, Rule
from nccompile.lint.layout import laid_out
from nccompile.lint.program import LINE_FEED, Bytes, Flags, Program

__all__ = ["Spacing"]


class Spacing(Rule):
    r"""Words are not separated by one blank.

    What: words that are glued together, tabs, several blanks, blanks at the start or end of a line.
    Why: words are separated by blanks (SoftMotion §3.2); other controls and editors may read glued words
    differently.
    NC055: % a\nN10G1X1  F20
    Okay: % a\nN10 G1 X1 F20
    Fix: lays the block out with one blank between its words.
    """

    code = "NC055"
    name = "spacing"
    severity = Severity.NOTE

    def check(self, program: Program) -> Iterator[Finding]:
        """Lays suspicious lines out and compares."""
        for line in program.lines_at(_suspicious(program.bytes)):
            block = program.by_line.get(line)
            if block is None or not block.sound:
                continue
            text = program.source.line(line)
            wanted = laid_out(block, keep_case=True)
            if text == wanted or text.endswith("\x1a"):
                continue
            edit = Edit(line, 1, len(text) + 1, wanted)
            yield Finding(
                block.span, "the words are not separated by one blank", "put one blank between two words",
                Fix("Put one blank between words", (edit,)),
            )  # fmt: skip


def _suspicious(data: Bytes) -> Flags:
    """Shape (n,): bytes at which a line may not be laid out as it should be; comments give false hits."""
    letter = ((data >= ord("A")) & (data <= ord("Z"))) | ((data >= ord("a")) & (data <= ord("z")))
    odd = ((data >= 9) & (data <= 13)) & (data != LINE_FEED)
    edge = (data == ord(" ")) | (data == LINE_FEED)
    flags: Flags = odd | np.zeros(len(data), np.bool_)
    if len(data):
        before, here = data[:-1], data[1:]
        touching = ~edge[:-1] & ~edge[1:]
        flags[1:] |= edge[:-1] & edge[1:] & ((before == ord(" ")) | (here == ord(" ")))
        flags[1:] |= touching & (
            (letter[1:] & ~letter[:-1]) | (before == ord(")")) | (here == ord("(")) | (here == ord("/"))
        )
        flags[0] |= data[0] == ord(" ")
        flags[-1] |= data[-1] == ord(" ")
    return flags
