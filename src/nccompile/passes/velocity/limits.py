"""Limits of segments and junctions: what the program, the machine and the bends of the path allow."""

from __future__ import annotations

from math import sin

import numpy as np

from nccompile.kernels import plan as kernels
from nccompile.kernels.corners import junctions
from nccompile.kernels.interpolator_rows import CONTINUES
from nccompile.kernels.timelaw import peak_factor
from nccompile.kernels.turns import turn_limits
from nccompile.passes.velocity.settings import SOFTMOTION, TIME_OPTIMAL, PlanSettings
from nccompile.toolpath.columns import Floats, Toolpath

__all__ = ["creep", "limited", "unfinished"]

_UNLIMITED = 1e6
"""v_limit of segments that nothing but their feed limits [mm/s]: the greatest velocity a machine may have."""

_UNBOUND = 1e9
"""Path acceleration that only the axes limit [mm/s²]: the greatest one a machine may have."""


def creep(settings: PlanSettings) -> Floats:
    """Shape (k,): the path velocity at which any bend may be run [mm/s].

    Even a turn back changes an axis velocity by no more than 2 v, so half of its velocity step is allowed at any
    curvature.  An axis without a step has what 0.4 of its acceleration makes in a cycle.
    """
    axis = settings.planned_limits
    stepped = (axis.velocity_step > 0.0) & np.isfinite(axis.velocity_step)
    return np.where(stepped, 0.5 * axis.velocity_step, 0.2 * axis.acceleration * settings.cycle)


def _whole_lengths(chunk: Toolpath, before: float) -> Floats:
    """Shape (n,): the length of the segment that each row is a part of; before [mm]: parts of the first one's."""
    parted = (chunk.profile >> np.uint16(CONTINUES)) & 1
    if before == 0.0 and not parted.any():
        return chunk.length
    segment = np.append(0, np.cumsum(1 - parted[:-1].astype(np.int64)))
    whole: Floats = np.bincount(segment, chunk.length).astype(np.float64)
    whole[0] += before
    out: Floats = whole[segment]
    return out


def unfinished(done: Toolpath, before: float) -> float:
    """Length of the parts put out so far of the segment that goes on behind `done` [mm]; before: as for `limited`."""
    if not len(done) or (int(done.profile[-1]) >> CONTINUES) & 1 == 0:
        return 0.0
    return float(_whole_lengths(done, before)[-1])


def limited(chunk: Toolpath, settings: PlanSettings, before: float = 0.0) -> tuple[Toolpath, int]:
    """The chunk with feed, accel and decel in force, v_limit and v_junction; v_end is 0.

    At junctions a row counts with the length of the whole segment it is a part of; before: length of those parts of
    the first segment that are not in the chunk any more (`unfinished`).
    Returns it with the number of leading rows whose junction is known: the last row that moves waits for the
    next one.
    """
    n = len(chunk)
    feed = np.where(chunk.feed > 0.0, chunk.feed, settings.feed)
    accel = np.where(chunk.accel > 0.0, chunk.accel, settings.accel)
    decel = np.where(chunk.decel > 0.0, chunk.decel, settings.decel)
    v_limit, v_junction = np.empty(n), np.empty(n)
    t_start, t_end = np.empty_like(chunk.target), np.empty_like(chunk.target)
    axis = settings.planned_limits
    straight = np.zeros(n, np.uint8)
    if settings.planner == TIME_OPTIMAL:
        straight[(chunk.profile & 0x7FFF) == 0] = 1
        accel[:] = decel[:] = _UNBOUND
    kernels.row_limits(
        chunk.kind, chunk.starts(), chunk.target, chunk.curve, chunk.curves.plane, chunk.curves.parameters,
        chunk.length, chunk.profile, axis.velocity, axis.acceleration, axis.rapid,
        creep(settings), peak_factor(settings.law), straight,
        feed, accel, decel, v_limit, t_start, t_end,
    )  # fmt: skip
    v_limit = np.where(np.isfinite(v_limit), v_limit, np.maximum(feed, _UNLIMITED))
    chord = 2.0 * sin(0.5 * settings.angle_tolerance)
    known = junctions(
        chunk.kind, _whole_lengths(chunk, before), v_limit, np.minimum(accel, decel), t_start, t_end, axis.acceleration,
        axis.velocity_step, chord, settings.cycle, settings.rule, settings.junction_deviation or 0.0,
        int(settings.rapid_stops), v_junction,
    )  # fmt: skip
    if settings.planner != SOFTMOTION and settings.limits_turns:
        turn_limits(
            chunk.kind, chunk.starts(), chunk.target, chunk.curve, chunk.curves.plane, chunk.curves.parameters,
            chunk.length, t_start, t_end, 2.0 * sin(0.5 * settings.corner_angle), settings.centripetal,
            settings.centripetal_jump, v_limit, v_junction,
        )  # fmt: skip
    planned = chunk.replace(
        feed=feed, accel=accel, decel=decel, v_limit=v_limit, v_junction=v_junction, v_end=np.zeros(n)
    )
    return planned, known
