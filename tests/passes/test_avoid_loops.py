"""avoid-loops: intersections of all kinds, cutting in order, closed contours, speed."""

from __future__ import annotations

import time
from math import cos, pi, sin

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.kernels import intersect
from nccompile.passes.avoid_loops import AvoidLoops
from nccompile.passes.measure import samples
from nccompile.toolpath.columns import Kind, Mark, Toolpath
from tests.passes.paths import SIZES, Sketch, paths, run, same

LOOPS = AvoidLoops(everywhere=True)


@settings(max_examples=25, deadline=None)
@given(path=paths(most=14))
def test_any_path_passes_and_chunks_do_not_matter(path: Toolpath) -> None:
    for p in (LOOPS, AvoidLoops()):
        whole, _ = run(p, path)
        for size in SIZES[:2]:
            assert same(run(p, path, size)[0], whole)


def test_a_loop_is_cut_at_its_crossing_between_g61_and_g60() -> None:
    sketch = (
        Sketch().to(10, 0).mark(Mark.LOOP).switch(1, 0.9).to(10, 5).switch(2, 0.5).to(5, 5).to(5, -5, 0, 8)
    )
    path = sketch.mark(Mark.LOOP_STOP).path()
    out, report = run(AvoidLoops(), path)
    assert out.target[:, :2].tolist() == [[5, 0], [5, -5]]
    assert out.target[-1, 3] == 8.0
    assert report.counts["loops"] == 1
    assert out.events.number.tolist() == [1, 2]
    assert out.events.segment.tolist() == [0, 0]
    assert out.mark.tolist() == [0, Mark.LOOP_STOP]
    assert len(run(AvoidLoops(), path.replace(mark=np.zeros(4, np.uint16)))[0]) == 4


def test_an_m_function_in_a_loop_is_kept_at_the_crossing() -> None:
    out, _ = run(LOOPS, Sketch().to(10, 0).to(10, 5).m(7).to(5, 5).to(5, -5).path())
    assert out.kind.tolist() == [Kind.LINE, Kind.M_FUNCTION, Kind.LINE]
    assert out.target[:, :2].tolist() == [[5, 0], [5, 0], [5, -5]]


def test_a_closed_contour_and_touching_joints_are_no_loops() -> None:
    square = Sketch().to(10, 0).to(10, 10).to(0, 10).to(0, 0).path()
    assert same(run(LOOPS, square)[0], square)
    circle = Sketch((5, 0)).arc(5.0, 2 * pi, turn=pi / 2).path()
    assert same(run(LOOPS, circle)[0], circle)
    back = Sketch().to(10, 0).to(0, 0).to(0, 5).path()
    assert same(run(LOOPS, back)[0], back)


def test_crossings_at_different_heights_are_none() -> None:
    path = Sketch().to(10, 0).to(10, 5).to(5, 5).to(5, 5, 2).to(5, -5).path()
    assert same(run(LOOPS, path)[0], path)


def test_arcs_ellipses_and_cubics_are_cut_where_they_cross() -> None:
    path = (
        Sketch()
        .arc(5.0, 5.5)
        .to(-20, 3)
        .cubic(30, 1, (40, 30), (40, -30))
        .ellipse(8, 0.4, 1.0, 5.0, 2.0)
        .path()
    )
    out, report = run(LOOPS, path)
    assert report.counts["loops"] >= 1
    again, _ = run(LOOPS, out)
    assert same(again, out)
    line = shapely.LineString(samples(out, np.full(len(out), 400))[0][:, :2])
    assert line.is_simple


segments = st.tuples(st.floats(-10, 10), st.floats(-10, 10), st.floats(-10, 10), st.floats(-10, 10))


@settings(max_examples=60, deadline=None)
@given(st.floats(-8, 8), st.floats(-8, 8), st.floats(0.5, 9), st.floats(0, 6), st.floats(0.2, 6), segments)
def test_line_and_arc_meet_where_shapely_says(
    x: float, y: float, r: float, start: float, sweep: float, ends: tuple[float, float, float, float]
) -> None:
    p = np.array([x, y, r, start, sweep] + [0.0] * 7)
    a, b = np.array(ends[:2]), np.array(ends[2:])
    if np.abs(a - b).max() < 0.1:
        return
    c, d = (np.array([x + r * cos(w), y + r * sin(w)]) for w in (start, start + sweep))
    us, vs = np.zeros(48), np.zeros(48)
    count = intersect.intersections(
        Kind.LINE, np.zeros(12), np.hstack([a, b]), Kind.ARC, p, np.hstack([c, d]), us, vs
    )
    for k in range(count):
        on_line = a + us[k] * (b - a)
        w = start + sweep * vs[k]
        assert on_line == pytest.approx([x + r * cos(w), y + r * sin(w)], abs=1e-6)
    t = start + sweep * np.linspace(0, 1, 4000)
    arc = shapely.LineString(np.stack([x + r * np.cos(t), y + r * np.sin(t)], axis=1))
    found = arc.intersection(shapely.LineString([a, b]))
    assert len(shapely.get_parts(found)) <= count + 1 if not found.is_empty else True


def test_a_hundred_thousand_segments_take_about_ten_times_ten_thousand() -> None:
    def contour(n: int) -> Toolpath:
        t = np.linspace(0, 1.9 * pi, n + 1)
        r = 100 + 3 * np.sin(40 * t)
        target = np.zeros((n + 1, 4))
        target[:, 0], target[:, 1] = r * np.cos(t), r * np.sin(t)
        path = Sketch().to(1, 0).path()
        one = np.zeros(n)
        return path.replace(
            start=target[0], target=target[1:], kind=np.ones(n, np.uint8), curve=np.full(n, -1, np.int32),
            length=np.sqrt((np.diff(target, axis=0) ** 2).sum(axis=1)), feed=one, accel=one, decel=one, radius=one,
            mark=np.zeros(n, np.uint16), profile=np.zeros(n, np.uint16), line=np.zeros(n, np.int32),
        )  # fmt: skip

    times = []
    for n in (100, 5_000, 50_000):
        begin = time.perf_counter()
        assert len(Toolpath.join(list(LOOPS.apply([contour(n)])))) == n
        times.append(time.perf_counter() - begin)
    assert times[2] < 40 * times[1]
