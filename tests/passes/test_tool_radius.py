"""tool-radius: corners, sides, approach and departure, gouges; random contours against shapely buffers."""

from __future__ import annotations

from math import cos, hypot, pi, sin

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.diagnostics import Severity
from nccompile.passes.avoid_loops import AvoidLoops
from nccompile.passes.base import Context, Report
from nccompile.passes.measure import samples
from nccompile.passes.tool_radius import ToolRadius
from nccompile.toolpath.columns import Floats, Kind, Mark, Toolpath
from nccompile.toolpath.verify import verify_chain
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


def feed_points(path: Toolpath) -> Floats:
    """Dense samples of the feed rows in X-Y."""
    points, owner, _ = samples(path, np.full(len(path), 60))
    flat: Floats = points[path.kind[owner] != Kind.POSITIONING][:, :2]
    return flat


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


@pytest.mark.parametrize("free", ["ellipse", "cubic"])
def test_free_curves_are_offset_within_the_tolerance(free: str) -> None:
    sketch = (
        Sketch().ellipse(20.0, 0.6, 0.4, 2.0, 0.3)
        if free == "ellipse"
        else Sketch().cubic(10, 5, (8, 9), (12, 4))
    )
    path = sketch.mark(Mark.TOOL_LEFT).path().replace(radius=np.array([1.5]))
    out, found = corrected(ToolRadius(tolerance=0.001), path)
    assert not found
    line = shapely.LineString(samples(path, np.array([20_000]))[0][:, :2])
    off = [line.distance(shapely.Point(p)) for p in feed_points(out)]
    assert len(off) > 100
    assert max(abs(d - 1.5) for d in off) <= 0.001 + 1e-5


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


def star(radii: list[float], arcs: bool) -> list[tuple[float, float]]:
    n = len(radii)
    return [(r * cos(2 * pi * i / n), r * sin(2 * pi * i / n)) for i, r in enumerate(radii)]


@settings(max_examples=40, deadline=None)
@given(st.lists(st.floats(12, 30), min_size=3, max_size=9), st.sampled_from([0.2, 1.0, 4.0]), st.booleans(),
       st.sampled_from([0.0, 1e6]))  # fmt: skip
def test_no_point_is_nearer_than_the_radius_or_it_is_said(
    radii: list[float], r: float, left: bool, off: float
) -> None:
    contour = [(x + off, y - off) for x, y in star(radii, False)]
    sketch = Sketch((*contour[0], 0.0, 0.0))
    for i, (x, y) in enumerate([*contour[1:], contour[0]]):
        sketch.to(x, y, d=r)
        if i == 0:
            sketch.mark(Mark.TOOL_LEFT if left else Mark.TOOL_RIGHT)
    path = sketch.path()
    out, found = corrected(ToolRadius(), path)
    ring = shapely.LineString([*contour, contour[0]])
    near = [ring.distance(shapely.Point(p)) for p in feed_points(out)]
    scale = 1e-6 + 1e-9 * (off > 0)
    if not found:
        assert min(near) >= r - scale
        assert max(near) <= r * (1 + 5.1e-5) + scale  # lines that hardly bend are extended
        if not left:
            area = shapely.Polygon(contour).buffer(r, quad_segs=256)
            assert all(area.exterior.distance(shapely.Point(p)) <= 1e-3 * r + 1e-6 for p in feed_points(out))
    else:
        assert min(near) < r
    assert hypot(*(out.end[:2] - contour[0])) <= 40 * r
