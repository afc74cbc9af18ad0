"""What round-corners and smooth-corners share: finding corners, cutting their neighbours, building the rows.

      ●───────────┐            before:  row i ends, row i + 1 begins in the corner
                  │            after:   row i up to its cut, pieces of the corner, row i + 1 from its cut
                  ●
      ●───────╮                     a: length cut off the end of i      b: off the start of i + 1
           a  │ b              Each row is cut by at most half its length at each end, so the corners do not
              ●                meet and every corner depends on its two rows alone.

The first half of the corner's way stands for the end of row i, the second for the start of row i + 1: switch
points pass it at the same share.  Additional axes run evenly through it.  Positionings, stops (dwell, M), set
positions, rows in the S-profile and rows that move additional axes only are never cut.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from nccompile.geometry.tolerance import COINCIDENT
from nccompile.kernels import expect_work
from nccompile.kernels import legs as kernels
from nccompile.passes.base import Context, Flags, Pass, bounded, gather, region
from nccompile.passes.edit import Geometry, Links, compose, geometry
from nccompile.passes.measure import deviation
from nccompile.toolpath.columns import (
    CURVE_PARAMETERS,
    Bytes,
    Curves,
    Events,
    Floats,
    Kind,
    Mark,
    Plane,
    Toolpath,
)
from nccompile.toolpath.lengths import PLANE_AXES
from nccompile.units import rad_from_deg

__all__ = ["CornerPass", "Fillings", "Legs"]

Whole = npt.NDArray[np.int64]

_A_CORNER = 3
_MORE = 12

_HALF, _MARKED = 0.5, 0.49
"""What a corner may cut off a row; one with marks must not vanish between two corners."""


class Legs(NamedTuple):
    """The rows of a stretch: their geometry, length [mm], what a corner may cut off each [mm], and D [mm]."""

    geometry: Geometry
    length: Floats
    room: Floats
    d: Floats


class Fillings(NamedTuple):
    """Corners behind the rows of a stretch, as the kernels fill them (`kernels.blends.blend_corners`)."""

    before: Floats
    after: Floats
    found: Bytes
    pieces: Whole
    kind: Bytes
    plane: Whole
    rows: Floats
    size: Floats

    @classmethod
    def empty(cls, n: int, pieces: int) -> Fillings:
        """No corners yet behind n rows, and room for the pieces."""
        return cls(
            np.zeros(n), np.zeros(n), np.zeros(n, np.uint8), np.zeros(n, np.int64), np.zeros(pieces, np.uint8),
            np.zeros(pieces, np.int64), np.zeros((pieces, CURVE_PARAMETERS)), np.zeros(pieces),
        )  # fmt: skip


@dataclass(frozen=True)
class CornerPass(Pass):
    """Replaces corners sharper than `angle` [°]; `everywhere`: not only between its start mark and G50."""

    start_mark: ClassVar[int]
    angle: float = 1.0
    everywhere: bool = False

    def __post_init__(self) -> None:
        bounded("angle", self.angle, 0.0, 179.9, "degrees")

    @abstractmethod
    def fill(self, legs: Legs, may: Flags, out: Fillings) -> int:
        """Fills the corners behind the rows of which `may` is set; the number of pieces, -1 if they do not fit."""

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module."""
        held: Toolpath | None = None
        inside = False
        trim = 0.0
        for chunk in gather(chunks):
            expect_work(context.report.segments_in)
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
        may = _may_bend(path, flags | self.everywhere, rad_from_deg(self.angle))
        if not may.any() and trim == 0.0:
            plain = path.rows(0, count)
            return plain.replace(mark=plain.mark & ~np.uint16(self.start_mark)), 0.0
        corners = self._filled(path, may)
        context.report.counts["corners"] += int((corners.found == kernels.CORNER).sum())
        context.report.counts["corners left"] += int((corners.found == kernels.LEFT).sum())
        out, links = _rebuilt(path, count, trim, corners, self.start_mark)
        ahead = float(corners.after[count - 1])
        if context.measure and count:
            before, links = _trimmed(path, count, trim, ahead, links)
            context.report.deviate(deviation(before, out, links))
        return out, ahead

    def _filled(self, path: Toolpath, may: Flags) -> Fillings:
        room = path.length * np.where(path.mark != 0, _MARKED, _HALF)
        legs = Legs(geometry(path), path.length, room, path.radius)
        most = _A_CORNER * int(may.sum()) + _MORE
        while True:
            corners = Fillings.empty(len(path), most)
            used = self.fill(legs, may, corners)
            if used >= 0:
                return corners._replace(
                    kind=corners.kind[:used], plane=corners.plane[:used], rows=corners.rows[:used],
                    size=corners.size[:used],
                )  # fmt: skip
            most *= 4


