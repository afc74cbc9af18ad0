"""limit-arc-feed: bound the centripetal acceleration on arcs and its jump at their ends.

    v² / r <= accel            =>  v <= sqrt(accel r)              on every arc
    v <= per_radius sqrt(r)                                        the same, by the velocity at radius 1
    v² |k1 - k2| <= jump       =>  v <= sqrt(jump / |k1 - k2|)     where a line or arc meets an arc

                 k2 = 1/r           k: signed curvature, 0 on a line, + turns left.  At such a junction the
               .-~                  last millimetre part of the first segment becomes a segment of its own
    ─────────●'                     with the lower feed, so the path passes the junction at that velocity:
      k1 = 0 ^ v_end                a decoded segment has no end velocity of its own.

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
from nccompile.passes.edit import Draft
from nccompile.passes.split import part_of, place_at
from nccompile.toolpath.columns import Floats, Kind, Toolpath

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
            if len(held) > 1:
                yield self._slowed(held, context)
                held = held.rows(len(held) - 1, len(held))
        if held is not None:
            yield held

    def _limited(self, path: Toolpath, context: Context) -> Toolpath:
        """The path with the feeds of its arcs limited."""
        arcs = path.kind == Kind.ARC
        if not arcs.any():
            return path
        radius = np.ones(len(path))
        radius[arcs] = path.curves.parameters[path.curve[arcs], 2]
        most = np.full(len(path), np.inf)
        if self.accel:
            most = np.sqrt(self.accel * radius)
        if self.per_radius:
            most = np.minimum(most, self.per_radius * np.sqrt(radius))
        default = self.feed or context.feed
        now = np.where(path.feed > 0.0, path.feed, default if default > 0.0 else np.inf)
        lower: Flags = arcs & (most < now)
        context.report.counts["feeds lowered"] += int(lower.sum())
        return path.replace(feed=np.where(lower, most, path.feed))

    def _slowed(self, path: Toolpath, context: Context) -> Toolpath:
        """All rows but the last, with slow ends before jumps of the curvature."""
        n = len(path)
        left = _signed_curvature(path)
        step = np.abs(left[1:] - left[:-1])
        moving = (path.kind >= Kind.LINE) & (path.kind <= Kind.ARC)
        either = (path.kind[1:] == Kind.ARC) | (path.kind[:-1] == Kind.ARC)
        step = np.where(moving[1:] & moving[:-1] & either, step, 0.0)
        with np.errstate(divide="ignore"):
            most = np.sqrt(self.jump / step)
        default = self.feed or context.feed
        feeds = np.where(path.feed > 0.0, path.feed, default if default > 0.0 else np.inf)
        slow = most < np.minimum(feeds[:-1], feeds[1:])
        if not slow.any():
            return path.rows(0, n - 1)
        context.report.counts["junctions slowed"] += int(slow.sum())
        draft = Draft(path.rows(0, n - 1))
        for i in range(n - 1):
            if slow[i]:
                self._end(draft, i, float(most[i]))
            else:
                draft.copy(i)
        return draft.build()

    def _end(self, draft: Draft, i: int, feed: float) -> None:
        """Row i, its last part at the lower feed."""
        s = draft.source
        length = float(s.length[i])
        if length <= _SHORTEST or s.profile[i]:
            draft.copy(i)
            draft.feed[len(draft) - 1] = feed
            return
        at = 1.0 - min(_TAIL, 0.25 * length) / length
        kind = int(s.kind[i])
        draft.add(kind, place_at(s, i, at), part_of(s, i, 0.0, at), i, 0.0, at)
        draft.add(kind, s.target[i], part_of(s, i, at, 1.0), i, at, 1.0)
        draft.feed[len(draft) - 1] = feed


def _signed_curvature(path: Toolpath) -> Floats:
    """1/r with the sign of the sweep on arcs, 0 on lines. Shape (n,)."""
    out = np.zeros(len(path))
    arcs = np.flatnonzero(path.kind == Kind.ARC)
    p = path.curves.parameters[path.curve[arcs]]
    out[arcs] = np.sign(p[:, 4]) / p[:, 2]
    return out
