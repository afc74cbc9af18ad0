"""Planner `time-optimal`: the fastest velocities along the path under the axes' velocities and accelerations.

    in    decoded chunks
    out   planned chunks; curves are cut in rows with a constant path acceleration each

The program's F is kept as a limit; E and the machine's path acceleration are not: the axes' limits count.
Straight segments need no cuts: their trapezoid at the axes' limit is the optimum.  `kernels.reach` has the
method and what a row keeps back because the limits are asked only where rows meet.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from nccompile.kernels import expect_work
from nccompile.kernels import reach as kernels
from nccompile.passes.velocity.cuts import cut_at_bends
from nccompile.passes.velocity.limits import limited, unfinished
from nccompile.passes.velocity.settings import PlanSettings
from nccompile.toolpath.columns import Floats, Kind, Toolpath

__all__ = ["OptimalPlanner"]

Flags = npt.NDArray[np.bool_]

_WORK = 12
"""What a curved row costs, in the units of `expect_work`: rows of a plain plan."""

_SLACK = 1e-6
"""Relative room of the limits for rounding."""


@dataclass(frozen=True)
class _Bends:
    """How rows follow their curves: q', q'' (n, 2, 3), greatest |q'| (n, 3), share of A (n,), curved (n,)."""

    d1: Floats
    d2: Floats
    widest: Floats
    share: Floats
    curved: Flags


@dataclass
class OptimalPlanner:
    """The window of the planner: rows whose velocities may still change."""

    settings: PlanSettings
    _held: Toolpath | None = field(default=None, init=False)
    _x: float = field(default=0.0, init=False)  # v² before the rows held
    _out: int = field(default=0, init=False)
    _before: float = field(default=0.0, init=False)  # of the first segment held, what is out already

    def feed(self, chunk: Toolpath) -> Iterator[Toolpath]:
        """Takes the next chunk; yields what nothing can change any more."""
        if len(chunk):
            chunk = cut_at_bends(chunk, self.settings)
            self._held = chunk if self._held is None else Toolpath.join([self._held, chunk])
            yield from self._settle(complete=False)

    def finish(self) -> Iterator[Toolpath]:
        """The rest of the path, which ends at rest."""
        if self._held is not None:
            yield from self._settle(complete=True)

    def _settle(self, *, complete: bool) -> Iterator[Toolpath]:
        assert self._held is not None
        path, known = limited(self._held, self.settings, self._before)
        a_axis = (1.0 - _SLACK) * self.settings.limits.acceleration[:3]
        bends = _bends(path, a_axis)
        expect_work(_WORK * int(bends.curved.sum()))
        cap = _caps(path, bends, self.settings.limits.velocity)
        x = np.empty(len(path))
        rows = kernels.backward(
            bends.d1, bends.d2, path.length, path.accel, bends.share, a_axis, cap, known, int(complete), x
        )
        if self.settings.window is not None:
            rows = max(rows, min(known, len(path) - self.settings.window))
        if rows < len(path):
            # The first row held has a length, for the bend behind rows without one is that from the row before them.
            rows = int(np.max(np.flatnonzero(path.length[: rows + 1] > 0.0), initial=0))
        if rows == 0:
            return
        done = path.rows(0, rows)
        x = x[:rows]
        given = (
            bends.d1[:rows],
            bends.d2[:rows],
            done.length,
            done.accel,
            bends.share[:rows],
            a_axis,
            self._x,
        )
        kernels.forward(*given, x)
        accel, decel = done.accel.copy(), done.accel.copy()
        kernels.ramps(*given, x, accel, decel)
        yield self._planned(done.replace(accel=accel, decel=decel), x, bends.curved)
        self._x = float(x[-1])
        self._before = unfinished(done, self._before)
        self._held = None if rows == len(path) else self._held.rows(rows, len(path))

    def _planned(self, done: Toolpath, x: Floats, curved: Flags) -> Toolpath:
        """Settled rows with their velocities; curved (n,): also of the rows after them."""
        assert done.v_limit is not None
        assert done.v_junction is not None
        n = len(done)
        v_end = np.sqrt(x)
        before = np.concatenate([[np.sqrt(self._x)], v_end[:-1]])
        at_curve = curved[:n] | np.append(curved, False)[1 : n + 1]
        out = done.replace(
            v_end=v_end, first=self._out,
            v_limit=np.where(curved[:n], np.maximum(before, v_end), done.v_limit),
            v_junction=np.where(at_curve, v_end, done.v_junction),
        )  # fmt: skip
        self._out += n
        return out


def _bends(path: Toolpath, a_axis: Floats) -> _Bends:
    assert path.v_limit is not None
    n = len(path)
    solid = (path.profile & 0x7FFF) != 0
    bends = _Bends(
        np.empty((n, 2, 3)), np.empty((n, 2, 3)), np.empty((n, 3)), np.empty(n),
        (path.curve >= 0) & ~solid & (path.length > 0.0),
    )  # fmt: skip
    kernels.slopes(
        path.kind, path.starts(), path.target, path.curve, path.curves.plane, path.curves.parameters, path.length,
        solid.astype(np.uint8), np.minimum(path.feed, path.v_limit), a_axis, bends.d1, bends.d2, bends.widest,
        bends.share,
    )  # fmt: skip
    return bends


def _caps(path: Toolpath, bends: _Bends, v_axis: Floats) -> Floats:
    """Greatest v² at the end of every row."""
    assert path.v_limit is not None
    assert path.v_junction is not None
    top = np.where(path.kind < Kind.SET_POSITION, np.minimum(path.feed, path.v_limit), np.inf)
    with np.errstate(divide="ignore"):
        top = np.minimum(top, ((1.0 - _SLACK) * v_axis[:3] / bends.widest).min(axis=1))
    cap = np.minimum(top, path.v_junction)
    cap[:-1] = np.minimum(cap[:-1], top[1:])
    out: Floats = cap * cap
    return out
