"""Whether the rows of a read chunk hold together; a queue that fails here is never run.

These are the facts that the interpolator relies on without looking.  They are checked on columns, so a
queue of a million segments costs tens of milliseconds.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nccompile.errors import QueueError
from nccompile.toolpath import EventKind, Kind, Mark, Plane, Toolpath

__all__ = ["check_chunk"]

_ALL_MARKS = int(sum(Mark))
_CURVED = (Kind.ARC, Kind.ELLIPSE, Kind.POLYNOMIAL)
_RESTING = (Kind.SET_POSITION, Kind.DWELL, Kind.M_FUNCTION)
_EVENT_OF = {Kind.DWELL: EventKind.DWELL, Kind.M_FUNCTION: EventKind.M_FUNCTION}


def check_chunk(chunk: Toolpath) -> None:
    """Raises QueueError with one sentence on the first fact that does not hold."""
    for problem in _problems(chunk):
        raise QueueError(problem)


def _problems(chunk: Toolpath) -> Iterator[str]:
    yield from _finite(chunk)
    if len(chunk) and chunk.kind.max() > max(Kind):
        yield f"it has a segment of unknown kind {chunk.kind.max()}"
    yield from _signs(chunk)
    yield from _curves(chunk)
    yield from _events(chunk)


def _finite(chunk: Toolpath) -> Iterator[str]:
    columns = {
        name: getattr(chunk, name)
        for name in ("target", "length", "feed", "accel", "decel", "radius", "v_limit", "v_junction", "v_end")
    }
    if chunk.is_third_order:
        columns |= {"a_end": chunk.a_end, "jerk": chunk.jerk}
    columns["curve table"] = chunk.curves.parameters
    columns |= {f"event {name}": getattr(chunk.events, name) for name in ("position", "k", "l")}
    for name, column in columns.items():
        if not np.isfinite(column).all():
            yield f"its column {name} holds values that are not numbers"


def _signs(chunk: Toolpath) -> Iterator[str]:
    for name in ("length", "feed", "v_limit", "v_junction", "v_end", "line"):
        column = getattr(chunk, name)
        if len(column) and column.min() < 0:
            yield f"its column {name} holds negative values"
    moving = ~np.isin(chunk.kind, _RESTING) & (chunk.length > 0)
    for name in ("feed", "accel", "decel", "v_limit"):
        if (getattr(chunk, name)[moving] <= 0).any():
            yield f"its column {name} is not positive for every move: the queue was not planned"
    if chunk.jerk is not None and (chunk.jerk[moving] <= 0).any():
        yield "its column jerk is not positive for every move: the queue was not planned"
    if len(chunk) and int(chunk.mark.max()) > _ALL_MARKS:
        yield "its column mark holds unknown marks"
    if len(chunk) and int((chunk.profile & 0x7FFF).max()) >> len(
        chunk.axes
    ):  # bit 15: goes on in the next row
        yield "its column profile names axes that the queue does not have"


def _curves(chunk: Toolpath) -> Iterator[str]:
    curved = np.isin(chunk.kind, _CURVED)
    rows = chunk.curve[curved]
    if len(rows) and (rows.min() < 0 or rows.max() >= len(chunk.curves)):
        yield "a curve segment points outside the curve table"
        return
    if (chunk.curve[~curved] != -1).any():
        yield "a straight segment points into the curve table"
    if len(chunk.curves) and chunk.curves.plane.max() > max(Plane):
        yield "its curve table names an unknown plane"
    flat = chunk.curves.plane[chunk.curve[np.isin(chunk.kind, (Kind.ARC, Kind.ELLIPSE))]]
    if (flat == Plane.SPACE).any():
        yield "an arc or ellipse does not lie in a plane"


def _events(chunk: Toolpath) -> Iterator[str]:
    events = chunk.events
    if len(events):
        if events.segment.min() < 0 or events.segment.max() >= len(chunk):
            yield "an event belongs to a segment that does not exist"
            return
        step = np.diff(events.segment)
        if ((step < 0) | ((step == 0) & (np.diff(events.position) < 0))).any():
            yield "its events are not in order"
        if events.kind.max() > max(EventKind):
            yield f"it has an event of unknown kind {events.kind.max()}"
        if events.position.min() < 0 or events.position.max() > 1:
            yield "an event lies outside its segment"
        if events.o.min() < -1 or events.o.max() >= len(chunk.names):
            yield "an event names a variable that the queue does not list"
    for kind, event in _EVENT_OF.items():
        having = events.segment[events.kind == event]
        if not np.array_equal(np.flatnonzero(chunk.kind == kind), having):
            yield f"its {kind.name.lower()} segments and events do not match"
