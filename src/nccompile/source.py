"""Source texts and places in them.

Every object that stems from the user's program carries a `Span`; with its `Source` it turns into
file:line:column and the text of the line.  Lines and columns count from 1, columns count code points.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

__all__ = ["NOWHERE", "Source", "Span"]


@dataclass(frozen=True, slots=True, order=True)
class Span:
    """A stretch of one source line: line and first column from 1, `end` is the column after the last one."""

    line: int
    column: int
    end: int

    def to(self, other: Span) -> Span:
        """The span from the start of this one to the end of `other` (same line) or to this line's end."""
        return Span(self.line, self.column, max(self.end, other.end if other.line == self.line else self.end))


NOWHERE = Span(0, 0, 0)
"""The span of what no word of the program caused (a whole file, a machine limit)."""


@dataclass(frozen=True)
class Source:
    """A program text with the name it is reported under; `sha256` of its bytes, empty if it never had any."""

    name: str
    text: str = field(repr=False)
    sha256: str = field(default="", repr=False, compare=False)

    @classmethod
    def from_bytes(cls, name: str, data: bytes) -> Source:
        """Decodes program bytes: UTF-8 (with or without byte-order mark), else Latin-1, which never fails."""
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("latin-1")
        return cls(name, text, hashlib.sha256(data).hexdigest())

    @classmethod
    def read(cls, path: Path) -> Source:
        """Reads a file; raises OSError as `Path.read_bytes` does."""
        return cls.from_bytes(str(path), path.read_bytes())

    @cached_property
    def lines(self) -> list[str]:
        """The lines without their ends; CR LF, LF and CR all end a line."""
        return self.text.replace("\r\n", "\n").replace("\r", "\n").split("\n")

    def line(self, number: int) -> str:
        """The text of line `number` (from 1); empty outside the file."""
        return self.lines[number - 1] if 1 <= number <= len(self.lines) else ""

    def text_span(self, number: int) -> Span:
        """The text of line `number` without the blanks around it."""
        text = self.line(number)
        first = len(text) - len(text.lstrip()) + 1
        return Span(number, first, max(first + 1, len(text.rstrip()) + 1))
