"""Parabola arcs by the intersection of their end tangents (SoftMotion §3.2, G06)."""

from __future__ import annotations

from math import hypot, isfinite

from nccompile.geometry.curve import XY, Curve, Impossible
from nccompile.geometry.tolerance import COINCIDENT, PARALLEL
from nccompile.kernels.curves import POLYNOMIAL

__all__ = ["parabola_by_tangents"]


def parabola_by_tangents(x0: float, y0: float, x1: float, y1: float, ix: float, iy: float) -> Curve:
    r"""The parabola from S = (x0, y0) to E = (x1, y1) whose end tangents meet in T = (ix, iy).

              T                 A parabola arc is a quadratic Bezier curve, and T its middle control point:
             / \                   P(t) = (1-t)² S + 2 t (1-t) T + t² E
            / _ \                       = S + 2 (T - S) t + (S - 2T + E) t²
           /.   .\              P'(0) = 2 (T - S) and P'(1) = 2 (E - T): both tangents pass through T.
          S       E

    Raises:   Impossible: T on the line through S and E but not between them (the curve had to turn back);
              between them the parabola is the straight line.
    Source:   SoftMotion §3.2 (words I, J of G06); own derivation.
    """
    if not isfinite(x0 + y0 + x1 + y1 + ix + iy):
        raise Impossible("an end or the tangent intersection of the parabola is not a finite number")
    ax, ay, bx, by = ix - x0, iy - y0, x1 - ix, y1 - iy
    first, last = hypot(ax, ay), hypot(bx, by)
    flat = abs(ax * by - ay * bx) <= PARALLEL * first * last
    if flat and ax * bx + ay * by < 0.0 and min(first, last) > COINCIDENT:
        chord = hypot(x1 - x0, y1 - y0)
        raise Impossible(
            "the tangent intersection lies on the line through start and end, "
            f"{0.5 * (first + last - chord):.4g} mm beyond them: the parabola had to turn back"
        )
    return Curve(POLYNOMIAL, XY, (x0, 2.0 * ax, bx - ax, 0.0, y0, 2.0 * ay, by - ay, 0.0))
