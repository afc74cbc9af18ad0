"""fit-arcs: runs of small lines become arcs, helices and lines within a tolerance.

    in    ●──●──●                    out   ●──────.
                 `●                               `-.     one arc through the first and the last vertex; every
                   `●                                \\     vertex and every chord of the run is within the
                     ●                                ●    tolerance of it, and it of them

    h(t) <= tolerance on both sides: see kernels/fit_arcs.py for the pencil of circles that gives the longest run

Greedy: each arc replaces the longest run that it can.  An arc lies in X-Y, or with `planes` in Z-X or Y-Z where
that axis stands still; if the third axis moves linearly with the way it is a helix.  Additional axes must move
linearly with the way within the same number (mm or degrees).  Corners sharper than `angle` stay exact.

Example:
    -p fit-arcs{tolerance=0.05}
    --- in
    % t
    N10 G0 X10
    N20 G1 X9.903926 Y1.382874 F50
    N30 G1 X9.617551 Y2.739177
    N40 G1 X9.146379 Y4.042850
    N50 G1 X8.499461 Y5.268846
    --- out
    positioning 10 0 0 source 2
    arc 8.499461 5.268846 0 feed 50 source 3 xy center -0.000555 -8e-06 radius 10.000555 start 1e-06 sweep 0.554897
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from nccompile.kernels import fit_arcs as kernels
from nccompile.passes.base import Context, Flags, Pass, bounded
from nccompile.passes.runs import Pieces, fit_stream, put_in
from nccompile.toolpath.columns import CURVE_PARAMETERS, Kind, Toolpath
from nccompile.units import rad_from_deg

__all__ = ["FitArcs"]


@dataclass(frozen=True)
class FitArcs(Pass):
    """Arcs for lines.

    tolerance: greatest distance, both ways [mm];  angle: sharper corners stay [°];  ratio: a segment this many
    times as long as its neighbour ends a run;  least: lines an arc replaces at least;  planes: arcs in Z-X and
    Y-Z too.
    """

    name: ClassVar[str] = "fit-arcs"
    tolerance: float = 0.005
    angle: float = 30.0
    ratio: float = 12.0
    least: int = 3
    planes: bool = True

    def __post_init__(self) -> None:
        bounded("tolerance", self.tolerance, 1e-6, 10.0, "mm")
        bounded("angle", self.angle, 0.1, 120.0, "degrees")
        bounded("ratio", self.ratio, 1.0, 1e6, "")
        bounded("least", self.least, 2, 1000, "lines")

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module."""
        for window in fit_stream(chunks, rad_from_deg(self.angle), self.ratio, context):
            path, breaks = window.path, window.breaks[window.low : window.high + 1] > 0
            yield put_in(path, self._pieces(path, breaks), context) if len(path) else path

    def _pieces(self, path: Toolpath, breaks: Flags) -> Pieces:
        n = len(path)
        points = np.vstack([path.start[None, :], path.target])
        ends, kinds, rows = np.zeros(n, np.int64), np.zeros(n, np.int64), np.zeros((n, 5))
        count = kernels.fit_arcs(points, breaks, self.tolerance, self.least, self.planes, ends, rows, kinds)
        ends, kinds = ends[:count].astype(np.intp), kinds[:count]
        single = np.diff(ends, prepend=0) == 1
        kind = np.where(kinds >= 0, int(Kind.ARC), np.where(single, -1, int(Kind.LINE)))
        table = np.zeros((count, CURVE_PARAMETERS))
        table[:, :5] = rows[:count]
        return Pieces(ends - 1, np.ones(count), kind, path.target[ends - 1], np.maximum(kinds, 0), table)
