"""What replaces a corner: an arc of a given radius, or a spline of continuous direction and curvature.

P0 ──────> V                  V: the corner,  t0, t1: unit tangents before and after it
         / |
        /  |  turn            turn: angle between t0 and t1
       /   v
          P1
"""

from __future__ import annotations

from math import atan2, hypot, pi, tan

import numpy as np

from nccompile.geometry.curve import Floats
from nccompile.geometry.spatial import hermite

__all__ = ["blend", "blend_of_lines", "fillet_distance", "space_arc", "turn_of"]


def turn_of(t0: Floats, t1: Floats) -> float:
    """The angle [rad] between two unit vectors in space, 0..pi."""
    cross = np.array([
        t0[1] * t1[2] - t0[2] * t1[1], t0[2] * t1[0] - t0[0] * t1[2], t0[0] * t1[1] - t0[1] * t1[0],
    ])  # fmt: skip
    return atan2(float(np.sqrt(cross @ cross)), float(t0 @ t1))


def fillet_distance(radius: float, turn: float) -> float:
    """How far from the corner of two lines an arc touches them: radius tan(turn / 2) [mm]."""
    return radius * tan(0.5 * min(turn, pi - 1e-6))


def space_arc(p0: Floats, t0: Floats, p1: Floats, t1: Floats, turn: float) -> Floats:
    """One cubic for an arc of up to 90° in a tilted plane: coefficients Shape (3, 4).

    Tangents of length 4/3 tan(turn / 4) radius at both ends: off the arc by at most 2.8e-4 radius at 90°.
    """
    step = p1 - p0
    chord = float(np.sqrt(step @ step))
    radius = 0.5 * chord / np.sin(0.5 * turn)
    size = 4.0 * tan(0.25 * turn) * radius
    return hermite(p0, size * t0, p1, size * t1)


def blend_of_lines(p0: Floats, corner: Floats, p1: Floats) -> list[Floats]:
    """The cubic with control points P0, V, V, P1: direction and curvature (0) of both lines at its ends.

    P(t) = (1-t)³ P0 + 3 t (1-t) V + t³ P1.  Coefficients, Shape (k, 4), of one piece.
    """
    return [np.stack([p0, 3.0 * (corner - p0), -3.0 * (corner - p0), p1 - p0], axis=1)]


def blend(
    p0: Floats, d0: Floats, k0: Floats, p1: Floats, d1: Floats, k1: Floats, length: float
) -> list[Floats]:
    """Three cubics, twice continuously differentiable, that match point, tangent and curvature at both ends.

    A cubic B-spline on the knots 0 0 0 0 1 2 3 3 3 3 has six control points, as many as the conditions:
    P' = L/3 T and P'' = (L/3)² K at each end, with L the length of the whole blend.

    Args:     p0, p1: ends;  d0, d1: unit tangents;  k0, k1: curvature vectors [1/mm]; Shape (k,) each.
    Returns:  coefficients of the pieces, Shape (k, 4) each.
    """
    speed = length / 3.0
    a0, a1 = speed * d0, speed * d1
    b0, b1 = speed * speed * k0, speed * speed * k1
    c1 = p0 + a0 / 3.0
    c2 = c1 + (2.0 * a0 + b0) / 3.0
    c4 = p1 - a1 / 3.0
    c3 = c4 - (2.0 * a1 - b1) / 3.0
    controls = np.stack([p0, c1, c2, c3, c4, p1])
    knots = np.array([0.0, 0, 0, 0, 1, 2, 3, 3, 3, 3])
    return [_piece(controls, knots, j) for j in range(3)]


def _piece(c: Floats, t: Floats, j: int) -> Floats:
    """Span j of a cubic B-spline as powers of the share of the span (formulas: kernels/fit_splines.py)."""
    u, end = t[j + 3], t[j + 4]
    e = [3.0 * (c[j + i + 1] - c[j + i]) / (t[j + i + 4] - t[j + i + 1]) for i in range(3)]
    f = [2.0 * (e[i + 1] - e[i]) / (t[j + i + 4] - t[j + i + 2]) for i in range(2)]
    share = (u - t[j + 2]) / (end - t[j + 2])
    a = c[j] + (u - t[j + 1]) / (end - t[j + 1]) * (c[j + 1] - c[j])
    b = c[j + 1] + (u - t[j + 2]) / (t[j + 5] - t[j + 2]) * (c[j + 2] - c[j + 1])
    h = end - u
    first = e[0] + share * (e[1] - e[0])
    return np.stack([a + share * (b - a), first * h, 0.5 * f[0] * h * h, (f[1] - f[0]) / 6.0 * h * h], axis=1)


def unit(v: Floats) -> Floats:
    """v / |v|; the zero vector stays."""
    size = hypot(*v.tolist())
    out: Floats = v / size if size > 0.0 else v
    return out