def _trimmed(path: Toolpath, count: int, trim: float, ahead: float, links: Links) -> tuple[Toolpath, Links]:
    """The part of the path that a window writes: row 0 from `trim` on, `ahead` of row `count`; and links to it."""
    n = count + (ahead > 0.0)
    part = path.rows(0, n)
    s0, s1 = np.zeros(n), part.length.copy()
    s0[0] = trim
    s1[count:] = ahead
    edges = np.flatnonzero((s0 > 0.0) | (s1 < part.length))
    rows, low, high = (np.zeros((len(edges), width)) for width in (CURVE_PARAMETERS, 3, 3))
    kernels.cut_legs(*geometry(part), part.length, edges, s0[edges], s1[edges], rows, low, high)
    start, target, parameters = part.start.copy(), part.target.copy(), part.curves.parameters.copy()
    if trim > 0.0:
        start[:3] = low[0]
    if ahead > 0.0:
        target[-1, :3] = high[-1]
    for edge, row in zip(edges, rows, strict=True):
        if part.curve[edge] >= 0:
            parameters[part.curve[edge]] = row
    size, at = np.where(s1 > s0, s1 - s0, 1.0), links.segment
    p0, p1 = ((p * part.length[at] - s0[at]) / size[at] for p in (links.p0, links.p1))
    part = part.replace(
        start=start, target=target, curves=Curves(part.curves.plane, parameters), length=s1 - s0
    )
    return part, Links(at, np.clip(p0, 0.0, 1.0), np.clip(p1, 0.0, 1.0), links.row, links.q0, links.q1)


class _Cuts(NamedTuple):
    """Where rows are cut: from s0 to s1 [mm] of their length.

    touched: which rows are;  rows: their curve rows;  start, end: positions at s0 and s1, all axes;  each Shape
    (m, ...) for the m touched rows, found by place: Shape (n,).
    """

    s0: Floats
    s1: Floats
    touched: Flags
    place: Whole
    rows: Floats
    start: Floats
    end: Floats


def _cuts(path: Toolpath, count: int, trim: float, corners: Fillings) -> _Cuts:
    """The cuts of the first `count` rows, and of the next one if a corner reaches into it."""
    s0 = np.concatenate([[trim], corners.after[:-1]])
    s1 = path.length - corners.before
    touched = (s0 > 0.0) | (corners.before > 0.0)
    picked = np.flatnonzero(touched)
    rows, low, high = (
        np.empty((len(picked), CURVE_PARAMETERS)),
        np.empty((len(picked), 3)),
        np.empty((len(picked), 3)),
    )
    kernels.cut_legs(*geometry(path), path.length, picked, s0[picked], s1[picked], rows, low, high)
    starts = path.starts()[picked]
    step = (path.target[picked] - starts) / path.length[picked, None]
    start, end = starts + s0[picked, None] * step, starts + s1[picked, None] * step
    start[:, :3], end[:, :3] = low, high
    whole = s1[picked] == path.length[picked]
    end[whole] = path.target[picked[whole]]
    return _Cuts(s0, s1, touched, np.cumsum(touched) - 1, rows, start, end)


