"""Third-order plans of straight lines for tests, made without the planner: constant jerks strung together."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from nccompile.kernels.interpolator import CONTINUES
from nccompile.toolpath.columns import Floats, Toolpath

ACCEL, DECEL, JERK = 800.0, 1000.0, 20_000.0


def ramp(by: float, accel: float, jerk: float) -> list[tuple[float, float]]:
    """Durations and jerks that change the velocity by `by`, from and to no acceleration."""
    j = jerk if by > 0.0 else -jerk
    size = abs(by)
    if size * jerk >= accel * accel:
        return [(accel / jerk, j), (size / accel - accel / jerk, 0.0), (accel / jerk, -j)]
    t = float(np.sqrt(size / jerk))
    return [(t, j), (t, -j)]


def levels(velocities: list[float], cruise: list[float], jerk: float = JERK) -> list[tuple[float, float]]:
    """Durations and jerks from rest over the given velocities, each held for a time, to rest."""
    phases: list[tuple[float, float]] = []
    v = 0.0
    for to, hold in zip([*velocities, 0.0], [*cruise, 0.0], strict=True):
        if to != v:
            phases += ramp(to - v, ACCEL if to > v else DECEL, jerk)
        if hold > 0.0 and to > 0.0:
            phases.append((hold, 0.0))
        v = to
    return [phase for phase in phases if phase[0] > 0.0]


def plan_of(phases: list[tuple[float, float]], cuts: int = 1, top: float = 150.0) -> Toolpath:
    """A planned path along X that runs the phases, each cut into rows; it starts and ends at rest.

    Limits: ACCEL, DECEL, JERK, and `top` for velocities above the programmed ones.
    """
    length, v_end, a_end, feed = [], [], [], []
    v = a = 0.0
    for duration, jerk in phases:
        t = duration / cuts
        for _ in range(cuts):
            length.append(t * (v + t * (a / 2 + t * jerk / 6)))
            v, a = v + t * (a + t * jerk / 2), a + t * jerk
            v, a = (0.0 if abs(v) < 1e-9 else v), (0.0 if abs(a) < 1e-7 else a)
            v_end.append(v)
            a_end.append(a)
            feed.append(100.0)
    n = len(length)
    x = np.cumsum(length)
    limit = np.full(n, top)
    ends = np.array(v_end)
    profile = np.full(n, 1 << CONTINUES, np.uint16)
    profile[ends == 0.0] = 0
    return Toolpath.empty(("X", "Y", "Z")).replace(
        kind=np.ones(n, np.uint8), target=np.column_stack([x, 0.5 * x, 0 * x]) / np.sqrt(1.25),
        curve=np.full(n, -1, np.int32), length=np.array(length), feed=np.array(feed),
        accel=np.full(n, ACCEL), decel=np.full(n, DECEL), radius=np.zeros(n), mark=np.zeros(n, np.uint16),
        profile=profile, line=np.arange(1, n + 1, dtype=np.int32),
        v_limit=limit, v_junction=np.where(ends == 0.0, 0.0, limit), v_end=ends, a_end=np.array(a_end),
        jerk=np.full(n, JERK),
    )  # fmt: skip


@st.composite
def plans(draw: st.DrawFn) -> Toolpath:
    """Random plans: levels of velocity with ramps between them, and rests."""
    phases: list[tuple[float, float]] = []
    for _ in range(draw(st.integers(1, 3))):
        count = draw(st.integers(1, 5))
        velocity = draw(st.lists(st.floats(1.0, 100.0), min_size=count, max_size=count))
        hold = draw(st.lists(st.sampled_from([0.0, 0.002, 0.05, 0.3]), min_size=count, max_size=count))
        phases += levels(velocity, hold, draw(st.sampled_from([JERK, 0.5 * JERK])))
    return plan_of(phases, draw(st.sampled_from([1, 3, 17])))


def derivatives(way: Floats, cycle: float) -> tuple[Floats, Floats, Floats]:
    """Velocity, acceleration and jerk as differences over cycles of the way covered in each."""
    v = np.concatenate([[0.0, 0.0, 0.0], way, [0.0, 0.0, 0.0]]) / cycle
    a = np.diff(v) / cycle
    return v, a, np.diff(a) / cycle
