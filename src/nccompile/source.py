"""Source texts and places in them.

Every object that stems from the user's program carries a `Span`; with its `Source` it turns into
file:line:column and the text of the line.  Lines and columns count from 1, columns count code points.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import tempfile
from bisect import bisect_right
from codecs import BOM_UTF8, getincrementaldecoder
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from threading import Lock, Thread
from typing import BinaryIO

from nccompile.errors import UsageError

__all__ = ["MOST_LINE", "NOWHERE", "STREAMED", "LargeSource", "Source", "Span", "shown_path"]

STREAMED = 400_000
"""Bytes above which a program is not held in memory: some ten thousand lines."""

MOST_LINE = 1 << 26
"""Bytes in a line above which a file is refused at once."""

_PART = 1 << 20


def shown_path(path: Path) -> str:
    """A path as text that can be written anywhere: bytes in it that are no UTF-8 become U+FFFD."""
    return str(path).encode("utf-8", "surrogateescape").decode("utf-8", "replace")


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
        """Reads a file, a large one when its parts are asked for; raises OSError."""
        file = path.open("rb")
        if path.is_file() and os.fstat(file.fileno()).st_size > STREAMED:
            return LargeSource(shown_path(path), file)
        with file:
            return cls.from_stream(shown_path(path), file)

    @classmethod
    def from_stream(cls, name: str, stream: BinaryIO) -> Source:
        """Reads a pipe to its end; what does not fit `STREAMED` bytes goes to a temporary file."""
        head = stream.read(STREAMED + 1)
        if len(head) <= STREAMED:
            return cls.from_bytes(name, head)
        file = tempfile.TemporaryFile()  # noqa: SIM115 - the source keeps it open
        file.write(head)
        shutil.copyfileobj(stream, file, _PART)
        return LargeSource(name, file)

    @cached_property
    def lines(self) -> list[str]:
        """The lines without their ends; CR LF, LF and CR all end a line."""
        return self.text.replace("\r\n", "\n").replace("\r", "\n").split("\n")

    def each_line(self, after: int = 0) -> Iterator[str]:
        """The lines behind line `after`, one by one."""
        yield from self.lines[after:] if after else self.lines

    def line(self, number: int) -> str:
        """The text of line `number` (from 1); empty outside the file."""
        return self.lines[number - 1] if 1 <= number <= len(self.lines) else ""

    def text_span(self, number: int) -> Span:
        """The text of line `number` without the blanks around it."""
        text = self.line(number)
        first = len(text) - len(text.lstrip()) + 1
        return Span(number, first, max(first + 1, len(text.rstrip()) + 1))


class LargeSource(Source):
    """A source whose bytes stay in their file; lines are decoded when they are asked for.

    Texts and places are those of a `Source` of the same bytes.  `text` and `lines` read everything.
    part: bytes that are read at a time.
    """

    def __init__(self, name: str, file: BinaryIO, part: int = _PART) -> None:
        object.__setattr__(self, "name", name)
        self.part = part
        self.on_read: Callable[[int], None] | None = None
        """Told the place up to which the program was read, again and again, by whichever thread reads."""
        self._file = file
        self._lock = Lock()
        self._known = [1], [0]  # lines and their places, ascending
        self._digest = hashlib.sha256()
        self._hashing: Thread | None = None
        self.size = file.seek(0, os.SEEK_END)

    __eq__ = object.__eq__
    __hash__ = object.__hash__

    def __repr__(self) -> str:
        return f"LargeSource({self.name!r}, {self.size} bytes)"

    def read_at(self, place: int, count: int) -> bytes:
        """At most `count` bytes from a place of the file; may be called by several threads."""
        with self._lock:
            self._file.seek(place)
            return self._file.read(count)

    def parts(self) -> Iterator[bytes]:
        """The bytes of the file in order."""
        for place in range(0, self.size, self.part):
            yield self.read_at(place, self.part)

    def hash_ahead(self) -> None:
        """Starts to compute `sha256` beside what follows."""
        if self._hashing is None:
            self._hashing = Thread(target=self._hash, daemon=True)
            self._hashing.start()

    def _hash(self) -> None:
        for part in self.parts():
            self._digest.update(part)

    @property
    def sha256(self) -> str:
        """SHA-256 of the bytes."""
        self.hash_ahead()
        assert self._hashing is not None
        self._hashing.join()
        return self._digest.hexdigest()

    @cached_property
    def encoding(self) -> str:
        """UTF-8 if all bytes are, else Latin-1."""
        decoder = getincrementaldecoder("utf-8")()
        try:
            for part in self.parts():
                if not part.isascii() or decoder.getstate()[0]:
                    decoder.decode(part)
            decoder.decode(b"", True)
        except UnicodeDecodeError:
            return "latin-1"
        return "utf-8"

    @cached_property
    def begin(self) -> int:
        """Where the text begins: after a byte-order mark."""
        marked = self.read_at(0, 3) == BOM_UTF8
        return 3 if marked and self.encoding == "utf-8" else 0

    def decode(self, line: bytes) -> str:
        """Bytes of this file as text."""
        return line.decode("ascii" if line.isascii() else self.encoding)

    @cached_property
    def text(self) -> str:
        """The whole text, decoded."""
        return self.read_at(self.begin, self.size).decode(self.encoding)

    def each_line(self, after: int = 0) -> Iterator[str]:
        """The lines behind line `after`, one by one; raises UsageError for one above `MOST_LINE` bytes."""
        at = max(bisect_right(self._known[0], after + 1) - 1, 0)
        number = self._known[0][at]
        for line in self._raw_lines(max(self._known[1][at], self.begin), number):
            if number > after:
                yield self.decode(line)
            number += 1

    def note(self, lines: Sequence[int], places: Sequence[int]) -> None:
        """Takes down where some lines start, so that `line` finds them and those after them quickly."""
        if len(lines) and lines[0] > self._known[0][-1]:
            self._known[0].extend(lines)
            self._known[1].extend(places)

    def line(self, number: int) -> str:
        """The text of line `number` (from 1); empty outside the file."""
        if number < 1:
            return ""
        return next(self.each_line(number - 1), "")

    def line_at(self, place: int) -> int:
        """The number of the line that a place of the file lies in."""
        at = max(bisect_right(self._known[1], place) - 1, 0)
        ends, cr = 0, False
        for begin in range(self._known[1][at], place, self.part):
            part = self.read_at(begin, min(self.part, place - begin))
            ends += part.count(b"\n") + part.count(b"\r") - part.count(b"\r\n") - (cr and part[:1] == b"\n")
            cr = part.endswith(b"\r")
        return self._known[0][at] + ends

    def line_start(self, place: int) -> bytes:
        """The bytes between a place of the file and the start of its line, at most `MOST_LINE` of them."""
        begin, found = place, b""
        while begin > self.begin and len(found) < MOST_LINE and b"\n" not in found and b"\r" not in found:
            begin = max(begin - self.part, self.begin)
            found = self.read_at(begin, place - begin)
        return found[max(found.rfind(b"\n"), found.rfind(b"\r")) + 1 :]

    def _raw_lines(self, place: int, number: int) -> Iterator[bytes]:
        rest = b""
        while part := self.read_at(place, self.part):
            place += len(part)
            rest += part
            if len(rest) > MOST_LINE:
                raise too_long(self.name, number)
            lines = rest.splitlines(keepends=True)
            rest = b"" if lines[-1].endswith(b"\n") else lines.pop()  # CR may be one half of CR LF
            for line in lines:
                yield line[: -2 if line.endswith(b"\r\n") else -1]
                number += 1
        if rest:
            yield rest.removesuffix(b"\r")


def too_long(name: str, line: int) -> UsageError:
    """The refusal of a file with a line above `MOST_LINE` bytes."""
    return UsageError(f"{name}: line {line} has more than {MOST_LINE:,} characters; this is no part program")
