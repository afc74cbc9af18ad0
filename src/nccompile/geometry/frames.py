"""Frames: affine maps of space, P' = M P + t with det M not 0 (SoftMotion §8.3, §6.4).

    Q = Rz(yaw) Ry(pitch) Rx(roll)        roll, pitch, yaw about the fixed axes X, then Y, then Z
    M = (x' y' z')                        the columns of M are the frame's unit vectors, as §8.3 gives them

Plain numbers in rad and mm; a mirror has det M < 0; M = s Q with Q orthogonal is a similarity, which keeps circles.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np
import numpy.typing as npt

from nccompile.geometry.curve import Floats

__all__ = ["Frame", "mapped_conics", "rotation"]

_ROUNDED = 4e-16
_SIMILAR = 1e-12
"""Relative: a map of a plane is a similarity if it stretches all directions alike but for rounding."""


@dataclass(frozen=True)
class Frame:
    """m: Shape (3, 3);  t: Shape (3,) [mm]."""

    m: Floats
    t: Floats

    def points(self, xyz: Floats) -> Floats:
        """Maps points, Shape (n, 3); one and the same point gives the same bits wherever it stands."""
        out = np.empty_like(xyz)
        for i in range(3):
            m = self.m[i]
            out[:, i] = m[0] * xyz[:, 0] + m[1] * xyz[:, 1] + m[2] * xyz[:, 2] + self.t[i]
        return out

    def inverse(self) -> Frame:
        """The map back."""
        back: Floats = np.linalg.inv(self.m).astype(np.float64)
        return Frame(back, -(back @ self.t))

    @property
    def mirrors(self) -> bool:
        """Whether left and right change places."""
        return float(np.linalg.det(self.m)) < 0.0

    @property
    def stretch(self) -> tuple[float, float]:
        """The least and the greatest factor by which lengths change."""
        sizes = np.linalg.svd(self.m, compute_uv=False)
        return float(sizes[-1]), float(sizes[0])

    def normal_of(self, u: int, v: int) -> int | None:
        """The axis 0..2 perpendicular to the plane in which the axes u and v come to lie, None if to none."""
        for axis in range(3):
            if self.m[axis, u] == 0.0 and self.m[axis, v] == 0.0:
                return axis
        return None

    def is_similar(self, u: int, v: int) -> bool:
        """Whether figures in the plane of the axes u and v keep their shape."""
        a, b = self.m[:, u], self.m[:, v]
        size = float(a @ a)
        return abs(size - float(b @ b)) <= _SIMILAR * size and abs(float(a @ b)) <= _SIMILAR * size


def mapped_conics(
    main: Floats, sub: Floats, direction: Floats, start: Floats, sweep: Floats, m: Floats
) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """What a linear map of their plane makes of ellipses, or of arcs with main = sub = r.  Shape (n,) each.

    P(w) = A (cos w, sin w) with the half axes as columns of A.  M A = U S V with V a rotation by f, so

        M P(w) = U S (cos(w + f), sin(w + f))       half axes S in the directions U; if U mirrors, w runs backwards

    Args:     half axes [mm], direction of the main one, start and sweep [rad];  m: Shape (2, 2).
    """
    c, s = np.cos(direction), np.sin(direction)
    a = np.empty((len(main), 2, 2))
    for i in range(2):
        a[:, i, 0] = main * (m[i, 0] * c + m[i, 1] * s)
        a[:, i, 1] = sub * (m[i, 1] * c - m[i, 0] * s)
    u, sizes, v = np.linalg.svd(a)
    flip = _mirrors(v)
    v[flip, 1], u[flip, :, 1] = -v[flip, 1], -u[flip, :, 1]
    side = np.where(_mirrors(u), -1.0, 1.0)
    begin = start + np.arctan2(v[:, 1, 0], v[:, 0, 0])
    return sizes[:, 0], sizes[:, 1], np.arctan2(u[:, 1, 0], u[:, 0, 0]), side * begin, side * sweep


def _mirrors(m: Floats) -> npt.NDArray[np.bool_]:
    """Which matrices, Shape (n, 2, 2), mirror."""
    return np.asarray(m[:, 0, 0] * m[:, 1, 1] < m[:, 0, 1] * m[:, 1, 0])


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
