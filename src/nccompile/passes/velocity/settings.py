"""What the planner needs to know of the machine and the options, as arrays in the order of the axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, pi, radians

import numpy as np

from nccompile.kernels.corners import NO_DEVIATION, PARABOLA
from nccompile.kernels.timelaw import LAW_NAMES, TRAPEZOID
from nccompile.machine.limits import AxisLimits, limits
from nccompile.machine.model import Machine
from nccompile.units import seconds_from_us

__all__ = ["JERK", "LAWS", "LOOK_AHEAD", "PLANNERS", "SOFTMOTION", "TIME_OPTIMAL", "WINDOW", "PlanSettings"]

SOFTMOTION = "softmotion"
LOOK_AHEAD = "look-ahead"
JERK = "jerk"
TIME_OPTIMAL = "time-optimal"

PLANNERS = (SOFTMOTION, LOOK_AHEAD, JERK, TIME_OPTIMAL)
"""Planners by the name that command line and machine file use."""

WINDOW = 30_000
"""Rows that a row's end velocity may depend on (as many blocks as INTERP looks ahead, §1.7)."""

LAWS = {name: law for law, name in enumerate(LAW_NAMES)}
"""Time laws by the name that machine file, command line and queue use."""


@dataclass(frozen=True)
class PlanSettings:
    """Settings of the velocity planner.

    feed [mm/s], accel, decel [mm/s²]: for segments where the program says nothing; angle_tolerance [rad];
    cycle [s]: the time in which an axis velocity may jump by its step once; law: `LAWS`; planner: `PLANNERS`;
    window: rows looked ahead, None for all; junction_deviation [mm]: how far a corner may be cut by a drive
    that does not jump, None for no such rule; junction_rule: PARABOLA, or CIRCLE as grbl and Klipper do;
    rapid_stops: positionings stop at both ends (SoftMotion §3.2); corner_angle [rad]: bend in all axes above which
    the path stops (OPENcontrol's MDA); centripetal, centripetal_jump [mm/s²]: greatest v² times curvature, and its
    greatest jump.
    """

    limits: AxisLimits
    feed: float
    accel: float
    decel: float
    angle_tolerance: float
    cycle: float
    law: int
    planner: str = LOOK_AHEAD
    window: int | None = WINDOW
    junction_deviation: float | None = None
    junction_rule: int = PARABOLA
    rapid_stops: bool = True
    corner_angle: float = pi
    centripetal: float = inf
    centripetal_jump: float = inf

    @property
    def rule(self) -> int:
        """The rule of the junction deviation in force, as the kernel takes it."""
        return NO_DEVIATION if self.junction_deviation is None else self.junction_rule

    @property
    def limits_turns(self) -> bool:
        """Whether the machine has limits of turns beside those of its axes."""
        return self.corner_angle < pi or self.centripetal < inf or self.centripetal_jump < inf

    @property
    def planned_limits(self) -> AxisLimits:
        """The limits that the planner respects: none of the axes' with the manual's rules."""
        if self.planner != SOFTMOTION:
            return self.limits
        none = np.full(len(self.limits.velocity), inf)
        return AxisLimits(none, none, none, none, none)

    @classmethod
    def from_machine(
        cls,
        machine: Machine,
        axes: Sequence[str],
        *,
        angle_tolerance_deg: float | None = None,
        time_law: str | None = None,
        planner: str | None = None,
        window: int | None = WINDOW,
        junction_deviation: float | None = None,
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
            law=TRAPEZOID if planner in (JERK, TIME_OPTIMAL) else LAWS[time_law or path.time_law],
            planner=planner or LOOK_AHEAD,
            window=window,
            junction_deviation=junction_deviation,
            corner_angle=radians(path.corner_angle),
            centripetal=inf if path.centripetal_acceleration is None else path.centripetal_acceleration,
            centripetal_jump=inf if path.centripetal_jump is None else path.centripetal_jump,
        )
