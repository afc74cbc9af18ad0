"""Cardinal splines through points (SoftMotion §3.2.6, G05)."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot
from typing import TypeAlias

from nccompile.geometry.curve import XY, Curve
from nccompile.geometry.tolerance import COINCIDENT
from nccompile.kernels.curves import POLYNOMIAL

__all__ = ["cardinal_spline"]

Point: TypeAlias = tuple[float, float]


def cardinal_spline(
    points: Sequence[Point], start_tangent: Point | None, end_tangent: Point | None
) -> list[Curve]:
    r"""The cubic pieces of a cardinal spline through `points`; neighbours share their tangent.

                 P1 ---> T1 parallel to P2 - P0         piece i in Hermite form, D = P(i+1) - P(i), d = |D|:
               /    \                                    P(t) = P(i) + M0 t + (3D - 2 M0 - M1) t²
             P0      P2                                         + (M0 + M1 - 2D) t³
                       \                                 M0 = d T(i),  M1 = d T(i+1)

    Inner points:  T(i) = (P(i+1) - P(i-1)) / (d(i-1) + d(i)): tension 0 on chordal knots.  For equal chords
                   M = (P(i+1) - P(i-1)) / 2, the textbook cardinal (Catmull-Rom) spline; for unequal ones the
                   long neighbour no longer throws the short piece into a loop, as |M| never exceeds d.
    Ends:          the unit tangent that is given (that of the neighbouring line or arc); else M0 = 2D - M1,
                   which leaves the end piece without a cubic term (a parabola), or the chord if it is alone.

    Args:     points: start and the programmed points [mm], at least 2;
              start_tangent, end_tangent: unit tangents of the neighbours in the direction of motion, or None.
    Returns:  len(points) - 1 curves; a piece between coincident points has no extent.
    Limits:   a point that the path leaves the way it came has T = 0: the spline stops and turns there.
    Source:   SoftMotion §3.2.6 (no kinks, neither inside nor at the neighbours); own derivation.
    """
    kept = [0]
    for i in range(1, len(points)):
        if _distance(points[kept[-1]], points[i]) > COINCIDENT:
            kept.append(i)
    path = [points[i] for i in kept]
    tangents = _tangents(path, start_tangent, end_tangent)
    pieces: list[Curve] = []
    at = 0
    for i in range(1, len(points)):
        if at + 1 < len(kept) and kept[at + 1] == i:
            pieces.append(_hermite(points[i - 1], path[at + 1], tangents[at], tangents[at + 1]))
            at += 1
        else:
            x, y = points[i - 1]
            pieces.append(_hermite((x, y), points[i], (0.0, 0.0), (0.0, 0.0)))
    return pieces


def _tangents(path: Sequence[Point], start: Point | None, end: Point | None) -> list[Point | None]:
    """T of every point; None for a free end."""
    inner: list[Point | None] = []
    for (ax, ay), (bx, by), (cx, cy) in zip(path, path[1:], path[2:], strict=False):
        span = _distance((ax, ay), (bx, by)) + _distance((bx, by), (cx, cy))
        inner.append(((cx - ax) / span, (cy - ay) / span))
    return [start, *inner, end]


def _hermite(a: Point, b: Point, ta: Point | None, tb: Point | None) -> Curve:
    """The cubic from a to b with M0 = d ta, M1 = d tb (formula: `cardinal_spline`)."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    d = _distance(a, b)
    m0 = None if ta is None else (d * ta[0], d * ta[1])
    m1 = None if tb is None else (d * tb[0], d * tb[1])
    if m0 is None:
        m0 = (dx, dy) if m1 is None else (2.0 * dx - m1[0], 2.0 * dy - m1[1])
    if m1 is None:
        m1 = (2.0 * dx - m0[0], 2.0 * dy - m0[1])
    return Curve(
        POLYNOMIAL,
        XY,
        (*_cubic(a[0], dx, m0[0], m1[0]), *_cubic(a[1], dy, m0[1], m1[1])),
    )


def _cubic(start: float, step: float, m0: float, m1: float) -> tuple[float, float, float, float]:
    return start, m0, 3.0 * step - 2.0 * m0 - m1, m0 + m1 - 2.0 * step


def _distance(a: Point, b: Point) -> float:
    return hypot(b[0] - a[0], b[1] - a[1])
