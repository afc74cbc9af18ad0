"""Planner `time-optimal`: the fastest velocities along the path under the axes' velocities and accelerations.

    in    decoded chunks
    out   planned chunks; curves are cut in parts with a constant path acceleration each

The program's F is kept as a limit; E and the machine's path acceleration are not: the axes' limits count.
Straight segments need no cuts: their trapezoid at the axes' limit is the optimum.  `kernels.reach` has the
method.  Curves are held to 0.998 of the acceleration, since the limits are asked only where parts meet.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from math import radians

import numpy as np

from nccompile.kernels import expect_work
from nccompile.kernels import reach as kernels
from nccompile.kernels.curves import NODES
from nccompile.passes.velocity.limits import limited
from nccompile.passes.velocity.parts import Parts, parted
from nccompile.passes.velocity.settings import PlanSettings
from nccompile.toolpath.columns import Bytes, Floats, Kind, Toolpath

__all__ = ["fastest"]

_TURN = radians(2.0)
"""Greatest turn of a part: between its ends an arc exceeds a limit by at most turn² / 8 = 1.5e-4."""

_WORK = 20
"""What an interval of a curve costs, in the units of `expect_work`: rows of a plain plan."""

_SHARE_V = 0.9997
"""The same for velocities."""

_SHARE = 0.998
"""Share of an axis's acceleration that is used on curves: room for what happens between ends of parts."""


def fastest(chunks: Iterable[Toolpath], settings: PlanSettings) -> Iterator[Toolpath]:
    """Planned chunks of the path."""
    stage = _Stage(settings)
    for chunk in chunks:
        yield from stage.feed(chunk)
    yield from stage.finish()


@dataclass(frozen=True)
class _Grid:
    """Intervals of a stretch of path: parts of rows, slopes q', q'' (m, 2, 3), lengths, which are curved."""

    parts: Parts
    d1: Floats
    d2: Floats
    length: Floats
    curved: Bytes


@dataclass
class _Stage:
    """The window: rows whose velocities may still change."""

    settings: PlanSettings
    _held: Toolpath | None = field(default=None, init=False)
    _x: float = field(default=0.0, init=False)  # v² before the rows held
    _out: int = field(default=0, init=False)

    def feed(self, chunk: Toolpath) -> Iterator[Toolpath]:
        """Takes the next chunk; yields what nothing can change any more."""
        if len(chunk):
            self._held = chunk if self._held is None else Toolpath.join([self._held, chunk])
            yield from self._settle(complete=False)

    def finish(self) -> Iterator[Toolpath]:
        """The rest of the path, which ends at rest."""
        if self._held is not None:
            yield from self._settle(complete=True)

    def _settle(self, *, complete: bool) -> Iterator[Toolpath]:
        assert self._held is not None
        path, known = limited(self._held, self.settings)
        grid = _grid(path)
        cap = _caps(path, grid, self.settings.limits.velocity)
        a_axis = _SHARE * self.settings.limits.acceleration[:3]
        bound = path.accel[grid.parts.row]
        expect_work(_WORK * int(grid.curved.sum()))
        x = np.empty(len(bound))
        known_intervals = int(np.searchsorted(grid.parts.row, known))
        settled = kernels.backward(
            grid.d1, grid.d2, grid.length, bound, a_axis, cap, known_intervals, int(complete), x
        )
        rows = len(path) if complete else int(grid.parts.row[settled]) if settled < len(x) else known
        if self.settings.window is not None:
            rows = max(rows, min(known, len(path) - self.settings.window))
        if rows == 0:
            return
        n = int(np.searchsorted(grid.parts.row, rows))
        d1, d2, length, bound, x = grid.d1[:n], grid.d2[:n], grid.length[:n], bound[:n], x[:n]
        kernels.forward(d1, d2, length, bound, a_axis, self._x, x)
        accel, decel = bound.copy(), bound.copy()
        kernels.ramps(d1, d2, length, bound, a_axis, self._x, x, accel, decel)
        yield self._planned(path, rows, grid, n, x, accel, decel)
        self._x = float(x[-1])
        self._held = None if rows == len(path) else self._held.rows(rows, len(path))

    def _planned(
        self, path: Toolpath, rows: int, grid: _Grid, n: int, x: Floats, accel: Floats, decel: Floats
    ) -> Toolpath:
        """The first `rows` rows with their velocities, curves cut."""
        parts = Parts(grid.parts.row[:n], grid.parts.p0[:n], grid.parts.p1[:n])
        out = parted(path.rows(0, rows), parts)
        assert out.v_limit is not None
        assert out.v_junction is not None
        v_end = np.sqrt(x)
        before = np.concatenate([[np.sqrt(self._x)], v_end[:-1]])
        curved = grid.curved[:n] == 1
        next_curved = np.append(curved[1:], n < len(grid.curved) and grid.curved[n] == 1)
        out = out.replace(
            v_end=v_end, accel=accel, decel=decel, first=self._out,
            v_limit=np.where(curved, np.maximum(before, v_end), out.v_limit),
            v_junction=np.where(curved | next_curved, v_end, out.v_junction),
        )  # fmt: skip
        self._out += len(out)
        return out


def _grid(path: Toolpath) -> _Grid:
    solid = ((path.profile & 0x7FFF) != 0).astype(np.uint8)
    room = len(path) + kernels.INTERVALS * int((path.curve >= 0).sum())
    row, p0, p1 = np.empty(room, np.int32), np.empty(room), np.empty(room)
    d1, d2 = np.empty((room, 2, 3)), np.empty((room, 2, 3))
    m = kernels.grid(
        path.kind, path.curve, path.curves.plane, path.curves.parameters, path.length, solid, _TURN,
        np.empty(NODES), np.empty(NODES), row, p0, p1, d1, d2,
    )  # fmt: skip
    row, p0, p1 = row[:m], p0[:m], p1[:m]
    length = path.length[row] * (p1 - p0)
    curved = ((path.curve[row] >= 0) & (solid[row] == 0) & (path.length[row] > kernels.SHORT)).astype(
        np.uint8
    )
    return _Grid(Parts(row, p0, p1), d1[:m], d2[:m], length, curved)


def _caps(path: Toolpath, grid: _Grid, v_axis: Floats) -> Floats:
    """Greatest v² at the end of every interval."""
    assert path.v_limit is not None
    assert path.v_junction is not None
    row = grid.parts.row
    top = np.where(path.kind < Kind.SET_POSITION, np.minimum(path.feed, path.v_limit), np.inf)[row]
    fastest_slope = np.abs(grid.d1).max(axis=1)
    with np.errstate(divide="ignore"):
        top = np.minimum(top, (_SHARE_V * v_axis[:3] / fastest_slope).min(axis=1))
    cap = top.copy()
    cap[:-1] = np.minimum(cap[:-1], top[1:])
    last = np.append(row[1:] != row[:-1], True)
    cap[last] = np.minimum(cap[last], path.v_junction[row[last]])
    out: Floats = cap * cap
    return out
