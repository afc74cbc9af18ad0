"""The ring buffer between the slow task and the interpolator: planned segments as fixed columns.

    slow task   push(chunk)  ->  [ .... head ======== tail .... ]  ->  view(), drop(n)   interpolator

All arrays are allocated once.  A kernel needs contiguous rows, so instead of wrapping round the rows move to
the front when the tail reaches the end of the arrays.  There are two banks of arrays with twice the capacity
each: `push` copies the rows that are left to the other bank and then switches, so a reader that is still at
work on the old bank is never disturbed and never waits.  (A second switch needs more rows than can be pushed
without a `drop` by that reader, so the old bank stays intact while it works.)

One thread may push while another reads and drops.
"""

from __future__ import annotations

from dataclasses import dataclass
from threading import Lock
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from nccompile.backend.samples import quick_decelerations
from nccompile.errors import UsageError
from nccompile.kernels.interpolator import Rows
from nccompile.toolpath.columns import CURVE_PARAMETERS, Floats, Toolpath

__all__ = ["Event", "Mark", "RingBuffer", "View"]

_PLAIN = (
    "kind",
    "target",
    "length",
    "feed",
    "v_limit",
    "v_junction",
    "v_end",
    "accel",
    "decel",
    "profile",
    "line",
)
_EVENTS = ("kind", "number", "position", "k")
_EVENT_COLUMNS = tuple(f"event_{name}" for name in _EVENTS)


class View(NamedTuple):
    """What the interpolator may read: rows head..tail-1 of `rows`.

    complete: no row will follow.  version changes with every push: then `rows.v_now`, the reader's own
    scratch, has to be filled anew.  Between two views all rows may have moved, but only together: a row keeps
    its distance from `head`, an event its distance from `rows.event_begin[head]`.
    """

    rows: Rows
    head: int
    tail: int
    complete: bool
    version: int


class Event(NamedTuple):
    """An event of a row (see `toolpath.columns.Events`); o is the name that the program gave, or ""."""

    kind: int
    number: int
    position: float
    k: float
    l: float  # noqa: E741 - the word letter of the language
    o: str


class Mark(NamedTuple):
    """A reading position to come back to (`RingBuffer.mark`)."""

    version: int
    head: int


@dataclass(frozen=True)
class _Bank:
    """One set of arrays: the interpolator's rows and what only messages need (l, o of events)."""

    rows: Rows
    event_l: Floats
    event_o: npt.NDArray[np.int32]

    @classmethod
    def allocate(cls, axes: int, room: int, event_room: int) -> _Bank:
        """Arrays for `room` rows of so many axes with `event_room` events, all zero, rows straight."""
        ints, floats = np.int32, np.float64
        rows = Rows(
            kind=np.zeros(room, np.uint8),
            start=np.zeros((room, axes)),
            target=np.zeros((room, axes)),
            curve=np.full(room, -1, ints),
            plane=np.zeros(room, np.uint8),
            parameters=np.zeros((room, CURVE_PARAMETERS)),
            length=np.zeros(room),
            feed=np.zeros(room),
            v_limit=np.zeros(room),
            v_junction=np.zeros(room),
            v_end=np.zeros(room),
            a_end=np.zeros(room),
            accel=np.zeros(room),
            decel=np.zeros(room),
            brake=np.zeros(room),
            jerk=np.zeros(room),
            profile=np.zeros(room, np.uint16),
            line=np.zeros(room, ints),
            event_begin=np.zeros(room, ints),
            event_end=np.zeros(room, ints),
            event_kind=np.zeros(event_room, np.uint8),
            event_number=np.zeros(event_room, ints),
            event_position=np.zeros(event_room, floats),
            event_k=np.zeros(event_room, floats),
            v_now=np.zeros(room),
        )
        return cls(rows, np.zeros(event_room), np.zeros(event_room, ints))


