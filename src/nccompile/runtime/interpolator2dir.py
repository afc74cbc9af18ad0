"""The interpolator that runs a path in both directions (SMC_Interpolator2Dir, SoftMotion §6.2.10).

A negative override runs back, as a hand wheel does.  The block holds the path and its backward path
(`runtime.backwards`) and runs one of them with the kernel of the ordinary interpolator:

    forward   A ----->----- B ---      override changes its sign: brakes to rest,
                            |          goes on from the same place on the other path
    backward  A -----<----- B

So every promise of the ordinary one holds in both directions, for every planner.  Forwards M functions wait, as
often as they are reached; backwards they are passed.  At its start the path waits for an override above 0.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from enum import IntEnum

import numpy as np

from nccompile.backend.samples import rows_of
from nccompile.kernels import interpolator as k
from nccompile.kernels.stepper import Burst, Snapshot, Stepper
from nccompile.runtime.backwards import backward
from nccompile.runtime.interpolator import OVERRIDE_MIN, Inputs, Outputs, Status, describe, describe_m
from nccompile.runtime.ring import Event
from nccompile.toolpath.columns import Floats, Toolpath

__all__ = ["Direction", "Interpolator2Dir", "Turn"]


class Direction(IntEnum):
    """SMC_Direction of §6.2.10."""

    NEGATIVE = -1
    STANDSTILL = 0
    POSITIVE = 1


@dataclass(frozen=True)
class Turn:
    """A state of an `Interpolator2Dir` to come back to."""

    stepper: Snapshot
    way: int
    head: int


@dataclass
class Interpolator2Dir:
    """The block, with the inputs and outputs of `Interpolator`; call `advance` as there.

    path: planned, at hand as a whole;  cycle [s];  acceleration: bounds quick stops, see `RingBuffer`.
    inputs.override: below 0 runs back, between -0.01 and 0.01 stands.  direction: of the last cycle.
    """

    path: Toolpath
    cycle: float
    acceleration: Floats | None = None
    inputs: Inputs = field(default_factory=Inputs)
    outputs: Outputs = field(init=False)
    direction: Direction = field(default=Direction.STANDSTILL, init=False)

    def __post_init__(self) -> None:
        self._paths = (self.path, backward(self.path))
        self._rows = tuple(rows_of(path, self.acceleration) for path in self._paths)
        self._way, self._head = 0, 0  # 0 forward, 1 backward; the first row that is not done
        self._stepper = Stepper(self.path.start)
        self.outputs = Outputs(set_position=np.array(self.path.start, np.float64))

    @property
    def held(self) -> tuple[str, ...]:
        """Inputs that keep the path where it rests."""
        stands = abs(self.inputs.override) < OVERRIDE_MIN or (self.at_start and self.inputs.override < 0.0)
        return (*self.inputs.stops, *(("override",) if stands else ()))

    @property
    def at_start(self) -> bool:
        """Whether the path stands at its start, run back to it."""
        return self._way == 1 and self._head >= len(self.path)

    def advance(self, n: int, *, patient: bool = True) -> Burst:
        """Runs up to n cycles with the present inputs; one, while the direction is to change."""
        turning = self._turn()
        count = len(self.path)
        if self.at_start and not turning and self.inputs.override < 0.0:
            burst = self._stand(n)
        else:
            inputs = self._inputs(turning)
            burst = self._stepper.run(
                self._rows[self._way], self._head, count, complete=True, version=self._way, inputs=inputs,
                n=1 if turning and self._stepper.f[k.V] != 0.0 else n,
            )  # fmt: skip
            self._head += burst.dropped
            if self._way == 1 and burst.reason == k.FINISHED:
                burst.status[-1] = Status.WAIT
                burst = Burst(*burst[:6], k.RAN, burst.dropped)
        self._describe(burst)
        return burst

    def _inputs(self, turning: bool) -> k.Inputs:
        """The inputs of the kernel: what is left of an override without its sign; a slow stop before a turn."""
        size = max(abs(self.inputs.override), OVERRIDE_MIN)
        held = replace(self.inputs, override=size, slow_stop=self.inputs.slow_stop or turning)
        if self._way == 1:
            held = replace(held, wait_at_next_stop=False)
        return held.to_kernel(self.cycle, patient=False)

    def _turn(self) -> bool:
        """Changes the path where the direction has to change and the motion rests; True while it does not rest."""
        override = self.inputs.override
        if abs(override) < OVERRIDE_MIN:
            return True
        if (override < 0.0) == (self._way == 1):
            return False
        f, i = self._stepper.f, self._stepper.i
        if i[k.STARTED] == 0 or f[k.V] != 0.0 or i[k.MODE] == k.TABLE:
            return bool(i[k.STARTED] == 1)
        head, s = self._head, 0.0
        inside = i[k.RUNNING] == 1 and head < len(self.path)
        if inside:
            s = float(self.path.length[head] if self._way == 0 else self._paths[1].length[head]) - float(
                f[k.S]
            )
        self._way = 1 - self._way
        self._head = len(self.path) - head - int(inside)
        self._stepper.place(self._rows[self._way], self._head, s, self._inputs(turning=False))
        return False

    def _stand(self, n: int) -> Burst:
        """n cycles at the start of the path, where nothing moves."""
        out = self.outputs
        return Burst(
            np.repeat(out.set_position[None, :], n, axis=0), np.zeros(n), np.full(n, -1, np.int32),
            np.full(n, Status.WAIT, np.uint8), np.full(n, out.switches, np.uint32), np.zeros((0, 3), np.int64),
            k.RAN, 0,
        )  # fmt: skip

    def _describe(self, burst: Burst) -> None:
        """The outputs after a call."""
        rows, out = self._rows[self._way], self.outputs
        describe(out, burst, self._stepper, rows, self._head, self.inputs.last_way_pos, self.cycle)
        moved = len(burst) > 0 and burst.velocity[-1] > 0.0
        self.direction = Direction((1 - 2 * self._way) if moved else 0)
        out.done = out.done and self._way == 0
        describe_m(out, self._stepper, self._events)

    def _events(self) -> Iterable[Event]:
        """The events of the first row of the forward path that is not done."""
        e = self.path.events
        for at in np.flatnonzero(e.segment == self._head).tolist():
            name = self.path.names[e.o[at]] if e.o[at] >= 0 else ""
            yield Event(
                int(e.kind[at]), int(e.number[at]), float(e.position[at]), float(e.k[at]), float(e.l[at]), name
            )  # fmt: skip

    def snapshot(self) -> Turn:
        """The state before a burst that may have to be taken back."""
        return Turn(self._stepper.snapshot(), self._way, self._head)

    def checkpoint(self) -> Callable[[], None]:
        """Keeps the present state; calling what is returned comes back to it."""
        saved = self.snapshot()
        return lambda: self.restore(saved)

    def restore(self, saved: Turn) -> None:
        """Comes back to a snapshot."""
        self._stepper.restore(saved.stepper)
        self._way, self._head = saved.way, saved.head
        self.outputs.set_position = saved.stepper.here.copy()
