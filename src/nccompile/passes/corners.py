"""What round-corners and smooth-corners share: finding corners, cutting their neighbours, building the rows.

      ●───────────┐            before:  row i ends, row i + 1 begins in the corner
                  │            after:   row i up to its cut, pieces of the corner, row i + 1 from its cut
                  ●
      ●───────╮                     a: length cut off the end of i      b: off the start of i + 1
           a  │ b              Each row is cut by at most half its length at each end, so the corners do not
              ●                meet and every corner depends on its two rows alone.

The first half of the corner's way stands for the end of row i, the second for the start of row i + 1: switch
points and additional axes pass it at the same share.  Positionings, stops (dwell, M), set positions, rows in
the S-profile and rows that move additional axes only are never cut.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from nccompile.geometry.parts import Way, curvature_at, cut, tangent_at
from nccompile.geometry.tolerance import COINCIDENT
from nccompile.kernels.distance import place_on
from nccompile.passes.base import Context, Flags, Pass, bounded, gather, region
from nccompile.passes.edit import Draft, Links, Shape
from nccompile.passes.measure import deviation
from nccompile.toolpath.columns import Events, Floats, Kind, Mark, Plane, Toolpath
from nccompile.toolpath.lengths import THIRD_AXIS
from nccompile.units import rad_from_deg

__all__ = ["Corner", "CornerPass", "Filler", "Leg"]


class Filler(NamedTuple):
    """A piece of a corner: kind, end in X, Y, Z, curve, and its share of the corner's way."""

    kind: int
    end: Floats
    shape: Shape
    share: float


class Leg:
    """One row next to a corner; s runs in mm of its length from its start."""

    def __init__(self, path: Toolpath, i: int, start: Floats) -> None:
        self.kind = int(path.kind[i])
        self.start = start
        self.end = path.target[i]
        self.length = float(path.length[i])
        self.room = 0.5 * self.length  # how much a corner may cut off
        row = int(path.curve[i])
        self.plane = -1 if row < 0 else int(path.curves.plane[row])
        self.p: Floats = np.zeros(12) if row < 0 else path.curves.parameters[row]
        self._way = None if row < 0 else Way(self.kind, self.p.tolist())

    @property
    def is_line(self) -> bool:
        """Whether it is straight."""
        return self._way is None

    @property
    def is_flat(self) -> bool:
        """Whether it stays in a plane X-Y."""
        return self.plane in (-1, Plane.XY) and bool(self.start[2] == self.end[2])

    def _u(self, s: float) -> float:
        return s / self.length if self._way is None else self._way.parameter(s / self.length)

    def point(self, s: float) -> Floats:
        """X, Y, Z at s."""
        return np.array(place_on(self.kind, self.plane, self.p, self.start, self.end, self._u(s)))

    def tangent(self, s: float) -> Floats:
        """Unit tangent in X, Y, Z at s."""
        if self._way is None:
            step = (self.end - self.start)[:3]
            out: Floats = step / np.sqrt(step @ step)
            return out
        rise = 0.0
        if self.plane != Plane.SPACE and self._way.length > 0.0:
            third = THIRD_AXIS[self.plane]
            rise = float(self.end[third] - self.start[third]) / self._way.length
        return np.array(tangent_at(self.kind, self.plane, self.p, self._u(s), rise))

    def curvature(self, s: float) -> Floats:
        """Curvature vector in X, Y, Z at s [1/mm]."""
        if self._way is None:
            return np.zeros(3)
        slant = 1.0 if self.plane == Plane.SPACE else self._way.length / self.length
        return slant * slant * np.array(curvature_at(self.kind, self.plane, self.p, self._u(s)))

    def part(self, s0: float, s1: float) -> Shape | None:
        """The curve between two lengths."""
        if self._way is None:
            return None
        return self.plane, cut(self.kind, self.p.tolist(), self._u(s0), self._u(s1))

    def position(self, s: float) -> Floats:
        """All axes at s; Shape (k,)."""
        out: Floats = self.start + s / self.length * (self.end - self.start)
        out[:3] = self.point(s)
        return out


class Corner(NamedTuple):
    """A filled corner: length cut off the row before and off the row after, and its pieces."""

    before: float
    after: float
    pieces: list[Filler]


