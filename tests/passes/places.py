"""Points, directions and curvature along one curve, from plain formulas: what the tests of passes measure by."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from nccompile.geometry.curve import ROW, Floats
from nccompile.kernels import curves as kernels
from nccompile.kernels.curves import NODES

__all__ = ["Way", "curvature_at", "tangent_at"]

Vector: TypeAlias = tuple[float, float, float]

SPACE = 3


def _embed(plane: int, u: float, v: float, w: float) -> Vector:
    """Plane coordinates and the third axis as X, Y, Z (in space: as they are)."""
    if plane == 1:
        return v, w, u
    if plane == 2:
        return w, u, v
    return u, v, w


class Way:
    """The arc length along one curve: u in 0..1 at a share 0..1 of the length."""

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
    return _embed(plane, x / size, y / size, z / size) if size > 0.0 else (0.0, 0.0, 0.0)


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
    return _embed(plane, float(k[0]), float(k[1]), float(k[2]))
