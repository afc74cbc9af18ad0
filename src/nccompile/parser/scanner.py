"""Large programs from file to word columns, part by part, one part ahead of who reads them.

    file ──> whole lines ──> kernels.scan ──> Table ──> decoder
             (a thread of its own: the kernel leaves the interpreter to the others)

Where parts begin and end has no influence on blocks, words and places.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from nccompile.kernels import scan as kernels
from nccompile.source import MOST_LINE, LargeSource, too_long

__all__ = ["Survey", "Table", "survey", "tables"]

_WORDS = 1 << 18
_BLOCKS = 1 << 16
_HARD = 1 << 16
_NOTED = 512  # every so many blocks the place of a line is taken down
_TAIL = b"\x1a\x00 \r\n"


@dataclass(frozen=True)
class Survey:
    """What must be known of a program before its first block is decoded.

    letters: those of the given axes that have a word outside comments and the header;  jumps: whether there may
    be a jump;  control: place of the first control character that no program has, -1 if there is none.
    """

    letters: frozenset[str]
    jumps: bool
    control: int


class Table:
    """Some blocks of a program as columns (`kernels.scan.scan`).

    block_line, block_begin, block_end: i4 (b,);  block_word: i4 (b + 1,);  plain: u1 (b,);
    letter: u1 (w,), value: f8 (w,), place: i4 (w,);  blocks, words: b and w;  end: place in the file behind it.
    Places count bytes from the start of the table's part of the file.
    """

    def __init__(self, source: LargeSource, data: bytes) -> None:
        self.source = source
        self.data = data
        self.block_line, self.block_begin, self.block_end = (np.empty(_BLOCKS, np.int32) for _ in range(3))
        self.block_word = np.empty(_BLOCKS + 1, np.int32)
        self.plain = np.empty(_BLOCKS, np.uint8)
        self.letter = np.empty(_WORDS, np.uint8)
        self.value = np.empty(_WORDS)
        self.place = np.empty(_WORDS, np.int32)
        self.blocks = self.words = 0
        self.end = 0

    def fill(self, begin: int, line: int) -> tuple[int, int]:
        """Scans from byte `begin` of its part, line `line`; returns the place and line behind what it took."""
        hard = np.empty(_HARD, np.int32)
        counts = np.zeros(4, np.int64)
        stop = kernels.scan(
            np.frombuffer(self.data, np.int8), begin, len(self.data), line, kernels.POWERS,
            self.block_line, self.block_begin, self.block_end, self.block_word, self.plain,
            self.letter, self.value, self.place, hard, counts,
        )  # fmt: skip
        self.blocks, self.words, hards, line = counts.tolist()
        for word in hard[:hards].tolist():
            self.value[word] = self._exact(int(self.place[word]) + 1)
        return stop, line

    def _exact(self, begin: int) -> float:
        end = begin
        while end < len(self.data) and self.data[end] in b"+-.0123456789":
            end += 1
        return float(self.data[begin:end])

    def shorten(self, blocks: list[int]) -> None:
        """Leaves out all blocks but these, of the others only such without words, and gives back unused memory."""
        ends = self.block_word[np.array([*(b + 1 for b in blocks)], np.intp)]
        self.block_word = np.concatenate([np.zeros(1, np.int32), ends])
        for name in ("block_line", "block_begin", "block_end", "plain"):
            setattr(self, name, getattr(self, name)[blocks])
        self.blocks, self.words = len(blocks), int(self.block_word[-1])
        for name in ("letter", "value", "place"):
            setattr(self, name, getattr(self, name)[: self.words].copy())

    def text(self, block: int) -> str:
        """The line of a block."""
        return self.source.decode(self.data[int(self.block_begin[block]) : int(self.block_end[block])])


def survey(source: LargeSource, letters: str) -> Survey:
    """Looks over a whole file for control characters, jumps and words of the axes `letters`."""
    found = np.zeros(2 + 26, np.int64)
    wanted = np.zeros(128, np.uint8)
    wanted[[ord(letter) for letter in letters]] = 1
    end = _text_end(source)
    for place, data in _whole_lines(source):
        length = min(len(data), end - place)
        control = kernels.survey(np.frombuffer(data, np.int8), length, found, wanted)
        if control >= 0:
            return Survey(frozenset(), False, place + control)
        if length < len(data):
            break
    named = frozenset(letter for letter in letters if found[2 + ord(letter) - ord("A")])
    return Survey(named, bool(found[1]), -1)


def _text_end(source: LargeSource) -> int:
    """Where the text ends: an end-of-file mark of old systems and what fills up the file are not part of it."""
    end = source.size
    if end == 0 or source.read_at(end - 1, 1) != b"\x1a":
        return end
    while end > 0:
        part = source.read_at(max(end - source.part, 0), min(source.part, end))
        bare = part.rstrip(_TAIL)
        end -= len(part) - len(bare)
        if bare:
            break
    return end


def tables(source: LargeSource) -> Iterator[Table]:
    """The blocks of a program in order, in tables of some ten thousand; raises UsageError for a line without end."""
    line = 1
    for place, data in _whole_lines(source):
        begin = 0
        while begin < len(data):
            table = Table(source, data)
            begin, line = table.fill(begin, line)
            table.end = place + begin
            noted = slice(0, table.blocks, _NOTED)
            source.note(
                table.block_line[noted].tolist(), (place + table.block_begin[noted].astype(np.int64)).tolist()
            )
            yield table
            if source.on_read is not None:
                source.on_read(table.end)


def _whole_lines(source: LargeSource) -> Iterator[tuple[int, bytes]]:
    """The file as (place, bytes); parts end behind a line end."""
    place, rest = source.begin, b""
    at = place
    while True:
        read = source.read_at(at, source.part)
        at += len(read)
        data = rest + read
        if len(read) < source.part:
            yield place, data
            return
        cut = _last_line_end(data)
        rest = data[cut:]
        if len(rest) > MOST_LINE:
            raise too_long(source.name, source.line_at(place + cut))
        if cut:
            yield place, data[:cut]
            place += cut


def _last_line_end(data: bytes) -> int:
    """The place behind the last line end; a CR in the last place may be half of one."""
    return max(data.rfind(b"\n"), data.rfind(b"\r", 0, len(data) - 1)) + 1
