"""What the cyclic task asks of drives, virtual or real."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple, Protocol

from nccompile.kernels import drive as k
from nccompile.toolpath.columns import Floats

__all__ = ["ALL_CHECKS", "NO_ACCELERATION_CHECK", "NO_CHECKS", "Drives", "Fault", "FaultCode"]

ALL_CHECKS = k.ALL
NO_ACCELERATION_CHECK = k.ALL & ~k.ACCELERATION
"""During an emergency stop, which holds the set position at once by definition (SoftMotion §6.2.8)."""
NO_CHECKS = 0
"""While braking after a fault: the first fault is the one to report."""


class FaultCode(IntEnum):
    """What a drive faulted on."""

    VELOCITY = k.VELOCITY
    ACCELERATION = k.ACCELERATION
    TRAVEL = k.TRAVEL
    FOLLOWING_ERROR = k.FOLLOWING


class Fault(NamedTuple):
    """A drive fault: column of the axis, what was exceeded, value and limit in mm (or deg) and seconds."""

    axis: int
    code: FaultCode
    value: float
    limit: float


class Drives(Protocol):
    """The drives of all axes, in the order of `axes`."""

    axes: tuple[str, ...]

    def power(self, on: bool) -> None:
        """Switches the regulators; without power set positions are refused with RuntimeFault."""

    def reset(self, position: Floats) -> None:
        """Sets where the axes stand, Shape (axes,), at rest and without fault."""

    def step(self, setpoints: Floats, actual: Floats, watch: int) -> tuple[int, Fault | None]:
        """Takes set positions (m, axes) for m cycles and fills `actual` (m, axes).

        Returns how many cycles were run, and the fault that ended them after its own cycle.
        """
