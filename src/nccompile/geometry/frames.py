"""Frames: similarity maps of space, P' = scale * Q P + t with Q orthogonal (SoftMotion §8.3, §6.4).

    Q = Rz(yaw) Ry(pitch) Rx(roll)        roll, pitch, yaw about the fixed axes X, then Y, then Z

Plain numbers in rad and mm; a mirror has det Q = -1.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from nccompile.geometry.curve import Floats

__all__ = ["Frame", "rotation"]

_ROUNDED = 4e-16


@dataclass(frozen=True)
class Frame:
    """scale > 0;  q: Shape (3, 3), orthogonal;  t: Shape (3,) [mm]."""

    scale: float
    q: Floats
    t: Floats

    def points(self, xyz: Floats) -> Floats:
        """Maps points, Shape (n, 3); one and the same point gives the same bits wherever it stands."""
        m = self.scale * self.q
        out = np.empty_like(xyz)
        for i in range(3):
            out[:, i] = m[i, 0] * xyz[:, 0] + m[i, 1] * xyz[:, 1] + m[i, 2] * xyz[:, 2] + self.t[i]
        return out

    @property
    def mirrors(self) -> bool:
        """Whether left and right change places."""
        return float(np.linalg.det(self.q)) < 0.0

    def plane_to(self, normal: int) -> int | None:
        """The axis 0..2 along which the normal axis of a plane comes to lie, None if along none."""
        column = np.abs(self.q[:, normal])
        at = int(np.argmax(column))
        return at if column[at] == 1.0 and float(column.sum()) == 1.0 else None


def rotation(roll: float, pitch: float, yaw: float) -> Floats:
    """The matrix Q of the module's drawing; multiples of 90° are exact. Shape (3, 3)."""
    (cr, sr), (cp, sp), (cy, sy) = (_circle(a) for a in (roll, pitch, yaw))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def _circle(angle: float) -> tuple[float, float]:
    """Cosine and sine; a value within rounding of 0 is 0, so that axes stay on axes."""
    c, s = cos(angle), sin(angle)
    if abs(c) < _ROUNDED:
        return 0.0, 1.0 if s > 0.0 else -1.0
    if abs(s) < _ROUNDED:
        return (1.0 if c > 0.0 else -1.0), 0.0
    return c, s
