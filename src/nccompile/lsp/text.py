"""The lines of an open document, edits to them, and positions in the client's encoding.

A position of the protocol counts lines from 0 and code units of UTF-16 (or UTF-8, UTF-32) from 0; a Span counts
lines and code points from 1.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from nccompile.lint.base import Edit
from nccompile.source import Span

__all__ = ["Change", "Place", "Text", "joined", "split"]

Place = tuple[int, int]
"""Line and character of the protocol, both from 0."""

Change = tuple[int, int, int]
"""First line, number of lines before, number of lines after, from 0."""

_END = re.compile(r"\r\n|\r|\n")


def split(text: str) -> tuple[list[str], list[str]]:
    """The lines and, one fewer, the line ends between them."""
    return _END.split(text), _END.findall(text)


def joined(lines: list[str], ends: list[str]) -> str:
    """The text of lines and the ends between them."""
    return "".join([line + end for line, end in zip(lines, ends, strict=False)]) + lines[-1]


def _utf8(character: str) -> int:
    code = ord(character)
    return 1 + (code > 0x7F) + (code > 0x7FF) + (code > 0xFFFF)


def _utf16(character: str) -> int:
    return 1 + (ord(character) > 0xFFFF)


_UNITS: dict[str, Callable[[str], int]] = {"utf-8": _utf8, "utf-16": _utf16, "utf-32": lambda _: 1}


class Text:
    """A document's lines without their ends; `ends[i]` stands behind line i."""

    def __init__(self, text: str, encoding: str = "utf-16") -> None:
        self.lines, self.ends = split(text)
        self._units = _UNITS[encoding]

    def __str__(self) -> str:
        return joined(self.lines, self.ends)

    def replace_all(self, text: str) -> Change:
        """Takes a whole new text."""
        before = len(self.lines)
        self.lines, self.ends = split(text)
        return 0, before, len(self.lines)

    def edit(self, start: Place, end: Place, new: str) -> Change:
        """Replaces what stands between two positions; positions outside the text are moved to its border."""
        (first, at), (last, until) = self._inside(start), self._inside(end)
        if (last, until) < (first, at):
            (first, at), (last, until) = (last, until), (first, at)
        joined = self.lines[first][:at] + new + self.lines[last][until:]
        lines, ends = split(joined)
        self.lines[first : last + 1] = lines
        self.ends[first:last] = ends
        return self._rejoin(first, last - first + 1, len(lines))

    def _rejoin(self, first: int, before: int, after: int) -> Change:
        """Makes one line end of a CR and an LF that the edit brought together."""
        low = max(0, first - 1)
        before, after = before + first - low, after + first - low
        for at in range(min(low + after, len(self.ends)) - 1, low, -1):
            if self.ends[at] == "\n" and self.ends[at - 1] == "\r" and self.lines[at] == "":
                del self.lines[at]
                self.ends[at - 1 : at + 1] = ["\r\n"]
                after -= 1
        return low, before, after

    def _inside(self, place: Place) -> Place:
        line, character = place
        if line >= len(self.lines):
            return len(self.lines) - 1, len(self.lines[-1])
        return max(line, 0), self.index(max(line, 0), character)

    def index(self, line: int, character: int) -> int:
        """The code points before a character of a line, at most its length."""
        text = self.lines[line]
        if text.isascii():
            return min(max(character, 0), len(text))
        units = 0
        for at, c in enumerate(text):
            if units >= character:
                return at
            units += self._units(c)
        return len(text)

    def character(self, line: int, index: int) -> int:
        """The protocol's character before code point `index` of a line."""
        text = self.lines[line] if line < len(self.lines) else ""
        if text.isascii():
            return min(index, len(text))
        return sum(self._units(c) for c in text[:index])

    def places(self, span: Span | Edit) -> tuple[Place, Place]:
        """Start and end of a span."""
        line = max(span.line - 1, 0)
        return (line, self.character(line, max(span.column - 1, 0))), (
            line,
            self.character(line, max(span.end - 1, 0)),
        )

    def end(self) -> Place:
        """The position behind the last character."""
        last = len(self.lines) - 1
        return last, self.character(last, len(self.lines[last]))
