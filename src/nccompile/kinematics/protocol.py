"""What every transformation between path points and axis positions offers."""

from __future__ import annotations

from typing import Protocol

from nccompile.toolpath.columns import Floats

__all__ = ["Kinematics"]


class Kinematics(Protocol):
    """Inverse and forward transformation of one machine kind (SoftMotion §8.2)."""

    axes: tuple[str, ...]
    """Letters of the machine's axes that carry the path, in the order of the axis positions."""

    def to_axes(self, points: Floats) -> Floats:
        """Axis positions, Shape (m, axes), of path points, Shape (m, path axes) [mm or deg]."""

    def to_path(self, positions: Floats) -> Floats:
        """Path points, Shape (m, path axes), of axis positions, Shape (m, axes) [mm or deg]."""
