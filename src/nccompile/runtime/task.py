"""The cyclic task: ring buffer -> interpolator -> kinematics -> drives, one set position an axis and cycle.

Virtual time runs in bursts of up to 4096 cycles, as fast as it can, and still behaves cycle by cycle: a burst
ends before a command of the schedule is due, and after a drive fault the interpolator goes back to the start
of the burst and runs again up to the cycle of the fault.  Real time runs one cycle a burst against absolute
deadlines, while a thread refills the ring buffer.

Where the set position jumps (G92, a start that is not where the axes stand) the interpolator waits until every
axis has got there on its own; commands that fall into that time are taken afterwards.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass

import numpy as np

from nccompile.diagnostics import Diagnostic, Severity
from nccompile.kernels import expect_work
from nccompile.kernels import interpolator as k
from nccompile.kernels.stepper import BURST, Burst
from nccompile.kernels.timelaw import LAW_NAMES
from nccompile.kinematics import build
from nccompile.machine.limits import limits
from nccompile.machine.model import Machine
from nccompile.runtime.clock import Clock, undisturbed
from nccompile.runtime.drives.protocol import ALL_CHECKS, NO_ACCELERATION_CHECK, NO_CHECKS, Drives
from nccompile.runtime.drives.virtual import VirtualDrives
from nccompile.runtime.feeder import Feeder
from nccompile.runtime.interpolator import Interpolator, Status
from nccompile.runtime.interpolator2dir import Interpolator2Dir
from nccompile.runtime.output import Output
from nccompile.runtime.report import MEntry, RunReport, SwitchEntry
from nccompile.runtime.ring import RingBuffer
from nccompile.runtime.schedule import Command, Schedule
from nccompile.runtime.trace import Trace
from nccompile.source import NOWHERE, Span
from nccompile.toolpath.columns import Toolpath

__all__ = ["CyclicTask", "Options"]

_BRAKING = 64
"""Cycles of a burst while the path brakes after a fault: few are thrown away once it stands."""


@dataclass(frozen=True)
class Options:
    """How a run is made.

    realtime: cycles at their deadlines instead of as fast as possible;  override: factor on velocities;
    commands: inputs that change at times;  m_delay: seconds until an M function is acknowledged, 0: in the
    next cycle, None: only by a command;  burst: greatest number of cycles between two looks at the inputs;
    vel_mode: time law, None: that of the machine;  two_way: the path is held as a whole, a negative override
    runs it back;  file: name of the program in diagnostics.
    """

    realtime: bool = False
    override: float = 1.0
    commands: Sequence[Command] = ()
    m_delay: float | None = 0.0
    burst: int = BURST
    vel_mode: int | None = None
    two_way: bool = False
    file: str = "program"


class CyclicTask:
    """Runs a planned path on drives; made for one run.

    chunks: consecutive chunks of a planned path, pulled as the run goes on;  drives: virtual ones if None;
    trace: takes every cycle.
    """

    def __init__(
        self,
        chunks: Iterable[Toolpath],
        machine: Machine,
        options: Options | None = None,
        drives: Drives | None = None,
        trace: Trace | None = None,
    ) -> None:
        two_way = options is not None and options.two_way
        supply = iter([Toolpath.join(held)] if two_way and (held := list(chunks)) else chunks)
        first = next(supply, None)
        path = Toolpath.empty() if first is None else first
        kinematics = build(machine, path.axes)
        self.machine, self.options = machine, options or Options()
        self.drives: Drives = VirtualDrives(machine, kinematics.axes) if drives is None else drives
        acceleration = limits(machine, path.axes).acceleration
        self.ring = RingBuffer(path.axes, machine.queue, acceleration=acceleration)
        self.interpolator: Interpolator | Interpolator2Dir
        if two_way:
            self.interpolator = Interpolator2Dir(path, machine.cycle, acceleration)
        else:
            self.interpolator = Interpolator(self.ring, path.start, machine.cycle)
        self.report = RunReport(machine.name, machine.cycle)
        self._clock = Clock(machine.cycle) if self.options.realtime else None
        self.output = Output(
            machine, kinematics, self.drives, self.report, trace, self._clock, self.options.file
        )
        self._kinematics, self._path_axes = kinematics, path.axes
        self._is_empty = first is None
        fed = Toolpath.empty(path.axes) if two_way else path
        self._feeder = Feeder(fed, supply, self.ring, machine.low_water)
        self._schedule = Schedule(self.options.commands)
        self._is_starved = False  # the buffer is full and still too short to look ahead
        self._m: MEntry | None = None  # the M function that waits
        self._m_at = 0  # cycle at which it was reached
        self._outcome = ""

    def run(self) -> RunReport:
        """Runs to the end, a fault, an abort or a standstill that nothing will end.

        Raises: what the chunks raise (QueueError); RuntimeFault for wrong use of drives.
        """
        if self._is_empty:
            return self.report
        self._set_inputs()
        with ExitStack() as stack:
            if self._clock is None:
                self._feeder.fill()
            else:
                stack.enter_context(undisturbed())
                stack.callback(self._feeder.stop)
                self._feeder.start(self.machine.cycle)
            self._begin()
            while not self._outcome:
                self._feeder.check()
                self._turn()
        self._finish()
        return self.report

    def _set_inputs(self) -> None:
        """The inputs that hold before the first command."""
        law = LAW_NAMES.index(self.machine.path.time_law)
        inputs = self.interpolator.inputs
        inputs.override = self.options.override
        inputs.vel_mode = law if self.options.vel_mode is None else self.options.vel_mode
        inputs.quick_deceleration = self.machine.path.quick_deceleration

    def _begin(self) -> None:
        """The first cycle: powers the axes and takes them to the start of the path."""
        burst = self.interpolator.advance(1)
        self.output.start(burst.position)
        if self._clock is not None:
            self._clock.start()
        self.output.bridge(burst, 0)
        if self.output.fault is not None:
            self._outcome = "fault"

    def _turn(self) -> None:
        """One burst: commands, interpolation, drives, reactions."""
        inputs = self.interpolator.inputs
        self._schedule.take(self.output.now, self.machine.cycle, inputs)
        n, patient = self._cycles_at_once(), self._is_patient()
        by_hand = inputs.ack_m
        inputs.ack_m = by_hand or self._is_acknowledge_due()
        if self._clock is None:
            self._feeder.refill()
            expect_work(self.output.now)
        go_back = self.interpolator.checkpoint() if n > 1 else None
        burst = self.interpolator.advance(n, patient=patient)
        jumped = burst.reason == k.JUMPED
        watch = NO_ACCELERATION_CHECK if inputs.emergency_stop or inputs.abort else ALL_CHECKS
        end = self._standing_from(burst, n)
        done = self.output.put(burst, 0, len(burst) - int(jumped) if end is None else end, watch)
        if self.output.fault is not None and go_back is not None and done < len(burst):
            go_back()
            burst, jumped = self.interpolator.advance(done, patient=patient), False
        inputs.ack_m = by_hand
        self._log_switches(burst, done)
        if self.output.fault is not None:
            self._stop_path()
            return
        if jumped:
            self.output.bridge(burst, len(burst) - 1)
        if self.output.fault is not None:
            self._outcome = "fault"
        elif end is not None:
            self._report_standstill()
        else:
            self._after(burst, patient)

    def _cycles_at_once(self) -> int:
        """Cycles until something has to be looked at: a command, an acknowledge; one in real time."""
        acknowledging = self._m is not None and self.interpolator.inputs.ack_m
        if self._clock is not None or self._is_starved or acknowledging:
            return 1
        n = min(self.options.burst, BURST)
        due = self._schedule.cycles_until_next(self.output.now, self.machine.cycle)
        if due is not None:
            n = min(n, due)
        if self._m is not None and self.options.m_delay is not None:
            n = min(n, self._acknowledge_at() - self.output.now)
        return max(1, n)

    def _is_patient(self) -> bool:
        """Whether to wait for rows rather than brake: in virtual time, unless the buffer cannot take more."""
        return self._clock is None and not self._is_starved

    def _acknowledge_at(self) -> int:
        """The cycle in which the waiting M function is acknowledged by itself."""
        return self._m_at + 1 + round((self.options.m_delay or 0.0) / self.machine.cycle)

    def _is_acknowledge_due(self) -> bool:
        if self._m is None or self.options.m_delay is None:
            return False
        return self.output.now >= self._acknowledge_at()

    def _after(self, burst: Burst, patient: bool) -> None:
        """Reacts to why a burst ended."""
        out = self.interpolator.outputs
        if not patient and out.underrun:
            self.report.underruns += len(burst)
        self._is_starved = False
        if self._m is not None and (out.m == 0 or burst.reason == k.AT_M):
            self._m_done()
        if burst.reason == k.AT_M:
            at = self._m_at = self.output.now - 1
            self._m = MEntry(
                at * self.machine.cycle, out.m, out.m_k, out.m_l, out.m_o, int(burst.line[-1]), 0.0
            )
        if out.done:
            self._outcome = "aborted" if self.interpolator.inputs.abort else "finished"
        elif burst.reason == k.NEED_DATA and patient:
            self._is_starved = self._feeder.fill() == 0 and not self._feeder.is_done

    def _m_done(self) -> None:
        """Logs the M function that waited."""
        assert self._m is not None
        waited = (self.output.now - 1 - self._m_at) * self.machine.cycle
        self.report.m_functions.add(self._m._replace(waited=waited))
        self._m = None

    def _standing_from(self, burst: Burst, n: int) -> int | None:
        """The end of the first cycle of a standstill that nothing will end; None if there is none."""
        out, inputs = self.interpolator.outputs, self.interpolator.inputs
        if out.status is not Status.WAIT or not self._schedule.is_done:
            return None
        if len(burst) < n or burst.reason != k.RAN or burst.velocity[-1] != 0.0:
            return None
        if out.m and not inputs.emergency_stop:
            held = self.options.m_delay is None and not inputs.ack_m
        else:
            held = bool(self.interpolator.held)
        if not held:
            return None
        others = np.flatnonzero((burst.status != Status.WAIT) | (burst.velocity != 0.0))
        return int(others[-1]) + 2 if len(others) else 1

    def _report_standstill(self) -> None:
        """The run ends here: says what it waits for."""
        out, inputs = self.interpolator.outputs, self.interpolator.inputs
        time = f"{(self.output.now - 1) * self.machine.cycle:.6g} s"
        if out.m and not inputs.emergency_stop:
            self._report(
                "NC706", Severity.ERROR, f"M{out.m} waits at {time} for an acknowledge that does not come",
                out.source_line, "acknowledge it with a command ack_m=1, or after a delay",
            )  # fmt: skip
        else:
            stops = self.interpolator.held
            self._report(
                "NC705", Severity.WARNING, f"the run was stopped at {time} and not released: {', '.join(stops)}",
                out.source_line, f"release it with a later command {stops[0]}={1 if stops[0] == 'override' else 0}",
            )  # fmt: skip
        self._outcome = "stopped"

    def _log_switches(self, burst: Burst, done: int) -> None:
        """Logs the switches passed in the first `done` cycles of a burst that has been put out."""
        first = self.output.now - done
        for cycle, number, line in burst.log.tolist():
            if cycle < done or burst.reason == k.JUMPED:
                position = tuple(burst.position[cycle].tolist())
                self.report.switches.add(
                    SwitchEntry((first + cycle) * self.machine.cycle, number, line, position)
                )

    def _stop_path(self) -> None:
        """After a fault: the path brakes with the quick deceleration until it stands; checks are off."""
        inputs = self.interpolator.inputs
        inputs.quick_stop, inputs.emergency_stop = True, False
        n = _BRAKING if self._clock is None else 1
        stands = False
        while not stands:
            burst = self.interpolator.advance(n, patient=False)
            resting = np.flatnonzero(burst.velocity == 0.0)
            end = int(resting[0]) + 1 if len(resting) else len(burst)
            jumped = burst.reason == k.JUMPED
            self.output.put(burst, 0, min(end, len(burst) - int(jumped)), NO_CHECKS)
            stands = len(resting) > 0 or jumped or self.interpolator.outputs.done
        self._outcome = "fault"

    def _report(self, code: str, severity: Severity, message: str, line: int, help: str) -> None:
        """A finding of the runtime at a line of the program, or at none."""
        span = Span(line, 1, 1) if line > 0 else NOWHERE
        self.report.diagnostics.add(Diagnostic(code, severity, message, span, self.options.file, help))

    def _finish(self) -> None:
        """Closes the report."""
        if self._m is not None:
            self._m_done()
        self.report.outcome = self._outcome
        self.output.finish()
        at = self._kinematics.to_path(self.output.set_position[None, :])[0]
        if self._outcome != "fault":
            at = self.interpolator.outputs.set_position
        self.report.end_position = dict(zip(self._path_axes, at.tolist(), strict=True))
        if self.report.underruns:
            self._report(
                "NC707", Severity.WARNING,
                f"the path braked or waited in {self.report.underruns} cycles because segments were missing",
                0, "raise [runtime] queue and low_water",
            )  # fmt: skip
        jitter = self.report.jitter
        if jitter is not None and jitter.overruns:
            self._report(
                "NC708", Severity.WARNING,
                f"{jitter.overruns} of {jitter.cycles} cycles missed their deadline",
                0, "raise cycle_us, or give the computer less else to do",
            )  # fmt: skip
