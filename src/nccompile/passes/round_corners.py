"""round-corners: an arc of radius r at every corner (SoftMotion §6.2.6, SMC_RoundPath; G52 .. G50).

    ●────────a──V              r: `radius`, or D of the row before the corner if that is 0
             `. │              two lines:  |aV| = |Vb| = r tan(turn / 2)
               `b              with curves: the centre C is r away from both rows,
                │                  A(s) + r n(s) = C = B(s') + r n(s'),   Newton in (s, s')
                ●              Cut to half the shorter neighbour: r is lowered until both cuts fit

With distance=true, r is the distance |aV| itself, as the manual's text has it; at a right angle between
lines both are the same.  In a plane parallel to X-Y the corner is an arc; between lines in space it is
cubics off the arc by less than 3e-4 r.  Corners between curves that leave the plane stay.

Example:
    -p round-corners
    --- in
    % t
    N10 G52 D2
    N20 G1 X10 F50
    N30 G1 Y10
    N40 G50
    --- out
    line 8 0 0 feed 50 tool_radius 2 source 3
    arc 10 2 0 feed 50 tool_radius 2 source 3 xy center 8 2 radius 2 start -1.570796 sweep 1.570796
    line 10 10 0 feed 50 tool_radius 2 mark 8 source 4
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, pi, tan
from typing import ClassVar

import numpy as np

from nccompile.geometry.corners import space_arc
from nccompile.geometry.parts import arc_row
from nccompile.passes.base import bounded
from nccompile.passes.corners import Corner, CornerPass, Filler, Leg
from nccompile.toolpath.columns import Floats, Kind, Mark, Plane

__all__ = ["RoundCorners"]

_SHARPEST = pi - 1e-3
"""A path that turns back has no arc that touches both ways."""

_SHORTEST = 1e-6
"""[mm] Cuts below this are not worth a segment."""

_STEPS = 30
_REACHED = 1e-12
_TRIES = 40


@dataclass(frozen=True)
class RoundCorners(CornerPass):
    """Arcs in corners.  radius: of the arc [mm], 0: D;  distance: it is the distance from the corner."""

    name: ClassVar[str] = "round-corners"
    start_mark: ClassVar[int] = int(Mark.ROUND)
    radius: float = 0.0
    distance: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        bounded("radius", self.radius, 0.0, 1e6, "mm")

    def fill(self, a: Leg, b: Leg, turn: float, d: float) -> Corner | None:
        """See the module."""
        wanted = self.radius or d
        room = min(a.room, b.room)
        if wanted <= 0.0 or turn > _SHARPEST or room <= _SHORTEST:
            return None
        half = tan(0.5 * turn)
        reach = min(wanted if self.distance else wanted * half, room)
        if reach <= _SHORTEST:
            return None
        if a.is_line and b.is_line:
            return _of_lines(a, b, turn, reach)
        return _of_curves(a, b, reach / half) if a.is_flat and b.is_flat else None


def _of_lines(a: Leg, b: Leg, turn: float, reach: float) -> Corner:
    """The arc that touches both lines `reach` from their corner."""
    p0, p1 = a.point(a.length - reach), b.point(reach)
    t0, t1 = a.tangent(0.0), b.tangent(0.0)
    radius = reach / tan(0.5 * turn)
    inward = (t1 - t0 * float(t0 @ t1)) / np.sin(turn)
    center = p0 + radius * inward
    if a.is_flat and b.is_flat:
        return Corner(reach, reach, [_arc(p0, p1, center, float(t0[0] * t1[1] - t0[1] * t1[0]) > 0.0)])
    pieces = []
    count = ceil(turn / (0.5 * pi) - 1e-9)
    before, along = p0, t0
    for i in range(1, count + 1):
        c, s = np.cos(turn * i / count), np.sin(turn * i / count)
        end = p1 if i == count else center - radius * (c * inward - s * t0)
        ahead = c * t0 + s * inward
        cubic = space_arc(before, along, end, ahead, turn / count)
        pieces.append(Filler(Kind.POLYNOMIAL, end, (int(Plane.SPACE), cubic.ravel().tolist()), 1.0 / count))
        before, along = end, ahead
    return Corner(reach, reach, pieces)


def _arc(p0: Floats, p1: Floats, center: Floats, left: bool) -> Filler:
    """The arc in X-Y from p0 to p1; its centre is moved onto their bisector, so that both ends are exact."""
    x0, y0, x1, y1 = float(p0[0]), float(p0[1]), float(p1[0]), float(p1[1])
    dx, dy = x1 - x0, y1 - y0
    off = ((float(center[0]) - x0 - 0.5 * dx) * dx + (float(center[1]) - y0 - 0.5 * dy) * dy) / (
        dx * dx + dy * dy
    )
    row = arc_row(x0, y0, x1, y1, float(center[0]) - off * dx, float(center[1]) - off * dy, left)
    return Filler(Kind.ARC, p1, (int(Plane.XY), row), 1.0)


def _of_curves(a: Leg, b: Leg, radius: float) -> Corner | None:
    """The arc of the greatest radius up to `radius` that touches both rows within their room."""
    good, low, high = None, 0.0, radius
    for tries in range(_TRIES):
        found = _touch(a, b, radius)
        if found is not None:
            good, low = found, radius
            if radius == high:
                break
        else:
            high = radius
        if good is not None and (high - low <= 1e-3 * high or tries > 24):
            break
        radius = 0.5 * (low + high)
        if radius < _SHORTEST:
            break
    return good


def _touch(a: Leg, b: Leg, radius: float) -> Corner | None:
    """The arc of this radius, None if Newton does not find it within the room of both rows."""
    t0, t1 = a.tangent(a.length), b.tangent(0.0)
    side = 1.0 if t0[0] * t1[1] - t0[1] * t1[0] > 0.0 else -1.0
    turn = float(np.arctan2(abs(t0[0] * t1[1] - t0[1] * t1[0]), t0 @ t1))
    cut = min(radius * tan(0.5 * turn), a.room, b.room)
    sa, sb = a.length - cut, cut
    for _ in range(_STEPS):
        pa, ta, ka = a.point(sa)[:2], a.tangent(sa)[:2], a.curvature(sa)[:2]
        pb, tb, kb = b.point(sb)[:2], b.tangent(sb)[:2], b.curvature(sb)[:2]
        na, nb = side * np.array([-ta[1], ta[0]]), side * np.array([-tb[1], tb[0]])
        miss = pa + radius * na - pb - radius * nb
        if float(np.abs(miss).max()) <= _REACHED * (1.0 + radius + float(np.abs(pa).max())):
            if not (a.length - a.room <= sa < a.length and 0.0 < sb <= b.room):
                return None
            p0, p1 = a.point(sa), b.point(sb)
            middle = 0.5 * (pa + radius * na + pb + radius * nb)
            arc = _arc(p0, p1, middle, side > 0.0)
            return Corner(a.length - sa, sb, [arc]) if abs(arc.shape[1][4]) < pi else None
        ja = ta * (1.0 - radius * float(ka @ na))
        jb = -tb * (1.0 - radius * float(kb @ nb))
        det = float(ja[0] * jb[1] - ja[1] * jb[0])
        if abs(det) < 1e-12:
            return None
        sa = min(max(sa - float(miss[0] * jb[1] - miss[1] * jb[0]) / det, a.length - 2.0 * a.room), a.length)
        sb = min(max(sb - float(ja[0] * miss[1] - ja[1] * miss[0]) / det, 0.0), b.length)
    return None
