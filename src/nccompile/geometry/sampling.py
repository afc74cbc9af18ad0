"""Many points on many curves at once: the vectorised twin of `kernels.curves.point`, for plots and checks."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from nccompile.geometry.curve import Floats
from nccompile.kernels.curves import ARC, ELLIPSE, POLYNOMIAL

__all__ = ["extent_of_digits", "sample_curves"]


def sample_curves(kinds: npt.NDArray[np.uint8], rows: Floats, u: Floats) -> Floats:
    """Points of m curves at q parameters each.

    Args:     kinds: Shape (m,);  rows: Shape (m, 12), curve rows;  u: Shape (q,) or (m, q), 0..1.
    Returns:  Shape (m, q, 3) [mm]: first and second coordinate of the plane, and the third of a polynomial
              in space (0 for plane curves).
    """
    u = np.broadcast_to(u, (len(rows), np.shape(u)[-1]))
    points = np.zeros((*u.shape, 3))
    arcs = kinds == ARC
    if arcs.any():
        p = rows[arcs]
        angle = p[:, 3:4] + p[:, 4:5] * u[arcs]
        points[arcs, :, 0] = p[:, 0:1] + p[:, 2:3] * np.cos(angle)
        points[arcs, :, 1] = p[:, 1:2] + p[:, 2:3] * np.sin(angle)
    ellipses = kinds == ELLIPSE
    if ellipses.any():
        p = rows[ellipses]
        angle = p[:, 5:6] + p[:, 6:7] * u[ellipses]
        x, y = p[:, 2:3] * np.cos(angle), p[:, 3:4] * np.sin(angle)
        c, s = np.cos(p[:, 4:5]), np.sin(p[:, 4:5])
        points[ellipses, :, 0] = p[:, 0:1] + (c * x - s * y)
        points[ellipses, :, 1] = p[:, 1:2] + (s * x + c * y)
    cubics = kinds == POLYNOMIAL
    if cubics.any():
        p, t = rows[cubics], u[cubics]
        for i in range(3):
            c0, c1, c2, c3 = (p[:, 4 * i + j, None] for j in range(4))
            points[cubics, :, i] = c0 + t * (c1 + t * (c2 + t * c3))
    return points


def extent_of_digits(kinds: npt.NDArray[np.uint8], rows: Floats) -> Floats:
    """The largest number that enters a point's coordinates, whose last digit bounds their error. Shape (m,)."""
    circular = np.abs(rows[:, 0]) + np.abs(rows[:, 1]) + np.abs(rows[:, 2])
    return np.where(kinds == POLYNOMIAL, np.abs(rows).max(axis=1, initial=0.0), circular)
