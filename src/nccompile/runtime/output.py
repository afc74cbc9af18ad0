"""From set positions to drives: steps the drives, watches them, keeps time, traces and reports.

A jump of the set position is bridged as ControlAxisByPos does (SoftMotion §2.2.5), see `runtime.bridge`.
"""

from __future__ import annotations

import numpy as np

from nccompile.diagnostics import Diagnostic, Severity
from nccompile.kernels.stepper import BURST, Burst
from nccompile.kinematics import Kinematics
from nccompile.machine.limits import limits
from nccompile.machine.model import Machine
from nccompile.runtime.axes import AxisGroup, AxisState
from nccompile.runtime.bridge import Brake, Bridge
from nccompile.runtime.clock import Clock
from nccompile.runtime.drives.protocol import ALL_CHECKS, NO_CHECKS, Drives, Fault, FaultCode
from nccompile.runtime.interpolator import Status
from nccompile.runtime.report import FaultEntry, Monitor, RunReport
from nccompile.runtime.trace import Cycles, Trace
from nccompile.source import Span
from nccompile.toolpath.columns import Floats

__all__ = ["Output"]

_FAULTS = {
    FaultCode.VELOCITY: ("NC701", "velocity", "/s"),
    FaultCode.ACCELERATION: ("NC702", "acceleration", "/s²"),
    FaultCode.TRAVEL: ("NC703", "position", ""),
    FaultCode.FOLLOWING_ERROR: ("NC704", "following error", ""),
}

_HELP = {
    FaultCode.VELOCITY: "compile the program for this machine, or lower the override",
    FaultCode.ACCELERATION: "compile the program for this machine",
    FaultCode.TRAVEL: "compile the program for this machine, or change [kinematics] offset",
    FaultCode.FOLLOWING_ERROR: "lower the feed, or raise following_error of the axis",
}


