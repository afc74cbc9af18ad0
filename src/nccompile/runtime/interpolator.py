"""The interpolator block: every input and output of SMC_Interpolator (SoftMotion §6.2.8, §6.2.9).

    ring buffer --rows--> Interpolator.advance(n) --set positions--> axes

`Inputs` are levels, read at each call; `Outputs` describe the last cycle of the last call.  All motion is in
`kernels.interpolator`; this class supplies rows, translates inputs and outputs, and can go back to a snapshot.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np

from nccompile.kernels import interpolator as k
from nccompile.kernels.stepper import Burst, Snapshot, Stepper
from nccompile.kernels.timelaw import TRAPEZOID
from nccompile.runtime.ring import Event, Mark, RingBuffer
from nccompile.toolpath.columns import EventKind, Floats

__all__ = [
    "OVERRIDE_MAX", "OVERRIDE_MIN", "Inputs", "Interpolator", "Outputs", "Saved", "Status", "describe", "describe_m",
]  # fmt: skip

OVERRIDE_MIN = 0.01
"""Least override; lower values act as this one (SoftMotion §6.2.8)."""

OVERRIDE_MAX = 10.0
"""Greatest override; the machine's limits hold at any override."""


_STOPS = ("emergency_stop", "quick_stop", "slow_stop", "wait_at_next_stop")


class Status(IntEnum):
    """SMC_INT_STATUS (SoftMotion §6.2.8)."""

    UNKNOWN = 0
    INIT = 1
    ACCEL = 2
    CONSTANT = 3
    DECEL = 4
    FINISHED = 5
    WAIT = 6


@dataclass
class Inputs:
    """Inputs of the block; the names of the manual are in brackets.

    slow_stop: brake with the segment's deceleration and wait until released [bSlow_Stop]
    emergency_stop: hold the position at once [bEmergency_Stop]
    quick_stop: as slow_stop, with at least quick_deceleration [bQuick_Stop, dQuickDeceleration mm/s²]
    wait_at_next_stop: wait where the path stops anyway [bWaitAtNextStop]
    single_step: stop for one cycle at the end of every segment [bSingleStep]
    override: factor on the commanded velocities, taken over outside ramps [dOverride]
    vel_mode: time law, 0 trapezoid, 1 sigmoid, 2 parabolic, taken over outside ramps [iVelMode]
    ack_m: acknowledges the waiting M function [bAcknM]
    abort: gives the path up [bAbort]
    last_way_pos: way already counted [mm], see Outputs.way_pos [dLastWayPos]
    """

    slow_stop: bool = False
    emergency_stop: bool = False
    quick_stop: bool = False
    wait_at_next_stop: bool = False
    single_step: bool = False
    override: float = 1.0
    vel_mode: int = TRAPEZOID
    ack_m: bool = False
    abort: bool = False
    quick_deceleration: float = 0.0
    last_way_pos: float = 0.0

    @property
    def stops(self) -> tuple[str, ...]:
        """The stops that are on, by their names."""
        return tuple(name for name in _STOPS if getattr(self, name))

    def to_kernel(self, cycle: float, *, patient: bool) -> k.Inputs:
        """The inputs as the kernel takes them; the strongest stop wins."""
        stop = k.GO
        for active, command in (
            (self.slow_stop, k.SLOW),
            (self.quick_stop, k.QUICK),
            (self.emergency_stop, k.EMERGENCY),
            (self.abort, k.ABORT),
        ):
            stop = command if active else stop
        override = min(max(self.override, OVERRIDE_MIN), OVERRIDE_MAX)
        return k.Inputs(
            stop, self.quick_deceleration, override, self.vel_mode, int(self.wait_at_next_stop),
            int(self.single_step), int(self.ack_m), int(patient), cycle,
        )  # fmt: skip


@dataclass
class Outputs:
    """Outputs of the block after a call; the names of the manual are in brackets.

    set_position f8 (axes,) [piSetPosition]; status [iStatus]; done: the path is at its end or was aborted
    [bDone]; working [bWorking]; source_line: line of the running segment, -1 when not working
    [iActObjectSourceNo]; velocity: path length of the last cycle over its time, mm/s [dVel]; tangent: unit
    direction in X, Y, Z, zeros at rest [vecActTangent]; last_switch: number of the switch passed last
    [iLastSwitch]; switches: bit b for switch b + 1 [dwSwitches]; way_pos: last_way_pos plus the way of the
    last cycle, mm [dWayPos]; m: number of the M function that waits, 0 if none [wM], with its words K, L and
    the name after O (SMC_GetMParameters, §6.2.9); underrun: braked or waiting for rows that have not come.
    """

    set_position: Floats
    status: Status = Status.INIT
    done: bool = False
    working: bool = False
    source_line: int = -1
    velocity: float = 0.0
    last_switch: int = 0
    switches: int = 0
    way_pos: float = 0.0
    m: int = 0
    m_k: float = 0.0
    m_l: float = 0.0
    m_o: str = ""
    underrun: bool = False
    _place: tuple[Stepper, k.Rows, int] | None = None

    @property
    def tangent(self) -> tuple[float, float, float]:
        """See the class; found when it is asked for, between two calls."""
        if self._place is None or not self.working:
            return 0.0, 0.0, 0.0
        stepper, rows, head = self._place
        return stepper.tangent(rows, head)


