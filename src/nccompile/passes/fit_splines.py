"""fit-splines: runs of small lines become C2 cubic splines within a tolerance.

    in    ●──●──●──●                 out   ●─────────.     cubics with continuous direction and curvature; the first
                    `●                                `-    and the last vertex of a run are met exactly, in the
                      `●──●                              ●  direction of its first and last chord

    h(t) = distance of chord and spline <= tolerance at every t: see kernels/spline_errors.py

A corner ends a spline: it keeps its place, and both directions in which the chords meet there.  Where only the
lengths of the chords break the run, both sides take the direction of the longer one.  Where the feed or a mark
changes, or a run is cut because it is long, the vertex stays and the spline is C2 across it.

In X-Y if Z stands still along the run, else in space.  Additional axes must move linearly with the way within
the same number along each piece.  A run without a spline of fewer pieces than lines stays as it is.

Example:
    -p fit-splines{tolerance=0.01}
    --- in
    % t
    N10 G1 X1 Y0.195090 F50
    N20 G1 X2 Y0.382683
    N30 G1 X3 Y0.555570
    N40 G1 X4 Y0.707107
    N50 G1 X5 Y0.831470
    --- out
    polynomial 5 0.83147 0 feed 50 source 2 xy u 0 5.466792 -1.488033 1.021241 v 0 1.066516 -0.329391 0.094344
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from nccompile.kernels import spline_runs as kernels
from nccompile.passes.base import Context, Pass, bounded
from nccompile.passes.runs import Pieces, Window, fit_stream, put_in
from nccompile.toolpath.columns import CURVE_PARAMETERS, Kind, Plane, Toolpath
from nccompile.units import rad_from_deg

__all__ = ["FitSplines"]


@dataclass(frozen=True)
class FitSplines(Pass):
    """Cubic splines for lines.

    tolerance: greatest distance, both ways [mm];  angle: sharper corners stay [°];  ratio: a segment this many
    times as long as its neighbour ends a run;  least: lines a spline replaces at least.
    """

    name: ClassVar[str] = "fit-splines"
    tolerance: float = 0.005
    angle: float = 30.0
    ratio: float = 12.0
    least: int = 4

    def __post_init__(self) -> None:
        bounded("tolerance", self.tolerance, 1e-6, 10.0, "mm")
        bounded("angle", self.angle, 0.1, 120.0, "degrees")
        bounded("ratio", self.ratio, 1.0, 1e6, "")
        bounded("least", self.least, 3, 1000, "lines")

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module."""
        for window in fit_stream(chunks, rad_from_deg(self.angle), self.ratio, context):
            path = window.path
            yield put_in(path, self._pieces(window), context) if len(path) else path

    def _pieces(self, window: Window) -> Pieces:
        """The splines of all runs, the rows between them as they are."""
        around, low, high = window.around, window.low, window.high
        n, k = high - low, len(around.axes)
        points = np.vstack([around.start[None, :], around.target])
        ends, spatial, parts = np.zeros(n, np.int64), np.zeros(n, np.int64), np.zeros(n)
        targets, rows = np.zeros((n, k)), np.zeros((n, CURVE_PARAMETERS))
        count = kernels.fit_splines(
            points, window.breaks, low, high, self.tolerance, self.least, ends, parts, targets, spatial, rows
        )
        new = spatial[:count] >= 0
        return Pieces(
            ends[:count].astype(np.intp),
            parts[:count],
            np.where(new, int(Kind.POLYNOMIAL), -1),
            targets[:count],
            np.where(spatial[:count] == 1, int(Plane.SPACE), int(Plane.XY)),
            rows[:count],
        )
