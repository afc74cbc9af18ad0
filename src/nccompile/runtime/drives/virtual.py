"""Virtual drives: first-order lag, limits watched, faults as a real drive's."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp

import numpy as np

from nccompile.errors import RuntimeFault
from nccompile.kernels import drive as k
from nccompile.machine.limits import limits, travel
from nccompile.machine.model import Machine
from nccompile.runtime.drives.protocol import Fault, FaultCode
from nccompile.toolpath.columns import Floats

__all__ = ["VirtualDrives"]


class VirtualDrives:
    """The drives of some axes of a machine, on paper (see `kernels.drive` for what they check)."""

    def __init__(self, machine: Machine, axes: Sequence[str]) -> None:
        self.axes = tuple(axes)
        self._cycle = machine.cycle
        self._powered = False
        self._state = np.zeros((5, len(self.axes)))
        self._fault = np.zeros(4)
        at = limits(machine, self.axes)
        low, high = travel(machine, self.axes)
        known = [machine.axes[letter] for letter in self.axes]
        self._limits = np.array(
            [
                at.velocity,
                at.acceleration * machine.cycle + at.velocity_step,
                low,
                high,
                [axis.following_error for axis in known],
                [1.0 - exp(-machine.cycle / axis.lag) if axis.lag > 0 else 1.0 for axis in known],
                at.acceleration * machine.cycle,
            ]
        )

    def power(self, on: bool) -> None:
        """Switches the regulators."""
        self._powered = on

    def reset(self, position: Floats) -> None:
        """Sets where the axes stand, at rest and without fault."""
        self._state[:] = 0.0
        self._state[k.SET] = position
        self._state[k.ACTUAL] = position

    def step(self, setpoints: Floats, actual: Floats, watch: int = k.ALL) -> tuple[int, Fault | None]:
        """Runs m cycles; see `Drives.step`.  Raises: RuntimeFault without power."""
        if not self._powered:
            raise RuntimeFault("set positions were sent to drives without power")
        m = len(setpoints)
        done = k.drive_step(setpoints, self._cycle, watch, self._state, self._limits, actual, self._fault)
        if done == m:
            return m, None
        axis, code, value, limit = self._fault.tolist()
        return done + 1, Fault(int(axis), FaultCode(int(code)), value, limit)
