"""Random decoded toolpaths for planning and interpolation: lines, arcs, rapids, stops, tiny and zero lengths."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import atan2, cos, pi, sin, sqrt

import numpy as np
from hypothesis import strategies as st

from nccompile.toolpath.columns import Curves, EventKind, Events, Kind, Toolpath


@dataclass
class Builder:
    """Collects segments behind each other, in X, Y, Z and one rotary axis."""

    axes: tuple[str, ...] = ("X", "Y", "Z", "A")
    at: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0, 0.0])
    heading: float = 0.0
    rows: list[tuple[int, list[float], int, float, float, float, float, int]] = field(default_factory=list)
    curves: list[tuple[int, tuple[float, ...]]] = field(default_factory=list)
    events: list[tuple[int, int, int, float, float, float, int]] = field(default_factory=list)

    def _add(
        self, kind: Kind, target: list[float], curve: int, length: float, f: float, a: float, d: float
    ) -> None:
        self.rows.append((kind, target, curve, length, f, a, d, 0))
        self.at = target

    def line(
        self, length: float, turn: float, f: float, a: float = 500.0, d: float = 500.0, dz: float = 0.0,
        da: float = 0.0, kind: Kind = Kind.LINE,
    ) -> None:  # fmt: skip
        """A straight segment that turns off the last direction by `turn` [rad]."""
        self.heading += turn
        x, y, z, rotary = self.at
        target = [x + length * cos(self.heading), y + length * sin(self.heading), z + dz, rotary + da]
        moved = sqrt((target[0] - x) ** 2 + (target[1] - y) ** 2 + dz * dz)
        self._add(kind, target, -1, moved if moved > 0.0 else abs(da), f, a, d)

    def arc(
        self, radius: float, sweep: float, turn: float, f: float, a: float = 500.0, d: float = 500.0
    ) -> None:
        """An arc that starts along the last direction turned by `turn`."""
        self.heading += turn
        x, y, z, rotary = self.at
        side = 1.0 if sweep > 0 else -1.0
        cx, cy = x - side * radius * sin(self.heading), y + side * radius * cos(self.heading)
        start = atan2(y - cy, x - cx)
        self.heading += sweep
        end = start + sweep
        self.curves.append((0, (cx, cy, radius, start, sweep)))
        target = [cx + radius * cos(end), cy + radius * sin(end), z, rotary]
        self._add(Kind.ARC, target, len(self.curves) - 1, radius * abs(sweep), f, a, d)

    def still(self, kind: Kind, seconds: float = 0.0, number: int = 0) -> None:
        """A dwell or an M function."""
        event = EventKind.DWELL if kind is Kind.DWELL else EventKind.M_FUNCTION
        self.events.append((len(self.rows), event, number, 0.0, seconds, 0.0, -1))
        self._add(kind, list(self.at), -1, 0.0, 0.0, 0.0, 0.0)

    def jump(self, dx: float) -> None:
        """A G92 in the middle."""
        self._add(Kind.SET_POSITION, [self.at[0] + dx, *self.at[1:]], -1, 0.0, 0.0, 0.0, 0.0)

    def switch(self, number: int, position: float) -> None:
        """A switch point on the last segment."""
        self.events.append((len(self.rows) - 1, EventKind.SWITCH, number, position, 0.0, 0.0, -1))

    def path(self) -> Toolpath:
        """The segments as one chunk."""
        n = len(self.rows)
        kind, target, curve, length, feed, accel, decel, mark = zip(*self.rows, strict=True)
        return Toolpath(
            axes=self.axes, start=np.zeros(4), kind=np.array(kind, np.uint8), target=np.array(target, float),
            curve=np.array(curve, np.int32), length=np.array(length, float), feed=np.array(feed, float),
            accel=np.array(accel, float), decel=np.array(decel, float), mark=np.array(mark, np.uint16),
            radius=np.zeros(n), profile=np.zeros(n, np.uint16), line=np.arange(1, n + 1, dtype=np.int32),
            curves=Curves.from_rows(self.curves), events=Events.from_rows(self.events),
        )  # fmt: skip


lengths = st.one_of(st.floats(0.5, 60.0), st.floats(1e-4, 0.05), st.just(0.0))
turns = st.one_of(st.just(0.0), st.floats(-0.3, 0.3), st.floats(-pi, pi))
feeds = st.one_of(st.floats(5.0, 400.0), st.just(0.0))
ramps = st.one_of(st.floats(50.0, 4000.0), st.just(0.0))


@st.composite
def paths(draw: st.DrawFn, *, stops: bool = True, most: int = 25) -> Toolpath:
    """A decoded path of up to `most` segments."""
    build = Builder()
    kinds = ["line", "line", "arc", "rapid", "rotary", "z"]
    if stops:
        kinds += ["dwell", "m", "jump"]
    for _ in range(draw(st.integers(1, most))):
        kind = draw(st.sampled_from(kinds))
        f, a, d = draw(feeds), draw(ramps), draw(ramps)
        if kind in ("line", "rapid", "z", "rotary"):
            build.line(
                draw(lengths) if kind != "rotary" else draw(st.sampled_from([0.0, 5.0])), draw(turns), f, a, d,
                dz=round(draw(st.floats(-10, 10)), 6) if kind == "z" else 0.0,
                da=round(draw(st.floats(-90, 90)), 6) if kind == "rotary" else 0.0,
                kind=Kind.POSITIONING if kind == "rapid" else Kind.LINE,
            )  # fmt: skip
            if draw(st.booleans()):
                build.switch(draw(st.sampled_from([1, -1, 5, 32, -32])), draw(st.floats(0, 1)))
        elif kind == "arc":
            sweep = draw(st.floats(0.05, 2 * pi)) * draw(st.sampled_from([1.0, -1.0]))
            build.arc(draw(st.floats(0.05, 40.0)), sweep, draw(turns), f, a, d)
        elif kind == "dwell":
            build.still(Kind.DWELL, seconds=draw(st.floats(0.0, 0.5)))
        elif kind == "m":
            build.still(Kind.M_FUNCTION, number=draw(st.integers(1, 99)))
        else:
            build.jump(draw(st.floats(-20, 20)))
    return build.path()


def cut(path: Toolpath, size: int) -> list[Toolpath]:
    """The path in chunks of `size` segments."""
    return [path.rows(at, at + size) for at in range(0, len(path), size)]
