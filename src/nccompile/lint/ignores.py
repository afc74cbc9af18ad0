"""Comments that silence findings.

    N10 G1 X1 (nc: ignore[NC151])            on its line
    (nc: ignore[NC151, NC25])                alone on its line: on the next block
    (nc: ignore)                             every code
    (nc: ignore-file[NC055])                 in the whole program

Codes may be cut short: NC25 means all of NC250 to NC259.  Errors cannot be silenced.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Sequence

from nccompile.diagnostics import Diagnostic, Severity
from nccompile.parser import Block

__all__ = ["Ignores"]

_MARK = re.compile(r"\s*nc:\s*(ignore-file|ignore)\s*(?:\[([^\]]*)\])?", re.IGNORECASE)


class Ignores:
    """The silencing comments of a program."""

    def __init__(self, blocks: Sequence[Block]) -> None:
        self._file: list[str] = []
        self._lines: dict[int, list[str]] = defaultdict(list)
        pending: list[str] = []
        for block in blocks:
            if pending and (block.words or block.number):
                self._lines[block.line] += pending
                pending = []
            for comment in block.comments:
                found = _MARK.match(comment.text)
                if found is None:
                    continue
                prefixes = [part.strip().upper() for part in (found[2] or "NC").split(",") if part.strip()]
                if found[1].lower() == "ignore-file":
                    self._file += prefixes
                elif block.words or block.number:
                    self._lines[block.line] += prefixes
                else:
                    pending += prefixes

    def hides(self, found: Diagnostic) -> bool:
        """Whether a finding is silenced."""
        if found.severity is Severity.ERROR or not (self._file or self._lines):
            return False
        prefixes = self._file + self._lines.get(found.span.line, [])
        return any(found.code.startswith(prefix) for prefix in prefixes)
