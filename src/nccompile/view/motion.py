"""Set positions over time: velocity, acceleration and jerk of each axis, and what a pixel shows of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from nccompile.toolpath.columns import Floats, Toolpath

__all__ = ["Caps", "Motion", "SetPositions", "caps", "envelope", "gather"]


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
        v = self._slopes(self.position)
        if len(self.t) > 1:
            jumped = (self.v[1:] == 0.0) & (np.abs(np.diff(self.position, axis=0)).max(axis=1) > 0.0)
            v[1:][jumped] = np.nan
        return v

    def accelerations(self) -> Floats:
        """Shape (m, k): difference quotient of the velocities; NaN next to a jump."""
        return self._slopes(self.velocities())

    def jerks(self) -> Floats:
        """Shape (m, k): difference quotient of the accelerations; NaN next to a jump."""
        return self._slopes(self.accelerations())

    def _slopes(self, values: Floats) -> Floats:
        """Shape (m, k): difference quotient over the cycle before, 0 in the first one."""
        slopes = np.zeros_like(values)
        if len(self.t) > 1:
            slopes[1:] = np.diff(values, axis=0) / np.diff(self.t)[:, None]
        return slopes


@dataclass(frozen=True)
class Caps:
    """What limits the path velocity over time, constant between its times.

    t f8 (m,) [s];  feed, limit f8 (m,) [mm/s]: as programmed, and what machine and geometry allow; NaN where the
    path stands.
    """

    t: Floats
    feed: Floats
    limit: Floats


def caps(chunks: Iterable[Toolpath], times: Callable[[Toolpath, float], Floats]) -> Caps:
    """The caps of a planned path; times gives the seconds of a chunk's rows, entered at a velocity."""
    end, before = 0.0, 0.0
    t, feed, limit = [np.zeros(1)], [np.full(1, np.nan)], [np.full(1, np.nan)]
    for chunk in chunks:
        if not len(chunk):
            continue
        assert chunk.v_limit is not None
        assert chunk.v_end is not None
        moving = chunk.length > 0.0
        t.append(end + np.cumsum(times(chunk, before)))
        feed.append(np.where(moving, chunk.feed, np.nan))
        limit.append(np.where(moving, chunk.v_limit, np.nan))
        end, before = float(t[-1][-1]), float(chunk.v_end[-1])
    return Caps(np.concatenate(t), np.concatenate(feed), np.concatenate(limit))


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
