"""tool-radius: corners, sides, approach and departure, gouges; random contours against shapely buffers."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile import kernels
from nccompile.diagnostics import Severity
from nccompile.passes.avoid_loops import AvoidLoops
from nccompile.passes.base import Context, Report
from nccompile.passes.measure import samples
from nccompile.passes.tool_radius import ToolRadius
from nccompile.toolpath.columns import Kind, Mark, Toolpath
from nccompile.toolpath.verify import verify_chain
from tests.passes.contours import closed_contours, distances, feed_points, outline
from tests.passes.paths import SIZES, Sketch, cut, paths, run, same


def corrected(
    p: ToolRadius, path: Toolpath, size: int = 0
) -> tuple[Toolpath, list[tuple[str, Severity, str, int]]]:
    """The corrected path and its findings."""
    found: list[tuple[str, Severity, str, int]] = []
    context = Context(
        Report(p.name), diagnose=lambda code, sev, text, line, help: found.append((code, sev, text, line))
    )
    return Toolpath.join(list(verify_chain(p.apply(cut(path, size), context)))), found


def square(mark: Mark, d: float = 1.0) -> Toolpath:
    sketch = Sketch().to(10, 0, kind=Kind.POSITIONING, d=d).to(20, 0, d=d).mark(mark)
    return sketch.to(20, 10, d=d).to(10, 10, d=d).to(10, 0, d=d).mark(Mark.TOOL_STOP).to(0, 0, kind=0).path()


def marked(path: Toolpath, r: float, left: bool, bits: int = 0) -> Toolpath:
    """The contour with its correction on."""
    mark = path.mark.copy()
    mark[0] |= (Mark.TOOL_LEFT if left else Mark.TOOL_RIGHT) | bits
    return path.replace(mark=mark, radius=np.full(len(path), r))


@pytest.mark.parametrize(
    "p", [ToolRadius(), ToolRadius(radius=0.7, everywhere=True, gouge="warn", lead="arc")], ids=repr
)
@settings(max_examples=12, deadline=None)
@given(path=paths(most=10))
def test_any_path_passes_and_chunks_do_not_matter(p: ToolRadius, path: Toolpath) -> None:
    whole, found = corrected(p, path)
    assert len(whole.events) == len(path.events)
    for size in SIZES[:2]:
        again, findings = corrected(p, path, size)
        assert same(again, whole)
        assert findings == found


def test_outside_of_a_square_has_arcs_at_its_corners() -> None:
    out, found = corrected(ToolRadius(), square(Mark.TOOL_RIGHT))
    assert not found
    assert out.target[0, :2].tolist() == [10, -1]
    assert [Kind(k).name for k in out.kind].count("ARC") == 4
    assert out.target[-2, :2].tolist() == [10, -1]  # the corner at the start is closed, too
    ring = shapely.Polygon([(10, 0), (20, 0), (20, 10), (10, 10)]).exterior
    off = [ring.distance(shapely.Point(p)) for p in feed_points(out)]
    assert min(off) >= 1 - 1e-6
    assert max(off) <= 1 + 1e-9
    assert out.line.tolist() == [1, 2, 2, 3, 3, 4, 4, 5, 5, 6]
    left_open, _ = corrected(ToolRadius(close=False), square(Mark.TOOL_RIGHT))
    assert left_open.target[-2, :2].tolist() == [9, 0]
    assert left_open.line.tolist() == [1, 2, 2, 3, 3, 4, 4, 5, 6]


def test_inside_of_a_square_is_cut_at_its_corners() -> None:
    out, found = corrected(ToolRadius(), square(Mark.TOOL_LEFT))
    assert not found
    assert out.target[:5, :2] == pytest.approx(np.array([[11, 1], [19, 1], [19, 9], [11, 9], [11, 1]]))
    assert len(out) == 6


def test_extended_lines_up_to_a_limit() -> None:
    out, _ = corrected(ToolRadius(corner="line"), square(Mark.TOOL_RIGHT))
    assert out.target[1:4, :2] == pytest.approx(np.array([[20, -1], [21, -1], [21, 0]]))
    sharp = Sketch().to(10, 0, d=1.0).mark(Mark.TOOL_RIGHT).to(0, 1, d=1.0).path()
    assert Kind.ARC in corrected(ToolRadius(corner="line"), sharp)[0].kind


def test_the_radius_of_the_pass_is_added_to_d() -> None:
    out, _ = corrected(ToolRadius(radius=0.5), square(Mark.TOOL_RIGHT))
    assert out.target[0, 1] == -1.5


def test_positionings_are_put_in_where_there_are_none() -> None:
    sketch = Sketch().to(5, 0).to(15, 0, d=2.0).mark(Mark.TOOL_LEFT | Mark.TOOL_STOP).to(15, 20)
    out, _ = corrected(ToolRadius(), sketch.path())
    assert [Kind(k).name for k in out.kind] == ["LINE", "POSITIONING", "LINE", "POSITIONING", "LINE"]
    assert out.target[:, :2].tolist() == [[5, 0], [5, 2], [15, 2], [15, 0], [15, 20]]


@pytest.mark.parametrize(("lead", "start"), [("line", [7, -1]), ("arc", [7, -4])])
def test_tangential_leads(lead: str, start: list[float]) -> None:
    out, _ = corrected(ToolRadius(lead=lead, length=3.0), square(Mark.TOOL_RIGHT))
    assert out.target[0, :2] == pytest.approx(start)
    assert out.target[1, :2] == pytest.approx([10, -1])


def test_tangent_joints_have_nothing_between_and_arcs_stay_arcs() -> None:
    path = (
        Sketch()
        .to(10, 0, d=1.0)
        .mark(Mark.TOOL_LEFT)
        .arc(5.0, pi / 2)
        .to(15, 20, d=1.0)
        .mark(Mark.TOOL_STOP)
        .path()
    )
    path = path.replace(radius=np.full(3, 1.0))
    out, found = corrected(ToolRadius(), path)
    assert not found
    assert [Kind(k).name for k in out.kind] == ["POSITIONING", "LINE", "ARC", "LINE"]
    assert out.curves.parameters[0, 2] == pytest.approx(4.0)


@pytest.mark.parametrize("free", ["ellipse", "cubic", "cusp"])
def test_free_curves_are_offset_within_the_tolerance(free: str) -> None:
    sketch = Sketch()
    if free == "ellipse":
        sketch.ellipse(20.0, 0.6, 0.4, 2.0, 0.3)
    elif free == "cubic":
        sketch.cubic(10, 5, (8, 9), (12, 4))
    else:
        sketch.cubic(0, 4, (10.0, 4.0), (-10.0, 4.0))  # bends to the right, away from the tool, within 0.4 mm
    path = marked(sketch.path(), 1.5, True) if free != "cusp" else marked(sketch.path(), 1.5, False)
    out, found = corrected(ToolRadius(tolerance=0.001), path)
    assert not found
    line = shapely.LineString(samples(path, np.array([4000]))[0][:, :2])
    off = shapely.distance(line, shapely.points(feed_points(out, 40)))
    assert len(off) > 50
    assert np.abs(off - 1.5).max() <= 0.001 + 1e-5


def test_d_may_change_inside_a_contour() -> None:
    path = Sketch().to(10, 0, d=1.0).mark(Mark.TOOL_LEFT).to(20, 0, d=2.0).mark(Mark.TOOL_STOP).path()
    out, _ = corrected(ToolRadius(), path)
    assert out.target[:, :2].tolist() == [[0, 1], [10, 1], [10, 2], [20, 2]]


@pytest.mark.parametrize(
    "contour",
    [
        [(0, 0), (10, 0), (10, -5), (11, -5), (11, 0), (20, 0)],  # a slot narrower than the tool
        [(0, 0), (10, 0), (10, 0.5), (20, 0.5), (20, 8)],  # a tiny step
    ],
)
def test_places_the_tool_cannot_enter_are_gouges(contour: list[tuple[float, float]]) -> None:
    sketch = Sketch()
    for i, (x, y) in enumerate(contour[1:]):
        sketch.to(x, y, d=2.0)
        if i == 0:
            sketch.mark(Mark.TOOL_LEFT | Mark.LOOP)
    path = sketch.path()
    out, found = corrected(ToolRadius(), path.replace(mark=path.mark & ~np.uint16(Mark.LOOP)))
    line = shapely.LineString(contour)
    depth = max(2.0 - line.distance(shapely.Point(p)) for p in feed_points(out))
    assert (depth > 1e-3) == bool(found)
    if found:
        assert found[0][:2] == ("NC302", Severity.ERROR)
        assert "mm into the contour at X" in found[0][2]
        _, warned = corrected(ToolRadius(), path)
        assert all(severity == Severity.WARNING for _, severity, _, _ in warned)
        clean, _ = run(AvoidLoops(everywhere=True), out)
        assert max(2.0 - line.distance(shapely.Point(p)) for p in feed_points(clean)) <= 1e-6


@settings(max_examples=40, deadline=None)
@given(closed_contours(low=12.0), st.sampled_from([0.2, 1.0, 4.0]), st.booleans(), st.booleans())
def test_no_point_is_nearer_than_the_radius_or_it_is_said(
    contour: Toolpath, r: float, left: bool, far_off: bool
) -> None:
    if far_off and not len(contour.curves):
        off = np.array([1e6, -1e6, 0.0, 0.0])
        contour = contour.replace(start=contour.start + off, target=contour.target + off)
    out, found = corrected(ToolRadius(), marked(contour, r, left))
    near = distances(feed_points(out), contour)
    scale = 1e-6 + 2e-9 * far_off
    if not found:
        assert min(near) >= r - scale
        assert max(near) <= r * (1 + 5.1e-5) + scale  # lines that hardly bend are extended
    else:
        assert min(near) < r


@settings(max_examples=60, deadline=None)
@given(closed_contours(), st.sampled_from([0.5, 2.0, 5.0, 9.0]), st.booleans())
def test_what_loop_avoidance_leaves_of_gouges_is_free_of_them_or_an_error(
    contour: Toolpath, r: float, left: bool
) -> None:
    out, found = corrected(ToolRadius(), marked(contour, r, left, Mark.LOOP))
    clean, report = run(AvoidLoops(), out)
    points = feed_points(clean)
    near = distances(points, contour)
    ring = outline(contour)
    failed = [text for _, severity, text, _ in found if severity == Severity.ERROR]
    if failed:
        assert min(near) < r - 1e-6
        # Only contours that cross themselves, and those into which the tool does not fit at all, are given up.
        inner = shapely.Polygon(ring).buffer(-r, quad_segs=64) if left else None
        assert not ring.is_simple or (inner is not None and inner.area < 1.0)
        return
    assert min(near) >= r - 1e-6
    assert max(near) <= r * (1 + 5.1e-5) + 1e-6
    if ring.is_simple and report.counts["loops"] == 0:
        # Nothing is left out either: the path covers one ring of the buffer's boundary.
        area = shapely.Polygon(ring).buffer(-r if left else r, quad_segs=64)
        rings = [g for part in shapely.get_parts(area) for g in (part.exterior, *part.interiors)]
        dense = shapely.LineString(points)
        assert min(shapely.hausdorff_distance(dense, g) for g in rings) <= 0.02 * r + 0.02


def test_a_gouge_between_distant_places_of_a_long_line_is_found() -> None:
    sketch = Sketch().to(2000, 0, d=2.0).mark(Mark.TOOL_LEFT)
    path = sketch.to(2000, 50, d=2.0).to(700.001, 50, d=2.0).to(700, 3, d=2.0).to(699.999, 50, d=2.0).path()
    _, found = corrected(ToolRadius(), path)
    assert "cut 1 mm into the contour at X7" in found[0][2]


def test_a_tool_that_fits_nowhere_is_an_error_even_where_loops_are_cut() -> None:
    path = Sketch((1.0, 0.0)).arc(1.0, 2 * pi, turn=pi / 2).path()
    out, found = corrected(ToolRadius(), marked(path, 3.0, True, Mark.LOOP))
    assert [severity for _, severity, _, _ in found] == [Severity.ERROR]
    assert len(out) == 2


def test_a_contour_that_starts_in_a_gouge_is_entered_where_the_tool_fits() -> None:
    corners = [(11, -3), (11, 0), (20, 0), (20, 10), (0, 10), (0, 0), (10, 0), (10, -3), (11, -3)]
    sketch = Sketch((*corners[0], 0.0, 0.0))
    for x, y in corners[1:]:
        sketch.to(x, y)
    path = marked(sketch.path(), 2.0, True)
    out, found = corrected(ToolRadius(gouge="loops"), path)
    assert all(severity == Severity.WARNING for _, severity, _, _ in found)
    near = distances(feed_points(out), path)
    assert near.min() >= 2 - 1e-6
    assert near.max() <= 2 + 1e-9
    assert out.end[:2] == pytest.approx(out.target[0, :2])
    assert out.end[0] == pytest.approx(10.5)


def test_an_arc_of_exactly_the_tools_radius_is_entered() -> None:
    path = Sketch().to(-10, 0).arc(1.0, pi, turn=-pi / 2).to(-22, 0).path()
    out, found = corrected(ToolRadius(), marked(path, 1.0, True))
    assert not found
    assert out.target[:, :2].tolist() == pytest.approx(
        np.array([[0, -1], [-10, -1], [-11, 0], [-11, 0], [-12, -1], [-22, -1]])
    )


@pytest.mark.parametrize("lead", ["line", "arc"])
def test_leads_of_a_closed_contour_meet_at_its_start(lead: str) -> None:
    out, _ = corrected(ToolRadius(lead=lead, length=3.0), square(Mark.TOOL_RIGHT))
    assert out.target[-3, :2] == pytest.approx([10, -1])  # the corner at the start is closed
    kept, report = run(AvoidLoops(everywhere=True), out)
    assert report.counts["loops"] == 0
    assert len(kept) == len(out)


def test_a_contour_that_is_led_in_and_out_on_one_line_is_not_closed() -> None:
    path = Sketch().to(10, 0).to(10, 10).to(20, 10).to(20, 0).to(10, 0).to(0, 0).path()
    out, _ = corrected(ToolRadius(gouge="warn"), marked(path, 1.0, False))
    assert out.end[:2].tolist() == [0, 1]


@settings(max_examples=15, deadline=None)
@given(st.floats(4.0, 40.0), st.floats(0.15, 1.0), st.floats(0.4, 6.0), st.sampled_from([-2.0, 0.7, 3.0]))
def test_the_reached_deviation_of_free_curves_is_measured_both_ways(
    main: float, ratio: float, sweep: float, d: float
) -> None:
    path = Sketch().ellipse(main, ratio, 0.3, sweep, 0.5).path()
    path = marked(path, abs(d), d > 0)
    p = ToolRadius(tolerance=0.002)
    report = Report(p.name)
    out = Toolpath.join(list(p.apply([path], Context(report))))
    assert report.deviation is not None
    assert report.deviation <= 0.002
    if report.counts["NC302"] == 0:
        source = samples(path, np.array([4000]))[0][:, :2]
        beside = feed_points(out, 40)
        there = shapely.distance(shapely.LineString(source), shapely.points(beside[1:-1]))
        back = shapely.distance(shapely.LineString(beside), shapely.points(source[5:-5:8]))
        assert np.abs(there - abs(d)).max() <= report.deviation + 1e-3
        assert np.abs(back - abs(d)).max() <= report.deviation + 1e-3


@settings(max_examples=6, deadline=None)
@given(path=paths(most=7))
def test_plain_and_compiled_kernels_give_the_same_bits(path: Toolpath) -> None:
    p = ToolRadius(radius=0.3, everywhere=True, gouge="loops", lead="line")
    compiled, found = corrected(p, path)
    cut_out, _ = run(AvoidLoops(everywhere=True), compiled)
    kernels.use(compiled=False)
    plain, again = corrected(p, path)
    assert same(plain, compiled)
    assert again == found
    assert same(run(AvoidLoops(everywhere=True), plain)[0], cut_out)
    kernels.use(compiled=True)
