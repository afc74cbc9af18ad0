"""Planner `jerk`, first half: caps that hold for the smoothed motion, rows cut where the caps change.

    in    decoded chunks
    out   the same path with limits, in more rows: a long row next to a slower one is cut, so that the motion
          that is to be smoothed is as slow already before and after it (`kernels.erosion`)

The second half is the usual look-ahead; the interpolator then runs the mean of the last T seconds
(`PlanSettings.smoothing`), which turns trapezoids into jerk-limited ramps of T + dv / a.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from nccompile.kernels.erosion import PARTS, erode
from nccompile.passes.velocity.cuts import cut_at_bends
from nccompile.passes.velocity.limits import limited
from nccompile.passes.velocity.parts import Parts, parted
from nccompile.passes.velocity.settings import PlanSettings
from nccompile.toolpath.columns import Floats, Toolpath

__all__ = ["smoothable"]


def smoothable(chunks: Iterable[Toolpath], settings: PlanSettings) -> Iterator[Toolpath]:
    """Limited chunks of the path, cut and capped for a mean of `settings.smoothing` seconds."""
    stage = _Stage(settings)
    for chunk in chunks:
        yield from stage.feed(chunk)
    yield from stage.finish()


@dataclass
class _Stage:
    """Holds rows back until all rows are known that can reach into them."""

    settings: PlanSettings
    _held: Toolpath | None = field(default=None, init=False)
    _done: int = field(default=0, init=False)  # rows of _held that are out already and kept as neighbours
    _out: int = field(default=0, init=False)  # rows put out

    def feed(self, chunk: Toolpath) -> Iterator[Toolpath]:
        """Takes the next chunk; yields the rows that are complete."""
        if len(chunk):
            chunk = cut_at_bends(chunk, self.settings)
            self._held = chunk if self._held is None else Toolpath.join([self._held, chunk])
            yield from self._emit(complete=False)

    def finish(self) -> Iterator[Toolpath]:
        """The rest of the path."""
        if self._held is not None:
            yield from self._emit(complete=True)

    def _emit(self, *, complete: bool) -> Iterator[Toolpath]:
        assert self._held is not None
        path, known = limited(self._held, self.settings)
        assert path.v_limit is not None
        assert path.v_junction is not None
        n = len(path) if complete else known + 1
        half = 0.5 * self.settings.smoothing
        top = np.minimum(path.feed, path.v_limit)
        room = PARTS * (n - self._done + 1)
        row, ramps = np.empty(room, np.int32), np.empty((room, 2))
        p0, p1, cap = np.empty(room), np.empty(room), np.empty(room)
        solid = ((path.profile & 0x7FFF) != 0).astype(np.uint8)
        count, ready = erode(
            path.kind[:n], path.length[:n], top[:n], path.v_junction[:n], path.accel[:n], path.decel[:n], half,
            self._done, int(complete), solid, row, p0, p1, cap, ramps,
        )  # fmt: skip
        if ready > self._done:
            parts = Parts(row[:count] - np.int32(self._done), p0[:count], p1[:count])
            yield self._cut(path.rows(self._done, ready), parts, cap[:count], ramps[:count])
            keep = _first_neighbour(top, path.length, ready, half)
            self._held = None if complete else self._held.rows(keep, len(self._held))
            self._done = ready - keep

    def _cut(self, path: Toolpath, parts: Parts, cap: Floats, ramps: Floats) -> Toolpath:
        """The parts as rows, with their caps."""
        out = parted(path, parts)
        assert out.v_limit is not None
        v_limit = np.where(cap < np.minimum(out.feed, out.v_limit), cap, out.v_limit)
        out = out.replace(
            v_limit=v_limit, accel=ramps[:, 0].copy(), decel=ramps[:, 1].copy(), first=self._out
        )
        self._out += len(out)
        return out


def _first_neighbour(top: Floats, length: Floats, ready: int, half: float) -> int:
    """First of the rows before `ready` that can reach beyond it."""
    keep, away, reach = ready, 0.0, float(top.max(initial=0.0)) * half
    while keep > 0 and away <= reach:
        keep -= 1
        away += float(length[keep])
    return keep
