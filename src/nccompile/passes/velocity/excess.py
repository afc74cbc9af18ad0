"""Where a plan by the manual's rules alone asks more of the machine than its file allows.

The planner `softmotion` knows no machine (docs/decisions/050): its plan is checked against the limits that the
planner `look-ahead` would have kept.

NC501   a segment or junction is planned beyond the machine's limits
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from nccompile.diagnostics import Diagnostics, Severity
from nccompile.passes.velocity.limits import limited
from nccompile.passes.velocity.settings import LOOK_AHEAD, PlanSettings
from nccompile.source import Source
from nccompile.toolpath.columns import Toolpath

__all__ = ["check_excess"]

_SLACK = 1.0 + 1e-9


def check_excess(
    chunks: Iterable[Toolpath], settings: PlanSettings, source: Source, diagnostics: Diagnostics
) -> Iterator[Toolpath]:
    """Hands planned chunks on and reports NC501 for the first excess of every source line of a chunk."""
    bound = replace(settings, planner=LOOK_AHEAD)
    for chunk in chunks:
        for row, what in sorted(_excesses(chunk, bound).items()):
            diagnostics.report_line(
                "NC501",
                Severity.WARNING,
                f"{what}, more than the machine file allows",
                source,
                int(chunk.line[row]),
                "the planner look-ahead keeps the machine's limits",
            )
        yield chunk


def _excesses(chunk: Toolpath, bound: PlanSettings) -> dict[int, str]:
    """What exceeds the limits, by row: the last of velocity, acceleration and step that does."""
    assert chunk.v_end is not None
    machine, known = limited(chunk, bound)
    assert machine.v_limit is not None
    assert machine.v_junction is not None
    moving = chunk.length > 0.0
    found: dict[int, str] = {}
    for i in np.flatnonzero(moving & (chunk.feed > machine.v_limit * _SLACK)):
        found[int(i)] = f"the velocity is {chunk.feed[i]:.6g} mm/s"
    ramps = np.maximum(chunk.accel / machine.accel, chunk.decel / machine.decel)
    for i in np.flatnonzero(moving & (ramps > _SLACK)):
        found[int(i)] = f"the acceleration is {max(chunk.accel[i], chunk.decel[i]):.6g} mm/s²"
    junction = moving & (chunk.v_end > machine.v_junction * _SLACK)
    for i in np.flatnonzero(junction[:known]):
        found[int(i)] = f"the bend after the segment is run at {chunk.v_end[i]:.6g} mm/s"
    return found
