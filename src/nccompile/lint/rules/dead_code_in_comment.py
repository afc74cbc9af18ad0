"""NC060 dead-code-in-comment."""

from __future__ import annotations

import re
from collections.abc import Iterator

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["DeadCodeInComment"]

_BLOCK = re.compile(r"\s*/?\s*(?:N\d+\s*)?[GM]\d+(?:\s*[A-MO-Z][-+.]?[0-9][0-9.]*)*\s*")


class DeadCodeInComment(Rule):
    r"""A comment holds a block.

    What: a comment whose text is made of words, as a block that was taken out.
    Why: nobody knows whether it may come back. The skip mark / takes a block out for good reason and visibly.
    NC060: % a\n(N10 G1 X5)\nN20 G1 X1 F20
    Okay: % a\n(first cut)\nN20 G1 X1 F20
    """

    code = "NC060"
    name = "dead-code-in-comment"
    severity = Severity.NOTE

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the text of comments."""
        for block in program.blocks:
            for comment in block.comments:
                if _BLOCK.fullmatch(comment.text) is not None:
                    yield Finding(
                        comment.span, "this comment is a block that was taken out",
                        "delete it, or put / before the block and leave it in",
                    )  # fmt: skip
