"""Curves at a distance from plane curves: lines and arcs exactly, ellipses and cubics as cubics within a tolerance.

     n                 d: distance to the left of the direction of motion, negative: to the right
·····^······· P + d n      line     both ends move by d n
     |                     arc      radius R - d for counter-clockwise, R + d for clockwise; below 0 the
─────P─────> T                      offset runs on the far side of the centre (the tool does not fit)
                           others   Q(u) = P(u) + d n(u),  Q' = P' (1 - d k), k: signed curvature
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import NamedTuple

import numpy as np

from nccompile.geometry.curve import ROW, Floats
from nccompile.geometry.parts import Way, cut
from nccompile.geometry.spatial import cubics
from nccompile.kernels import curves as kernels
from nccompile.kernels import intersect
from nccompile.kernels.curves import ARC, ELLIPSE, POLYNOMIAL

__all__ = ["Piece", "arc_about", "meeting", "offset", "straight"]

_NO_RADIUS = 1e-9
"""[mm] An offset arc of less is a point."""


class Piece(NamedTuple):
    """A plane segment: kind (1: a line), curve row, ends in X-Y; p0..p1: the part of its source it stands for."""

    kind: int
    row: Floats
    a: Floats
    b: Floats
    p0: float = 0.0
    p1: float = 1.0

    def part(self, u0: float, u1: float) -> Piece:
        """The part u0..u1."""
        if u0 == 0.0 and u1 == 1.0:
            return self
        p0, p1 = (self.p0 + u * (self.p1 - self.p0) for u in (u0, u1))
        if self.kind < ARC:
            step = self.b - self.a
            return Piece(
                self.kind, self.row, self.a + u0 * step, self.b if u1 == 1.0 else self.a + u1 * step, p0, p1
            )
        row = np.array(cut(self.kind, self.row.tolist(), u0, u1))
        a, b = (np.array(kernels.point(self.kind, self.row, u)) for u in (u0, u1))
        return Piece(self.kind, row, a, self.b if u1 == 1.0 else b, p0, p1)


def straight(a: Floats, b: Floats) -> Piece:
    """The line from a to b."""
    return Piece(1, np.zeros(ROW), a, b)


def arc_about(center: Floats, a: Floats, b: Floats, sweep: float) -> Piece:
    """The arc from a to b about a centre, with this signed sweep [rad]."""
    row = np.zeros(ROW)
    dx, dy = float(a[0] - center[0]), float(a[1] - center[1])
    row[:5] = center[0], center[1], np.hypot(dx, dy), np.arctan2(dy, dx), sweep
    return Piece(ARC, row, a, b)


def offset(kind: int, row: Floats, a: Floats, b: Floats, d: float, tolerance: float) -> list[Piece]:
    """The offset of a segment from a to b in X-Y, in order; empty if it is a point."""
    if kind < ARC:
        step = b - a
        t = step / np.sqrt(step @ step)
        n = d * np.array([-t[1], t[0]])
        return [straight(a + n, b + n)]
    if kind == ARC:
        return _arc(row, d)
    if kind in (ELLIPSE, POLYNOMIAL):
        return _free(kind, row, d, tolerance)
    return []


def _arc(row: Floats, d: float) -> list[Piece]:
    center, start, sweep = row[:2], float(row[3]), float(row[4])
    radius = float(row[2]) - (d if sweep > 0.0 else -d)
    if abs(radius) <= _NO_RADIUS:
        return []
    if radius < 0.0:
        radius, start = -radius, start + pi
    out = np.zeros(ROW)
    out[:5] = center[0], center[1], radius, start, sweep
    a, b = (center + radius * np.array([cos(w), sin(w)]) for w in (start, start + sweep))
    return [Piece(ARC, out, a, b)]


def _free(kind: int, row: Floats, d: float, tolerance: float) -> list[Piece]:
    """Cubics within the tolerance; by the share of the source's length."""
    way = Way(kind, row.tolist())
    if way.length <= 0.0:
        return []

    def place(share: float) -> tuple[Floats, Floats]:
        u = way.parameter(share)
        x, y = kernels.point(kind, row, u)
        tx, ty = kernels.tangent(kind, row, u)
        dx, dy = kernels.derivative(kind, row, u)
        ddx, ddy = kernels.second(kind, row, u)
        speed = np.hypot(dx, dy)
        bend = (dx * ddy - dy * ddx) / speed**3 if speed > 0.0 else 0.0
        return np.array([x - d * ty, y + d * tx]), (1.0 - d * bend) * np.array([tx, ty])

    pieces = []
    before, a = 0.0, place(0.0)[0]
    for share, c in cubics(place, way.length, tolerance):
        cubic = np.zeros(ROW)
        cubic[:8] = c.ravel()
        b = place(share)[0]
        pieces.append(Piece(POLYNOMIAL, cubic, a, b, before, share))
        before, a = share, b
    return pieces


def meeting(one: Piece, two: Piece) -> tuple[float, float] | None:
    """Where two pieces meet, as u on the first and v on the second: nearest to the end of `one`, then to the start
    of `two`; None if nowhere."""
    us, vs = np.zeros(48), np.zeros(48)
    count = intersect.intersections(one.kind, one.row, one.a, one.b, two.kind, two.row, two.a, two.b, us, vs)
    if not count:
        return None
    best = int(np.argmin(vs[:count] - us[:count]))
    return float(us[best]), float(vs[best])
