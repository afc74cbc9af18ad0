"""A whole program in memory, for programs with jumps: blocks by index, and indices by block number.

Listed     blocks as they were parsed
Scanned    word columns of a large program; only blocks that are not plain are kept as blocks
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

import numpy as np

from nccompile.decoder.core import LIMIT
from nccompile.kernels.scan import LETTER_N
from nccompile.parser import Block, Reader
from nccompile.parser.scanner import Table
from nccompile.toolpath.columns import Floats

__all__ = ["Listed", "Program", "Scanned"]


class Program(Protocol):
    """What `Flow` needs to know of a program."""

    def __len__(self) -> int:
        """Blocks in the program."""

    def block(self, at: int) -> Block:
        """The block at an index."""

    def targets(self, number: int) -> list[int]:
        """The indices of the blocks with a number."""

    def nearest(self, number: int) -> int | None:
        """The block number in use that is nearest to one; the first of two; None if there are no numbers."""


class Listed:
    """Parsed blocks; those that hold nothing but comments are left out."""

    def __init__(self, blocks: Iterable[Block]) -> None:
        self._blocks = [block for block in blocks if not block.is_empty]
        self._numbers: dict[int, list[int]] = {}
        for at, block in enumerate(self._blocks):
            number = _number(block)
            if number is not None:
                self._numbers.setdefault(number, []).append(at)

    def __len__(self) -> int:
        return len(self._blocks)

    def block(self, at: int) -> Block:
        """The block at an index."""
        return self._blocks[at]

    def targets(self, number: int) -> list[int]:
        """The indices of the blocks with a number."""
        return self._numbers.get(number, [])

    def nearest(self, number: int) -> int | None:
        """The block number in use that is nearest to one; the first of two; None if there are no numbers."""
        return min(self._numbers, key=lambda known: abs(known - number), default=None)


class Scanned:
    """Tables of a program, some 100 bytes a block; `reader` reads what is not plain, in the program's order."""

    def __init__(self, tables: Iterable[Table], reader: Reader) -> None:
        self._reader = reader
        self._nodes: dict[int, Block] = {}
        self._found: dict[int, list[int]] = {}
        self._tables: list[Table] = []
        self._first = [0]
        numbers: list[Floats] = []
        for table in tables:
            kept = self._keep(table)
            table.shorten(kept)
            numbers.append(self._numbers_of(table))
            self._tables.append(table)
            self._first.append(self._first[-1] + table.blocks)
            if reader.stopped:
                break
        else:
            reader.finish()
        self._number = np.concatenate([np.zeros(0), *numbers])

    def _keep(self, table: Table) -> list[int]:
        """The rows of a table that are blocks; reads those that are not plain."""
        reader, kept, first = self._reader, [], self._first[-1]
        for row, plain in enumerate(table.plain[: table.blocks].tolist()):
            if plain and reader.any_block:
                kept.append(row)
                continue
            block = reader.take(int(table.block_line[row]), table.text(row))
            if block is not None and not block.is_empty:
                self._nodes[first + len(kept)] = block
                kept.append(row)
            if reader.stopped:
                break
        return kept

    def _numbers_of(self, table: Table) -> Floats:
        """Shape (b,): block numbers, NaN for blocks without."""
        found = np.full(table.blocks, np.nan)
        starts = table.block_word[: table.blocks]
        worded = starts < table.block_word[1 : table.blocks + 1]
        rows = np.flatnonzero(worded)
        rows = rows[table.letter[starts[rows]] == LETTER_N]
        found[rows] = table.value[starts[rows]]
        for row in np.flatnonzero(~worded).tolist():
            number = _number(self._nodes[self._first[-1] + row])
            if number is not None:
                found[row] = number
        found[found > LIMIT] = np.nan
        return found

    def __len__(self) -> int:
        return self._first[-1]

    def place(self, at: int) -> tuple[Table, int]:
        """The table and row of a block."""
        which = int(np.searchsorted(self._first, at, "right")) - 1
        return self._tables[which], at - self._first[which]

    def block(self, at: int) -> Block:
        """The block at an index."""
        node = self._nodes.get(at)
        if node is None:
            table, row = self.place(at)
            read = self._reader.read(int(table.block_line[row]), table.text(row))
            assert isinstance(read, Block)
            return read
        return node

    def targets(self, number: int) -> list[int]:
        """The indices of the blocks with a number."""
        if number not in self._found:
            self._found[number] = np.flatnonzero(self._number == number).tolist()
        return self._found[number]

    def nearest(self, number: int) -> int | None:
        """The block number in use that is nearest to one; the first of two; None if there are no numbers."""
        known = self._number[~np.isnan(self._number)]
        return int(known[np.argmin(np.abs(known - number))]) if len(known) else None


def _number(block: Block) -> int | None:
    value = block.number.value if block.number is not None else None
    return int(value) if isinstance(value, float) and value <= LIMIT else None
