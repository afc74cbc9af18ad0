"""NC054 lower-case."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nccompile.diagnostics import Severity
from nccompile.lint.base import Edit, Finding, Fix, Rule
from nccompile.lint.program import Program

__all__ = ["LowerCase"]


class LowerCase(Rule):
    r"""Words are written with small letters.

    What: a block with a word letter in lower case.
    Why: case has no meaning (SoftMotion §3.2), but a program is easier to read and to search in one spelling.
    NC054: % a\nn10 g1 x1 f20
    Okay: % a\nN10 G1 X1 F20
    Fix: writes the letters of the block in upper case.
    """

    code = "NC054"
    name = "lower-case"
    severity = Severity.NOTE

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the blocks of lines with small letters."""
        data = program.bytes
        for line in program.lines_at(np.asarray((data >= ord("a")) & (data <= ord("z")))):
            block = program.by_line.get(line)
            if block is None:
                continue
            words = block.words if block.number is None else (block.number, *block.words)
            small = [word for word in words if word.text[0] != word.letter]
            if small:
                edits = tuple(Edit(line, w.column, w.column + 1, w.letter) for w in small)
                yield Finding(
                    small[0].span.to(small[-1].span), "word letters in lower case", "write them in upper case",
                    Fix("Write the letters in upper case", edits),
                )  # fmt: skip
