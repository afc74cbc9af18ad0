"""smooth-corners: a spline of continuous direction and curvature at every corner (SoftMotion §6.2.5; G51 .. G50).

●────────a──V          |aV| = |Vb| = distance: `distance` + D of the row before the corner,
         `, │                         at most half the shorter neighbour
           ', b        two lines:    one cubic with control points a, V, V, b (curvature 0 at both ends)
            │          with curves:  three cubics, C2 inside, with tangent and curvature of the rows at
            ●                        a and b (kernels/blends.py)

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

from nccompile.kernels.blends import blend_corners
from nccompile.passes.base import Flags, bounded
from nccompile.passes.corners import CornerPass, Fillings, Legs
from nccompile.toolpath.columns import Mark
from nccompile.units import rad_from_deg

__all__ = ["SmoothCorners"]


@dataclass(frozen=True)
class SmoothCorners(CornerPass):
    """Splines in corners.  distance: added to D [mm], at which both rows are cut."""

    name: ClassVar[str] = "smooth-corners"
    start_mark: ClassVar[int] = int(Mark.SMOOTH)
    distance: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        bounded("distance", self.distance, 0.0, 1e6, "mm")

    def fill(self, legs: Legs, may: Flags, out: Fillings) -> int:
        """See the module."""
        return blend_corners(
            *legs.geometry, legs.length, legs.room, may, legs.d + self.distance, rad_from_deg(self.angle), out.before,
            out.after, out.found, out.pieces, out.kind, out.plane, out.rows, out.size,
        )  # fmt: skip
