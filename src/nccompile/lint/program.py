"""A program as the rules see it: its lines, blocks and words, what compiling it reports, and its toolpath."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from io import BytesIO
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from nccompile.decoder.tables import INSTRUCTIONS, Group
from nccompile.diagnostics import Diagnostics
from nccompile.errors import Cancelled
from nccompile.lint.config import Config
from nccompile.machine.model import Machine
from nccompile.parser import MAX_LINE, Block, Header, ReadSource, Word, parse, read_header, read_line
from nccompile.source import STREAMED, LargeSource, Source
from nccompile.toolchain import Compilation, Options
from nccompile.toolpath import Toolpath

__all__ = ["LINE_FEED", "Occurrences", "Program", "always", "first", "prepare"]

Bytes: TypeAlias = npt.NDArray[np.uint8]
Flags: TypeAlias = npt.NDArray[np.bool_]

LINE_FEED = 10


class Occurrences(NamedTuple):
    """Words of a letter in written order, and the indices of their blocks, rising.

    Two lists, not one of pairs: the pairs of a long program take a hundredth of a second to free, and all threads
    wait meanwhile.
    """

    blocks: list[int]
    words: list[Word]

    def pairs(self) -> Iterator[tuple[int, Word]]:
        """(index of block, word) of each."""
        return zip(self.blocks, self.words, strict=True)


_MARKS = ("\ufeff", "\xff\xfe", "\xfe\xff")
"""Byte-order marks; encoding a text that still has one would not give back its bytes."""


def always() -> bool:
    """That findings are wanted whatever happens."""
    return True


@dataclass
class Program:
    """Everything a rule may look at.

    blocks: those that `compile` reads, unsound ones too;  diagnostics: what `compile` reports;
    chunks: the toolpath as decoded.  Indices of blocks count from 0.
    """

    source: ReadSource
    header: Header | None
    blocks: list[Block]
    diagnostics: Diagnostics
    chunks: list[Toolpath]
    machine: Machine
    config: Config
    wanted: Callable[[], bool] = field(default=always, repr=False)

    @cached_property
    def path(self) -> Toolpath:
        """The whole toolpath; rules with `needs_path` run only if the program has no errors."""
        return Toolpath.join(self.chunks) if len(self.chunks) > 1 else self.chunks[0]

    @cached_property
    def bytes(self) -> Bytes:
        """The lines, joined by LF, with one byte a character; characters beyond Latin-1 are 255."""
        text = "\n".join(self.source.lines)
        try:
            data = text.encode("ascii")
        except UnicodeEncodeError:
            data = bytes(min(ord(c), 255) for c in text)
        return np.frombuffer(data, np.uint8)

    def lines_at(self, flags: Flags) -> list[int]:
        """The numbers of the lines that have a flagged byte, rising."""
        hits = np.flatnonzero(flags)
        if not len(hits):
            return []
        ends = np.flatnonzero(self.bytes == LINE_FEED)
        return sorted(set((np.searchsorted(ends, hits) + 1).tolist()))

    @cached_property
    def by_line(self) -> dict[int, Block]:
        """The blocks by their line."""
        return {block.line: block for block in self.blocks}

    @cached_property
    def _words(self) -> dict[str, Occurrences]:
        found: dict[str, Occurrences] = defaultdict(lambda: Occurrences([], []))
        for at, block in enumerate(self.blocks):
            for word in block.words:
                places, words = found[word[0]]
                places.append(at)
                words.append(word)
        return found

    def occurrences(self, letter: str) -> Occurrences:
        """All words of a letter."""
        return self._words.get(letter, Occurrences([], []))

    def words(self, letter: str) -> Iterator[tuple[int, Word]]:
        """(index of block, word) of all words of a letter in written order."""
        return self.occurrences(letter).pairs()

    @cached_property
    def codes(self) -> list[int | None]:
        """For every block its G code; None if it has none, or not exactly one whole one."""
        codes: list[int | None] = [None] * len(self.blocks)
        seen: set[int] = set()
        for at, word in self.words("G"):
            value = word.value
            good = isinstance(value, float) and value.is_integer() and at not in seen
            codes[at] = int(value) if good else None  # type: ignore[arg-type]  # a float if it is good
            seen.add(at)
        return codes

    def instructions(self, *codes: int) -> Iterator[tuple[int, int]]:
        """(index of block, G code) of the blocks that have one of the codes."""
        for at in sorted(at for code in set(codes) for at in self._by_code.get(code, ())):
            code = self.codes[at]
            assert code is not None
            yield at, code

    @cached_property
    def _by_code(self) -> dict[int | None, list[int]]:
        """Indices of the blocks by their G code."""
        found: dict[int | None, list[int]] = defaultdict(list)
        for at, code in enumerate(self.codes):
            found[code].append(at)
        return found

    @cached_property
    def moves(self) -> list[int | None]:
        """For every block the drive instruction that it runs with; None if it moves nothing.

        Blocks are taken in written order, as if there were no jumps.
        """
        moves: list[int | None] = []
        drive: int | None = None
        motion = frozenset("XYZABCPQUVWIJRH")
        for block, code in zip(self.blocks, self.codes, strict=True):
            if code is not None and code in INSTRUCTIONS and INSTRUCTIONS[code].group is Group.DRIVE:
                drive = code
                moves.append(code)
            elif code is None and any(word[0] in motion for word in block.words):
                moves.append(drive)
            else:
                moves.append(None)
        return moves

    @cached_property
    def jumps(self) -> list[int]:
        """Indices of the blocks with G20, or with a G whose value is a variable and may be it."""
        return [at for at, word in self.words("G") if word.value == 20.0 or not isinstance(word.value, float)]

    @cached_property
    def targets(self) -> frozenset[int]:
        """Indices of the blocks that a jump leads to; of all of them if a jump's target is not a number."""
        found: set[int] = set()
        for at in self.jumps:
            word = first(self.blocks[at], "L")
            if word is None or not isinstance(word.value, float):
                return frozenset(range(len(self.blocks)))
            found.update(self.numbers.get(int(word.value), ()))
        return frozenset(found)

    @cached_property
    def numbers(self) -> dict[int, list[int]]:
        """Indices of the blocks by block number."""
        found: dict[int, list[int]] = defaultdict(list)
        for at, block in enumerate(self.blocks):
            if block.number is not None and isinstance(block.number.value, float):
                found[int(block.number.value)].append(at)
        return found