class Output:
    """The axes' side of the cyclic task.

    now: number of the next cycle;  set_position: axis set positions of the last cycle, Shape (axes,);
    fault: the drive fault that happened, if any;  clock: None for virtual time.
    """

    def __init__(
        self, machine: Machine, kinematics: Kinematics, drives: Drives, report: RunReport,
        trace: Trace | None, clock: Clock | None, file: str,
    ) -> None:  # fmt: skip
        self.now = 0
        self.fault: Fault | None = None
        self.axes = AxisGroup(kinematics.axes)
        self.set_position = np.zeros(len(kinematics.axes))
        self._machine, self._kinematics, self._drives = machine, kinematics, drives
        self._report, self._trace, self._clock, self._file = report, trace, clock, file
        self._limits = limits(machine, kinematics.axes)
        self._monitor = Monitor(machine, kinematics.axes)
        self._actual = np.zeros((BURST, len(kinematics.axes)))

    def start(self, path_start: Floats) -> None:
        """Powers the axes where they stand: at `home`, or at the start of the path, Shape (1, path axes)."""
        letters = self._kinematics.axes
        start = self._kinematics.to_axes(path_start)[0].tolist()
        homes = [self._machine.axes[letter].home for letter in letters]
        at = np.array([s if home is None else home for s, home in zip(start, homes, strict=True)])
        self._drives.reset(at)
        self._drives.power(True)
        self._monitor.start(at)
        self.set_position = at
        self.axes.power(True)
        self.axes.update(at, at, np.zeros(len(at)))
        if self._trace is not None:
            self._trace.begin(letters, self._machine.cycle_us)

    def put(self, burst: Burst, begin: int, end: int, watch: int = ALL_CHECKS) -> int:
        """Hands cycles begin..end-1 of a burst to the drives; returns how many were run.

        Fewer than asked for: `fault` says why, the last cycle run is that of the fault.
        """
        pick = slice(begin, end)
        return self._put(
            Cycles(
                self.now, self._kinematics.to_axes(burst.position[pick]), self._actual[: max(0, end - begin)],
                burst.velocity[pick], burst.line[pick], burst.status[pick], burst.switches[pick], False,
            ),
            watch,
        )  # fmt: skip

    def _put(self, cycles: Cycles, watch: int) -> int:
        """Steps the drives, then records what was run."""
        m = len(cycles.velocity)
        if m == 0:
            return 0
        if self._clock is None:
            done, fault = self._drives.step(cycles.setpoints, cycles.actual, watch)
        else:
            done, fault = 0, None
            while done < m and fault is None:
                self._clock.wait()
                row = slice(done, done + 1)
                _, fault = self._drives.step(cycles.setpoints[row], cycles.actual[row], watch)
                done += 1
        ran = cycles.leading(done)
        self._monitor.watch(ran.setpoints, ran.actual)
        if self._trace is not None:
            self._trace.write(ran)
        self.now += done
        self.set_position = ran.setpoints[-1].copy()
        self.axes.update(self.set_position, ran.actual[-1], self._monitor.velocity)
        if fault is not None:
            self._report_fault(fault, int(ran.line[-1]))
        return done

    def bridge(self, burst: Burst, row: int) -> None:
        """Takes the axes to the set position of one cycle of a burst, however far it is.

        Puts out that cycle last; those before it, in which each axis runs on its own, count as WAIT.
        """
        target = self._kinematics.to_axes(burst.position[row : row + 1])[0]
        at, cycle = self._limits, self._machine.cycle
        velocity = np.minimum(at.rapid, at.velocity)
        way = Bridge(self.set_position, target, velocity, at.acceleration, cycle)
        if len(way) > 1:
            self.axes.enter(AxisState.DISCRETE_MOTION)
            self._run(way, len(way) - 1, burst, row, ALL_CHECKS)
        if self.fault is not None:
            stop = Brake(self.set_position, self._monitor.velocity, at.acceleration, cycle)
            self._run(stop, len(stop), burst, row, NO_CHECKS)
            return
        self.put(burst, row, row + 1)
        if self.fault is None:
            self.axes.enter(AxisState.SYNCHRONIZED_MOTION)

    def _run(self, way: Bridge | Brake, length: int, burst: Burst, row: int, watch: int) -> None:
        """Puts out the first cycles of a motion of the axes on their own, until a fault ends it."""
        for first in range(0, length, BURST):
            setpoints = way.positions(first, min(BURST, length - first))
            m = len(setpoints)
            cycles = Cycles(
                self.now, setpoints, self._actual[:m], np.zeros(m), np.repeat(burst.line[row], m),
                np.full(m, Status.WAIT, np.uint8), np.repeat(burst.switches[row], m), True,
            )  # fmt: skip
            if self._put(cycles, watch) < m:
                return

    def _report_fault(self, fault: Fault, line: int) -> None:
        """The first fault goes to the axes, the report and the diagnostics."""
        self.fault = fault
        self.axes.fail(fault.axis, fault.code)
        letter = self._kinematics.axes[fault.axis]
        unit = self._machine.axes[letter].unit
        code, quantity, per = _FAULTS[fault.code]
        time = (self.now - 1) * self._machine.cycle
        name = fault.code.name.lower()
        self._report.faults.append(FaultEntry(time, letter, name, fault.value, fault.limit, line))
        self._report.diagnostics.add(
            Diagnostic(
                code,
                Severity.ERROR,
                f"axis {letter} faulted at {time:.6g} s: {quantity} {fault.value:.6g} {unit}{per} is beyond the "
                f"limit of {fault.limit:.6g} {unit}{per}",
                Span(max(line, 0), 1, 1),
                self._file,
                _HELP[fault.code],
            )
        )

    def finish(self) -> None:
        """Enters what was measured into the report."""
        self._report.cycles = self.now
        self._report.axes = self._monitor.reports()
        if self.fault is None:
            self.axes.enter(AxisState.STANDSTILL)
        if self._clock is not None:
            self._report.jitter = self._clock.statistics()
