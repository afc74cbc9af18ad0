"""How far the compilation of a large program is: one line on a terminal, nothing anywhere else."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic

from nccompile.source import LargeSource, Source

__all__ = ["progress"]

_BAR = 30
_FIRST, _AGAIN = 0.2, 0.1  # [s] short compilations show nothing; a terminal need not be faster than the eye


@contextmanager
def progress(source: Source) -> Iterator[None]:
    """Shows on standard error how much of a large program has been read, until the block ends."""
    if not isinstance(source, LargeSource) or not sys.stderr.isatty():
        yield
        return
    due = monotonic() + _FIRST
    shown = False

    def show(place: int) -> None:
        nonlocal due, shown
        now = monotonic()
        if now >= due:
            due, shown = now + _AGAIN, True
            share = place / max(source.size, 1)
            bar = "#" * int(share * _BAR)
            print(f"\r[{bar:<{_BAR}}] {share:4.0%}", end="", file=sys.stderr, flush=True)

    source.on_read = show
    try:
        yield
    finally:
        source.on_read = None
        if shown:
            print(f"\r{' ' * (_BAR + 8)}\r", end="", file=sys.stderr, flush=True)
