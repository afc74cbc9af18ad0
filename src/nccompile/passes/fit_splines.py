"""fit-splines: runs of small lines become C2 cubic splines within a tolerance.

    in    ●──●──●──●                 out   ●─────────.     cubics that share position, first and second
                    `●                                `-    derivative at their joints; the first and the last
                      `●──●                              ●  vertex of a run are met exactly

    h(t) = distance of chord and spline <= tolerance at every t: see kernels/fit_splines.py

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
    polynomial 5 0.83147 0 feed 50 source 2 xy u 0 4.973215 0.01037 0.016415 v 0 0.979625 -0.022892 -0.125263
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

import numpy as np

from nccompile.kernels import fit_splines as kernels
from nccompile.passes.base import Context, Flags, Pass, bounded
from nccompile.passes.runs import Pieces, fit_stream, put_in
from nccompile.toolpath.columns import CURVE_PARAMETERS, Floats, Kind, Plane, Toolpath
from nccompile.units import rad_from_deg

__all__ = ["FitSplines"]

_SAG = 16.0
"""Second difference of the vertices / half the sag of their chords, for chords of equal length."""

_MARGIN = 0.99
"""Part of the tolerance used: the bound between vertices leaves out terms of third order, 0.1 % in 6000 runs."""


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
        for path, breaks in fit_stream(chunks, rad_from_deg(self.angle), self.ratio, context):
            yield put_in(path, self._pieces(path, breaks), context) if len(path) else path

    def _pieces(self, path: Toolpath, breaks: Flags) -> Pieces:
        """The splines of all runs, the rows between them as they are."""
        at = np.flatnonzero(breaks)
        parts: list[Pieces] = []
        quiet = 0
        for first, last in pairwise(at.tolist()):
            if last - first < self.least:
                continue
            fitted = self._run(path, first, last)
            if fitted is not None:
                parts.append(_as_they_are(path, quiet, first))
                parts.append(fitted)
                quiet = last
        parts.append(_as_they_are(path, quiet, len(path)))
        return Pieces(
            *(np.concatenate(columns) for columns in zip(*(vars(p).values() for p in parts), strict=True))
        )

    def _run(self, path: Toolpath, first: int, last: int) -> Pieces | None:
        """The spline of the rows first..last - 1, None if there is none with fewer pieces."""
        n = last - first
        origin = path.start if first == 0 else path.target[first - 1]
        vertices = np.vstack([origin[None, :], path.target[first:last]])
        points = vertices - origin
        data = points[:, :3].copy()
        data[1:-1] += (points[:-2, :3] - 2.0 * points[1:-1, :3] + points[2:, :3]) / _SAG
        steps = np.diff(points[:, :3], axis=0)
        tau = np.concatenate([[0.0], np.cumsum(np.sqrt((steps * steps).sum(axis=1)))])
        most = max(n // 2, 1)
        knots, rows = np.zeros(most + 1), np.zeros((most, CURVE_PARAMETERS))
        count = kernels.fit_spline(points, data, tau, _MARGIN * self.tolerance, knots, rows, most)
        if count == 0 or count >= n:
            return None
        flat = bool(np.all(vertices[:, 2] == origin[2]))
        rows = rows[:count]
        target = self._targets(vertices, points, tau, knots[1:count], rows, origin)
        rows[:, [0, 4, 8]] += origin[:3]
        if flat:
            rows[:, 8:] = 0.0
        row = np.minimum(np.searchsorted(tau[1:], knots[1 : count + 1]), n - 1)
        part = (knots[1 : count + 1] - tau[row]) / (tau[row + 1] - tau[row])
        row[-1], part[-1] = n - 1, 1.0
        plane = np.full(count, int(Plane.XY if flat else Plane.SPACE))
        return Pieces(
            first + row, np.clip(part, 0.0, 1.0), np.full(count, int(Kind.POLYNOMIAL)), target, plane, rows
        )

    @staticmethod
    def _targets(
        vertices: Floats, points: Floats, tau: Floats, inner: Floats, rows: Floats, origin: Floats
    ) -> Floats:
        """End positions of the pieces: on the spline in X, Y, Z, additional axes by the way. Shape (m, k)."""
        target = np.empty((len(rows), vertices.shape[1]))
        for c in range(3):
            target[:, c] = rows[:, 4 * c : 4 * c + 4].sum(axis=1) + origin[c]
        for c in range(3, vertices.shape[1]):
            target[:-1, c] = np.interp(inner, tau, points[:, c]) + origin[c]
        target[-1] = vertices[-1]
        still = np.all(vertices[:, :3] == origin[:3], axis=0)
        for c in np.flatnonzero(still).tolist():
            target[:, c] = origin[c]
        return target


def _as_they_are(path: Toolpath, first: int, last: int) -> Pieces:
    """The rows first..last - 1 unchanged."""
    n = last - first
    return Pieces(
        np.arange(first, last), np.ones(n), np.full(n, -1), path.target[first:last], np.zeros(n, np.int64),
        np.zeros((n, CURVE_PARAMETERS)),
    )  # fmt: skip