def _rebuilt(
    path: Toolpath, count: int, trim: float, corners: Fillings, start_mark: int
) -> tuple[Toolpath, Links]:
    """The first `count` rows with their corners filled, and what became of what."""
    cuts = _cuts(path, count, trim, corners)
    s0, s1 = cuts.s0[:count], cuts.s1[:count]
    kept = ~cuts.touched[:count] | (s1 - s0 > COINCIDENT)
    pieces = corners.pieces[:count]
    slots = kept + pieces
    first = np.cumsum(slots) - slots
    owner = np.repeat(np.arange(count), pieces)
    at = np.repeat(first + kept - (np.cumsum(pieces) - pieces), pieces) + np.arange(len(owner))

    n, k = int(slots.sum()), path.target.shape[1]
    kind, target, shape = np.empty(n, np.uint8), np.empty((n, k)), np.full(n, -1, np.int32)
    known = np.zeros(n)
    rows = np.flatnonzero(kept)
    place = first[rows]
    kind[place], target[place], shape[place] = path.kind[rows], path.target[rows], path.curve[rows]
    cut = rows[cuts.touched[rows]]
    where = cuts.place[cut]
    target[first[cut]] = cuts.end[where]
    curved = path.curve[cut] >= 0
    shape[first[cut[curved]]] = len(path.curves) + where[curved]
    kind[at], known[at] = corners.kind, corners.size
    shape[at] = len(path.curves) + len(cuts.rows) + np.arange(len(owner))
    done, share = _shares(corners, owner)
    target[at] = _ends(corners, owner, share, cuts)
    curves = Curves(
        np.concatenate([
            path.curves.plane, _planes(path, cuts), corners.plane.astype(np.uint8),
        ]),
        np.vstack([path.curves.parameters, cuts.rows, corners.rows]),
    )  # fmt: skip
    links = _links(path, corners, kept, first, (owner, at, done, share), cuts)
    source = _share_of(path, count, trim, cuts)
    origin = np.repeat(np.arange(count), slots)
    return compose(source, origin, kind, target, shape, curves, links, clear=start_mark, known=known), links


def _planes(path: Toolpath, cuts: _Cuts) -> Bytes:
    """The planes of the touched rows, X-Y for those that have none."""
    curve = path.curve[cuts.touched]
    planes = np.zeros(len(curve), np.uint8)
    planes[curve >= 0] = path.curves.plane[curve[curve >= 0]]
    return planes


def _shares(corners: Fillings, owner: npt.NDArray[np.intp]) -> tuple[Floats, Floats]:
    """The shares of its corner's way at which each piece begins and ends; the last ends at 1."""
    if not len(owner):
        return np.zeros(0), np.zeros(0)
    fresh = np.diff(owner, prepend=-1) != 0
    whole = np.bincount(owner, corners.size, minlength=len(corners.pieces))[owner]
    done, share = np.zeros(len(owner)), corners.size / np.where(whole > 0.0, whole, 1.0)
    ordinal = np.arange(len(owner)) - np.maximum.accumulate(np.where(fresh, np.arange(len(owner)), 0))
    for place in range(1, int(ordinal.max()) + 1):
        later = np.flatnonzero(ordinal == place)
        done[later] = share[later - 1]
        share[later] += done[later]
    share[np.append(fresh[1:], True)] = 1.0
    return done, share


def _ends(corners: Fillings, owner: npt.NDArray[np.intp], share: Floats, cuts: _Cuts) -> Floats:
    """The end positions of the pieces, Shape (m, k): evenly spread on additional axes."""
    begin, end = cuts.end[cuts.place[owner]], cuts.start[cuts.place[owner + 1]]
    target = begin + share[:, None] * (end - begin)
    inner = share < 1.0
    c = corners.rows.reshape(-1, 3, 4)
    sums = c[:, :, 0] + c[:, :, 1] + c[:, :, 2] + c[:, :, 3]
    for plane, axes in ((Plane.SPACE, (0, 1, 2)), *PLANE_AXES.items()):
        own = np.flatnonzero(inner & (corners.plane == plane))
        for i, axis in enumerate(axes):
            target[own, axis] = sums[own, i]
    target[~inner] = end[~inner]
    return np.asarray(target)


