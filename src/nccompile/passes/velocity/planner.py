"""check-velocities: the end velocity of every segment (SMC_CheckVelocities, SoftMotion §3.2 and §6.2.7).

    in    decoded chunks: feed, accel, decel as programmed, 0 where they were not
    out   planned chunks: feed, accel, decel in force, v_limit, v_junction, v_end

Rules, in this order; each can only lower what the ones before allow:

    1. junction = 0 next to positionings, stops, and where the path bends by more than the angle tolerance;
       otherwise the lower commanded velocity of both segments (the manual's rule)
    2. the machine: axis velocity, acceleration also on curves, the velocity step at a junction, and, if given,
       the junction deviation; not with the planner `softmotion`, which knows the manual's rules only
    3. look-ahead: no velocity that cannot be braked (deceleration) or reached (acceleration) in time

Look-ahead runs on a window and passes on only rows that no later row can change, so the result is that of
an infinite window and does not depend on the chunk size.

         |<------------- window ------------->|
    v    |      ____      cap                 |
         |  ___/    \\__________               |
         |_/           settled | \\            |   the rest is braking to 0: unknown rows follow
         +---------------------+--\\-----------+
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from nccompile.kernels import plan as kernels
from nccompile.passes.velocity.cuts import cut_at_bends
from nccompile.passes.velocity.jerk import JerkPlanner
from nccompile.passes.velocity.limits import limited, unfinished
from nccompile.passes.velocity.optimal import OptimalPlanner
from nccompile.passes.velocity.settings import JERK, TIME_OPTIMAL, PlanSettings
from nccompile.toolpath.columns import EventKind, Floats, Kind, Toolpath

__all__ = ["Planner", "plan", "row_times"]

_PLANNERS: dict[str, Callable[[PlanSettings], JerkPlanner | OptimalPlanner | Planner]] = {
    JERK: JerkPlanner,
    TIME_OPTIMAL: OptimalPlanner,
}
"""Planners with a window of their own; the others are `Planner`."""


def plan(chunks: Iterable[Toolpath], settings: PlanSettings) -> Iterator[Toolpath]:
    """Plans the velocities of a path; the chunks that come out are cut where rows settle."""
    planner = _PLANNERS.get(settings.planner, Planner)(settings)
    for chunk in chunks:
        yield from planner.feed(chunk)
    yield from planner.finish()


@dataclass
class Planner:
    """The window of the planners `softmotion` and `look-ahead`, for callers who push chunks themselves."""

    settings: PlanSettings
    _pending: Toolpath | None = field(default=None, init=False)
    _idle: Toolpath | None = field(default=None, init=False)
    _v_before: float = field(default=0.0, init=False)
    _out: int = field(default=0, init=False)  # rows put out
    _before: float = field(default=0.0, init=False)  # of the first segment pending, what is out already

    def feed(self, chunk: Toolpath) -> Iterator[Toolpath]:
        """Takes the next chunk; yields what it settles."""
        if len(chunk):
            if chunk.v_limit is None:
                chunk = cut_at_bends(chunk, self.settings)
            self._pending = chunk if self._pending is None else Toolpath.join([self._pending, chunk])
            self._idle = None
            yield from self._settle(complete=False)
        elif self._pending is None and chunk.first == 0:
            self._idle = chunk  # a path without a segment still has axes and a start

    def finish(self) -> Iterator[Toolpath]:
        """The rest of the path, which ends at rest."""
        if self._idle is not None:
            yield plan_window(self._idle, self.settings, 0.0, complete=True)[0]
        if self._pending is not None:
            yield from self._settle(complete=True)

    def _settle(self, *, complete: bool) -> Iterator[Toolpath]:
        assert self._pending is not None
        planned, settled = plan_window(
            self._pending, self.settings, self._v_before, complete=complete, before=self._before
        )
        if settled == 0:
            return
        done = planned.rows(0, settled)
        assert done.v_end is not None
        self._v_before = float(done.v_end[-1])
        self._before = unfinished(done, self._before)
        self._pending = self._pending.rows(settled, len(planned)) if settled < len(planned) else None
        yield done.replace(first=self._out)
        self._out += len(done)


def plan_window(
    window: Toolpath, settings: PlanSettings, v_before: float, *, complete: bool, before: float = 0.0
) -> tuple[Toolpath, int]:
    """A window with its velocities planned, and how many of its leading rows are settled; before: as `limited`."""
    known = len(window)
    if window.v_limit is None:
        window, known = limited(window, settings, before)
    assert window.v_limit is not None
    assert window.v_junction is not None
    v_end = np.empty(len(window))
    settled = kernels.look_ahead(
        window.kind, window.length, window.feed, window.v_limit, window.v_junction, window.accel, window.decel,
        v_before, known, int(complete), settings.window or 0, v_end,
    )  # fmt: skip
    return window.replace(v_end=v_end), settled


def row_times(chunk: Toolpath, v_before: float) -> Floats:
    """Shape (n,): the time of every segment at override 1 [s]; M functions count 0, dwells their seconds.

    v_before: velocity at the start of the chunk [mm/s], the end velocity of the chunk before it; a third-order
    plan has no acceleration there.
    """
    assert chunk.v_limit is not None
    assert chunk.v_end is not None
    out = np.empty(len(chunk))
    if chunk.a_end is not None:
        kernels.third_order_durations(chunk.kind, chunk.length, chunk.v_end, chunk.a_end, v_before, out)
    else:
        kernels.durations(
            chunk.kind, chunk.length, chunk.feed, chunk.v_limit, chunk.v_end, chunk.accel, chunk.decel, v_before, out
        )  # fmt: skip
    e = chunk.events
    dwell = (e.kind == EventKind.DWELL) & (chunk.kind[e.segment] == Kind.DWELL)
    out[e.segment[dwell]] = e.k[dwell]
    return out