@dataclass(frozen=True)
class CornerPass(Pass):
    """Replaces corners sharper than `angle` [°]; `everywhere`: not only between its start mark and G50."""

    start_mark: ClassVar[int]
    angle: float = 1.0
    everywhere: bool = False

    def __post_init__(self) -> None:
        bounded("angle", self.angle, 0.0, 179.9, "degrees")

    @abstractmethod
    def fill(self, a: Leg, b: Leg, turn: float, d: float) -> Corner | None:
        """The corner between two rows that bend by `turn` [rad]; d: D in force [mm]; None: it stays."""

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module."""
        held: Toolpath | None = None
        inside = False
        trim = 0.0
        for chunk in gather(chunks):
            held = chunk if held is None else Toolpath.join([held, chunk])
            if len(held) > 1:
                out, trim = self._corners(held, len(held) - 1, inside, trim, context)
                _, inside = self._inside(held.rows(0, len(held) - 1), inside)
                yield out
                held = held.rows(len(held) - 1, len(held))
        if held is not None:
            yield self._corners(held, len(held), inside, trim, context)[0]

    def _inside(self, path: Toolpath, inside: bool) -> tuple[Flags, bool]:
        return region(path, self.start_mark, int(Mark.CORNER_STOP), inside)

    def _corners(
        self, path: Toolpath, count: int, inside: bool, trim: float, context: Context
    ) -> tuple[Toolpath, float]:
        """The first `count` rows; trim: length already cut off the first one.  Returns that of the next row, too."""
        flags, _ = self._inside(path, inside)
        sharp = _may_bend(path, flags | self.everywhere, rad_from_deg(self.angle))
        if not sharp[:count].any() and trim == 0.0:
            plain = path.rows(0, count)
            return plain.replace(mark=plain.mark & ~np.uint16(self.start_mark)), 0.0
        starts = path.starts()
        corners = [self._corner(path, starts, i, context) if sharp[i] else None for i in range(count)]
        last = corners[-1]
        draft = Draft(
            _share_of(path, starts[0], count, trim, 0.0 if last is None else last.after), self.start_mark
        )
        cut_off = trim
        for i, corner in enumerate(corners):
            _row(draft, i, starts[i], cut_off, corner)
            cut_off = 0.0 if corner is None else corner.after
            if corner is not None:
                _fill(draft, Leg(path, i, starts[i]), Leg(path, i + 1, starts[i + 1]), i, corner)
        out = draft.build()
        if context.measure:
            before = path.rows(0, count)
            if last is not None:
                before = path
            context.report.deviate(deviation(before, out, Links.from_rows(draft.links)))
        return out, cut_off

    def _corner(self, path: Toolpath, starts: Floats, i: int, context: Context) -> Corner | None:
        """The filled corner between rows i and i + 1, None if it stays."""
        a, b = Leg(path, i, starts[i]), Leg(path, i + 1, starts[i + 1])
        t0, t1 = a.tangent(a.length), b.tangent(0.0)
        cross = np.cross(t0, t1)
        turn = float(np.arctan2(np.sqrt(cross @ cross), t0 @ t1))
        if turn <= rad_from_deg(self.angle):
            return None
        # A row with marks must not vanish between two corners.
        a.room = a.length * (0.49 if path.mark[i] else 0.5)
        b.room = b.length * (0.49 if path.mark[i + 1] else 0.5)
        corner = self.fill(a, b, turn, float(path.radius[i]))
        context.report.counts["corners left" if corner is None else "corners"] += 1
        return corner


def _share_of(path: Toolpath, start: Floats, count: int, trim: float, ahead: float) -> Toolpath:
    """What a window has to write: its start, and events and marks of its rows, are told from its neighbours'.

    trim: length of row 0 that the window before wrote;  ahead: length of row `count` that this one writes.
    """
    e = path.events
    keep = e.segment <= count
    if trim > 0.0:
        keep &= (e.segment > 0) | (e.position > trim / path.length[0])
        start = Leg(path, 0, start).position(trim)
    mark = path.mark.copy()
    if count < len(path):
        keep &= (e.segment < count) | (e.position <= (ahead / path.length[count] if ahead else -1.0))
        mark[count:] = 0
    names = ("segment", "kind", "number", "position", "k", "l", "o")
    return path.replace(start=start, mark=mark, events=Events(*(getattr(e, name)[keep] for name in names)))


def _row(draft: Draft, i: int, start: Floats, s0: float, corner: Corner | None) -> None:
    """Writes row i from s0 to its cut before the corner that follows."""
    if s0 == 0.0 and corner is None:
        draft.copy(i)
        return
    leg = Leg(draft.source, i, start)
    s1 = leg.length - (0.0 if corner is None else corner.before)
    if s1 - s0 > COINCIDENT:
        target = draft.source.target[i] if corner is None else leg.position(s1)
        draft.add(leg.kind, target, leg.part(s0, s1), i, s0 / leg.length, s1 / leg.length)


def _fill(draft: Draft, a: Leg, b: Leg, i: int, corner: Corner) -> None:
    """Adds the pieces of the corner after row i, with their links to both rows."""
    begin, end = a.position(a.length - corner.before), b.position(corner.after)
    halves = ((i, 1.0 - corner.before / a.length, 1.0, 0.0), (i + 1, 0.0, corner.after / b.length, 0.5))
    done = 0.0
    for at, piece in enumerate(corner.pieces, 1):
        share = min(done + piece.share, 1.0) if at < len(corner.pieces) else 1.0
        target = end.copy()
        if at < len(corner.pieces):
            target = begin + share * (end - begin)
            target[:3] = piece.end
        row = len(draft)
        draft.insert(piece.kind, target, piece.shape, i)
        for segment, p0, p1, half in halves:
            low, high = max(done, half), min(share, half + 0.5)
            if low < high:
                v0, v1 = 2.0 * (low - half), 2.0 * (high - half)
                last = p1 if v1 == 1.0 else p0 + v1 * (p1 - p0)
                size = share - done
                draft.link(segment, p0 + v0 * (p1 - p0), last, row, (low - done) / size, (high - done) / size)
        done = share


def _may_bend(path: Toolpath, inside: Flags, angle: float) -> Flags:
    """Shape (n,): whether the end of row i may be a corner to fill; lines are decided here, at once."""
    n = len(path)
    out = np.zeros(n, np.bool_)
    if n < 2:
        return out
    steps = (path.target - path.starts())[:, :3]
    length = np.sqrt((steps * steps).sum(axis=1))
    straight = path.curve < 0
    usable = (path.kind >= Kind.LINE) & (path.kind <= Kind.POLYNOMIAL) & (path.profile == 0)
    usable &= (length > COINCIDENT) | (~straight & (path.length > COINCIDENT))
    usable &= inside
    dot = (steps[:-1] * steps[1:]).sum(axis=1)
    bends = dot < np.cos(angle) * length[:-1] * length[1:]
    out[:-1] = usable[:-1] & usable[1:] & (bends | ~straight[:-1] | ~straight[1:])
    return out
