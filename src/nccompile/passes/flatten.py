"""flatten: ellipses, splines and, if asked, arcs become lines (SoftMotion §3.6, convert splines/ellipses).

          . - ~ ~ - .              P(0) ... P(n) on the curve, evenly spread; n is the least number for which
       . '   chord    ' .            length      no line is longer than `length`           [mm]
      ●───────────────────●          angle       neighbouring lines bend by less than `angle`  [°]
            sag ≤ tolerance          tolerance   no point of the curve is farther from its line [mm]

At least one of the three is asked for; all given ones hold.  The spread is by arc length for `length`, by
arc length weighted with the bend otherwise, so flat parts get fewer lines.  Additional axes and the third axis
of a helix keep their value at the same share of the way; an axis in the S-profile is run along its S.

Example:
    -p flatten{tolerance=0.5,arcs}
    --- in
    % t
    N10 G3 X20 R10 F50
    --- out
    line 1.339746 -5 0 feed 50 source 2
    line 5 -8.660254 0 feed 50 source 2
    line 10 -10 0 feed 50 source 2
    line 15 -8.660254 0 feed 50 source 2
    line 18.660254 -5 0 feed 50 source 2
    line 20 0 0 feed 50 source 2
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from nccompile.errors import UsageError
from nccompile.kernels import expect_work
from nccompile.kernels.flat_lines import MOST, flat_lines
from nccompile.passes.base import Context, Pass, bounded, gather
from nccompile.passes.edit import Pieces, Rows, cut_curves, geometry, put_pieces
from nccompile.passes.measure import deviation
from nccompile.toolpath.columns import CURVE_PARAMETERS, Curves, Floats, Kind, Toolpath
from nccompile.units import rad_from_deg

__all__ = ["Flatten"]

_WORK = 1000
"""What a curve costs, in the rows by which other passes count."""


@dataclass(frozen=True)
class Flatten(Pass):
    """Lines instead of curves.

    length: greatest length of a line [mm];  angle: bend below which neighbouring lines stay [°];  tolerance:
    greatest distance from the curve [mm];  0: not asked for;  arcs: arcs too.
    """

    name: ClassVar[str] = "flatten"
    length: float = 0.0
    angle: float = 0.0
    tolerance: float = 0.0
    arcs: bool = False

    def __post_init__(self) -> None:
        bounded("length", self.length, 0.0, 1e6, "mm")
        bounded("angle", self.angle, 0.0, 180.0, "degrees")
        bounded("tolerance", self.tolerance, 0.0, 1e3, "mm")
        if not (self.length or self.angle or self.tolerance):
            raise UsageError("give length, angle or tolerance")

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module."""
        kinds = [Kind.ELLIPSE, Kind.POLYNOMIAL] + [Kind.ARC] * self.arcs
        for chunk in gather(chunks):
            curved = np.isin(chunk.kind, kinds)
            if not curved.any():
                yield chunk
                continue
            out, links = put_pieces(chunk, self._lines(chunk, np.flatnonzero(curved)))
            profile = out.profile.copy()
            profile[curved[links.segment]] = 0
            out = out.replace(profile=profile)
            if context.measure:
                context.report.deviate(deviation(chunk, out, links))
            yield out

    def _lines(self, path: Toolpath, picked: Rows) -> Pieces:
        """The lines of curves; picked: Shape (p,), ascending, their rows."""
        shape, wanted = geometry(path), (float(self.length), rad_from_deg(self.angle), float(self.tolerance))

        def fill(begin: int, owner: Rows, share: Floats, ends: Floats) -> int:
            return flat_lines(*shape, path.length, picked, begin, *wanted, owner, share, ends)

        expect_work(_WORK * len(picked))
        owner, share, (ends,) = cut_curves(picked, MOST, (3,), fill)
        begin, end, profile = path.starts()[owner], path.target[owner], path.profile[owner]
        part = np.repeat(share[:, None], len(path.axes), axis=1)
        for axis in range(len(path.axes)):
            own = profile >> axis & 1 == 1
            part[own, axis] = _s_profile(share[own])
        target = np.where(share[:, None] < 1.0, begin + part * (end - begin), end)
        plane = path.curves.plane[path.curve[owner]]
        for axis in range(3):
            own = (profile >> axis & 1 == 0) | (plane != 2 - axis)
            target[own, axis] = ends[own, axis]
        kind, none = np.full(len(owner), Kind.LINE, np.uint8), np.zeros(len(owner), np.uint8)
        return Pieces(owner, share, kind, target, Curves(none, np.zeros((len(owner), CURVE_PARAMETERS))))


def _s_profile(share: Floats) -> Floats:
    """Which share of its move an axis has made that runs 10 t³ - 15 t⁴ + 6 t⁵."""
    return np.asarray(share**3 * (10.0 + share * (6.0 * share - 15.0)))
