"""Set positions over time: velocity and acceleration of each axis, and their reduction to what a pixel shows."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from nccompile.toolpath.columns import Floats

__all__ = ["Motion", "SetPositions", "envelope", "gather"]


class SetPositions(Protocol):
    """A block of samples: m consecutive cycles (`backend.samples.SampleBlock` is one)."""

    @property
    def t(self) -> Floats:
        """Shape (m,) [s]."""

    @property
    def position(self) -> Floats:
        """Shape (m, k) [mm or deg]."""

    @property
    def velocity(self) -> Floats:
        """Shape (m,): path velocity [mm/s]."""


@dataclass(frozen=True)
class Motion:
    """Sampled motion: axes, t f8 (m,) [s], position f8 (m, k), v f8 (m,) path velocity [mm/s]."""

    axes: tuple[str, ...]
    t: Floats
    position: Floats
    v: Floats

    def moving(self) -> list[int]:
        """The columns of the axes that move at all."""
        return np.flatnonzero(np.ptp(self.position, axis=0) > 0.0).tolist() if len(self.t) else []

    def velocities(self) -> Floats:
        """Shape (m, k): difference quotient over the cycle before; NaN where the position jumped (G92)."""
        v = np.zeros_like(self.position)
        if len(self.t) > 1:
            step = np.diff(self.position, axis=0)
            v[1:] = step / np.diff(self.t)[:, None]
            jumped = (self.v[1:] == 0.0) & (np.abs(step).max(axis=1) > 0.0)
            v[1:][jumped] = np.nan
        return v

    def accelerations(self) -> Floats:
        """Shape (m, k): difference quotient of the velocities; NaN next to a jump."""
        a = np.zeros_like(self.position)
        if len(self.t) > 1:
            a[1:] = np.diff(self.velocities(), axis=0) / np.diff(self.t)[:, None]
        return a


def gather(axes: Sequence[str], blocks: Iterable[SetPositions]) -> Motion:
    """The blocks of a sampler as one motion."""
    parts = [(block.t, block.position, block.velocity) for block in blocks]
    if not parts:
        return Motion(tuple(axes), np.zeros(0), np.zeros((0, len(axes))), np.zeros(0))
    t, position, v = (np.concatenate(column) for column in zip(*parts, strict=True))
    return Motion(tuple(axes), t, position, v)


def envelope(t: Floats, y: Floats, bins: int) -> tuple[Floats, Floats]:
    """At most 2 `bins` points that look the same: least and greatest value of each stretch of time.

    Peaks of a single cycle stay visible, which thinning by every n-th sample loses.

    Args:     t, y: Shape (m,);  NaN in y is left out unless a whole stretch is NaN.
    """
    m = len(t)
    if m <= 2 * bins:
        return t, y
    edges = np.linspace(0, m, bins + 1).astype(np.intp)[:-1]
    low, high = np.fmin.reduceat(y, edges), np.fmax.reduceat(y, edges)
    last = np.append(edges[1:], m) - 1
    rising = np.nan_to_num(y[last]) >= np.nan_to_num(y[edges])
    places = np.column_stack([t[edges], t[last]]).ravel()
    pairs = np.where(rising[:, None], np.column_stack([low, high]), np.column_stack([high, low]))
    return places, pairs.ravel()
