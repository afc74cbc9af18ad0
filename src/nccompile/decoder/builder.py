"""Collects segments and hands them out as toolpath chunks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from nccompile.geometry import Curve
from nccompile.toolpath.columns import CURVE_PARAMETERS, Curves, EventKind, Events, Toolpath

__all__ = ["ChunkBuilder", "Columns", "Row"]

_SLACK = 64
"""Rows beyond a chunk's size that have room at once."""


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


class Columns:
    """Room for segments and curves, as many of the one as of the other; rows that are not in use are undefined
    except for `mark` and `profile`, which are 0.
    """

    def __init__(self, room: int, axes: int) -> None:
        self.kind = np.empty(room, np.uint8)
        self.target = np.empty((room, axes))
        self.curve = np.empty(room, np.int32)
        self.length, self.feed, self.accel, self.decel, self.radius = (np.empty(room) for _ in range(5))
        self.mark = np.zeros(room, np.uint16)
        self.profile = np.zeros(room, np.uint16)
        self.line = np.empty(room, np.int32)
        self.plane = np.empty(room, np.uint8)
        self.parameters = np.empty((room, CURVE_PARAMETERS))

    def take_over(self, other: Columns, rows: slice, curves: slice) -> None:
        """Copies rows and curves of another table to the start of this one."""
        for name, column in vars(self).items():
            source: npt.NDArray[Any] = getattr(other, name)[
                curves if name in {"plane", "parameters"} else rows
            ]
            column[: len(source)] = source


class ChunkBuilder:
    """Rows of a growing toolpath.

    Rows are numbered through the whole path.  The last drive segment (`last_drive`) may still get a stop mark,
    and the last spline piece (`unshaped`) its curve; these and what follows them stay here, all before leaves
    in chunks of exactly `size` rows, whatever the program.  `columns`, `rows` and `curves` (rows in use) are open
    to the columnar decoder.
    """

    def __init__(self, axes: tuple[str, ...], start: list[float], size: int) -> None:
        self.axes = axes
        self.start = start
        self.size = size
        self.last_drive: int | None = None
        self.unshaped: int | None = None
        self.columns = Columns(size + _SLACK, len(axes))
        self.rows = 0
        self.curves = 0
        self.first = 0
        self._events: list[tuple[int, int, int, float, float, float, int]] = []
        self._names: dict[str, int] = {}
        self._named = 0

    def __len__(self) -> int:
        return self.first + self.rows

    @property
    def room(self) -> int:
        """Rows that the columns can take."""
        return len(self.columns.kind)

    def reserve(self) -> None:
        """Makes sure that there is room for another row."""
        if self.rows == self.room:
            full = self.columns
            self.columns = Columns(2 * self.rows, len(self.axes))
            self.columns.take_over(full, slice(0, self.rows), slice(0, self.curves))

    def add(self, row: Row, target: list[float], curve: Curve | None = None) -> int:
        """Adds a segment; returns its number."""
        self.reserve()
        columns, at = self.columns, self.rows
        columns.kind[at], columns.length[at], columns.feed[at], columns.accel[at] = row[:4]
        columns.decel[at], columns.radius[at], columns.profile[at], columns.line[at] = row[4:]
        columns.target[at] = target
        columns.mark[at] = 0
        columns.curve[at] = -1
        self.rows = at + 1
        if curve is not None:
            self._shape(at, curve)
        return self.first + at

    def bend(self, number: int, curve: Curve, length: float) -> None:
        """Gives the unshaped segment its curve and path length [mm]."""
        self.unshaped = None
        self.columns.length[number - self.first] = length
        self._shape(number - self.first, curve)

    def _shape(self, at: int, curve: Curve) -> None:
        """Segments get their curves in their order, so the curve table is in that order too."""
        columns, row = self.columns, self.curves
        columns.plane[row] = curve.plane
        columns.parameters[row, : len(curve.parameters)] = curve.parameters
        columns.parameters[row, len(curve.parameters) :] = 0.0
        columns.curve[at] = row
        self.curves = row + 1

    def mark(self, number: int, bits: int) -> None:
        """Adds mark bits to a segment that is still here."""
        self.columns.mark[number - self.first] |= bits

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
        return self.rows > self.size

    def ready(self) -> Iterator[Toolpath]:
        """The full chunks that nothing can change any more."""
        held = [number for number in (self.last_drive, self.unshaped) if number is not None]
        fixed = min(held, default=len(self)) - self.first
        while fixed >= self.size:
            yield self._chunk(self.size)
            fixed -= self.size

    def finish(self) -> Iterator[Toolpath]:
        """All that is left; one empty chunk if the path has no segment."""
        while self.rows > self.size:
            yield self._chunk(self.size)
        if self.rows or self.first == 0:
            yield self._chunk(self.rows)

    def _chunk(self, n: int) -> Toolpath:
        """The first n rows as a chunk, which takes their memory; the others move to new columns."""
        columns, first = self.columns, self.first
        curves = int(np.count_nonzero(columns.curve[:n] >= 0))
        events = [(row[0] - first, *row[1:]) for row in self._events if row[0] < first + n]
        self._named = max([self._named, *(1 + row[6] for row in events)])
        chunk = Toolpath(
            axes=self.axes,
            start=np.array(self.start, np.float64),
            curves=Curves(columns.plane[:curves], columns.parameters[:curves]),
            events=Events.from_rows(events),
            first=first,
            names=tuple(self._names)[: self._named],
            **{name: getattr(columns, name)[:n] for name in _SEGMENT},
        )
        if n:
            self.start = columns.target[n - 1].tolist()
        self._move_on(n, curves)
        self._events = [row for row in self._events if row[0] >= first + n]
        return chunk

    def _move_on(self, n: int, curves: int) -> None:
        """Forgets the first n rows and their curves."""
        rest = Columns(max(self.size, self.rows - n) + _SLACK, len(self.axes))
        rest.take_over(self.columns, slice(n, self.rows), slice(curves, self.curves))
        self.columns = rest
        self.rows -= n
        self.curves -= curves
        self.first += n
        column = rest.curve[: self.rows]
        column[column >= 0] -= curves


_SEGMENT = (
    "kind",
    "target",
    "curve",
    "length",
    "feed",
    "accel",
    "decel",
    "mark",
    "radius",
    "profile",
    "line",
)
