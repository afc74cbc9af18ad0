"""NC056 beyond-ascii."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program
from nccompile.source import Span

__all__ = ["BeyondAscii"]


class BeyondAscii(Rule):
    r"""Characters that a control may not show.

    What: a comment or name with characters beyond ASCII.
    Why: controls read programs in different encodings; letters with accents come out as other ones, and some
    controls refuse the file.
    NC056: % a\nN10 G1 X1 F20 (größer)
    Okay: % a\nN10 G1 X1 F20 (groesser)
    """

    code = "NC056"
    name = "beyond-ascii"

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks for bytes above 127."""
        for line in program.lines_at(np.asarray(program.bytes > 127)):
            text = program.source.line(line)
            block = program.by_line.get(line)
            if block is not None and not block.sound:
                continue  # the unreadable character has been reported
            at = next(i for i, c in enumerate(text) if ord(c) > 127)
            end = next((i for i in range(at, len(text)) if ord(text[i]) <= 127), len(text))
            yield Finding(
                Span(line, at + 1, end + 1), f"'{text[at:end]}' is not ASCII", "spell it with plain letters"
            )
