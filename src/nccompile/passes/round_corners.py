"""round-corners: an arc of radius r at every corner (SoftMotion §6.2.6, SMC_RoundPath; G52 .. G50).

    ●────────a──V              r: `radius`, or D of the row before the corner if that is 0
             `. │              two lines:  |aV| = |Vb| = r tan(turn / 2)
               `b              with curves: the centre C is r away from both rows,
                │                  A(s) + r n(s) = C = B(s') + r n(s'),   Newton in (s, s')
                ●              Cut to half the shorter neighbour: r is lowered until both cuts fit

The path misses the corner by at most r: at turns above 120 degrees, where an arc of radius r would miss it by more,
the arc is smaller.  With distance=true, r is the distance |aV| itself, as the manual's text has it; at a right angle
between lines both are the same.

In a plane parallel to X-Y, Z-X or Y-Z the corner is an arc.  Between lines in space it is cubics within `tolerance`
of the arc.  Curves that leave such a plane (helices, curves in space) have in general no arc that touches both: there
the corner is a spline of continuous direction and curvature between cuts at the distance |aV| of the tangents.

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
from typing import ClassVar

import numpy as np

from nccompile.kernels.fillets import round_corners
from nccompile.passes.base import Flags, bounded
from nccompile.passes.corners import CornerPass, Fillings, Legs
from nccompile.toolpath.columns import Mark
from nccompile.units import rad_from_deg

__all__ = ["RoundCorners"]


@dataclass(frozen=True)
class RoundCorners(CornerPass):
    """Arcs in corners.

    radius: of the arc [mm], 0: D;  distance: it is the distance from the corner;  tolerance: of arcs in tilted
    planes [mm].
    """

    name: ClassVar[str] = "round-corners"
    start_mark: ClassVar[int] = int(Mark.ROUND)
    radius: float = 0.0
    distance: bool = False
    tolerance: float = 0.001

    def __post_init__(self) -> None:
        super().__post_init__()
        bounded("radius", self.radius, 0.0, 1e6, "mm")
        bounded("tolerance", self.tolerance, 1e-6, 1.0, "mm")

    def fill(self, legs: Legs, may: Flags, out: Fillings) -> int:
        """See the module."""
        wanted = np.full(len(may), self.radius) if self.radius else legs.d
        return round_corners(
            *legs.geometry, legs.length, legs.room, may, wanted, self.distance, self.tolerance,
            rad_from_deg(self.angle), out.before, out.after, out.found, out.pieces, out.kind, out.plane, out.rows,
            out.size,
        )  # fmt: skip
