"""Following a path by the position of its X axis (SMC_XInterpolator, SoftMotion §6.7).

Another process moves the workpiece along X; the other axes go to where the path is at that X:

    x of the workpiece --+ offset--> path point with this X --> set position

There is no velocity profile: the workpiece is the clock.  The path must go on in X everywhere, else there would be
no point, or several, for an X.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from nccompile.backend.samples import rows_of
from nccompile.errors import UsageError
from nccompile.kernels import interpolator as k
from nccompile.kernels.curves import NODES, tabulate
from nccompile.toolpath.columns import EventKind, Floats, Kind, Toolpath

__all__ = ["XInterpolator"]

_PLACES = 65
_STEPS = 60


@dataclass
class XInterpolator:
    """The block; call `advance` once a cycle.

    path: planned, at hand as a whole;  direction: 1 or -1, the way X goes;  offset: path X minus axis X [mm].

    set_position f8 (axes,);  done: X is beyond the path;  source_line: -1 before it and after it;  switches: bit b
    for switch b + 1;  last_switch;  way_pos: path length behind [mm].
    Raises: UsageError: X stands still or goes back somewhere, with the source line.
    """

    path: Toolpath
    direction: int = 1
    offset: float = 0.0
    set_position: Floats = field(init=False)
    done: bool = field(default=False, init=False)
    source_line: int = field(default=-1, init=False)
    switches: int = field(default=0, init=False)
    last_switch: int = field(default=0, init=False)
    way_pos: float = field(default=0.0, init=False)

    def __post_init__(self) -> None:
        if self.direction not in (1, -1):
            raise UsageError(f"the direction is 1 or -1, not {self.direction}")
        moving = np.flatnonzero((self.path.length > 0.0) & (self.path.kind < Kind.SET_POSITION))
        if len(moving) and int(self.path.kind[: moving[-1]].max(initial=0)) >= Kind.SET_POSITION:
            raise UsageError("a path that follows X cannot wait or jump on its way")
        self._rows = rows_of(self.path)
        self._moving = moving
        self._behind = np.append(0.0, np.cumsum(self.path.length[moving]))  # path length before each of them
        self._row = 0
        self._nodes, self._tabulated, self._count = (np.zeros(NODES), np.zeros(NODES)), -1, 0
        self._event = 0
        self._point = np.array(self.path.start, np.float64)
        self.set_position = self._point.copy()
        for row in moving:
            self._check(int(row))

    def advance(self, x: float) -> Floats:
        """The set position for the axis at x [mm]; the path is never run back."""
        wanted = self.direction * (x + self.offset)
        while self._row < len(self._moving):
            row = int(self._moving[self._row])
            if self.direction * float(self.path.target[row, 0]) > wanted:
                self._inside(row, wanted)
                return self.set_position
            self._fire(row, 1.0)
            self.set_position = self.path.target[row].copy()
            self._row += 1
            self.way_pos = float(self._behind[self._row])
        self.done, self.source_line = True, -1
        return self.set_position

    def _inside(self, row: int, wanted: float) -> None:
        """The point of a row at an X, by halving: X goes on along it."""
        length = float(self.path.length[row])
        behind = float(self._behind[self._row])
        low = max(0.0, self.way_pos - behind)
        if wanted < self.direction * self._x_at(row, low):
            return  # not there yet, or the workpiece goes back
        high = length
        for _ in range(_STEPS):
            mid = 0.5 * (low + high)
            if self.direction * self._x_at(row, mid) <= wanted:
                low = mid
            else:
                high = mid
        self._x_at(row, low)
        self.set_position = self._point.copy()
        self.way_pos = behind + low
        self.source_line = int(self.path.line[row])
        self._fire(row, low / length)

    def _x_at(self, row: int, s: float) -> float:
        """X at path length s of a row, whose point is left in `_point`."""
        curve, kind = int(self.path.curve[row]), int(self.path.kind[row])
        if row != self._tabulated and curve >= 0 and kind != Kind.ARC:
            self._count = int(tabulate(kind, self.path.curves.parameters[curve], *self._nodes))
            self._tabulated = row
        k.locate(self._rows, row, s, *self._nodes, self._count, self._point)
        return float(self._point[0])

    def _check(self, row: int) -> None:
        """Raises UsageError if X does not go on along a row."""
        length = float(self.path.length[row])
        x = np.array([self._x_at(row, length * i / (_PLACES - 1)) for i in range(_PLACES)])
        if (self.direction * np.diff(x) <= 0.0).any():
            raise UsageError(
                f"source line {self.path.line[row]}: X does not go on in the direction of the workpiece"
            )

    def _fire(self, row: int, share: float) -> None:
        """Sets the switches up to a share of a row's length."""
        e = self.path.events
        while self._event < len(e) and (e.segment[self._event], e.position[self._event]) <= (row, share):
            number = int(e.number[self._event])
            if e.kind[self._event] == EventKind.SWITCH:
                self.last_switch = number
                bit = 1 << (abs(number) - 1)
                self.switches = self.switches | bit if number > 0 else self.switches & ~bit
            self._event += 1
