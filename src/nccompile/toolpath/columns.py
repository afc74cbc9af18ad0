"""The toolpath: a chain of segments as numpy columns, in chunks of bounded length.

    start --segment 0--> target[0] --segment 1--> target[1] ... target[n-1]

Every segment starts where the one before it ended, so only the end is stored.  The first segment of a chunk
starts at `Toolpath.start`.  A jump without motion (G92) is a segment of its own kind, so there is no hidden
gap.  Units: mm, mm/s, mm/s², radians inside the curve table; rotary axes (A, B, C) in degrees.

    columns   one row a segment: kind, target, curve, length, feed, accel, decel, mark, radius, profile, line
    planned   v_limit, v_junction, v_end (absent before velocity planning), and a_end, jerk (third-order plans only)
    curves    rows for segments that are not straight, found by the column `curve`
    events    switch points, M functions and dwells, keyed by the segment's row in this chunk

Path length (SoftMotion §6.2.8, docs/decisions/040): the length in X-Y-Z space; for a helix that of the
curve in its plane and the linear third axis together.  A segment that moves only additional axes is as long
as their Euclidean distance, so its feed is theirs.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from enum import IntEnum, IntFlag
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from nccompile.toolpath.views import Segment

__all__ = [
    "ADDITIONAL",
    "AXIS_LETTERS",
    "CHUNK",
    "CURVE_PARAMETERS",
    "Curves",
    "EventKind",
    "Events",
    "Floats",
    "Kind",
    "Mark",
    "Plane",
    "Toolpath",
]

Floats: TypeAlias = npt.NDArray[np.float64]
Ints: TypeAlias = npt.NDArray[np.int32]
Bytes: TypeAlias = npt.NDArray[np.uint8]
Words: TypeAlias = npt.NDArray[np.uint16]

AXIS_LETTERS = "XYZABCPQUVW"
"""All axis letters; a toolpath uses X, Y, Z and those of the others that its program names, in this order."""

ADDITIONAL = AXIS_LETTERS[3:]

CHUNK = 4096
"""Segments in a chunk unless somebody asks for another size."""

CURVE_PARAMETERS = 12
"""Width of a row of the curve table."""


class Kind(IntEnum):
    """What a segment does; the numbers are part of the queue format."""

    POSITIONING = 0  # G0: straight, at rapid, stops at both ends
    LINE = 1  # G1
    ARC = 2  # G2 G3: curve row centre_u, centre_v, radius, start angle [rad], sweep [rad, + is ccw]
    ELLIPSE = (
        3  # G8 G9: centre_u, centre_v, main half-axis, sub half-axis, direction [rad], start, sweep [rad]
    )
    POLYNOMIAL = 4  # G5 G6: cubics c0 + c1 t + c2 t² + c3 t³, t in 0..1: four coefficients each for x, y, z
    SET_POSITION = 5  # G92: a jump, takes no time
    DWELL = 6  # G4: waits, event row has the seconds
    M_FUNCTION = 7  # M: waits for the acknowledge, event row has number, K, L, O


class Plane(IntEnum):
    """The two axes (u, v) in which a curve lies; the third is linear in arc length."""

    XY = 0
    ZX = 1
    YZ = 2
    SPACE = 3  # POLYNOMIAL only: all three coordinates are polynomials


class Mark(IntFlag):
    """Start and stop of path passes at a segment (SMC_GEOINFO byInternMark, SoftMotion §6.6).

    A start mark acts from the start of its segment, a stop mark from the end of its segment.
    """

    TOOL_STOP = 1
    TOOL_LEFT = 2
    TOOL_RIGHT = 4
    CORNER_STOP = 8
    SMOOTH = 16
    ROUND = 32
    LOOP_STOP = 64
    LOOP = 128


class EventKind(IntEnum):
    """What an event row means."""

    SWITCH = 0  # number > 0 on, < 0 off, at `position` 0..1 of the segment's length
    M_FUNCTION = 1  # number, with parameters k, l, o
    DWELL = 2  # `k` seconds


@dataclass(frozen=True)
class Curves:
    """Geometry of the segments that are not straight; one row each.

    plane: u1 (m,), see `Plane`; parameters: f8 (m, 12), layout by the segment's `Kind`, unused ones 0.
    """

    plane: Bytes
    parameters: Floats

    @classmethod
    def empty(cls) -> Curves:
        """A table without rows."""
        return cls(np.zeros(0, np.uint8), np.zeros((0, CURVE_PARAMETERS)))

    @classmethod
    def from_rows(cls, rows: Sequence[tuple[int, Sequence[float]]]) -> Curves:
        """A table of (plane, parameters) rows; short parameter lists are filled with 0."""
        parameters = np.zeros((len(rows), CURVE_PARAMETERS))
        for at, (_, values) in enumerate(rows):
            parameters[at, : len(values)] = values
        return cls(np.array([plane for plane, _ in rows], np.uint8), parameters)

    def __len__(self) -> int:
        return len(self.plane)


@dataclass(frozen=True)
class Events:
    """Switch points, M functions and dwells, sorted by (segment, position).

    segment: i4 (e,) row in this chunk; kind: u1 (e,); number: i4 (e,); position: f8 (e,) 0..1;
    k, l: f8 (e,), 0 if not programmed; o: i4 (e,) row in `Toolpath.names`, -1 if none.
    """

    segment: Ints
    kind: Bytes
    number: Ints
    position: Floats
    k: Floats
    l: Floats  # noqa: E741 - the word letter of the language
    o: Ints

    @classmethod
    def empty(cls) -> Events:
        """A table without rows."""
        return cls.from_rows([])

    @classmethod
    def from_rows(cls, rows: Sequence[tuple[int, int, int, float, float, float, int]]) -> Events:
        """A table of (segment, kind, number, position, k, l, o) rows, sorted by (segment, position)."""
        ordered = sorted(rows, key=lambda row: (row[0], row[3]))
        columns: list[Sequence[Any]] = list(zip(*ordered, strict=True)) or [()] * 7
        dtypes = (np.int32, np.uint8, np.int32, np.float64, np.float64, np.float64, np.int32)
        return cls(*(np.array(c, d) for c, d in zip(columns, dtypes, strict=True)))

    def __len__(self) -> int:
        return len(self.segment)


@dataclass(frozen=True)
class Toolpath:
    """A chunk of a toolpath (a whole small path is one chunk).  Arrays are never changed in place.

    axes: letters of the k axes in use, X, Y, Z first;  start: f8 (k,) position before segment 0;
    kind: u1 (n,);  target: f8 (n, k) end positions;  curve: i4 (n,) row in `curves`, -1 if straight;
    length: f8 (n,) path length [mm];  feed: f8 (n,) programmed path velocity [mm/s], 0 if none was programmed;
    accel, decel: f8 (n,) limits [mm/s²], 0 if none was programmed;  mark: u2 (n,) `Mark` bits;
    radius: f8 (n,) D in force [mm];  profile: u2 (n,) bit i set: axis i runs in the S-profile (SoftMotion
    §6.2.8);  line: i4 (n,) source line, from 1;
    v_limit, v_junction, v_end: f8 (n,) [mm/s], None before planning: the greatest velocity that machine and
    geometry allow on the segment whatever the feed, the same at its end, and the planned velocity at its end;
    in a planned path `feed`, `accel` and `decel` hold the values in force, all > 0 where the segment moves, and
    the segment runs at min(override * feed, v_limit);
    a_end [mm/s²], jerk [mm/s³]: f8 (n,), both or none: path acceleration at the end of a segment that is run with a
    constant jerk, 0 where the path stops, and the greatest path jerk allowed on it (> 0 where the segment moves);
    segments without length hand v_end and a_end of the one before them on;
    first: index of row 0 in the whole path;  names: what `Events.o` points to.
    """

    axes: tuple[str, ...]
    start: Floats
    kind: Bytes
    target: Floats
    curve: Ints
    length: Floats
    feed: Floats
    accel: Floats
    decel: Floats
    mark: Words
    radius: Floats
    profile: Words
    line: Ints
    curves: Curves = field(default_factory=Curves.empty)
    events: Events = field(default_factory=Events.empty)
    v_limit: Floats | None = None
    v_junction: Floats | None = None
    v_end: Floats | None = None
    a_end: Floats | None = None
    jerk: Floats | None = None
    first: int = 0
    names: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.kind)

    def __getitem__(self, i: int) -> Segment:
        """The typed read-only view of row i (`toolpath.views`)."""
        from nccompile.toolpath.views import view  # noqa: PLC0415 - views import this module

        return view(self, i)

    def __iter__(self) -> Iterator[Segment]:
        return (self[i] for i in range(len(self)))

    @property
    def is_planned(self) -> bool:
        """Whether velocities have been planned."""
        return self.v_end is not None

    @property
    def is_third_order(self) -> bool:
        """Whether the segments are planned with a constant jerk each (columns a_end and jerk)."""
        return self.a_end is not None

    @property
    def end(self) -> Floats:
        """Shape (k,): the position after the last segment."""
        return self.target[-1] if len(self) else self.start

    def starts(self) -> Floats:
        """Shape (n, k): the start position of every segment."""
        return np.vstack([self.start[None, :], self.target[:-1]]) if len(self) else self.target

    def replace(self, **columns: Any) -> Toolpath:
        """A copy with some columns exchanged."""
        return replace(self, **columns)

    def rows(self, begin: int, end: int) -> Toolpath:
        """The segments begin..end-1 as a chunk of its own, with their curves and events."""
        begin, end = max(0, begin), min(end, len(self))
        pick = slice(begin, end)
        curve = self.curve[pick].copy()
        used = np.flatnonzero(curve >= 0)
        rows = curve[used]
        curve[used] = np.arange(len(used), dtype=np.int32)
        e = self.events
        lo, hi = np.searchsorted(e.segment, [begin, end])
        return Toolpath(
            axes=self.axes,
            start=self.start if begin == 0 else self.target[begin - 1],
            kind=self.kind[pick],
            target=self.target[pick],
            curve=curve,
            length=self.length[pick],
            feed=self.feed[pick],
            accel=self.accel[pick],
            decel=self.decel[pick],
            mark=self.mark[pick],
            radius=self.radius[pick],
            profile=self.profile[pick],
            line=self.line[pick],
            curves=Curves(self.curves.plane[rows], self.curves.parameters[rows]),
            events=Events(
                (e.segment[lo:hi] - begin).astype(np.int32),
                e.kind[lo:hi], e.number[lo:hi], e.position[lo:hi], e.k[lo:hi], e.l[lo:hi], e.o[lo:hi],
            ),
            v_limit=None if self.v_limit is None else self.v_limit[pick],
            v_junction=None if self.v_junction is None else self.v_junction[pick],
            v_end=None if self.v_end is None else self.v_end[pick],
            a_end=None if self.a_end is None else self.a_end[pick],
            jerk=None if self.jerk is None else self.jerk[pick],
            first=self.first + begin,
            names=self.names,
        )  # fmt: skip

    @classmethod
    def join(cls, chunks: Sequence[Toolpath]) -> Toolpath:
        """One chunk from consecutive ones (same axes; names of the last, which holds those before it)."""
        if len(chunks) == 1:
            return chunks[0]
        offsets = np.cumsum([0] + [len(c) for c in chunks])
        curve_offsets = np.cumsum([0] + [len(c.curves) for c in chunks])
        planned = all(c.is_planned for c in chunks)
        third_order = all(c.is_third_order for c in chunks)

        def stack(name: str) -> Any:
            return np.concatenate([getattr(c, name) for c in chunks])

        return cls(
            axes=chunks[0].axes,
            start=chunks[0].start,
            curve=np.concatenate(
                [np.where(c.curve >= 0, c.curve + at, -1).astype(np.int32)
                 for c, at in zip(chunks, curve_offsets[:-1], strict=True)]
            ),
            curves=Curves(
                np.concatenate([c.curves.plane for c in chunks]),
                np.concatenate([c.curves.parameters for c in chunks]),
            ),
            events=Events(
                np.concatenate([(c.events.segment + at).astype(np.int32)
                                for c, at in zip(chunks, offsets[:-1], strict=True)]),
                *(np.concatenate([getattr(c.events, name) for c in chunks])
                  for name in ("kind", "number", "position", "k", "l", "o")),
            ),
            v_limit=stack("v_limit") if planned else None,
            v_junction=stack("v_junction") if planned else None,
            v_end=stack("v_end") if planned else None,
            a_end=stack("a_end") if third_order else None,
            jerk=stack("jerk") if third_order else None,
            first=chunks[0].first,
            names=max((c.names for c in chunks), key=len),
            **{name: stack(name) for name in _PLAIN},
        )  # fmt: skip

    @classmethod
    def empty(cls, axes: tuple[str, ...] = ("X", "Y", "Z"), start: Floats | None = None) -> Toolpath:
        """A path without segments."""
        k = len(axes)
        none = np.zeros(0)
        return cls(
            axes=axes,
            start=np.zeros(k) if start is None else start,
            kind=np.zeros(0, np.uint8),
            target=np.zeros((0, k)),
            curve=np.zeros(0, np.int32),
            length=none, feed=none, accel=none, decel=none, radius=none,
            mark=np.zeros(0, np.uint16),
            profile=np.zeros(0, np.uint16),
            line=np.zeros(0, np.int32),
        )  # fmt: skip


_PLAIN = ("kind", "target", "length", "feed", "accel", "decel", "mark", "radius", "profile", "line")
