"""Random decoded paths with marks, curves of all kinds and stops, and what the tests of all passes share."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from math import cos, sin

import numpy as np
from hypothesis import strategies as st

from nccompile.kernels import curves as kernels
from nccompile.kernels.distance import place_on
from nccompile.passes.base import Context, Pass, Report, gather
from nccompile.toolpath.columns import Curves, EventKind, Events, Floats, Kind, Mark, Plane, Toolpath
from nccompile.toolpath.lengths import THIRD_AXIS, path_lengths
from nccompile.toolpath.verify import verify_chain
from tests.passes.places import Way, curvature_at, tangent_at

AXES = ("X", "Y", "Z", "A")


class Sketch:
    """Draws a path segment by segment; axes X, Y, Z and A."""

    def __init__(self, start: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)) -> None:
        self.start = np.array([*start, 0.0, 0.0, 0.0, 0.0][:4])
        self.at = self.start.copy()
        self.heading = 0.0
        self.rows: list[tuple[int, Floats, int, float, float, int]] = []
        self.curves: list[tuple[int, list[float]]] = []
        self.events: list[tuple[int, int, int, float, float, float, int]] = []
        self.marks: dict[int, int] = {}

    def _add(self, kind: int, target: Floats, curve: int = -1, feed: float = 50.0, d: float = 0.0) -> Sketch:
        self.rows.append((kind, target, curve, feed, d, len(self.rows) + 1))
        self.at = target
        return self

    def to(self, x: float, y: float, z: float | None = None, a: float | None = None, *, feed: float = 50.0,
           d: float = 0.0, kind: int = Kind.LINE) -> Sketch:  # fmt: skip
        """A straight segment."""
        target = np.array([x, y, self.at[2] if z is None else z, self.at[3] if a is None else a])
        step = target - self.at
        if step[0] or step[1]:
            self.heading = float(np.arctan2(step[1], step[0]))
        return self._add(kind, target, feed=feed, d=d)

    def arc(
        self, radius: float, sweep: float, turn: float = 0.0, dz: float = 0.0, feed: float = 50.0
    ) -> Sketch:
        """An arc that starts along the heading turned by `turn`; a helix if dz."""
        heading = self.heading + turn
        side = 1.0 if sweep > 0 else -1.0
        cx = self.at[0] - side * radius * sin(heading)
        cy = self.at[1] + side * radius * cos(heading)
        start = float(np.arctan2(self.at[1] - cy, self.at[0] - cx))
        self.curves.append((0, [cx, cy, radius, start, sweep]))
        end = start + sweep
        target = np.array([cx + radius * cos(end), cy + radius * sin(end), self.at[2] + dz, self.at[3]])
        self.heading = heading + sweep
        return self._add(Kind.ARC, target, len(self.curves) - 1, feed)

    def ellipse(self, main: float, ratio: float, start: float, sweep: float, direction: float) -> Sketch:
        """An ellipse arc that starts where the path is."""
        p = np.zeros(12)
        p[2:7] = main, main * ratio, direction, start, sweep
        x, y = kernels.point(3, p, 0.0)
        p[:2] = self.at[0] - x, self.at[1] - y
        self.curves.append((0, p.tolist()))
        end = np.array([*kernels.point(3, p, 1.0), self.at[2], self.at[3]])
        tx, ty = kernels.tangent(3, p, 1.0)
        self.heading = float(np.arctan2(ty, tx))
        return self._add(Kind.ELLIPSE, end, len(self.curves) - 1)

    def cubic(self, dx: float, dy: float, m0: tuple[float, float], m1: tuple[float, float]) -> Sketch:
        """A cubic with these derivatives at its ends."""
        p = np.zeros(12)
        for c, step in enumerate((dx, dy)):
            p[4 * c : 4 * c + 4] = (
                self.at[c], m0[c], 3 * step - 2 * m0[c] - m1[c], m0[c] + m1[c] - 2 * step,
            )  # fmt: skip
        self.curves.append((0, p.tolist()))
        self.heading = float(np.arctan2(m1[1], m1[0]))
        return self._add(
            Kind.POLYNOMIAL, np.array([self.at[0] + dx, self.at[1] + dy, *self.at[2:]]), len(self.curves) - 1
        )

    def jump(self, x: float, y: float) -> Sketch:
        """G92."""
        return self._add(Kind.SET_POSITION, np.array([x, y, self.at[2], self.at[3]]))

    def m(self, number: int) -> Sketch:
        """An M function."""
        self.events.append((len(self.rows), EventKind.M_FUNCTION, number, 0.0, 0.0, 0.0, -1))
        return self._add(Kind.M_FUNCTION, self.at)

    def switch(self, number: int, position: float) -> Sketch:
        """A switch point on the last segment."""
        self.events.append((len(self.rows) - 1, EventKind.SWITCH, number, position, 0.0, 0.0, -1))
        return self

    def mark(self, bits: int) -> Sketch:
        """Marks the last segment."""
        self.marks[len(self.rows) - 1] = self.marks.get(len(self.rows) - 1, 0) | int(bits)
        return self

    def path(self) -> Toolpath:
        """The path as one chunk."""
        n = len(self.rows)
        kind, target, curve, feed, d, line = zip(*self.rows, strict=True) if n else ((),) * 6
        path = Toolpath(
            axes=AXES, start=self.start, kind=np.array(kind, np.uint8),
            target=np.array(target, float).reshape(n, 4), curve=np.array(curve, np.int32), length=np.zeros(n),
            feed=np.array(feed, float), accel=np.zeros(n), decel=np.zeros(n),
            mark=np.array([self.marks.get(i, 0) for i in range(n)], np.uint16), radius=np.array(d, float),
            profile=np.zeros(n, np.uint16), line=np.array(line, np.int32),
            curves=Curves.from_rows(self.curves), events=Events.from_rows(self.events),
        )  # fmt: skip
        return path.replace(length=path_lengths(path))


class Probe:
    """Point, direction and curvature along row i of a path; s in mm from its start."""

    def __init__(self, path: Toolpath, i: int) -> None:
        self.kind, self.length = int(path.kind[i]), float(path.length[i])
        self.start, self.end = path.starts()[i], path.target[i]
        row = int(path.curve[i])
        self.plane = -1 if row < 0 else int(path.curves.plane[row])
        self.p: Floats = np.zeros(12) if row < 0 else path.curves.parameters[row]
        self.way = None if row < 0 else Way(self.kind, self.p.tolist())

    def _u(self, s: float) -> float:
        return s / self.length if self.way is None else self.way.parameter(s / self.length)

    def point(self, s: float) -> Floats:
        """X, Y, Z."""
        return np.array(place_on(self.kind, self.plane, self.p, self.start, self.end, self._u(s)))

    def tangent(self, s: float) -> Floats:
        """Unit vector."""
        if self.way is None:
            step = (self.end - self.start)[:3]
            return np.asarray(step / np.linalg.norm(step))
        rise = 0.0
        if self.plane != Plane.SPACE:
            third = THIRD_AXIS[self.plane]
            rise = float(self.end[third] - self.start[third]) / self.way.length
        return np.array(tangent_at(self.kind, self.plane, self.p, self._u(s), rise))

    def curvature(self, s: float) -> Floats:
        """Vector [1/mm]."""
        if self.way is None:
            return np.zeros(3)
        slant = 1.0 if self.plane == Plane.SPACE else self.way.length / self.length
        return slant * slant * np.array(curvature_at(self.kind, self.plane, self.p, self._u(s)))


@contextmanager
def windows(least: int) -> Iterator[None]:
    """Passes look at windows of at least this many rows, 0: as ever; so short paths have many windows, too."""
    before = gather.__defaults__
    gather.__defaults__ = (least,) if least else before
    try:
        yield
    finally:
        gather.__defaults__ = before


def run(p: Pass, path: Toolpath, size: int = 0) -> tuple[Toolpath, Report]:
    """A pass over a path cut in chunks of `size`, which are its windows (0: one chunk); the result is verified."""
    report = Report(p.name)
    with windows(size):
        out = list(verify_chain(p.apply(cut(path, size), Context(report))))
    return Toolpath.join(out), report


def cut(path: Toolpath, size: int) -> Iterable[Toolpath]:
    """The path in chunks of `size` segments."""
    return [path.rows(at, at + size) for at in range(0, max(len(path), 1), size)] if size else [path]


def same(one: Toolpath, two: Toolpath) -> bool:
    """Whether two paths are equal, bit by bit."""
    names = (
        "start",
        "kind",
        "target",
        "curve",
        "length",
        "feed",
        "accel",
        "decel",
        "mark",
        "radius",
        "profile",
        "line",
    )
    pairs = [(getattr(one, n), getattr(two, n)) for n in names]
    pairs += [(one.curves.plane, two.curves.plane), (one.curves.parameters, two.curves.parameters)]
    pairs += [
        (getattr(one.events, n), getattr(two.events, n))
        for n in ("segment", "kind", "number", "position", "k")
    ]
    return all(np.array_equal(a, b) for a, b in pairs)


SIZES = (1, 7, 1000)

_lengths = st.one_of(st.floats(0.5, 60.0), st.floats(1e-4, 0.05), st.just(0.0), st.just(10.0))
_turns = st.one_of(
    st.just(0.0), st.floats(-0.3, 0.3), st.floats(-3.1, 3.1), st.sampled_from([1.5707963267948966, 3.0])
)
_offsets = st.sampled_from([0.0, 0.0, 1e6])


@st.composite
def paths(
    draw: st.DrawFn, *, most: int = 16, marks: bool = True, flat: bool = False, stops: bool = True
) -> Toolpath:
    """A decoded path of up to `most` segments."""
    off = draw(_offsets)
    sketch = Sketch((off, -off, 0.0, 0.0))
    kinds = ["line", "line", "line", "arc", "arc", "ellipse", "cubic"]
    kinds += ["rapid", "m", "jump"] if stops else []
    for _ in range(draw(st.integers(1, most))):
        kind = draw(st.sampled_from(kinds))
        _segment(draw, sketch, kind, flat)
        if kind not in ("m", "jump") and draw(st.integers(0, 3)) == 0:
            sketch.switch(
                draw(st.sampled_from([1, -1, 5])), draw(st.sampled_from([0.0, 0.25, 0.5, 0.9, 1.0]))
            )
        if marks and kind not in ("m", "jump") and draw(st.integers(0, 3)) == 0:
            sketch.mark(draw(st.sampled_from([m for m in Mark if m != Mark.TOOL_RIGHT])))
    return sketch.path()


def _segment(draw: st.DrawFn, sketch: Sketch, kind: str, flat: bool) -> None:
    length = draw(_lengths)
    heading = sketch.heading + draw(_turns)
    x, y = sketch.at[0] + length * cos(heading), sketch.at[1] + length * sin(heading)
    size = max(length, 1e-3)
    if kind in ("line", "rapid"):
        dz = 0.0 if flat else draw(st.sampled_from([0.0, 0.0, 1.5]))
        da = draw(st.sampled_from([0.0, 5.0]))
        d = draw(st.sampled_from([0.5, 2.0]))
        drive = Kind.LINE if kind == "line" else Kind.POSITIONING
        sketch.to(x, y, sketch.at[2] + dz, sketch.at[3] + da, kind=drive, d=d)
    elif kind == "arc":
        sweep = draw(st.floats(0.05, 6.2)) * draw(st.sampled_from([1.0, -1.0]))
        sketch.arc(size, sweep, draw(_turns), 0.0 if flat else draw(st.sampled_from([0.0, 2.0])))
    elif kind == "ellipse":
        sketch.ellipse(
            size, draw(st.floats(0.1, 1.0)), draw(st.floats(0, 6)), draw(st.floats(0.1, 6.2)), heading
        )
    elif kind == "cubic":
        step = (size * cos(heading), size * sin(heading))
        sketch.cubic(*step, (size, 0.0), (step[1], size))
    elif kind == "m":
        sketch.m(draw(st.integers(1, 99)))
    else:
        sketch.jump(x, y)
