"""Collects segments and hands them out as toolpath chunks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from nccompile.geometry import Curve
from nccompile.toolpath.columns import Curves, EventKind, Events, Toolpath

__all__ = ["ChunkBuilder", "Row"]


class Row(NamedTuple):
    """The columns of a segment that are known when it is added."""

    kind: int
    length: float
    feed: float
    accel: float
    decel: float
    radius: float
    profile: int
    line: int


class ChunkBuilder:
    """Rows of a growing toolpath.

    Rows are numbered through the whole path.  The last drive segment (`last_drive`) may still get a stop mark,
    and the last spline piece (`unshaped`) its curve; these and what follows them stay here, all before leaves
    in chunks of exactly `size` rows, whatever the program.
    """

    def __init__(self, axes: tuple[str, ...], start: list[float], size: int) -> None:
        self.axes = axes
        self.start = start
        self.size = size
        self.last_drive: int | None = None
        self.unshaped: int | None = None
        self._first = 0
        self._rows: list[Row] = []
        self._targets: list[list[float]] = []
        self._curves: dict[int, Curve] = {}
        self._marks: dict[int, int] = {}
        self._events: list[tuple[int, int, int, float, float, float, int]] = []
        self._names: dict[str, int] = {}
        self._named = 0

    def __len__(self) -> int:
        return self._first + len(self._rows)

    def add(self, row: Row, target: list[float], curve: Curve | None = None) -> int:
        """Adds a segment; returns its number."""
        number = self._first + len(self._rows)
        self._rows.append(row)
        self._targets.append(target)
        if curve is not None:
            self._curves[number] = curve
        return number

    def bend(self, number: int, curve: Curve, length: float) -> None:
        """Gives the unshaped segment its curve and path length [mm]."""
        at = number - self._first
        self.unshaped = None
        self._rows[at] = self._rows[at]._replace(length=length)
        self._curves[number] = curve

    def mark(self, number: int, bits: int) -> None:
        """Adds mark bits to a segment that is still here."""
        self._marks[number] = self._marks.get(number, 0) | bits

    def event(
        self, segment: int, kind: EventKind, number: int, position: float, k: float = 0.0, l: float = 0.0,  # noqa: E741
        name: str | None = None,
    ) -> None:  # fmt: skip
        """Adds an event at `position` 0..1 of a segment that is still here."""
        o = -1 if name is None else self._names.setdefault(name, len(self._names))
        self._events.append((segment, int(kind), number, position, k, l, o))

    @property
    def is_full(self) -> bool:
        """Whether it is worth asking for `ready` chunks."""
        return len(self._rows) > self.size

    def ready(self) -> Iterator[Toolpath]:
        """The full chunks that nothing can change any more."""
        held = [number for number in (self.last_drive, self.unshaped) if number is not None]
        fixed = min(held, default=len(self)) - self._first
        while fixed >= self.size:
            yield self._chunk(self.size)
            fixed -= self.size

    def finish(self) -> Iterator[Toolpath]:
        """All that is left; one empty chunk if the path has no segment."""
        while len(self._rows) > self.size:
            yield self._chunk(self.size)
        if self._rows or self._first == 0:
            yield self._chunk(len(self._rows))

    def _chunk(self, n: int) -> Toolpath:
        """The first n rows as a chunk; they are forgotten here."""
        first = self._first
        kind, length, feed, accel, decel, radius, profile, line = (
            zip(*self._rows[:n], strict=True) if n else ((),) * 8
        )
        curve, shapes = self._take_curves(first, n)
        events = [(row[0] - first, *row[1:]) for row in self._events if row[0] < first + n]
        self._named = max([self._named, *(1 + row[6] for row in events)])
        chunk = Toolpath(
            axes=self.axes,
            start=np.array(self.start),
            kind=np.array(kind, np.uint8),
            target=np.array(self._targets[:n], np.float64).reshape(n, len(self.axes)),
            curve=curve,
            length=np.array(length, np.float64),
            feed=np.array(feed, np.float64),
            accel=np.array(accel, np.float64),
            decel=np.array(decel, np.float64),
            mark=np.array([self._marks.pop(first + at, 0) for at in range(n)], np.uint16),
            radius=np.array(radius, np.float64),
            profile=np.array(profile, np.uint16),
            line=np.array(line, np.int32),
            curves=shapes,
            events=Events.from_rows(events),
            first=first,
            names=tuple(self._names)[: self._named],
        )
        if n:
            self.start = self._targets[n - 1]
        del self._rows[:n], self._targets[:n]
        self._events = [row for row in self._events if row[0] >= first + n]
        self._first += n
        return chunk

    def _take_curves(self, first: int, n: int) -> tuple[np.ndarray[tuple[int], np.dtype[np.int32]], Curves]:
        """The curve column and table of the first n rows."""
        column = np.full(n, -1, np.int32)
        rows: list[tuple[int, tuple[float, ...]]] = []
        for number in sorted(number for number in self._curves if number < first + n):
            shape = self._curves.pop(number)
            column[number - first] = len(rows)
            rows.append((shape.plane, shape.parameters))
        return column, Curves.from_rows(rows)
