"""Gantry: every axis position is the path coordinate plus an offset (SMC_TRAFO_Gantry, SoftMotion §8.2.1)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nccompile.machine.limits import offsets
from nccompile.machine.model import Machine
from nccompile.toolpath.columns import Floats

__all__ = ["Gantry"]


class Gantry:
    """A portal machine.  Path axes that it does not have are left out; on the way back they are 0.

    The chain is exact where it can be: without offsets the numbers pass through unchanged.
    """

    def __init__(self, machine: Machine, path_axes: Sequence[str]) -> None:
        self.axes = tuple(letter for letter in path_axes if letter in machine.axes)
        self._width = len(path_axes)
        self._columns = [path_axes.index(letter) for letter in self.axes]
        self._all = len(self.axes) == self._width
        self._offset = offsets(machine, self.axes)
        self._shifted = bool(self._offset.any())

    def to_axes(self, points: Floats) -> Floats:
        """Axis positions of path points; the same array if nothing has to be changed."""
        chosen = points if self._all else np.ascontiguousarray(points[:, self._columns])
        return chosen + self._offset if self._shifted else chosen

    def to_path(self, positions: Floats) -> Floats:
        """Path points of axis positions."""
        points = np.zeros((len(positions), self._width))
        points[:, self._columns] = positions - self._offset
        return points
