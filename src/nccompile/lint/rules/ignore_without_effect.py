"""NC062 ignore-without-effect."""

from __future__ import annotations

import re
from collections.abc import Iterator

from nccompile.codes import PAGES
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["IgnoreWithoutEffect"]

_START = re.compile(r"\s*nc:", re.IGNORECASE)
_FORM = re.compile(r"\s*nc:\s*ignore(?:-file)?\s*(?:\[([^\]]*)\])?\s*", re.IGNORECASE)
_HELP = "write (nc: ignore[NC151]) or (nc: ignore-file[NC151])"


class IgnoreWithoutEffect(Rule):
    r"""A comment that silences nothing known.

    What: (nc: ...) that is not one of the forms of ignore comments, or names a code that does not exist.
    Why: the finding that it should silence is still shown, or will never come.
    NC062: % a\nN10 G1 X1 F20 (nc: ignore[NC9])
    Okay: % a\nN10 G1 X1 F20 (nc: ignore[NC151])
    """

    code = "NC062"
    name = "ignore-without-effect"

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at comments that start with nc:"""
        for block in program.blocks:
            for comment in block.comments:
                if not _START.match(comment.text):
                    continue
                found = _FORM.fullmatch(comment.text)
                if found is None:
                    yield Finding(comment.span, "this comment silences nothing", _HELP)
                    continue
                for part in (found[1] or "NC").upper().split(","):
                    if not any(code.startswith(part.strip()) for code in PAGES):
                        yield Finding(comment.span, f"there is no code {part.strip()}", _HELP)
