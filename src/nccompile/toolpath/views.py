"""Typed read-only views of single segments, for people, tests and messages.

`view(path, i)`, or `path[i]`, gives the view of a row; loops over views are for small work only: everything
that runs over large files works on the columns.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from nccompile.toolpath.columns import EventKind, Kind, Plane, Toolpath
from nccompile.toolpath.lengths import PLANE_AXES

__all__ = [
    "Arc", "Dwell", "Ellipse", "Line", "MFunction", "Polynomial", "Position", "Positioning", "Segment",
    "SetPosition", "Switch", "view",
]  # fmt: skip

Position: TypeAlias = dict[str, float]
"""Axis letter -> mm (degrees for A, B, C)."""

Point: TypeAlias = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Switch:
    """A switch point: number > 0 on, < 0 off, at a share 0..1 of the segment's length."""

    number: int
    position: float


@dataclass(frozen=True, slots=True)
class Segment:
    """What all segments have: place in the path, source line, ends [mm], length [mm], feed [mm/s]."""

    index: int
    line: int
    start: Position
    end: Position
    length: float
    feed: float
    switches: tuple[Switch, ...]


@dataclass(frozen=True, slots=True)
class Positioning(Segment):
    """A straight rapid move (G0); stops at both ends."""


@dataclass(frozen=True, slots=True)
class Line(Segment):
    """A straight feed move (G1)."""


@dataclass(frozen=True, slots=True)
class Arc(Segment):
    """A circular move (G2, G3); with a move of the third axis a helix.

            end *
               /  .        sweep > 0: counter-clockwise (G3)
            r /     .      sweep < 0: clockwise (G2)
             /       .
    center  *---------*  start, at start_angle
    """

    plane: Plane
    center: Point  # [mm], in the plane's axes
    radius: float  # [mm]
    start_angle: float  # [rad]
    sweep: float  # [rad]


@dataclass(frozen=True, slots=True)
class Ellipse(Segment):
    """An elliptic move (G8, G9); angles are eccentric, counted from the main axis."""

    plane: Plane
    center: Point  # [mm]
    main: float  # half-axis [mm]
    sub: float  # half-axis [mm]
    direction: float  # of the main axis [rad]
    start_angle: float  # [rad]
    sweep: float  # [rad], + is counter-clockwise

    @property
    def ratio(self) -> float:
        """Sub axis / main axis."""
        return self.sub / self.main


@dataclass(frozen=True, slots=True)
class Polynomial(Segment):
    """A cubic c0 + c1 t + c2 t² + c3 t³, t in 0..1 (G5, G6): coefficients [mm] of the plane's axes."""

    plane: Plane
    coefficients: tuple[tuple[float, float, float, float], ...]

    def point(self, t: float) -> tuple[float, ...]:
        """The coordinates [mm] at t."""
        return tuple(c0 + t * (c1 + t * (c2 + t * c3)) for c0, c1, c2, c3 in self.coefficients)


@dataclass(frozen=True, slots=True)
class SetPosition(Segment):
    """A jump of the set position (G92)."""


@dataclass(frozen=True, slots=True)
class Dwell(Segment):
    """A wait (G4)."""

    seconds: float


@dataclass(frozen=True, slots=True)
class MFunction(Segment):
    """A machine function: the path waits for its acknowledge."""

    number: int
    k: float
    l: float  # noqa: E741 - the word letter of the language
    o: str  # name of the parameter data, empty if none


def view(path: Toolpath, i: int) -> Segment:
    """The typed view of row i of a chunk (negative counts from the end).

    Raises:   IndexError: no such row.
    """
    n = len(path)
    if not -n <= i < n:
        raise IndexError(f"segment {i} of a toolpath with {n}")
    i %= n
    kind = Kind(int(path.kind[i]))
    before = path.start if i == 0 else path.target[i - 1]
    first, last = np.searchsorted(path.events.segment, [i, i + 1])
    common = (
        path.first + i,
        int(path.line[i]),
        dict(zip(path.axes, before.tolist(), strict=True)),
        dict(zip(path.axes, path.target[i].tolist(), strict=True)),
        float(path.length[i]),
        float(path.feed[i]),
        _switches(path, int(first), int(last)),
    )
    if path.curve[i] >= 0:
        return _curved(path, i, kind, common)
    if kind in (Kind.DWELL, Kind.M_FUNCTION):
        return _waiting(path, kind, range(int(first), int(last)), common)
    straight = {Kind.POSITIONING: Positioning, Kind.SET_POSITION: SetPosition}
    return straight.get(kind, Line)(*common)


_Common: TypeAlias = tuple[int, int, Position, Position, float, float, tuple[Switch, ...]]


def _switches(path: Toolpath, first: int, last: int) -> tuple[Switch, ...]:
    e = path.events
    rows = [j for j in range(first, last) if e.kind[j] == EventKind.SWITCH]
    return tuple(Switch(int(e.number[j]), float(e.position[j])) for j in rows)


def _curved(path: Toolpath, i: int, kind: Kind, common: _Common) -> Segment:
    row = int(path.curve[i])
    plane = Plane(int(path.curves.plane[row]))
    p = path.curves.parameters[row].tolist()
    if kind == Kind.ARC:
        return Arc(*common, plane, (p[0], p[1]), p[2], p[3], p[4])
    if kind == Kind.ELLIPSE:
        return Ellipse(*common, plane, (p[0], p[1]), p[2], p[3], p[4], p[5], p[6])
    count = 3 if plane == Plane.SPACE else len(PLANE_AXES[plane])
    cubics = tuple((p[4 * c], p[4 * c + 1], p[4 * c + 2], p[4 * c + 3]) for c in range(count))
    return Polynomial(*common, plane, cubics)


def _waiting(path: Toolpath, kind: Kind, rows: range, common: _Common) -> Segment:
    e = path.events
    wanted = EventKind.DWELL if kind == Kind.DWELL else EventKind.M_FUNCTION
    row = next((j for j in rows if e.kind[j] == wanted), None)
    if kind == Kind.DWELL:
        return Dwell(*common, 0.0 if row is None else float(e.k[row]))
    if row is None:
        return MFunction(*common, 0, 0.0, 0.0, "")
    o = int(e.o[row])
    return MFunction(
        *common, int(e.number[row]), float(e.k[row]), float(e.l[row]), path.names[o] if o >= 0 else ""
    )