def _links(
    path: Toolpath, corners: Fillings, kept: Flags, first: Whole,
    pieces: tuple[npt.NDArray[np.intp], Whole, Floats, Floats], cuts: _Cuts,
) -> Links:  # fmt: skip
    """Rows went to what is kept of them, their ends to the halves of the corners."""
    rows = np.flatnonzero(kept)
    length = np.where(path.length > 0.0, path.length, 1.0)
    whole = ~cuts.touched[rows]
    p0 = np.where(whole, 0.0, cuts.s0[rows] / length[rows])
    p1 = np.where(whole, 1.0, cuts.s1[rows] / length[rows])
    parts = [Links(rows, p0, p1, first[rows], np.zeros(len(rows)), np.ones(len(rows)))]
    owner, at, done, share = pieces
    none = np.zeros(len(owner))
    for half, segment, p0, p1 in (
        (0.0, owner, 1.0 - corners.before[owner] / length[owner], none + 1.0),
        (0.5, owner + 1, none, corners.after[owner] / length[owner + 1]),
    ):
        low, high = np.maximum(done, half), np.minimum(share, half + 0.5)
        own = np.flatnonzero(low < high)
        low, high, p0, p1 = low[own], high[own], p0[own], p1[own]
        v0, v1 = 2.0 * (low - half), 2.0 * (high - half)
        last = np.where(v1 == 1.0, p1, p0 + v1 * (p1 - p0))
        size, begin = (share - done)[own], done[own]
        parts.append(
            Links(
                segment[own], p0 + v0 * (p1 - p0), last, at[own], (low - begin) / size, (high - begin) / size
            )
        )
    return Links.merged(parts)


def _share_of(path: Toolpath, count: int, trim: float, cuts: _Cuts) -> Toolpath:
    """What a window has to write: its start, and events and marks of its rows, are told from its neighbours'.

    trim: length of row 0 that the window before wrote;  a corner may reach into row `count`.
    """
    e = path.events
    keep = e.segment <= count
    start = path.start
    if trim > 0.0:
        keep &= (e.segment > 0) | (e.position > trim / path.length[0])
        start = cuts.start[0]
    mark = path.mark.copy()
    if count < len(path):
        ahead = float(cuts.s0[count])
        keep &= (e.segment < count) | (e.position <= (ahead / path.length[count] if ahead else -1.0))
        mark[count:] = 0
    names = ("segment", "kind", "number", "position", "k", "l", "o")
    return path.replace(start=start, mark=mark, events=Events(*(getattr(e, name)[keep] for name in names)))


def _may_bend(path: Toolpath, inside: Flags, angle: float) -> Flags:
    """Shape (n,): whether the end of row i may be a corner to fill; lines are decided here, at once."""
    n = len(path)
    out = np.zeros(n, np.bool_)
    if n < 2:
        return out
    steps = (path.target - path.starts())[:, :3]
    x, y, z = steps[:, 0], steps[:, 1], steps[:, 2]
    length = np.sqrt(x * x + y * y + z * z)
    straight = path.curve < 0
    usable = (path.kind >= Kind.LINE) & (path.kind <= Kind.POLYNOMIAL) & (path.profile == 0)
    usable &= (length > COINCIDENT) | (~straight & (path.length > COINCIDENT))
    usable &= inside
    dot = x[:-1] * x[1:] + y[:-1] * y[1:] + z[:-1] * z[1:]
    bends = dot < np.cos(angle) * length[:-1] * length[1:]
    out[:-1] = usable[:-1] & usable[1:] & (bends | ~straight[:-1] | ~straight[1:])
    return out
