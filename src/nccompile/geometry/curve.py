"""A curve with its ends, and the exception for geometry that cannot be."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from nccompile.kernels import curves

__all__ = ["XY", "Curve", "Floats", "Impossible"]

Floats: TypeAlias = npt.NDArray[np.float64]

ROW = 12
"""Width of a curve row."""

XY = 0
"""The plane of all curves made here; the maker of a segment exchanges it for another."""


class Impossible(ValueError):
    """No such curve exists; the message is a plain sentence with the error in mm, fit for a diagnostic."""


class Curve(NamedTuple):
    """A plane curve: kind (`kernels.curves`: ARC, ELLIPSE, POLYNOMIAL), plane, and its row without the zeros.

    Angles in rad, sweep > 0 is counter-clockwise, lengths in mm.
    """

    kind: int
    plane: int
    parameters: tuple[float, ...]

    @property
    def row(self) -> Floats:
        """Shape (12,): the parameters as a row of the curve table."""
        row = np.zeros(ROW)
        row[: len(self.parameters)] = self.parameters
        return row

    @property
    def length(self) -> float:
        """The length in the plane [mm], to 1e-13 relative."""
        return curves.in_plane_length(self.kind, self.row)

    @property
    def start_tangent(self) -> tuple[float, float]:
        """Unit tangent at the start, in the direction of motion; (0, 0) for a curve without extent."""
        return curves.tangent(self.kind, self.row, 0.0)

    @property
    def end_tangent(self) -> tuple[float, float]:
        """Unit tangent at the end, in the direction of motion; (0, 0) for a curve without extent."""
        return curves.tangent(self.kind, self.row, 1.0)

    def point(self, u: float) -> tuple[float, float]:
        """The point [mm] at curve parameter u in 0..1."""
        return curves.point(self.kind, self.row, u)