def describe(
    out: Outputs, burst: Burst, stepper: Stepper, rows: k.Rows, head: int, last_way_pos: float, cycle: float
) -> None:
    """Fills the outputs after a call of the kernel, except those of M functions and missing rows."""
    i = stepper.i
    if len(burst):
        out.velocity = float(burst.velocity[-1])
        out.status = Status(int(burst.status[-1]))
        out.set_position = burst.position[-1].copy()
        out.way_pos = last_way_pos + out.velocity * cycle
    out.done = out.status is Status.FINISHED
    out.working = Status.ACCEL <= out.status <= Status.WAIT and not out.done
    out.source_line = int(i[k.LINE_NO]) if out.working else -1
    out.last_switch, out.switches = int(i[k.LAST_SWITCH]), int(i[k.SWITCHES])
    out._place = stepper, rows, head


def describe_m(out: Outputs, stepper: Stepper, events: Callable[[], Iterable[Event]]) -> None:
    """Fills the outputs of the M function that waits, 0 if none does; events: those of the first row at hand."""
    out.m, out.m_k, out.m_l, out.m_o = 0, 0.0, 0.0, ""
    if stepper.i[k.M_ROW] >= 0:
        event = next(e for e in events() if e.kind == EventKind.M_FUNCTION)
        out.m, out.m_k, out.m_l, out.m_o = event.number, event.k, event.l, event.o


@dataclass(frozen=True)
class Saved:
    """A state of an `Interpolator` to come back to."""

    stepper: Snapshot
    mark: Mark


@dataclass
class Interpolator:
    """Interpolates the segments of a ring buffer.

    ring: supplies rows; start: Shape (axes,), set position before the first segment; cycle: seconds.
    """

    ring: RingBuffer
    start: Floats
    cycle: float
    inputs: Inputs = field(default_factory=Inputs)
    outputs: Outputs = field(init=False)

    def __post_init__(self) -> None:
        self._stepper = Stepper(self.start)
        self.outputs = Outputs(set_position=np.array(self.start, np.float64))

    @property
    def held(self) -> tuple[str, ...]:
        """Inputs that keep the path where it rests."""
        return self.inputs.stops

    def advance(self, n: int, *, patient: bool = True) -> Burst:
        """Runs up to n cycles with the present inputs.

        Fewer than n: see `Burst.reason`; the caller acts on it and calls again.  patient: return with reason
        NEED_DATA, possibly without a cycle, rather than brake because rows are still to come.
        """
        view = self.ring.view()
        burst = self._stepper.run(
            view.rows, view.head, view.tail, complete=view.complete, version=view.version,
            inputs=self.inputs.to_kernel(self.cycle, patient=patient), n=n,
        )  # fmt: skip
        head = view.head + burst.dropped
        out = self.outputs
        describe(out, burst, self._stepper, view.rows, head, self.inputs.last_way_pos, self.cycle)
        out.underrun = not view.complete and (
            head >= view.tail or self._brakes_early(view.rows, head, view.tail)
        )
        self.ring.drop(burst.dropped)
        describe_m(out, self._stepper, lambda: self.ring.events(0))
        return burst

    def snapshot(self) -> Saved:
        """The state before a burst that may have to be taken back."""
        return Saved(self._stepper.snapshot(), self.ring.mark())

    def checkpoint(self) -> Callable[[], None]:
        """Keeps the present state; calling what is returned comes back to it."""
        saved = self.snapshot()
        return lambda: self.restore(saved)

    def restore(self, saved: Saved) -> None:
        """Comes back to a snapshot; nothing may have been pushed to the ring in between."""
        self._stepper.restore(saved.stepper)
        self.ring.rewind(saved.mark)
        self.outputs.set_position = saved.stepper.here.copy()

    def _brakes_early(self, rows: k.Rows, head: int, tail: int) -> bool:
        """Whether the running segment is to end slower than planned because rows are missing."""
        row = min(head + int(self._stepper.i[k.ROW]), tail - 1)
        if self._stepper.i[k.STARVED] == 1:
            return True
        return bool(rows.v_now[row] < rows.v_end[row]) and self._stepper.f[k.OVERRIDE] == 1.0
