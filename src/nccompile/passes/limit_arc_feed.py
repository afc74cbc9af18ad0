"""limit-arc-feed: bound the centripetal acceleration on arcs and its jump at their ends.

    v² |k| <= accel            =>  v <= sqrt(accel / |k|)          on every arc, |k| = 1 / r
    v <= per_radius sqrt(r)                                        the same, by the velocity at radius 1
    v² |k1 - k2| <= jump       =>  v <= sqrt(jump / |k1 - k2|)     where a line or arc meets an arc

                 k2: to the      k: curvature vector, 0 on a line, cos² of its slope / r on a helix.  At such a
               .-~   centre       junction the last hundredth of a millimetre of the first segment becomes a segment
    ─────────●'                   of its own with the lower feed, so the path passes the junction at that velocity:
      k1 = 0 ^ v_end              a decoded segment has no end velocity of its own.

(SoftMotion §6.2.7, SMC_LimitCircularVelocities: dMaxAcc, dMaxAccJump, dVmaxPerRadiusUnit; 0 = no check.)

Example:
    -p limit-arc-feed{accel=1000}
    --- in
    % t
    N10 G1 X10 F100
    N20 G3 X11 Y1 R1
    --- out
    line 10 0 0 feed 100 source 2
    arc 11 1 0 feed 31.622777 source 3 xy center 10 1 radius 1 start -1.570796 sweep 1.570796
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from nccompile.errors import UsageError
from nccompile.passes.base import Context, Flags, Pass, bounded, gather
from nccompile.passes.edit import Rows
from nccompile.passes.measure import deviation
from nccompile.passes.split import split_rows
from nccompile.toolpath.columns import Floats, Kind, Toolpath
from nccompile.toolpath.lengths import PLANE_AXES

__all__ = ["LimitArcFeed"]

_TAIL = 0.01
"""[mm] Length of the slow end of a segment before a junction, at most a quarter of the segment."""

_SHORTEST = 1e-6
"""[mm] A segment shorter than this is slowed as a whole."""


@dataclass(frozen=True)
class LimitArcFeed(Pass):
    """Lower feeds on arcs and before their ends; the path stays.

    accel [mm/s²], jump [mm/s²], per_radius [mm/s at a radius of 1 mm]; 0: no check;  feed: where neither the
    program nor the machine says one [mm/s].
    """

    name: ClassVar[str] = "limit-arc-feed"
    accel: float = 0.0
    jump: float = 0.0
    per_radius: float = 0.0
    feed: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in (("accel", "mm/s2"), ("jump", "mm/s2"), ("per_radius", "mm/s"), ("feed", "mm/s")):
            bounded(name.replace("_", "-"), getattr(self, name), 0.0, 1e9, unit)
        if not (self.accel or self.jump or self.per_radius):
            raise UsageError("give accel, jump or per-radius")

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module."""
        held: Toolpath | None = None
        for chunk in gather(chunks):
            limited = self._limited(chunk, context)
            if not self.jump:
                yield limited
                continue
            held = limited if held is None else Toolpath.join([held, limited])
            counting = _counting(held)
            last = int(counting[-1]) if len(counting) else 0
            if last:
                out = self._slowed(held, counting, context)
                yield out.rows(0, len(out) - len(held) + last)
                held = held.rows(last, len(held))
        if held is not None:
            yield held

    def _limited(self, path: Toolpath, context: Context) -> Toolpath:
        """The path with the feeds of its arcs limited."""
        arcs = (path.kind == Kind.ARC) & (path.length > 0.0)
        if not arcs.any():
            return path
        bend = _bend(path, np.flatnonzero(arcs))
        most = np.full(len(path), np.inf)
        if self.accel:
            most[arcs] = np.sqrt(self.accel / bend)
        if self.per_radius:
            most[arcs] = np.minimum(most[arcs], self.per_radius / np.sqrt(bend))
        lower: Flags = arcs & (most < self._feeds(path, context))
        context.report.counts["feeds lowered"] += int(lower.sum())
        return path.replace(feed=np.where(lower, most, path.feed))

    def _feeds(self, path: Toolpath, context: Context) -> Floats:
        default = self.feed or context.feed
        return np.where(path.feed > 0.0, path.feed, default if default > 0.0 else np.inf)

    def _slowed(self, path: Toolpath, counting: Rows, context: Context) -> Toolpath:
        """The path with slow ends before jumps of the curvature; counting: Shape (m,), rows that make junctions."""
        one, two = counting[:-1], counting[1:]
        step = _ends(path, two, 0.0) - _ends(path, one, 1.0)
        size = np.sqrt(step[:, 0] * step[:, 0] + step[:, 1] * step[:, 1] + step[:, 2] * step[:, 2])
        moving = (path.kind >= Kind.LINE) & (path.kind <= Kind.ARC)
        size[~(moving[one] & moving[two])] = 0.0
        with np.errstate(divide="ignore"):
            most = np.sqrt(self.jump / size)
        feeds = self._feeds(path, context)
        slow = most < np.minimum(feeds[one], feeds[two])
        if not slow.any():
            return path
        context.report.counts["junctions slowed"] += int(slow.sum())
        rows, most = one[slow], most[slow]
        length = path.length[rows]
        whole = (length <= _SHORTEST) | (path.profile[rows] != 0)
        feed = path.feed.copy()
        feed[rows[whole]] = most[whole]
        rows, length = rows[~whole], length[~whole]
        out, links, tails = split_rows(
            path.replace(feed=feed), rows, length - np.minimum(_TAIL, 0.25 * length)
        )
        feed = out.feed.copy()
        feed[tails] = most[~whole]
        if context.measure:
            context.report.deviate(deviation(path, out, links))
        return out.replace(feed=feed)


def _counting(path: Toolpath) -> Rows:
    """The rows between which there are junctions: those that move, and stops and jumps, which part them."""
    return np.flatnonzero((path.length > 0.0) | (path.kind > Kind.POLYNOMIAL))


def _bend(path: Toolpath, arcs: Rows) -> Floats:
    """The curvature [1/mm] of arcs: 1 / r, on a helix times the square of the slope's cosine."""
    p = path.curves.parameters[path.curve[arcs]]
    flat = p[:, 2] * np.abs(p[:, 4]) / path.length[arcs]
    return np.asarray(flat * flat / p[:, 2])


def _ends(path: Toolpath, rows: Rows, u: float) -> Floats:
    """The curvature vectors [1/mm] of rows in X, Y, Z at their start (u = 0) or end (1); 0 but on arcs."""
    out = np.zeros((len(rows), 3))
    arcs = np.flatnonzero(path.kind[rows] == Kind.ARC)
    curve = path.curve[rows[arcs]]
    p, plane, bend = path.curves.parameters[curve], path.curves.plane[curve], _bend(path, rows[arcs])
    angle = p[:, 3] + u * p[:, 4]
    for at, axes in PLANE_AXES.items():
        own = plane == at
        out[arcs[own], axes[0]] = -(bend * np.cos(angle))[own]
        out[arcs[own], axes[1]] = -(bend * np.sin(angle))[own]
    return out
