"""The interpolator that runs a path in both directions (SMC_Interpolator2Dir, SoftMotion §6.2.10).

A negative override runs back, as a hand wheel does.  The plan is a motion s(T) over its own time T; the block
runs T at a rate r of -1 .. 1:

    T' = r     path velocity r v     path acceleration r² a + r' v       (v, a: of the plan)

At a constant rate nothing is beyond the plan.  While the rate changes, r' is chosen each cycle so that the path
acceleration stays in the segment's -decel .. accel; where the plan itself needs all of it, the rate waits.
The whole path must be at hand, and trapezoids be its time law; jumps and M functions are not for it.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np

from nccompile.backend.samples import rows_of
from nccompile.errors import UsageError
from nccompile.kernels import interpolator as k
from nccompile.kernels.curves import NODES, tabulate
from nccompile.kernels.timelaw import TRAPEZOID, law_distance, law_times, law_velocity
from nccompile.toolpath.columns import Floats, Kind, Toolpath

__all__ = ["Direction", "Interpolator2Dir"]

_RATE_CHANGE = 20.0
"""Greatest change of the rate [1/s]: from rest to the plan in 50 ms where the plan stands still."""

_ROOM = 0.99
"""Share of the segment's acceleration that a change of the rate uses: the plan goes on within the cycle."""


class Direction(IntEnum):
    """SMC_Direction of §6.2.10."""

    NEGATIVE = -1
    STANDSTILL = 0
    POSITIVE = 1


@dataclass
class Interpolator2Dir:
    """The block; call `advance` once a cycle.

    path: planned, at hand as a whole;  cycle [s];  override: -1 .. 1, beyond acts as the bound.
    set_position f8 (axes,);  direction;  velocity: path length of the last cycle over its time, negative
    backwards [mm/s];  source_line;  at_end: the end is reached;  at_start: so is the start, backwards.
    Raises: UsageError: the path has jumps or M functions.
    """

    path: Toolpath
    cycle: float
    override: float = 1.0
    set_position: Floats = field(init=False)
    direction: Direction = field(default=Direction.STANDSTILL, init=False)
    velocity: float = field(default=0.0, init=False)
    source_line: int = field(default=-1, init=False)

    def __post_init__(self) -> None:
        kinds = self.path.kind
        if ((kinds == Kind.SET_POSITION) | (kinds == Kind.M_FUNCTION)).any():
            raise UsageError("a path that runs in both directions cannot jump or wait for an M function")
        self._rows = rows_of(self.path)
        self._laws: list[tuple[int, float, float, float, float, float, float]] = []
        self._begins: list[float] = []
        self._end = self._tabulate_laws()
        self._nodes = np.zeros(NODES), np.zeros(NODES)
        self._tabulated, self._count = -1, 0
        self._time = 0.0
        self._rate = 0.0
        self._way = 0.0
        self.set_position = np.array(self.path.start, np.float64)

    @property
    def at_end(self) -> bool:
        """Whether the end of the path is reached."""
        return self._time >= self._end

    @property
    def at_start(self) -> bool:
        """Whether the path stands at its start."""
        return self._time <= 0.0

    def advance(self) -> Floats:
        """One cycle; returns the set position."""
        wanted = min(max(self.override, -1.0), 1.0)
        rate = self._next_rate(wanted)
        time = min(max(self._time + 0.5 * (self._rate + rate) * self.cycle, 0.0), self._end)
        if time in (0.0, self._end) and (rate > 0.0) == (time > 0.0):
            rate = 0.0  # the plan is at rest there
        self._time, self._rate = time, rate
        way = self._place()
        self.velocity = (way - self._way) / self.cycle
        self._way = way
        self.direction = Direction(int(np.sign(rate)))
        return self.set_position

    def _tabulate_laws(self) -> float:
        """The time laws of the moving rows and where they begin; returns the duration of the plan."""
        path, v, begin = self.path, 0.0, 0.0
        assert path.v_limit is not None
        assert path.v_end is not None
        way = 0.0
        self._ways: list[float] = []
        for row in np.flatnonzero(path.length > 0.0).tolist():
            top = min(float(path.feed[row]), float(path.v_limit[row]))
            numbers = (path.length[row], v, top, path.v_end[row], path.accel[row], path.decel[row])
            t1, t2, t3, peak, end = law_times(*(float(number) for number in numbers))
            self._laws.append((row, t1, t2, t3, v, peak, end))
            self._begins.append(begin)
            self._ways.append(way)
            begin, v, way = begin + t1 + t2 + t3, end, way + float(path.length[row])
        return begin

    def _law(self) -> tuple[int, float]:
        """Index of the law at the present time and the time in it."""
        at = max(0, bisect_right(self._begins, self._time) - 1)
        return at, self._time - self._begins[at]

    def _next_rate(self, wanted: float) -> float:
        """The rate after this cycle, as near to the wanted one as the acceleration allows."""
        if not self._laws:
            return 0.0
        at, t = self._law()
        row, t1, t2, t3, v0, peak, v1 = self._laws[at]
        v = law_velocity(TRAPEZOID, t, t1, t2, t3, v0, peak, v1)
        a = 0.0
        if t < t1:
            a = (peak - v0) / t1
        elif t > t1 + t2 and t3 > 0.0:
            a = (v1 - peak) / t3
        used = self._rate * self._rate * a
        up = max(_ROOM * float(self.path.accel[row]) - used, 0.0)
        down = max(_ROOM * float(self.path.decel[row]) + used, 0.0)
        most = min(up / v, _RATE_CHANGE) if v > 0.0 else _RATE_CHANGE
        least = min(down / v, _RATE_CHANGE) if v > 0.0 else _RATE_CHANGE
        change = min(max(wanted - self._rate, -least * self.cycle), most * self.cycle)
        return self._rate + change

    def _place(self) -> float:
        """Puts the set position at the present time; returns the path length there."""
        if not self._laws:
            return 0.0
        at, t = self._law()
        row, t1, t2, t3, v0, peak, v1 = self._laws[at]
        s = min(law_distance(TRAPEZOID, t, t1, t2, t3, v0, peak, v1), float(self.path.length[row]))
        if self.at_end:
            s = float(self.path.length[row])
        curve = int(self.path.curve[row])
        if curve >= 0 and self.path.kind[row] != Kind.ARC and self._tabulated != row:
            parameters = self.path.curves.parameters[curve]
            self._count = tabulate(int(self.path.kind[row]), parameters, *self._nodes)
            self._tabulated = row
        k.locate(self._rows, row, s, *self._nodes, self._count, self.set_position)
        self.source_line = int(self.path.line[row])
        return self._ways[at] + s