def first(block: Block, letter: str) -> Word | None:
    """The first word of a letter in a block."""
    return next((word for word in block.words if word[0] == letter), None)


def prepare(
    source: Source, options: Options, config: Config, *, limit: int | None = None, wanted: Callable[[], bool] = always
) -> Program:  # fmt: skip
    """Reads and decodes a program as `compile` does.

    Args:     limit: findings kept of each code, `compile`'s if None;  wanted: asked now and then.
    Raises:   Cancelled: it was not wanted any more.
    """
    if not isinstance(source, ReadSource):
        nodes = [read_line(at, text) for at, text in enumerate(source.lines, 1)]
        source = ReadSource(source.name, source.text, source.sha256, nodes)
    compilation = Compilation(_decodable(source), options, wanted)
    if limit is not None:
        compilation.diagnostics.limit = limit
    blocks = list(parse(source, Diagnostics()))
    chunks = []
    for chunk in compilation.decoded():
        if not wanted():
            raise Cancelled
        chunks.append(chunk)
    header = read_header(source)
    return Program(source, header, blocks, compilation.diagnostics, chunks, options.machine, config, wanted)


def _decodable(source: ReadSource) -> Source:
    """The source as `compile` reads a file of its size: a large one in columns, many times as fast.

    Both routes give the same toolpath and findings (tests/decoder), so this is a matter of time only.
    """
    text = source.text
    if len(text) < STREAMED or text.startswith(_MARKS) or max(map(len, source.lines)) > MAX_LINE:
        return source
    try:
        return LargeSource(source.name, BytesIO(text.encode()))
    except UnicodeEncodeError:  # half a surrogate pair, from an editor
        return source
