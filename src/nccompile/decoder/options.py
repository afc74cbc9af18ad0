"""What the user can say about decoding besides the program itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite

from nccompile.errors import UsageError
from nccompile.toolpath.columns import AXIS_LETTERS

__all__ = ["LARGE_CHUNK", "DecodeOptions"]

LARGE_CHUNK = 32_768
"""Segments in a chunk of a large program: fewer calls and members in the queue, 4 MB each."""


@dataclass(frozen=True)
class DecodeOptions:
    """Settings of one decoding.

    start: position before the first block, by axis letter [mm, degrees], 0 for axes not named;
    defines: values of variables that the program does not set itself;
    skip_blocks: leave out blocks that start with / (SoftMotion §3.2: step suppress);
    max_jumps, max_blocks: a program that jumps more often, or runs more blocks by jumping, is stopped;
    max_switches: most switch points on a path object (SoftMotion §3.2.1: MAX_SWITCHES);
    chunk: segments in a chunk; None: CHUNK, and `LARGE_CHUNK` if the program is large;
    ignore: words that are left out before a block is read: a letter (E), or letter and number (M107).

    Raises UsageError for values that make no sense.
    """

    start: Mapping[str, float] = field(default_factory=dict)
    defines: Mapping[str, float] = field(default_factory=dict)
    skip_blocks: bool = False
    max_jumps: int = 10_000
    max_blocks: int = 1_000_000
    max_switches: int = 8
    chunk: int | None = None
    ignore: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        for letter, value in self.start.items():
            if len(letter) != 1 or letter.upper() not in AXIS_LETTERS:
                raise UsageError(f"start position: '{letter}' is no axis; axes are {' '.join(AXIS_LETTERS)}")
            if not isfinite(value):
                raise UsageError(f"start position: {letter} must be a finite number")
        for name, value in self.defines.items():
            if not isfinite(value):
                raise UsageError(f"variable {name}: the value must be a finite number")
        for name in ("max_jumps", "max_blocks", "max_switches", "chunk"):
            value = getattr(self, name)
            if value is not None and value < 1:
                raise UsageError(f"{name.replace('_', '-')} must be at least 1")
