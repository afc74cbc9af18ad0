"""NC057 form-feed."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nccompile.lint.base import Edit, Finding, Fix, Rule
from nccompile.lint.program import Program
from nccompile.source import Span

__all__ = ["FormFeed"]


class FormFeed(Rule):
    r"""Control characters between words.

    What: a form feed or vertical tab, left over from printing.
    Why: they count as blanks here, but not on every control.
    NC057: % a\nN10 G1\x0cX1 F20
    Okay: % a\nN10 G1 X1 F20
    Fix: replaces them by blanks.
    """

    code = "NC057"
    name = "form-feed"

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks for the two characters."""
        data = program.bytes
        for line in program.lines_at(np.asarray((data == 11) | (data == 12))):
            text = program.source.line(line)
            places = [at for at, character in enumerate(text) if character in "\v\f"]
            edits = tuple(Edit(line, at + 1, at + 2, " ") for at in places)
            yield Finding(
                Span(line, places[0] + 1, places[0] + 2),
                f"control character U+{ord(text[places[0]]):04X} between words", "write a blank",
                Fix("Replace control characters by blanks", edits),
            )  # fmt: skip
