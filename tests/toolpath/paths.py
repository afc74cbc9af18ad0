"""Sound toolpaths for the tests of the IR: one rich chunk, and random ones."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi

import numpy as np
from hypothesis import strategies as st

from nccompile.geometry import (
    Curve,
    arc_by_center,
    arc_by_radius,
    cardinal_spline,
    ellipse_by_center,
    parabola_by_tangents,
)
from nccompile.toolpath.columns import Curves, EventKind, Events, Kind, Mark, Plane, Toolpath
from nccompile.toolpath.lengths import path_length


@dataclass
class Builder:
    """Collects segments one behind the other on the given axes."""

    axes: tuple[str, ...] = ("X", "Y", "Z", "A", "P")
    at: list[float] = field(default_factory=lambda: [0.0] * 5)
    rows: list[tuple[int, list[float], int, float, int]] = field(default_factory=list)
    curves: list[tuple[int, tuple[float, ...]]] = field(default_factory=list)
    events: list[tuple[int, int, int, float, float, float, int]] = field(default_factory=list)

    def add(
        self,
        kind: Kind,
        *,
        curve: Curve | None = None,
        plane: Plane = Plane.XY,
        profile: int = 0,
        **to: float,
    ) -> Builder:
        """A segment to the position given by axis letters; the others stay."""
        start = list(self.at)
        for letter, value in to.items():
            self.at[self.axes.index(letter)] = value
        row = -1
        if curve is not None:
            row = len(self.curves)
            self.curves.append((plane, curve.parameters))
        length = path_length(
            self.axes, kind, start, self.at, None if curve is None else plane,
            None if curve is None else curve.row, profile,
        )  # fmt: skip
        self.rows.append((kind, list(self.at), row, length, profile))
        return self

    def event(
        self,
        kind: EventKind,
        number: int,
        position: float = 0.0,
        k: float = 0.0,
        l: float = 0.0,  # noqa: E741 - the word letter of the language
        o: int = -1,
    ) -> Builder:
        """An event of the last segment."""
        self.events.append((len(self.rows) - 1, kind, number, position, k, l, o))
        return self

    def path(self, names: tuple[str, ...] = ()) -> Toolpath:
        """The chunk."""
        n = len(self.rows)
        kind, target, curve, length, profile = zip(*self.rows, strict=True)
        moving = np.array(length) > 0.0
        mark = np.zeros(n, np.uint16)
        mark[0] = Mark.TOOL_LEFT | Mark.ROUND
        mark[-1] = Mark.TOOL_STOP | Mark.CORNER_STOP
        return Toolpath(
            axes=self.axes,
            start=np.zeros(len(self.axes)),
            kind=np.array(kind, np.uint8),
            target=np.array(target),
            curve=np.array(curve, np.int32),
            length=np.array(length),
            feed=np.where(moving, 20.0, 0.0),
            accel=np.where(moving, 0.1 + 0.2, 0.0),
            decel=np.zeros(n),
            mark=mark,
            radius=np.full(n, 1.0 / 3.0),
            profile=np.array(profile, np.uint16),
            line=np.arange(3, n + 3, dtype=np.int32),
            curves=Curves.from_rows(self.curves),
            events=Events.from_rows(self.events),
            names=names,
        )


def rich() -> Toolpath:
    """One chunk with every kind, plane, event and mark."""
    b = Builder()
    b.add(Kind.SET_POSITION, X=5.0, Y=5.0, Z=10.0)
    b.add(Kind.POSITIONING, X=0.0, Y=0.0, Z=10.0)
    b.add(Kind.LINE, Z=-1.0, A=90.0).event(EventKind.SWITCH, 2, 0.0).event(EventKind.SWITCH, -2, 0.25)
    b.add(Kind.ARC, curve=arc_by_radius(0.0, 0.0, 20.0, 0.0, 10.0, ccw=False), X=20.0)
    b.event(EventKind.SWITCH, 7, 0.5)
    b.add(Kind.ARC, curve=arc_by_center(20.0, 0.0, 20.0, 0.0, 15.0, 0.0, ccw=True), Z=-4.0)
    b.add(Kind.M_FUNCTION).event(EventKind.M_FUNCTION, 10, 0.0, 1.5, -2.5, 0)
    ellipse = ellipse_by_center(20.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.3, 0.6, ccw=True)
    b.add(Kind.ELLIPSE, curve=ellipse, X=0.0, P=3.0).event(EventKind.SWITCH, 8, 1.0)
    b.add(Kind.POLYNOMIAL, curve=parabola_by_tangents(0.0, 0.0, 30.0, 5.0, 10.0, 10.0), X=30.0, Y=5.0)
    for piece, (x, y) in zip(
        cardinal_spline([(30.0, 5.0), (40.0, 0.0), (45.0, 9.0)], (0.6, 0.8), None),
        [(40.0, 0.0), (45.0, 9.0)],
        strict=True,
    ):
        b.add(Kind.POLYNOMIAL, curve=piece, X=x, Y=y, Z=-6.0, profile=4)
    b.add(Kind.DWELL).event(EventKind.DWELL, 0, 0.0, 0.75)
    zx = arc_by_center(-6.0, 45.0, -4.0, 47.0, -4.0, 45.0, ccw=False)
    b.add(Kind.ARC, curve=zx, plane=Plane.ZX, Z=-4.0, X=47.0)
    yz = arc_by_center(9.0, -4.0, 11.0, -6.0, 11.0, -4.0, ccw=True)
    b.add(Kind.ARC, curve=yz, plane=Plane.YZ, Y=11.0, Z=-6.0)
    space = Curve(
        Kind.POLYNOMIAL, Plane.SPACE, (47.0, 3.0, 0.0, 0.0, 11.0, 0.0, 4.0, 0.0, -6.0, 0.0, 0.0, 5.0)
    )
    b.add(Kind.POLYNOMIAL, curve=space, plane=Plane.SPACE, X=50.0, Y=15.0, Z=-1.0)
    b.add(Kind.LINE, A=0.0, P=4.0).add(Kind.LINE, P=5.0, profile=1 << 4)
    return b.path(names=('g "data"', "g_zähler # 2"))


def planned_line(lengths: list[float], accel: float = 100.0) -> Toolpath:
    """Planned lines along X that start and end at rest, as fast as 10 mm/s and their limits allow."""
    b = Builder(axes=("X", "Y", "Z"), at=[0.0] * 3)
    x = 0.0
    for length in lengths:
        x += length
        b.add(Kind.LINE, X=x)
    path = b.path()
    n = len(path)
    v = np.full(n, 10.0)
    v[-1] = 0.0
    for i in range(n):
        v[i] = min(v[i], (float(v[i - 1]) ** 2 * (i > 0) + 2 * accel * float(path.length[i])) ** 0.5)
    for i in range(n - 2, -1, -1):
        v[i] = min(v[i], (float(v[i + 1]) ** 2 + 2 * accel * float(path.length[i + 1])) ** 0.5)
    limit = np.full(n, 50.0)
    return path.replace(
        accel=np.full(n, accel), decel=np.full(n, accel), v_limit=limit, v_junction=limit.copy(), v_end=v
    )


numbers = st.floats(-1e6, 1e6)


@st.composite
def paths(draw: st.DrawFn) -> Toolpath:
    """A random sound chunk of lines, rapids, full circles, waits and events, any floats."""
    b = Builder()
    for _ in range(draw(st.integers(1, 6))):
        kind = draw(
            st.sampled_from([Kind.LINE, Kind.POSITIONING, Kind.ARC, Kind.SET_POSITION, Kind.M_FUNCTION])
        )
        if kind is Kind.ARC:
            x, y = b.at[:2]
            radius, angle = draw(st.floats(1e-3, 1e5)), draw(st.floats(-pi, pi))
            curve = Curve(
                kind, 0, (x - radius * np.cos(angle), y - radius * np.sin(angle), radius, angle, 2 * pi)
            )
            b.add(kind, curve=curve, Z=draw(numbers))
        elif kind is Kind.M_FUNCTION:
            number = draw(st.integers(-(2**31), 2**31 - 1))
            b.add(kind).event(
                EventKind.M_FUNCTION, number, 0.0, draw(numbers), draw(numbers), draw(st.integers(-1, 1))
            )
        else:
            b.add(
                kind,
                X=draw(numbers),
                Y=draw(numbers),
                P=draw(numbers),
                profile=draw(st.sampled_from([0, 4, 16])),
            )
            if kind is not Kind.SET_POSITION:
                for place in sorted(draw(st.lists(st.floats(0.0, 1.0), max_size=3))):
                    b.event(EventKind.SWITCH, draw(st.sampled_from([1, -1, 32])), place)
    path = b.path(names=("a", draw(st.text(max_size=5))))
    if draw(st.booleans()):
        n = len(path)
        column = st.lists(st.floats(allow_nan=False), min_size=n, max_size=n)
        path = path.replace(**{name: np.array(draw(column)) for name in ("v_limit", "v_junction", "v_end")})
    return path.replace(first=draw(st.integers(0, 10)))