class RingBuffer:
    """A bounded queue of planned segments.

    capacity: segments it holds; event_capacity: switch points, M functions and dwells it holds (default: as
    many as segments, at least 1024); axes: letters of the toolpath that will be pushed; acceleration: of each of
    these axes, Shape (k,) [mm/s²], which bounds quick stops (`Rows.brake`); None: without bound.
    """

    def __init__(
        self,
        axes: tuple[str, ...],
        capacity: int,
        event_capacity: int | None = None,
        acceleration: Floats | None = None,
    ) -> None:
        if capacity < 1:
            raise UsageError(f"a ring buffer holds at least one segment, not {capacity}")
        self.axes = axes
        self.capacity = capacity
        self.event_capacity = max(1024, capacity) if event_capacity is None else event_capacity
        self.names: tuple[str, ...] = ()
        self._acceleration = acceleration
        self._banks = tuple(
            _Bank.allocate(len(axes), 2 * capacity, 2 * self.event_capacity) for _ in range(2)
        )
        self._now = 0  # index of the bank in use
        self._head = self._tail = 0
        self._event_tail = 0
        self._complete = False
        self._version = 0
        self._lock = Lock()

    @property
    def count(self) -> int:
        """Segments at hand."""
        return self._tail - self._head

    @property
    def free(self) -> int:
        """Segments that there is room for (fewer may fit if they carry many events)."""
        return self.capacity - self.count

    @property
    def end_of_list(self) -> bool:
        """Whether the last segment of the path has been pushed."""
        return self._complete

    def close(self) -> None:
        """Says that no segment will follow."""
        with self._lock:
            self._complete = True
            self._version += 1

    def view(self) -> View:
        """The rows at hand; they stay as they are until this reader drops them."""
        with self._lock:
            rows = self._banks[self._now].rows
            return View(rows, self._head, self._tail, self._complete, self._version)

    def drop(self, n: int) -> None:
        """Gives the first n rows back.  Raises: UsageError if there are fewer."""
        with self._lock:
            if not 0 <= n <= self._tail - self._head:
                raise UsageError(f"cannot drop {n} of {self._tail - self._head} segments")
            self._head += n

    def mark(self) -> Mark:
        """The reading position, for `rewind`."""
        return Mark(self._version, self._head)

    def rewind(self, mark: Mark) -> None:
        """Takes back every drop since `mark`.  Raises: UsageError if something was pushed in between."""
        with self._lock:
            if mark.version != self._version:
                raise UsageError("segments were pushed since the mark")
            self._head = mark.head

    def events(self, row: int) -> list[Event]:
        """The events of row `head + row`."""
        bank = self._banks[self._now]
        at = self._head + row
        rows = bank.rows
        return [
            Event(
                int(rows.event_kind[e]),
                int(rows.event_number[e]),
                float(rows.event_position[e]),
                float(rows.event_k[e]),
                float(bank.event_l[e]),
                self.names[bank.event_o[e]] if bank.event_o[e] >= 0 else "",
            )
            for e in range(rows.event_begin[at], rows.event_end[at])
        ]

    def push(self, chunk: Toolpath, begin: int = 0, limit: int | None = None) -> int:
        """Appends rows begin.. of a planned chunk, as many as fit, at most `limit`; returns how many.

        Raises: UsageError if the chunk is not planned, has other axes, or one row has more events than the
        buffer holds.
        """
        if not chunk.is_planned:
            raise UsageError("only a planned toolpath can be pushed")
        if chunk.axes != self.axes:
            raise UsageError(f"the buffer is for axes {' '.join(self.axes)}, not {' '.join(chunk.axes)}")
        rest = len(chunk) - begin if limit is None else min(limit, len(chunk) - begin)
        end = begin + min(rest, self.free)
        end, event_end = self._with_events(chunk, begin, end)
        if end <= begin:
            return 0
        event_begin = int(np.searchsorted(chunk.events.segment, begin))
        room, event_room = len(self._banks[0].rows.kind), len(self._banks[0].event_l)
        if self._tail + end - begin > room or self._event_tail + event_end - event_begin > event_room:
            self._compact()
        self._append(chunk, begin, end, event_begin, event_end)
        with self._lock:
            if len(chunk.names) > len(self.names):
                self.names = chunk.names
            self._tail += end - begin
            self._event_tail += event_end - event_begin
            self._version += 1
        return end - begin

    def _with_events(self, chunk: Toolpath, begin: int, end: int) -> tuple[int, int]:
        """The end of the rows whose events fit too, and the end of those events in the chunk's table."""
        first = int(np.searchsorted(chunk.events.segment, begin))
        last = int(np.searchsorted(chunk.events.segment, end))
        room = self.event_capacity - self._events_at_hand()
        if last - first > room:
            row = int(chunk.events.segment[first + room])  # the first row with an event that does not fit
            end, last = row, int(np.searchsorted(chunk.events.segment, row))
            if row == begin and self.count == 0:
                raise UsageError(
                    f"a segment of source line {chunk.line[row]} has more switch points than the queue "
                    f"holds ({self.event_capacity})"
                )
        return end, last

    def _events_at_hand(self) -> int:
        with self._lock:
            if self._head == self._tail:
                return 0
            return self._event_tail - int(self._banks[self._now].rows.event_begin[self._head])

    def _append(self, chunk: Toolpath, begin: int, end: int, event_begin: int, event_end: int) -> None:
        """Copies rows and events behind the tail, where no reader looks yet."""
        bank = self._banks[self._now]
        rows = bank.rows
        to = slice(self._tail, self._tail + end - begin)
        for name in _PLAIN:
            getattr(rows, name)[to] = getattr(chunk, name)[begin:end]
        for name in ("a_end", "jerk"):
            column = getattr(chunk, name)
            getattr(rows, name)[to] = 0.0 if column is None else column[begin:end]
        rows.start[self._tail] = chunk.start if begin == 0 else chunk.target[begin - 1]
        rows.start[self._tail + 1 : to.stop] = chunk.target[begin : end - 1]
        curve = chunk.curve[begin:end]
        rows.brake[to] = quick_decelerations(chunk, self._acceleration, begin, end)
        curved = np.flatnonzero(curve >= 0)
        own = (self._tail + curved).astype(np.int32)
        rows.curve[to] = -1
        rows.curve[own] = own
        rows.plane[own] = chunk.curves.plane[curve[curved]]
        rows.parameters[own] = chunk.curves.parameters[curve[curved]]
        events = chunk.events
        here = slice(self._event_tail, self._event_tail + event_end - event_begin)
        for name in _EVENTS:
            getattr(rows, f"event_{name}")[here] = getattr(events, name)[event_begin:event_end]
        bank.event_l[here] = events.l[event_begin:event_end]
        bank.event_o[here] = events.o[event_begin:event_end]
        borders = np.searchsorted(events.segment, np.arange(begin, end + 1)) - event_begin + self._event_tail
        rows.event_begin[to] = borders[:-1]
        rows.event_end[to] = borders[1:]

    def _compact(self) -> None:
        """Moves the rows at hand to the front of the other bank and switches to it."""
        old, new = self._banks[self._now], self._banks[1 - self._now]
        head, tail = self._head, self._tail  # the reader may drop more meanwhile: they are copied in vain
        count = tail - head
        first = int(old.rows.event_begin[head]) if count else self._event_tail
        events = self._event_tail - first
        for name in Rows._fields:
            source: npt.NDArray[Any] = getattr(old.rows, name)
            target: npt.NDArray[Any] = getattr(new.rows, name)
            if name in _EVENT_COLUMNS:
                target[:events] = source[first : first + events]
            else:
                target[:count] = source[head:tail]
        new.event_l[:events] = old.event_l[first : first + events]
        new.event_o[:events] = old.event_o[first : first + events]
        new.rows.event_begin[:count] -= first
        new.rows.event_end[:count] -= first
        curve = new.rows.curve[:count]
        curve[curve >= 0] -= head
        with self._lock:
            self._now = 1 - self._now
            self._head -= head
            self._tail = count
            self._event_tail = events
            self._version += 1
