"""Planes of curves and the axes that they move.

Toolpaths number planes XY, ZX, YZ and space 0, 1, 2, 3 (`toolpath.Plane`).  The axis across plane 0..2 is 2 - plane;
it goes on linearly, as do all axes that are no X, Y or Z.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = ["SPACE", "embed", "in_plane_share", "least_in_plane", "moves", "plane_axes"]

Floats = npt.NDArray[np.float64]

SPACE = 3
"""The plane of a polynomial in space."""


@kernel
def plane_axes(plane: int) -> tuple[int, int]:
    """The first and second axis of a plane among X, Y, Z; X and Y of space."""
    if plane == 1:
        return 2, 0
    if plane == 2:
        return 1, 2
    return 0, 1


@kernel
def embed(plane: int, u: float, v: float, w: float) -> tuple[float, float, float]:
    """Coordinates in a plane and on the axis across it as X, Y, Z; those of space as they are."""
    if plane == 1:
        return v, w, u
    if plane == 2:
        return w, u, v
    return u, v, w


@kernel
def moves(plane: int, axis: int) -> bool:
    """Whether a curve in a plane (-1: a straight row) moves an axis; the others go on linearly."""
    return plane >= 0 and axis < SPACE and (plane == SPACE or axis != 2 - plane)


@kernel
def least_in_plane(values: Floats, plane: int) -> float:
    """The least of values (k,), one an axis, of those that a curve in a plane moves."""
    first, second = plane_axes(plane)
    least = min(float(values[first]), float(values[second]))
    return min(least, float(values[2])) if plane == SPACE else least


@kernel
def in_plane_share(start: float, target: float, length: float) -> float:
    """The part of a row's path length that its curve has in its plane; start, target: of the axis across it."""
    rise = (target - start) / length
    return sqrt(max(1.0 - rise * rise, 0.0))
