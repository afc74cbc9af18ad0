"""What must hold for every planner, on any path: limits in every cycle, the end at rest, the time of the plan.

Independent of the planner: set positions are differentiated, and measured against the decoded path.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from nccompile.backend.samples import SampleBlock, sample
from nccompile.passes.velocity import SOFTMOTION, PlanSettings
from nccompile.passes.velocity.planner import plan, row_times
from nccompile.toolpath.columns import Floats, Kind, Toolpath
from nccompile.toolpath.verify import verify_chain

__all__ = [
    "NEVER_SLOWER",
    "WINDOWS",
    "broken_limits",
    "off_the_path",
    "planned_time",
    "sampled",
    "times_by_window",
]

SLACK = 1e-6
"""Relative, of every limit."""

WINDOWS = (1, 2, 100, 30_000, None)

NEVER_SLOWER = 1.0 + 1e-9
"""Ratio of the times with a larger and a smaller window."""

_LINEAR = 3

_HANDSHAKE = 3
"""Cycles that an M function, a dwell or a G92 may add: it begins and ends in cycles of its own."""


def sampled(chunks: Sequence[Toolpath], cycle: float) -> SampleBlock:
    """All set positions of a plan."""
    blocks = list(sample(chunks, cycle))
    return SampleBlock(*(np.concatenate(column) for column in zip(*blocks, strict=True)))


def planned_time(chunks: Sequence[Toolpath]) -> float:
    """Seconds of a plan."""
    total, before = 0.0, 0.0
    for chunk in chunks:
        assert chunk.v_end is not None
        total += float(row_times(chunk, before).sum())
        before = float(chunk.v_end[-1]) if len(chunk) else before
    return total


def broken_limits(path: Sequence[Toolpath], settings: PlanSettings, cycle: float) -> list[str]:
    """Plans a path, and what is wrong with its set positions every `cycle` seconds: nothing, one hopes."""
    chunks = list(verify_chain(plan(path, settings)))
    block = sampled(chunks, cycle)
    found = []
    v_end = chunks[-1].v_end
    if v_end is None or v_end[-1] != 0.0 or not np.array_equal(block.position[-1], path[-1].end):
        found.append(f"ends at {block.position[-1]} instead of {path[-1].end} at rest")
    expected = planned_time(chunks)
    waits = sum(int((chunk.kind > Kind.POLYNOMIAL).sum()) for chunk in path)
    room = cycle * (1.0 + SLACK + _HANDSHAKE * waits) + 1e-9 * expected
    if abs(block.t[-1] - expected) > room:
        found.append(f"{block.t[-1]} s in cycles of {cycle} s, planned {expected} s")
    if settings.planner == SOFTMOTION:
        return found  # the manual's rules know no axes
    jumps = np.flatnonzero(_jumps(path, block))
    v = np.diff(block.position, axis=0) / cycle
    v[jumps] = np.nan
    dv = np.abs(np.diff(v, axis=0))
    noise = 1e-15 * float(np.abs(block.position).max(initial=1.0)) / cycle
    limits = settings.limits
    for i, letter in enumerate(path[0].axes):
        fastest = float(np.nanmax(np.abs(v[:, i]), initial=0.0))
        if fastest > limits.velocity[i] * (1.0 + SLACK) + 2.0 * noise:
            found.append(f"{letter} runs at {fastest}, limit {limits.velocity[i]}")
        most = float(np.nanmax(dv[:, i], initial=0.0))
        room = limits.acceleration[i] * cycle + limits.velocity_step[i]
        if most > room * (1.0 + SLACK) + 4.0 * noise:
            found.append(f"{letter} changes by {most} mm/s in a cycle of {cycle} s, limit {room}")
    return found


def _jumps(path: Sequence[Toolpath], block: SampleBlock) -> npt.NDArray[np.bool_]:
    """Between which set positions a G92 moved the coordinates; source lines ascend."""
    lines = np.concatenate([chunk.line[chunk.kind == Kind.SET_POSITION] for chunk in path])
    jumped: npt.NDArray[np.bool_] = np.diff(np.searchsorted(lines, block.line, side="right")) != 0
    return jumped


def off_the_path(path: Toolpath, settings: PlanSettings, cycle: float) -> float:
    """The greatest distance of a set position from the line or arc of its source line, in X, Y, Z [mm].

    Every row of the path must have a source line of its own.
    """
    block = sampled(list(plan([path], settings)), cycle)
    starts, worst = path.starts(), 0.0
    row_of = {int(line): j for j, line in enumerate(path.line)}
    for line in np.unique(block.line):
        j = row_of.get(int(line))
        if j is None or path.kind[j] > Kind.ARC:
            continue
        points = block.position[block.line == line][:, :_LINEAR]
        if path.kind[j] == Kind.ARC:
            cu, cv, r = path.curves.parameters[path.curve[j], :3]
            away = np.abs(np.hypot(points[:, 0] - cu, points[:, 1] - cv) - r)
        else:
            away = _from_line(points, starts[j, :_LINEAR], path.target[j, :_LINEAR])
        worst = max(worst, float(away.max(initial=0.0)))
    return worst


def _from_line(points: Floats, a: Floats, b: Floats) -> Floats:
    size2 = float((b - a) @ (b - a))
    share = np.clip((points - a) @ (b - a) / size2, 0.0, 1.0) if size2 else np.zeros(len(points))
    out: Floats = np.linalg.norm(points - (a + share[:, None] * (b - a)), axis=1)
    return out


def times_by_window(path: Sequence[Toolpath], settings: PlanSettings) -> list[float]:
    """Seconds of the plans with every one of `WINDOWS`."""
    return [planned_time(list(plan(path, replace(settings, window=window)))) for window in WINDOWS]
