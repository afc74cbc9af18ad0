"""Parts of segments: cutting curves, turning them round, their points, directions and curvature in space.

    kind, plane, row      as in the curve table; a straight segment has no row (None)
    u0 .. u1              the curve parameter of the part, 0..1

All functions take one segment and plain floats; passes that work on many lines at once use columns instead.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from nccompile.geometry.curve import ROW, Floats
from nccompile.kernels import curves as kernels
from nccompile.kernels.curves import ARC, ELLIPSE, NODES

__all__ = ["Way", "curvature_at", "cut", "embed", "reparameter", "reverse", "tangent_at"]

Vector: TypeAlias = tuple[float, float, float]

SPACE = 3


def cut(kind: int, row: Sequence[float], u0: float, u1: float) -> list[float]:
    """The curve row of the part u0..u1 of a curve."""
    p = [float(v) for v in row] + [0.0] * (ROW - len(row))
    if kind == ARC:
        p[3], p[4] = p[3] + p[4] * u0, p[4] * (u1 - u0)
    elif kind == ELLIPSE:
        p[5], p[6] = p[5] + p[6] * u0, p[6] * (u1 - u0)
    else:
        for c in range(3):
            p[4 * c : 4 * c + 4] = reparameter(p[4 * c : 4 * c + 4], u0, u1)
    return p


def reparameter(c: Sequence[float], u0: float, u1: float) -> list[float]:
    """Coefficients of the cubic c in v, where u = u0 + (u1 - u0) v."""
    h = u1 - u0
    c0, c1, c2, c3 = c
    return [
        c0 + u0 * (c1 + u0 * (c2 + u0 * c3)),
        h * (c1 + u0 * (2.0 * c2 + u0 * 3.0 * c3)),
        h * h * (c2 + 3.0 * c3 * u0),
        h * h * h * c3,
    ]


def reverse(kind: int, row: Sequence[float]) -> list[float]:
    """The same curve run from its end to its start."""
    return cut(kind, row, 1.0, 0.0)


def embed(plane: int, u: float, v: float, w: float) -> Vector:
    """Plane coordinates and the third axis as X, Y, Z (in space: as they are)."""
    if plane == 1:
        return v, w, u
    if plane == 2:
        return w, u, v
    return u, v, w


class Way:
    """The arc length along one curve and its inverse: s in 0..1 of the length <-> u in 0..1."""

    def __init__(self, kind: int, row: Sequence[float]) -> None:
        self.kind = kind
        self.row: Floats = np.zeros(ROW)
        self.row[: len(row)] = row
        self._u: Floats = np.empty(NODES)
        self._s: Floats = np.empty(NODES)
        self._count = kernels.tabulate(kind, self.row, self._u, self._s)
        self.length = float(self._s[self._count - 1])

    def parameter(self, share: float) -> float:
        """u at a share 0..1 of the length in the plane."""
        if share <= 0.0 or share >= 1.0:
            return min(max(share, 0.0), 1.0)
        return kernels.parameter(self.kind, self.row, self._u, self._s, self._count, share * self.length)


def tangent_at(kind: int, plane: int, row: Floats, u: float, rise: float) -> Vector:
    """Unit tangent in X, Y, Z; rise: third axis per mm of length in the plane."""
    x, y, z = kernels.tangent3(kind, row, u)
    if plane != SPACE:
        z = rise
    size = (x * x + y * y + z * z) ** 0.5
    return embed(plane, x / size, y / size, z / size) if size > 0.0 else (0.0, 0.0, 0.0)


def curvature_at(kind: int, plane: int, row: Floats, u: float) -> Vector:
    """Curvature vector d²P/ds² [1/mm] in X, Y, Z at u; the third axis of a plane curve stands still.

    d²P/ds² = (P'' - (P''.T) T) / |P'|²
    """
    d = np.array(kernels.derivative3(kind, row, u))
    dd = np.array(kernels.second3(kind, row, u))
    size = float(d @ d)
    if size == 0.0:
        return 0.0, 0.0, 0.0
    k = (dd - (dd @ d) / size * d) / size
    return embed(plane, float(k[0]), float(k[1]), float(k[2]))
