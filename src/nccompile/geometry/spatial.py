"""Plane curves, helices too, as cubics in space: where a plane is tilted, no arc or ellipse row can hold them.

    P(b)                   Hermite cubic over the share a..b of the way, h = b - a:
   /  T(b)                     value and direction at both ends are those of the curve,
P(a)                           |derivative| = h L, the length of the part
  T(a)                     halved until it keeps within the tolerance at eight inner places
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from nccompile.geometry.curve import Floats

__all__ = ["cubics", "hermite"]

Place: TypeAlias = Callable[[float], tuple[Floats, Floats]]

_DEEPEST = 1.0 / 4096
_CHECKS = (0.1, 0.22, 0.35, 0.5, 0.65, 0.78, 0.9)


def hermite(p0: Floats, d0: Floats, p1: Floats, d1: Floats) -> Floats:
    """Coefficients c0..c3 a coordinate, Shape (k, 4), of the cubic with these ends and derivatives, Shape (k,)."""
    step = p1 - p0
    return np.stack([p0, d0, 3.0 * step - 2.0 * d0 - d1, d0 + d1 - 2.0 * step], axis=1)


def cubics(
    place: Place, length: float, tolerance: float, start: float = 0.0, end: float = 1.0
) -> list[tuple[float, Floats]]:
    """Cubics within `tolerance` [mm] of a curve.

    Args:     place: share 0..1 of the way -> point, Shape (3,), and unit tangent, Shape (3,);  length [mm].
    Returns:  (share at the end, coefficients Shape (3, 4)) for each piece, in order.
    """
    (p0, t0), (p1, t1) = place(start), place(end)
    size = (end - start) * length
    c = hermite(p0, size * t0, p1, size * t1)
    worst = 0.0
    for v in _CHECKS:
        off = c @ np.array([1.0, v, v * v, v * v * v]) - place(start + v * (end - start))[0]
        worst = max(worst, float(np.sqrt(off @ off)))
    if worst <= 0.9 * tolerance or end - start <= _DEEPEST:
        return [(end, c)]
    mid = 0.5 * (start + end)
    return cubics(place, length, tolerance, start, mid) + cubics(place, length, tolerance, mid, end)
