"""The machine's numbers as arrays, and the checks of a path against axes and travel.

NC401   the program moves an axis that the machine does not have
NC402   an axis leaves its travel
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nccompile.diagnostics import Diagnostics, Severity
from nccompile.machine.extents import extents
from nccompile.machine.model import Machine
from nccompile.source import Source
from nccompile.toolpath.columns import AXIS_LETTERS, Floats, Toolpath

__all__ = ["AxisLimits", "check_axes", "check_travel", "limits", "missing_axes", "offsets", "travel"]

TRAVEL_SLACK = 1e-9
"""Excess of travel that is rounding of arc ends and offsets, not motion [mm or deg]."""


@dataclass(frozen=True)
class AxisLimits:
    """Limits of k axes, f8 arrays of shape (k,), in mm (or deg) and seconds.

    An axis that the machine does not have is without limits (inf): `check_axes` reports it if it moves.
    `rapid` is inf where the machine leaves the velocity of G0 to the program's F, as SoftMotion does; `jerk`
    is None for limits without it.
    """

    velocity: Floats
    acceleration: Floats
    velocity_step: Floats
    rapid: Floats
    jerk: Floats | None = None


JERK_RATE = 40.0
"""Jerk over acceleration of an axis whose machine file has no `jerk` [1/s]: full acceleration after 25 ms."""


def limits(machine: Machine, axes: Sequence[str]) -> AxisLimits:
    """The limits of the path axes `axes`, in their order."""
    rows = [
        (
            a.velocity,
            a.acceleration,
            a.velocity_step,
            np.inf if a.rapid is None else a.rapid,
            JERK_RATE * a.acceleration if a.jerk is None else a.jerk,
        )
        if (a := machine.axes.get(letter)) is not None
        else (np.inf, np.inf, np.inf, np.inf, np.inf)
        for letter in axes
    ]
    return AxisLimits(*(np.array(column, np.float64) for column in zip(*rows, strict=True)))


def offsets(machine: Machine, axes: Sequence[str]) -> Floats:
    """Shape (k,): axis position minus path coordinate of the gantry [mm or deg]."""
    return np.array([machine.kinematics.offset.get(letter, 0.0) for letter in axes])


def travel(machine: Machine, axes: Sequence[str]) -> tuple[Floats, Floats]:
    """Least and greatest position of each axis [mm or deg], shape (k,); -inf and inf where there is none."""
    known = [machine.axes.get(letter) for letter in axes]
    low = np.array([-np.inf if a is None else a.low for a in known])
    return low, np.array([np.inf if a is None else a.high for a in known])


def missing_axes(machine: Machine, axes: Sequence[str]) -> tuple[str, ...]:
    """Those of `axes` that the machine does not have, in the order of the axis letters."""
    return tuple(letter for letter in AXIS_LETTERS if letter in axes and letter not in machine.axes)


def check_axes(chunk: Toolpath, machine: Machine, source: Source, diagnostics: Diagnostics) -> None:
    """Reports NC401 at the first segment of a chunk that moves an axis the machine does not have."""
    for letter in missing_axes(machine, chunk.axes):
        column = chunk.axes.index(letter)
        moving = np.flatnonzero(chunk.target[:, column] != chunk.starts()[:, column])
        if len(moving):
            diagnostics.report_line(
                "NC401",
                Severity.ERROR,
                f"the machine {machine.name} has no axis {letter}",
                source,
                int(chunk.line[moving[0]]),
                f"it has {' '.join(machine.axes)}; choose another machine file or leave the axis out",
            )


def check_travel(chunk: Toolpath, machine: Machine, source: Source, diagnostics: Diagnostics) -> None:
    """Reports NC402 for every segment that leaves the travel of an axis, once for each time it is left.

    Segments that start outside are the same excursion and are passed over, so the findings do not depend on
    the size of the chunks.  Arcs, ellipses and cubics are checked over their whole course.
    """
    low, high = travel(machine, chunk.axes)
    if not len(chunk) or not (np.isfinite(low).any() or np.isfinite(high).any()):
        return
    shift = offsets(machine, chunk.axes)
    least, greatest = extents(chunk)
    starts = chunk.starts() + shift
    inside = (starts >= low - TRAVEL_SLACK) & (starts <= high + TRAVEL_SLACK)
    if chunk.first == 0:
        inside[0] = True
    below = low - (least + shift)
    above = (greatest + shift) - high
    leaving = (np.maximum(below, above) > TRAVEL_SLACK) & inside
    for row, column in np.argwhere(leaving):
        letter = chunk.axes[column]
        under = below[row, column] > above[row, column]
        reached = (least if under else greatest)[row, column] + shift[column]
        axis = machine.axes[letter]
        bound = "minimum" if under else "maximum"
        limit = (low if under else high)[column]
        diagnostics.report_line(
            "NC402",
            Severity.ERROR,
            f"axis {letter} reaches {reached:.6g} {axis.unit}, beyond its {bound} of {limit:g} {axis.unit}",
            source,
            int(chunk.line[row]),
            f"the travel of {letter} on {machine.name} is {low[column]:g} to {high[column]:g} {axis.unit}"
            + (f", path coordinates are {shift[column]:g} {axis.unit} less" if shift[column] else ""),
        )
