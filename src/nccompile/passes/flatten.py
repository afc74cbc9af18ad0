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
from math import ceil
from typing import ClassVar

import numpy as np

from nccompile.errors import UsageError
from nccompile.geometry.parts import Way
from nccompile.geometry.sampling import sample_curves
from nccompile.kernels.distance import place_on
from nccompile.passes.base import Context, Pass, bounded, gather
from nccompile.passes.edit import Draft, Links
from nccompile.passes.measure import deviation
from nccompile.toolpath.columns import Floats, Kind, Plane, Toolpath
from nccompile.toolpath.lengths import PLANE_AXES, THIRD_AXIS
from nccompile.units import rad_from_deg

__all__ = ["Flatten"]

_FINE = 512
"""Places at which a curve is looked at to find its bend."""

_MOST = 100_000
"""Lines one curve may become; more is a typing error in a parameter."""

_EVEN = 0.05
"""Weight of the length beside the bend: flat parts get some lines too."""

_RESOLVED = 8
"""Places looked at for each line at least."""

_MARGIN = 0.97
"""Part of the tolerance used: with 8 places a line, the farthest one is missed by 1/64 of its distance."""


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
            draft = Draft(chunk)
            starts = chunk.starts()
            for i in range(len(chunk)):
                if curved[i]:
                    self._lines(draft, i, starts[i])
                else:
                    draft.copy(i)
            flat = draft.build()
            profile = flat.profile.copy()
            profile[curved[np.array(draft.origin)]] = 0
            flat = flat.replace(profile=profile)
            if context.measure:
                context.report.deviate(deviation(chunk, flat, Links.from_rows(draft.links)))
            yield flat

    def _lines(self, draft: Draft, i: int, start: Floats) -> None:
        """Adds the lines of one curve."""
        s = draft.source
        row = int(s.curve[i])
        plane, p, kind, end = int(s.curves.plane[row]), s.curves.parameters[row], int(s.kind[i]), s.target[i]
        way = Way(kind, p.tolist())
        fine = _FINE
        shares = self._spread(*_looked_at(kind, plane, p, start, end, fine), way.length)
        while len(shares) * _RESOLVED > fine and len(shares) <= _MOST:
            fine = len(shares) * _RESOLVED * 2
            shares = self._spread(*_looked_at(kind, plane, p, start, end, fine), way.length)
        additional = _shape_of(shares, int(s.profile[i]), len(start))
        before = 0.0
        for j, share in enumerate(shares[1:], 1):
            target = start + additional[j] * (end - start)
            if share < 1.0:
                at = way.parameter(float(share))
                target[:3] = place_on(kind, plane, p, start, end, at)
                if plane != Plane.SPACE and int(s.profile[i]) >> (2 - plane) & 1:
                    third = 2 - plane
                    target[third] = start[third] + additional[j][third] * (end[third] - start[third])
            else:
                target = end.copy()
            draft.add(Kind.LINE, target, None, i, before, float(share))
            before = float(share)

    def _spread(self, fine: Floats, points: Floats, length: float) -> Floats:
        """The shares of the way at which lines end: 0, ..., 1."""
        count = max(1, ceil(length / self.length * (1.0 - 1e-12))) if self.length else 1
        count = min(count, _MOST)
        steps = np.diff(points, axis=0)
        size = np.sqrt((steps * steps).sum(axis=1))
        bend = _bends(steps, size)
        weight = np.diff(fine)
        if not self.length and bend.sum() > 0.0:
            local = bend if self.angle else np.sqrt(bend * weight)
            weight = local / local.sum() + _EVEN * weight
        mass = np.concatenate([[0.0], np.cumsum(weight)]) / weight.sum()

        def spread(number: int) -> Floats:
            shares = np.interp(np.linspace(0.0, 1.0, number + 1), mass, fine)
            shares[-1] = 1.0
            return shares

        few = count - 1
        while count < _MOST and not self._holds(spread(count), fine, points):
            few, count = count, 2 * count
        while count - few > 1:
            middle = (few + count) // 2
            if self._holds(spread(middle), fine, points):
                count = middle
            else:
                few = middle
        return spread(count)

    def _holds(self, shares: Floats, fine: Floats, points: Floats) -> bool:
        """Whether angle and tolerance hold for lines that end at these shares."""
        ends = np.stack([np.interp(shares, fine, points[:, c]) for c in range(3)], axis=1)
        lines = np.diff(ends, axis=0)
        size = np.sqrt((lines * lines).sum(axis=1))
        if self.angle:
            if len(lines) < 2:
                return False
            turn = _bends(lines, size)[:-1]
            if turn.max() >= rad_from_deg(self.angle):
                return False
        if self.tolerance:
            owner = np.clip(np.searchsorted(shares, fine, side="right") - 1, 0, len(lines) - 1)
            off = points - ends[owner]
            along = (off * lines[owner]).sum(axis=1) / np.maximum(size[owner] ** 2, 1e-300)
            off = off - np.clip(along, 0.0, 1.0)[:, None] * lines[owner]
            worst = float(np.sqrt((off * off).sum(axis=1)).max())
            return worst <= self.tolerance * _MARGIN
        return True


def _looked_at(
    kind: int, plane: int, p: Floats, start: Floats, end: Floats, count: int
) -> tuple[Floats, Floats]:
    """Places at equal steps of u: their share of the way, Shape (m,), and points in X, Y, Z, Shape (m, 3)."""
    inside = sample_curves(np.array([kind], np.uint8), p[None, :], np.linspace(0.0, 1.0, count + 1))[0]
    steps = np.diff(inside, axis=0)
    way = np.concatenate([[0.0], np.cumsum(np.sqrt((steps * steps).sum(axis=1)))])
    share = way / way[-1] if way[-1] > 0.0 else np.linspace(0.0, 1.0, count + 1)
    if plane == Plane.SPACE:
        return share, inside
    points = np.empty_like(inside)
    u, v = PLANE_AXES[plane]
    third = THIRD_AXIS[plane]
    points[:, u], points[:, v] = inside[:, 0], inside[:, 1]
    points[:, third] = start[third] + share * (end[third] - start[third])
    return share, points


def _bends(steps: Floats, size: Floats) -> Floats:
    """Angle [rad] between each step and the next, the last one again at the end. Shape of `size`."""
    if len(steps) < 2:
        return np.zeros(len(steps))
    dot = (steps[1:] * steps[:-1]).sum(axis=1)
    cross = np.cross(steps[:-1], steps[1:])
    angle = np.arctan2(np.sqrt((cross * cross).sum(axis=1)), dot)
    return np.append(angle, angle[-1])


def _shape_of(shares: Floats, profile: int, k: int) -> Floats:
    """Shape (m, k): which share of its move each axis has made; an S-profile axis runs 10 t³ - 15 t⁴ + 6 t⁵."""
    out = np.repeat(shares[:, None], k, axis=1)
    for axis in range(k):
        if profile >> axis & 1:
            out[:, axis] = shares**3 * (10.0 + shares * (6.0 * shares - 15.0))
    return out
