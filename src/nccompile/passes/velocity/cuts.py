"""Ellipses and splines cut before their limits are known: at cusps, and where the curvature changes.

    in    decoded chunks
    out   the same path; a cubic that turns back on itself is two rows with a junction of 180 degrees, and a curve
          that would be run at its tightest bend's velocity throughout is a row for each velocity; for the
          planner `time-optimal` every curve is rows that turn by at most 1.25 degrees

What is cut where: `kernels.curve_parts`.  Rows with an S-profile stay whole (docs/decisions/054).
"""

from __future__ import annotations

from math import radians

import numpy as np

from nccompile.kernels import curve_parts as kernels
from nccompile.kernels import expect_work
from nccompile.passes.velocity.limits import creep
from nccompile.passes.velocity.parts import Parts, assembled
from nccompile.passes.velocity.settings import JERK, LOOK_AHEAD, TIME_OPTIMAL, PlanSettings
from nccompile.toolpath.columns import CURVE_PARAMETERS, Floats, Kind, Plane, Toolpath

__all__ = ["cut_at_bends"]

_ACROSS = 0.8
"""Share of an axis's acceleration that curvature takes (`kernels.plan.row_limits`)."""

_GAIN = 0.1
"""Share of a cycle that a cut has to save."""

_WORK = 20
"""What a curve costs, in the units of `expect_work`."""

_TURN = radians(1.25)
"""Greatest turn of a part where the planner follows the curve: time within 1 % of the optimum (docs/planning.md)."""

_AXES = {Plane.XY: (0, 1), Plane.ZX: (2, 0), Plane.YZ: (1, 2), Plane.SPACE: (0, 1, 2)}


def cut_at_bends(chunk: Toolpath, settings: PlanSettings) -> Toolpath:
    """The chunk with its ellipses and cubics cut; itself if there are none."""
    turn = _TURN if settings.planner == TIME_OPTIMAL else 0.0
    curved = (chunk.kind == Kind.ELLIPSE) | (chunk.kind == Kind.POLYNOMIAL)
    if turn:
        curved = chunk.curve >= 0
    number = int(curved.sum())
    if not number:
        return chunk
    expect_work(_WORK * number)
    across, top, slow = _bounds(chunk, settings)
    room = len(chunk) + kernels.PARTS * number
    row, ends = np.empty(room, np.int32), np.empty(room, np.uint8)
    u0, u1 = np.empty(room), np.empty(room)
    whole = ((chunk.profile & 0x7FFF) != 0).astype(np.uint8)
    m = kernels.curve_parts(
        chunk.kind, chunk.curve, chunk.curves.parameters, chunk.length, whole, across, top, slow,
        _GAIN * settings.cycle, turn, row, u0, u1, ends,
    )  # fmt: skip
    if m == len(chunk):
        return chunk
    row, u0, u1, ends = row[:m], u0[:m], u1[:m], ends[:m]
    p0, p1, target, parameters = (
        np.empty(m),
        np.empty(m),
        np.empty((m, len(chunk.axes))),
        np.zeros((m, CURVE_PARAMETERS)),
    )
    kernels.cut_curves(
        chunk.kind, chunk.starts(), chunk.target, chunk.curve, chunk.curves.plane, chunk.curves.parameters, row,
        u0, u1, ends, p0, p1, target, parameters,
    )  # fmt: skip
    return assembled(chunk, Parts(row, p0, p1), target, parameters, chunk.length[row] * (p1 - p0))


def _bounds(chunk: Toolpath, settings: PlanSettings) -> tuple[Floats, Floats, Floats]:
    """What decides about cuts, by row: acceleration for curvature, greatest velocity, velocity of any bend.

    Planners that follow the curvature themselves, or know no axes, leave the acceleration unlimited.
    """
    n = len(chunk)
    feed = np.where(chunk.feed > 0.0, chunk.feed, settings.feed)
    across, top, slow = np.full(n, np.inf), feed.copy(), np.zeros(n)
    if settings.planner not in (LOOK_AHEAD, JERK):
        return across, top, slow
    limits = settings.planned_limits
    curved = np.flatnonzero(chunk.curve >= 0)
    plane = chunk.curves.plane[chunk.curve[curved]]
    slowest = creep(settings)
    for value, columns in _AXES.items():
        rows, axes = curved[plane == value], list(columns)
        across[rows] = min(_ACROSS * float(limits.acceleration[axes].min()), settings.centripetal)
        top[rows] = np.minimum(feed[rows], limits.velocity[axes].min())
        slow[rows] = slowest[axes].min()
    return across, top, np.minimum(slow, top)
