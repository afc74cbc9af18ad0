"""What the planner needs to know of the machine and the options, as arrays in the order of the axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import radians

from nccompile.kernels.timelaw import SIGMOID, TRAPEZOID
from nccompile.machine.limits import AxisLimits, limits
from nccompile.machine.model import Machine
from nccompile.units import seconds_from_us

__all__ = ["LAWS", "PlanSettings"]

LAWS = {"trapezoid": TRAPEZOID, "sigmoid": SIGMOID}
"""Time laws by the name that machine file, command line and queue use."""


@dataclass(frozen=True)
class PlanSettings:
    """Settings of the velocity planner.

    feed [mm/s], accel, decel [mm/s²]: for segments where the program says nothing; angle_tolerance [rad];
    cycle [s]: the time in which an axis velocity may jump by its step once; law: `LAWS`.
    """

    limits: AxisLimits
    feed: float
    accel: float
    decel: float
    angle_tolerance: float
    cycle: float
    law: int

    @classmethod
    def from_machine(
        cls,
        machine: Machine,
        axes: Sequence[str],
        *,
        angle_tolerance_deg: float | None = None,
        time_law: str | None = None,
    ) -> PlanSettings:
        """The machine's settings, with options of the command line over them."""
        path = machine.path
        angle_deg = path.angle_tolerance if angle_tolerance_deg is None else angle_tolerance_deg
        return cls(
            limits=limits(machine, axes),
            feed=path.feed,
            accel=path.acceleration,
            decel=path.deceleration,
            angle_tolerance=radians(angle_deg),
            cycle=seconds_from_us(machine.cycle_us),
            law=LAWS[time_law or path.time_law],
        )
