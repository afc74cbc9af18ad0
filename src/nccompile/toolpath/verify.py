"""The invariants of a toolpath; runs between passes in tests and under `--verify`.

    shape      one row in every column, with its dtype; axes X, Y, Z first, each once, in the order of the table
    numbers    finite; lengths, feeds, accelerations not negative; marks and S-profile bits that exist
    chain      a chunk starts where the one before ended; waits do not move; G92 and waits have no length
    curves     one row of the table a curved segment, in their order; arcs, ellipses and polynomials only; unused
               parameters 0; both ends meet the chain within MEETING (geometry/tolerance.py)
    lengths    as `lengths` computes them, within LENGTH_RATIO
    events     in the order of (segment, position), position 0..1; switches on motions, one M or dwell a wait
    planned    velocities within their limits, and reachable: v1² <= v0² + 2 a L, v0² <= v1² + 2 d L

Everything is vectorised: a million straight segments take about a second.  A broken invariant is a bug of the
stage that made the path, never the user's mistake.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
import numpy.typing as npt

from nccompile.errors import InvalidToolpath
from nccompile.geometry.sampling import extent_of_digits, sample_curves
from nccompile.geometry.tolerance import LENGTH_RATIO, MEETING, MEETING_RATIO
from nccompile.toolpath.columns import (
    AXIS_LETTERS,
    CURVE_PARAMETERS,
    EventKind,
    Floats,
    Kind,
    Mark,
    Plane,
    Toolpath,
)
from nccompile.toolpath.lengths import PLANE_AXES, path_lengths

__all__ = ["verify", "verify_chain"]

Flags = npt.NDArray[np.bool_]

_DTYPES = {
    "kind": np.uint8, "curve": np.int32, "length": np.float64, "feed": np.float64, "accel": np.float64,
    "decel": np.float64, "mark": np.uint16, "radius": np.float64, "profile": np.uint16, "line": np.int32,
}  # fmt: skip
_EVENT_DTYPES = {
    "segment": np.int32, "kind": np.uint8, "number": np.int32, "position": np.float64, "k": np.float64,
    "l": np.float64, "o": np.int32,
}  # fmt: skip
_PLANNED = ("v_limit", "v_junction", "v_end")
_THIRD_ORDER = ("a_end", "jerk")

_USED = {Kind.ARC: 5, Kind.ELLIPSE: 7}
"""Parameters in use; a polynomial has 12 in space and 8 in a plane."""

_MARKS = int(sum(Mark))
_VELOCITY_RATIO = 1e-9
"""Planned squares of velocities may be off by this part: they pass through a root and back."""

_LAW_RATIO = 1e-6
"""The same for accelerations, jerks and velocities of a third-order plan."""

_PLACE = 1e-12
"""Rounding of coordinates in the length of a segment [mm]: what a jerk is told by in segments that are as short."""

_CURVED = (Kind.ARC, Kind.ELLIPSE, Kind.POLYNOMIAL)
_WAITS = (Kind.DWELL, Kind.M_FUNCTION)


def verify(chunk: Toolpath, *, previous_end: Floats | None = None, previous_v: float | None = None) -> None:
    """Checks one chunk.

    Args:     previous_end: Shape (k,), where the chunk before ended; None: unknown, or this is the first;
              previous_v: velocity at which the chunk before ended [mm/s]; None: 0 if this is the first chunk
              (`first` is 0), else unknown.
    Raises:   InvalidToolpath: names the segment, its source line and the invariant.
    """
    _check_shapes(chunk)
    _check_axes(chunk)
    _check_numbers(chunk)
    _check_chain(chunk, previous_end)
    _check_curves(chunk)
    _check_lengths(chunk)
    _check_events(chunk)
    if chunk.is_planned:
        _check_plan(chunk, 0.0 if previous_v is None and chunk.first == 0 else previous_v)


def verify_chain(chunks: Iterable[Toolpath]) -> Iterator[Toolpath]:
    """Passes chunks on, each checked against the one before; a planned path must end at rest.

    Raises:   InvalidToolpath: as `verify`, or the chunks' indices, axes or names do not fit together.
    """
    before: Toolpath | None = None
    for chunk in chunks:
        if before is None:
            verify(chunk)
        else:
            _check_successor(before, chunk)
            ends_at = float(before.v_end[-1]) if before.v_end is not None and len(before) else None
            verify(chunk, previous_end=before.end, previous_v=ends_at)
        yield chunk
        before = chunk if len(chunk) or before is None else before
    if before is not None and before.v_end is not None and len(before) and before.v_end[-1] != 0.0:
        raise _broken(before, len(before) - 1, f"the path ends at {before.v_end[-1]} mm/s instead of 0")


def _check_successor(before: Toolpath, chunk: Toolpath) -> None:
    if chunk.axes != before.axes:
        raise InvalidToolpath(f"chunk at segment {chunk.first}: its axes differ from those before")
    if chunk.first != before.first + len(before):
        raise InvalidToolpath(
            f"chunk at segment {chunk.first}: the one before ends at {before.first + len(before)}"
        )
    if chunk.names[: len(before.names)] != before.names:
        raise InvalidToolpath(f"chunk at segment {chunk.first}: its names do not continue those before")
    if (chunk.is_planned, chunk.is_third_order) != (before.is_planned, before.is_third_order):
        raise InvalidToolpath(f"chunk at segment {chunk.first}: only one of two chunks is planned")


def _broken(chunk: Toolpath, row: int, what: str) -> InvalidToolpath:
    kind = int(chunk.kind[row])
    name = Kind(kind).name if kind in list(Kind) else f"kind {kind}"
    return InvalidToolpath(
        f"segment {chunk.first + row} ({name}, source line {int(chunk.line[row])}): {what}"
    )


def _forbid(chunk: Toolpath, bad: Flags, what: str, rows: npt.NDArray[np.intp] | None = None) -> None:
    """Raises for the first row that `bad` marks; `rows` are the rows it speaks of if not all."""
    if bad.any():
        at = int(np.argmax(bad))
        raise _broken(chunk, at if rows is None else int(rows[at]), what)


def _finite_rows(values: Floats) -> Flags:
    """Which rows hold only finite numbers."""
    finite: Flags = np.all(np.isfinite(values), axis=1)
    return finite


def _check_shapes(chunk: Toolpath) -> None:
    n, k = len(chunk), len(chunk.axes)
    shapes: dict[str, tuple[npt.NDArray[np.generic], tuple[int, ...], type]] = {
        "start": (chunk.start, (k,), np.float64),
        "target": (chunk.target, (n, k), np.float64),
        "curves.plane": (chunk.curves.plane, (len(chunk.curves),), np.uint8),
        "curves.parameters": (chunk.curves.parameters, (len(chunk.curves), CURVE_PARAMETERS), np.float64),
    }
    shapes |= {name: (getattr(chunk, name), (n,), dtype) for name, dtype in _DTYPES.items()}
    e = chunk.events
    shapes |= {
        f"events.{name}": (getattr(e, name), (len(e),), dtype) for name, dtype in _EVENT_DTYPES.items()
    }
    for names in (_PLANNED, _THIRD_ORDER):
        missing = [getattr(chunk, name) is None for name in names]
        if any(missing) != all(missing):
            raise InvalidToolpath(
                f"chunk at segment {chunk.first}: only some of {', '.join(names)} are planned"
            )
        if not any(missing):
            shapes |= {name: (getattr(chunk, name), (n,), np.float64) for name in names}
    for name, (column, shape, dtype) in shapes.items():
        if column.shape != shape or column.dtype != dtype:
            raise InvalidToolpath(
                f"chunk at segment {chunk.first}: column {name} has shape {column.shape} and dtype "
                f"{column.dtype}, expected {shape} and {np.dtype(dtype)}"
            )


def _check_axes(chunk: Toolpath) -> None:
    if chunk.axes != tuple(a for a in AXIS_LETTERS if a in chunk.axes) or chunk.axes[:3] != ("X", "Y", "Z"):
        raise InvalidToolpath(
            f"chunk at segment {chunk.first}: axes {' '.join(chunk.axes)} are not X Y Z and others of "
            f"{AXIS_LETTERS} in this order"
        )


def _check_numbers(chunk: Toolpath) -> None:
    if not np.isfinite(chunk.start).all():
        raise InvalidToolpath(f"chunk at segment {chunk.first}: the start position is not finite")
    _forbid(chunk, chunk.kind > max(Kind), "a kind that does not exist")
    _forbid(chunk, ~_finite_rows(chunk.target), "the end position is not finite")
    for name in ("length", "feed", "accel", "decel"):
        column = getattr(chunk, name)
        _forbid(chunk, ~(np.isfinite(column) & (column >= 0.0)), f"{name} is negative or not finite")
    _forbid(chunk, ~np.isfinite(chunk.radius), "radius is not finite")
    _forbid(chunk, chunk.line < 0, "the source line is negative")
    _forbid(chunk, (chunk.profile & 0x7FFF) >= 1 << len(chunk.axes), "an S-profile bit beyond the axes")
    _forbid(chunk, (chunk.mark & ~np.uint16(_MARKS)) != 0, "a mark that does not exist")
    for pair in (Mark.TOOL_LEFT | Mark.TOOL_RIGHT, Mark.SMOOTH | Mark.ROUND):
        _forbid(chunk, (chunk.mark & int(pair)) == int(pair), f"marks {pair!s} exclude each other")


def _check_chain(chunk: Toolpath, previous_end: Floats | None) -> None:
    if previous_end is not None and not np.array_equal(chunk.start, previous_end):
        raise InvalidToolpath(f"chunk at segment {chunk.first}: does not start where the one before ended")
    waits = np.isin(chunk.kind, _WAITS)
    if waits.any():
        moved: Flags = np.any(chunk.target != chunk.starts(), axis=1)
        _forbid(chunk, waits & moved, "a wait moves")


def _check_curves(chunk: Toolpath) -> None:
    curved = np.isin(chunk.kind, _CURVED)
    _forbid(chunk, curved & (chunk.curve < 0), "a curve without a row in the curve table")
    _forbid(chunk, ~curved & (chunk.curve != -1), "a straight segment with a row in the curve table")
    rows = np.flatnonzero(curved)
    table = chunk.curve[rows]
    _forbid(
        chunk,
        table != np.arange(len(rows), dtype=np.int32),
        "the curve table is not in the order of the segments",
        rows,
    )
    if len(rows) != len(chunk.curves):
        raise InvalidToolpath(
            f"chunk at segment {chunk.first}: {len(chunk.curves)} rows in the curve table for {len(rows)} curves"
        )
    if len(rows):
        _check_curve_rows(chunk, rows)
        _check_curve_ends(chunk, rows)


def _check_curve_rows(chunk: Toolpath, rows: npt.NDArray[np.intp]) -> None:
    kinds, plane, p = chunk.kind[rows], chunk.curves.plane, chunk.curves.parameters
    _forbid(chunk, ~_finite_rows(p), "a curve parameter is not finite", rows)
    _forbid(chunk, plane > Plane.SPACE, "a plane that does not exist", rows)
    space = plane == Plane.SPACE
    _forbid(chunk, space & (kinds != Kind.POLYNOMIAL), "only polynomials run in space", rows)
    used = np.where(space, 12, 8)
    for kind, count in _USED.items():
        used[kinds == kind] = count
    unused = (np.arange(CURVE_PARAMETERS) >= used[:, None]) & (p != 0.0)
    _forbid(chunk, unused.any(axis=1), "an unused curve parameter is not 0", rows)
    arc, ellipse = kinds == Kind.ARC, kinds == Kind.ELLIPSE
    _forbid(chunk, arc & ~(p[:, 2] > 0.0), "the radius is not above 0", rows)
    _forbid(chunk, ellipse & ~((p[:, 2] > 0.0) & (p[:, 3] > 0.0)), "a half-axis is not above 0", rows)
    sweep = np.abs(np.where(arc, p[:, 4], p[:, 6]))
    turn = 2.0 * np.pi * (1.0 + MEETING_RATIO)
    _forbid(
        chunk, (arc | ellipse) & ~((sweep > 0.0) & (sweep <= turn)), "the sweep is 0 or over a turn", rows
    )


def _check_curve_ends(chunk: Toolpath, rows: npt.NDArray[np.intp]) -> None:
    kinds, plane, p = chunk.kind[rows], chunk.curves.plane, chunk.curves.parameters
    ends = sample_curves(kinds, p, np.array([0.0, 1.0]))
    allowed = MEETING + MEETING_RATIO * extent_of_digits(kinds, p)
    columns = np.zeros((4, 3), np.intp)
    for name, axes in PLANE_AXES.items():
        columns[name, :2] = axes
    columns[Plane.SPACE] = (0, 1, 2)
    picked = columns[plane]
    for i, (word, chain) in enumerate((("start", chunk.starts()[rows]), ("end", chunk.target[rows]))):
        wanted = np.take_along_axis(chain, picked, axis=1)
        off = np.abs(ends[:, i] - wanted)
        off[plane != Plane.SPACE, 2] = 0.0
        bad = ~(off.max(axis=1) <= allowed)
        if bad.any():
            worst = off[int(np.argmax(bad))].max()
            _forbid(chunk, bad, f"the curve misses the {word} of its segment by {worst:.3g} mm", rows)


def _check_lengths(chunk: Toolpath) -> None:
    length = path_lengths(chunk)
    off = ~(np.abs(chunk.length - length) <= LENGTH_RATIO * length)
    if off.any():
        at = int(np.argmax(off))
        _forbid(
            chunk, off, f"length {float(chunk.length[at])!r} mm, the geometry's is {float(length[at])!r} mm"
        )


def _check_events(chunk: Toolpath) -> None:
    e, n = chunk.events, len(chunk)
    if len(e) and not (e.segment.min() >= 0 and e.segment.max() < n):
        raise InvalidToolpath(
            f"chunk at segment {chunk.first}: an event of a segment that is not in the chunk"
        )
    rows = e.segment.astype(np.intp)
    _forbid(chunk, e.kind > max(EventKind), "an event kind that does not exist", rows)
    _forbid(chunk, ~((e.position >= 0.0) & (e.position <= 1.0)), "an event outside 0..1 of its segment", rows)
    _forbid(chunk, ~(np.isfinite(e.k) & np.isfinite(e.l)), "an event parameter is not finite", rows)
    _forbid(
        chunk, (e.o < -1) | (e.o >= len(chunk.names)), "an event names data that is not in the names", rows
    )
    step = np.diff(rows)
    back = (step < 0) | ((step == 0) & (np.diff(e.position) < 0.0))
    _forbid(chunk, back, "events are not in order", rows[1:])
    _check_event_kinds(chunk, rows)


def _check_event_kinds(chunk: Toolpath, rows: npt.NDArray[np.intp]) -> None:
    e = chunk.events
    kinds = chunk.kind[rows]
    switch = e.kind == EventKind.SWITCH
    _forbid(chunk, switch & (kinds > Kind.POLYNOMIAL), "a switch point on a segment that does not move", rows)
    _forbid(chunk, switch & (e.number == 0), "a switch point without a number", rows)
    _forbid(chunk, (e.kind == EventKind.DWELL) & ~(e.k >= 0.0), "a dwell of negative time", rows)
    for kind, event in ((Kind.M_FUNCTION, EventKind.M_FUNCTION), (Kind.DWELL, EventKind.DWELL)):
        count = np.bincount(rows[e.kind == event], minlength=len(chunk))
        _forbid(chunk, count != (chunk.kind == kind), f"{kind.name} rows and events do not match")


def _check_plan(chunk: Toolpath, v_before: float | None) -> None:
    assert chunk.v_limit is not None
    assert chunk.v_junction is not None
    assert chunk.v_end is not None
    for name in ("v_limit", "v_junction"):
        _forbid(chunk, ~(getattr(chunk, name) >= 0.0), f"{name} is negative or not a number")
    v = chunk.v_end
    _forbid(chunk, ~(np.isfinite(v) & (v >= 0.0)), "v_end is negative or not finite")
    moving = chunk.length > 0.0
    for name in ("feed", "accel", "decel", "v_limit"):
        _forbid(chunk, moving & ~(getattr(chunk, name) > 0.0), f"planned {name} is not above 0")
    slack = 1.0 + _VELOCITY_RATIO
    _forbid(chunk, v > chunk.v_limit * slack, "v_end above v_limit")
    _forbid(chunk, v > chunk.v_junction * slack, "v_end above v_junction")
    _forbid(chunk, moving & (v > chunk.feed * slack), "v_end above the feed")
    _forbid(chunk, (chunk.kind > Kind.POLYNOMIAL) & (v != 0.0), "a velocity where the path stands")
    known = np.ones(len(chunk), np.bool_)
    if v_before is None and len(chunk):
        known[0] = False
    start = np.concatenate([[v_before or 0.0], v[:-1]])[: len(chunk)]
    reach = start * start + 2.0 * chunk.accel * chunk.length
    brake = v * v + 2.0 * chunk.decel * chunk.length
    _forbid(chunk, known & (v * v > reach * slack), "v_end cannot be reached from the velocity before")
    _forbid(chunk, known & (start * start > brake * slack), "the velocity before cannot be braked to v_end")
    if chunk.is_third_order:
        _check_third_order(chunk, start, known)


def _check_third_order(chunk: Toolpath, start: Floats, known: Flags) -> None:
    """Accelerations and jerks inside the segment's own, and velocities that they lead to."""
    assert chunk.v_end is not None
    assert chunk.a_end is not None
    assert chunk.jerk is not None
    a1, jerk, v, moving = chunk.a_end, chunk.jerk, chunk.v_end, chunk.length > 0.0
    _forbid(chunk, ~np.isfinite(a1), "a_end is not finite")
    _forbid(chunk, moving & ~((jerk > 0.0) & np.isfinite(jerk)), "planned jerk is not above 0")
    _forbid(chunk, (v == 0.0) & (a1 != 0.0), "an acceleration where the path stands")
    room = 1.0 + _LAW_RATIO
    _forbid(
        chunk, moving & ((a1 > chunk.accel * room) | (-a1 > chunk.decel * room)), "a_end beyond the limits"
    )
    a0 = np.concatenate([[0.0], a1[:-1]])[: len(chunk)]
    known = known & moving
    if len(known) and chunk.first > 0:
        known[0] = False  # the acceleration before is not at hand
    length = chunk.length
    mean = 0.5 * (start + v)
    below = mean + np.sqrt(np.maximum(mean * mean + (a0 - a1) * length / 3.0, 0.0))
    time = np.divide(2.0 * length, below, out=np.zeros_like(v), where=known & (below > 0.0))
    _forbid(chunk, known & (time <= 0.0), "the segment cannot be run with a constant jerk")
    off = np.abs(start + 0.5 * (a0 + a1) * time - v)
    _forbid(chunk, known & (off > _LAW_RATIO * np.maximum(v, start)), "v_end is not where the jerk leads to")
    least = np.divide(
        _PLACE, np.maximum(v, start), out=np.where(known, np.inf, 0.0), where=np.maximum(v, start) > 0.0
    )
    _forbid(chunk, known & (np.abs(a1 - a0) > jerk * (time * room + least)), "a jerk beyond the limit")
