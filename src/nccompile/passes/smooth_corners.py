"""smooth-corners: a spline of continuous direction and curvature at every corner (SoftMotion §6.2.5; G51 .. G50).

●────────a──V          |aV| = |Vb| = distance: `distance` + D of the row before the corner,
         `, │                         at most half the shorter neighbour
           ', b        two lines:    one cubic with control points a, V, V, b (curvature 0 at both ends)
            │          with curves:  three cubics, C2 inside, with tangent and curvature of the rows at
            ●                        a and b (geometry/corners.py)

Example:
    -p smooth-corners{distance=2,everywhere}
    --- in
    % t
    N10 G1 X10 F50
    N20 G1 Y10
    --- out
    line 8 0 0 feed 50 source 2
    polynomial 10 2 0 feed 50 source 2 xy u 8 6 -6 2 v 0 0 0 2
    line 10 10 0 feed 50 source 3
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from nccompile.geometry.corners import blend, blend_of_lines
from nccompile.passes.base import bounded
from nccompile.passes.corners import Corner, CornerPass, Filler, Leg
from nccompile.toolpath.columns import Floats, Kind, Mark, Plane

__all__ = ["SmoothCorners"]

_SHORTEST = 1e-6
"""[mm] Cuts below this are not worth a segment."""

_SHARPEST = np.pi - 1e-3


@dataclass(frozen=True)
class SmoothCorners(CornerPass):
    """Splines in corners.  distance: added to D [mm], at which both rows are cut."""

    name: ClassVar[str] = "smooth-corners"
    start_mark: ClassVar[int] = int(Mark.SMOOTH)
    distance: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        bounded("distance", self.distance, 0.0, 1e6, "mm")

    def fill(self, a: Leg, b: Leg, turn: float, d: float) -> Corner | None:
        """See the module."""
        reach = min(self.distance + d, a.room, b.room)
        if reach <= _SHORTEST or turn > _SHARPEST:
            return None
        corner = b.point(0.0)
        sa, sb = a.length - _cut(a, corner, reach, True), _cut(b, corner, reach, False)
        p0, p1 = a.point(sa), b.point(sb)
        if a.is_line and b.is_line:
            cubics = blend_of_lines(p0, corner, p1)
        else:
            size = a.length - sa + sb
            chord = float(np.sqrt((p1 - p0) @ (p1 - p0)))
            cubics = blend(
                p0, a.tangent(sa), a.curvature(sa), p1, b.tangent(sb), b.curvature(sb), 0.5 * (size + chord)
            )
        flat = a.is_flat and b.is_flat
        share = 1.0 / len(cubics)
        return Corner(a.length - sa, sb, [_piece(c, flat, share) for c in cubics])


def _piece(c: Floats, flat: bool, share: float) -> Filler:
    plane = Plane.XY if flat else Plane.SPACE
    return Filler(Kind.POLYNOMIAL, c.sum(axis=1), (int(plane), c[: 2 if flat else 3].ravel().tolist()), share)


def _cut(leg: Leg, corner: Floats, reach: float, at_end: bool) -> float:
    """The length to cut off so that the cut is `reach` from the corner, at most the leg's room."""
    if leg.is_line:
        return reach
    low, high = 0.0, leg.room
    for _ in range(50):
        middle = 0.5 * (low + high)
        off = leg.point(leg.length - middle if at_end else middle) - corner
        if float(off @ off) < reach * reach:
            low = middle
        else:
            high = middle
    return high
