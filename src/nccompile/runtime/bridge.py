"""ControlAxisByPos: bridges a jump of the set position, each axis on its own (SoftMotion §2.2.5, §3.2).

The interpolator waits (its bEmergency_Stop) while every axis runs from where it stands to the new set
position, all starting together, each as fast as its velocity and acceleration allow.

      v |   ______          d >= v²/a:  t1 = v / a,        t2 = d / v - t1
        |  /      \\         else:       t1 = sqrt(d / a),  t2 = 0
        +--------------- t  t1, t2, t1
"""

from __future__ import annotations

import numpy as np

from nccompile.toolpath.columns import Floats

__all__ = ["Brake", "Bridge"]

_ROUNDING = 1e-9
"""Part of a cycle that counts as rounding when a time is divided into cycles."""


def _cycles(seconds: float, cycle: float) -> int:
    """The number of cycles that cover a time, at least one."""
    return max(1, int(np.ceil(seconds / cycle - _ROUNDING)))


class Bridge:
    """Set positions from `start` to `target` (axes,), both at rest; the last one is `target`, to the bit.

    velocity [mm/s], acceleration [mm/s²]: Shape (axes,).  `len` is the number of cycles, at least one.
    """

    def __init__(
        self, start: Floats, target: Floats, velocity: Floats, acceleration: Floats, cycle: float
    ) -> None:
        self._start, self._target, self._cycle = start.copy(), target.copy(), cycle
        self._sign, distance = np.sign(target - start), np.abs(target - start)
        self._distance, self._a = distance, acceleration
        self._t1 = np.minimum(velocity / acceleration, np.sqrt(distance / acceleration))
        self._v = acceleration * self._t1
        cruise = np.maximum(distance - self._v * self._t1, 0.0)
        self._t2 = np.divide(cruise, self._v, out=np.zeros_like(cruise), where=self._v > 0)
        self._total = 2.0 * self._t1 + self._t2
        self._length = _cycles(float(self._total.max()), cycle)

    def __len__(self) -> int:
        return self._length

    def positions(self, first: int, count: int) -> Floats:
        """Shape (m, axes): the set positions of cycles first.. (from 0), at most `count`."""
        last = min(first + count, self._length)
        t = (np.arange(first, last, dtype=np.float64)[:, None] + 1.0) * self._cycle
        up = np.minimum(t, self._t1)
        level = np.clip(t - self._t1, 0.0, self._t2)
        down = np.clip(self._total - t, 0.0, self._t1)  # time left on the last ramp
        climbed = 0.5 * self._a * up * up + self._v * level
        way = np.where(t <= self._t1 + self._t2, climbed, self._distance - 0.5 * self._a * down * down)
        out: Floats = np.where(t >= self._total, self._target, self._start + self._sign * way)
        if last == self._length:
            out[-1] = self._target
        return out


class Brake:
    """Set positions of axes that brake to a stop from `position` and `velocity`, each on its own."""

    def __init__(self, position: Floats, velocity: Floats, acceleration: Floats, cycle: float) -> None:
        self._position, self._cycle = position.copy(), cycle
        self._v, self._a = velocity.copy(), acceleration
        self._stop = np.abs(velocity) / acceleration
        self._length = _cycles(float(self._stop.max()), cycle)

    def __len__(self) -> int:
        return self._length

    def positions(self, first: int, count: int) -> Floats:
        """Shape (m, axes): the set positions of cycles first.. (from 0), at most `count`."""
        last = min(first + count, self._length)
        t = (np.arange(first, last, dtype=np.float64)[:, None] + 1.0) * self._cycle
        t = np.minimum(t, self._stop)
        out: Floats = self._position + self._v * t - np.sign(self._v) * 0.5 * self._a * t * t
        return out
