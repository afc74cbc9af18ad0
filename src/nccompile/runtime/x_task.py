"""Runs a path that follows X on drives: `XInterpolator` (SoftMotion §6.7) in the place of the cyclic task.

    x(t) of the workpiece --> XInterpolator --> kinematics --> drives

The X axis of the machine takes part with the path's X.  The run is finished when X is beyond the path, and stopped
where the workpiece never gets there.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from nccompile.diagnostics import Diagnostic, Severity
from nccompile.errors import UsageError
from nccompile.kernels import interpolator as k
from nccompile.kernels.stepper import BURST, Burst
from nccompile.kernels.timelaw import TRAPEZOID, law_distance, law_times
from nccompile.kinematics import build
from nccompile.machine.model import Machine
from nccompile.runtime.drives.virtual import VirtualDrives
from nccompile.runtime.interpolator import Status
from nccompile.runtime.output import Output
from nccompile.runtime.profiles import read_profile
from nccompile.runtime.report import RunReport, SwitchEntry
from nccompile.runtime.trace import Trace
from nccompile.runtime.x_interpolator import XInterpolator
from nccompile.source import NOWHERE
from nccompile.toolpath.columns import Floats, Toolpath

__all__ = ["Workpiece", "XTask"]


class Workpiece:
    """Where the workpiece is: places [mm] at times [s], straight lines between them."""

    def __init__(self, times: Floats, places: Floats) -> None:
        self._times, self._places = times, places

    @classmethod
    def of(
        cls, path: Toolpath, offset: float, machine: Machine, velocity: float | None, profile: Path | None
    ) -> Workpiece:
        """From a profile, or a velocity [mm/s]: along X of the path, with ramps of the machine's path acceleration.

        Raises: UsageError.
        """
        if (velocity is None) == (profile is None):
            raise UsageError("the interpolator x needs --x-velocity or --x-profile")
        if profile is not None:
            return cls(*read_profile(profile))
        assert velocity is not None
        if not velocity > 0.0:
            raise UsageError(f"--x-velocity {velocity:g}: it is above 0, the path gives the direction")
        way = float(path.end[0] - path.start[0])
        accel = machine.path.acceleration
        t1, t2, t3, top, _ = law_times(max(abs(way), 1e-9), 0.0, velocity, 0.0, accel, accel)
        count = int(np.ceil((t1 + t2 + t3) / machine.cycle)) + 1
        times: Floats = np.arange(count, dtype=np.float64) * machine.cycle
        ways = [law_distance(TRAPEZOID, t, t1, t2, t3, 0.0, top, 0.0) for t in times.tolist()]
        places: Floats = path.start[0] - offset + np.copysign(np.array(ways), way)
        places[-1] = path.end[0] - offset
        return cls(times, places)

    def at(self, t: float) -> float:
        """Its position [mm] at a time [s]."""
        return float(np.interp(t, self._times, self._places))

    def is_over(self, t: float) -> bool:
        """Whether it does not move any more."""
        return bool(t > self._times[-1])


class XTask:
    """One run; chunks: of a planned path;  offset: path X minus axis X [mm];  file: name in diagnostics."""

    def __init__(
        self, chunks: Iterable[Toolpath], machine: Machine, velocity: float | None, profile: Path | None,
        offset: float = 0.0, trace: Trace | None = None, file: str = "program",
    ) -> None:  # fmt: skip
        held = list(chunks)
        path = Toolpath.join(held) if held else Toolpath.empty()
        self.workpiece = Workpiece.of(path, offset, machine, velocity, profile)
        self.report = RunReport(machine.name, machine.cycle)
        self._follow = XInterpolator(path, 1 if path.end[0] >= path.start[0] else -1, offset)
        kinematics = build(machine, path.axes)
        drives = VirtualDrives(machine, kinematics.axes)
        self._output = Output(machine, kinematics, drives, self.report, trace, None, file)
        self._path, self._cycle, self._file = path, machine.cycle, file

    def run(self) -> RunReport:
        """Runs to the end of the path, a fault, or the end of the workpiece's way."""
        first = self._burst(0, 1)
        self._output.start(self._path.start[None, :])
        self._output.bridge(first, 0)
        cycle, reached = 1, len(first)
        while self._output.fault is None and not self._follow.done and not self._is_over(cycle):
            burst = self._burst(cycle, BURST)
            reached = self._output.put(burst, 0, len(burst))
            self._log_switches(burst, cycle, reached)
            cycle += len(burst)
        self._finish()
        return self.report

    def _is_over(self, cycle: int) -> bool:
        return self.workpiece.is_over((cycle - 1) * self._cycle)

    def _burst(self, first: int, count: int) -> Burst:
        """At most `count` cycles, the last one beyond the path or with the workpiece at rest."""
        follow = self._follow
        rows, log = [], []
        for cycle in range(first, first + count):
            before, switches = follow.way_pos, follow.switches
            follow.advance(self.workpiece.at(cycle * self._cycle))
            moved = follow.way_pos - before
            status = Status.FINISHED if follow.done else Status.CONSTANT if moved > 0.0 else Status.WAIT
            rows.append((follow.set_position.copy(), moved, follow.source_line, status, follow.switches))
            if follow.switches != switches:
                log.append((cycle - first, follow.last_switch, follow.source_line))
            if follow.done or self._is_over(cycle + 1):
                break
        position, way, line, state, word = zip(*rows, strict=True)
        return Burst(
            np.array(position), np.array(way) / self._cycle, np.array(line, np.int32), np.array(state, np.uint8),
            np.array(word, np.uint32), np.array(log, np.int64).reshape(-1, 3), k.RAN, 0,
        )  # fmt: skip

    def _log_switches(self, burst: Burst, first: int, reached: int) -> None:
        for cycle, number, line in burst.log.tolist():
            if cycle < reached:
                place = tuple(burst.position[cycle].tolist())
                self.report.switches.add(SwitchEntry((first + cycle) * self._cycle, number, line, place))

    def _finish(self) -> None:
        """Closes the report."""
        outcome = "finished" if self._follow.done else "stopped"
        self.report.outcome = outcome if self._output.fault is None else "fault"
        self._output.finish()
        at = self._follow.set_position.tolist()
        self.report.end_position = dict(zip(self._path.axes, at, strict=True))
        if self.report.outcome == "stopped":
            message = f"the workpiece stops at X {self.workpiece.at(self._output.now * self._cycle):g}, before the end"
            help = "let its profile reach the end of the path"
            self.report.diagnostics.add(
                Diagnostic("NC705", Severity.WARNING, message, NOWHERE, self._file, help)
            )
