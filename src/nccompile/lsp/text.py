"""The lines of an open document, edits to them, and positions in the client's encoding.

A position of the protocol counts lines from 0 and code units of UTF-16 (or UTF-8, UTF-32) from 0; a Span counts
lines and code points from 1.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from copy import copy

from nccompile.lint.base import Edit
from nccompile.source import Span

__all__ = ["Change", "Place", "Text", "common_ends", "joined", "pieces", "split"]

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
    return "".join(pieces(lines, ends))


def pieces(lines: list[str], ends: list[str]) -> list[str]:
    """The lines with their ends."""
    return [*[line + end for line, end in zip(lines, ends, strict=False)], lines[-1]]


def common_ends(old: list[str], new: list[str]) -> tuple[int, int]:
    """How many lines are the same at the start of both, and how many behind those at the end of both."""
    short = min(len(old), len(new))
    start = next((at for at in range(short) if old[at] != new[at]), short)
    left = short - start
    return start, next((at for at in range(left) if old[-1 - at] != new[-1 - at]), left)


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

    def copy(self) -> Text:
        """The same text; edits of one do not reach the other."""
        twin = copy(self)
        twin.lines, twin.ends = list(self.lines), list(self.ends)
        return twin

    def pieces(self) -> list[str]:
        """The lines with their ends."""
        return pieces(self.lines, self.ends)

    def replace_all(self, text: str) -> Change:
        """Takes a whole new text."""
        before = self.lines
        self.lines, self.ends = split(text)
        return self._narrowed(0, before, len(self.lines))

    def edit(self, start: Place, end: Place, new: str) -> Change:
        """Replaces what stands between two positions; positions outside the text are moved to its border."""
        (first, at), (last, until) = self._inside(start), self._inside(end)
        if (last, until) < (first, at):
            (first, at), (last, until) = (last, until), (first, at)
        low = max(0, first - 1)
        old = self.lines[low : last + 1]
        new_text = self.lines[first][:at] + new + self.lines[last][until:]
        lines, ends = split(new_text)
        rest = len(self.lines) - last - 1
        self.lines[first : last + 1] = lines
        self.ends[first:last] = ends
        self._rejoin(low, first + len(lines))
        return self._narrowed(low, old, len(self.lines) - rest - low)

    def _rejoin(self, low: int, high: int) -> None:
        """Makes one line end of a CR and an LF that an edit brought together, behind line `low` and before `high`."""
        for at in range(min(high, len(self.ends)) - 1, low, -1):
            if self.ends[at] == "\n" and self.ends[at - 1] == "\r" and self.lines[at] == "":
                del self.lines[at]
                self.ends[at - 1 : at + 1] = ["\r\n"]

    def _narrowed(self, first: int, old: list[str], after: int) -> Change:
        """The change without the lines at its start and end that are as they were: what an editor sends may be much
        more than what is new, the whole text when it lays it out."""
        start, end = common_ends(old, self.lines[first : first + after])
        return first + start, len(old) - start - end, after - start - end

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
