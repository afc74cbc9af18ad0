"""Start and stop marks of path passes: G40-42, G50-52, G60-61 (SoftMotion §6.6, byInternMark).

A start mark acts at the next path object, a stop mark at the one before.
"""

from __future__ import annotations

from dataclasses import dataclass

from nccompile.decoder.core import Core
from nccompile.decoder.tables import INSTRUCTIONS
from nccompile.source import Span
from nccompile.toolpath.columns import Mark

__all__ = ["Marks"]

_STARTS = {41: Mark.TOOL_LEFT, 42: Mark.TOOL_RIGHT, 51: Mark.SMOOTH, 52: Mark.ROUND, 61: Mark.LOOP}
_STOPS = {40: Mark.TOOL_STOP, 50: Mark.CORNER_STOP, 60: Mark.LOOP_STOP}
_STOP_OF = {41: 40, 42: 40, 51: 50, 52: 50, 61: 60}


@dataclass(slots=True)
class _On:
    """A function that is on: its G code, where it was started, whether a path object has its start mark."""

    code: int
    span: Span
    marked: bool = False


class Marks:
    """Which path passes are on."""

    def __init__(self, core: Core) -> None:
        self._core = core
        self._on: dict[int, _On] = {}

    def start(self, code: int, span: Span) -> None:
        """G41, G42, G51, G52 or G61."""
        stop = _STOP_OF[code]
        on = self._on.get(stop)
        if on is None:
            self._on[stop] = _On(code, span)
        elif on.code == code:
            self._core.warn("NC123", f"G{code} is already on since line {on.span.line}", span)
        else:
            self._core.error(
                "NC124", f"G{code} while G{on.code} is on (since line {on.span.line})", span,
                f"end it with G{stop} first",
            )  # fmt: skip

    def stop(self, code: int) -> None:
        """G40, G50 or G60; without effect if nothing is on."""
        on = self._on.pop(code, None)
        if on is not None and on.marked:
            self._mark_last(code)

    @property
    def waiting(self) -> bool:
        """Whether the next path object gets a start mark."""
        return not all(on.marked for on in self._on.values())

    def drive(self, row: int) -> None:
        """Marks a new path object."""
        for on in self._on.values():
            if not on.marked:
                on.marked = True
                self._core.path.mark(row, _STARTS[on.code])

    def finish(self) -> None:
        """Ends at the last path object what the program did not."""
        for stop, on in self._on.items():
            self._core.warn(
                "NC125", f"G{on.code} is not ended; it ends with the program", on.span,
                f"end {INSTRUCTIONS[on.code].group.value} with G{stop}",
            )  # fmt: skip
            if on.marked:
                self._mark_last(stop)
        self._on.clear()

    def _mark_last(self, code: int) -> None:
        if self._core.path.last_drive is not None:
            self._core.path.mark(self._core.path.last_drive, _STOPS[code])
