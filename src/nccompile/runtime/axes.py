"""The axes as the application sees them: AXIS_REF (SoftMotion §2.4) with the states of PLCopen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

from nccompile.errors import RuntimeFault
from nccompile.runtime.drives.protocol import FaultCode
from nccompile.toolpath.columns import Floats

__all__ = ["Axis", "AxisGroup", "AxisState"]


class AxisState(IntEnum):
    """State of an axis; the numbers are those of nAxisState (SoftMotion §2.4, no. 1000)."""

    POWER_OFF = 0
    ERRORSTOP = 1
    STOPPING = 2
    STANDSTILL = 3
    DISCRETE_MOTION = 4
    CONTINUOUS_MOTION = 5
    SYNCHRONIZED_MOTION = 6
    HOMING = 7


@dataclass
class Axis:
    """One axis.  Positions in mm (or deg), velocity in mm/s (or deg/s)."""

    letter: str
    state: AxisState = AxisState.POWER_OFF
    set_position: float = 0.0
    actual_position: float = 0.0
    set_velocity: float = 0.0
    error: FaultCode | None = None

    @property
    def following_error(self) -> float:
        """Set minus actual position."""
        return self.set_position - self.actual_position


class AxisGroup:
    """The axes that run together under one interpolator."""

    def __init__(self, letters: Sequence[str]) -> None:
        self.axes = tuple(Axis(letter) for letter in letters)

    def power(self, on: bool) -> None:
        """Regulators on: from power_off to standstill; off: power_off from everywhere, errors are cleared."""
        for axis in self.axes:
            if not on:
                axis.state, axis.error = AxisState.POWER_OFF, None
            elif axis.state is AxisState.POWER_OFF:
                axis.state = AxisState.STANDSTILL

    def enter(self, state: AxisState) -> None:
        """Takes healthy axes to a state.  Raises: RuntimeFault if an axis has no power."""
        for axis in self.axes:
            if axis.state is AxisState.POWER_OFF:
                raise RuntimeFault(f"axis {axis.letter} cannot go to {state.name.lower()} without power")
            if axis.state is not AxisState.ERRORSTOP:
                axis.state = state

    def fail(self, column: int, error: FaultCode) -> None:
        """One axis faults: it goes to errorstop, the others are stopping."""
        self.enter(AxisState.STOPPING)
        self.axes[column].state = AxisState.ERRORSTOP
        self.axes[column].error = error

    def update(self, setpoint: Floats, actual: Floats, velocity: Floats) -> None:
        """Takes the positions and velocities (axes,) after a cycle."""
        for axis, s, a, v in zip(
            self.axes, setpoint.tolist(), actual.tolist(), velocity.tolist(), strict=True
        ):
            axis.set_position, axis.actual_position, axis.set_velocity = s, a, v
