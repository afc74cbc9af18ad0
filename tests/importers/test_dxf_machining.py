"""Machining data: sides, passes, leads, tabs, overcut, drilling, switches, M functions, job files."""

from __future__ import annotations

from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from nccompile.errors import UsageError
from nccompile.importers.dxf.job import Job, Operation, load_job
from nccompile.importers.dxf.offset import offset_path
from nccompile.importers.dxf.pieces import Pieces, bulge_row, ellipse_row, end_tangents, flatten
from nccompile.passes.tool_radius import ToolRadius
from nccompile.toolpath import EventKind, Kind, Toolpath
from tests.importers.workshop import Made, codes, compiled, machine, new_drawing

ROOT = Path(__file__).parents[2]


def job(**operation: Any) -> Job:
    return Job.model_validate({"operation": [operation]})


def square(side: float = 20.0, x: float = 0.0) -> Any:
    doc = new_drawing()
    doc.modelspace().add_lwpolyline([(x, 0), (x + side, 0), (x + side, side), (x, side)], close=True)
    return doc


def cut(doc: Any, folder: Path, **operation: Any) -> tuple[Made, Toolpath]:
    """The drawing machined by one operation, and the toolpath of its program, which compiles without a finding."""
    made = machine(doc, folder, job(**operation))
    path, found = compiled(made.text)
    assert not found.counts
    return made, path


def feed_line(path: Toolpath, height: float | None = None) -> Any:
    """The XY course of the feed moves (at a height) as a shapely geometry."""
    starts = path.starts()
    lines = []
    for i in np.flatnonzero(path.kind != Kind.POSITIONING).tolist():
        if height is not None and abs(path.target[i, 2] - height) > 1e-9:
            continue
        if path.curve[i] < 0:
            lines.append(np.array([starts[i, :2], path.target[i, :2]]))
        else:
            cx, cy, radius, begin, sweep = path.curves.parameters[path.curve[i], :5]
            angle = begin + sweep * np.linspace(0, 1, 200)
            lines.append(np.column_stack([cx + radius * np.cos(angle), cy + radius * np.sin(angle)]))
    return shapely.MultiLineString([line for line in lines if (line[0] != line[-1]).any() or len(line) > 2])


corners = st.lists(st.tuples(st.floats(5, 30), st.floats(-0.6, 0.6)), min_size=3, max_size=9)


def blob(shape: list[tuple[float, float]]) -> Pieces:
    """A star-shaped counter-clockwise contour of lines and arcs about the origin."""
    n = len(shape)
    vertices = [r * complex(np.cos(2 * pi * k / n), np.sin(2 * pi * k / n)) for k, (r, _) in enumerate(shape)]
    rows = [bulge_row(vertices[k], vertices[(k + 1) % n], shape[k][1]) for k in range(n)]
    return Pieces.from_rows(rows)


def polygon(pieces: Pieces) -> Any:
    line = np.concatenate(flatten(pieces, 1e-4))
    return shapely.Polygon(np.column_stack([line.real, line.imag]))


@given(corners, st.sampled_from([-3.0, -1.0, -0.5, 0.5, 1.0, 3.0]))
@settings(max_examples=80, deadline=None)
def test_offset_encloses_the_area_that_a_buffer_does(
    shape: list[tuple[float, float]], distance: float
) -> None:
    # at larger distances GEOS simplifies hollows of the contour away and is off by some square millimetres
    contour = blob(shape)
    enter, leave = end_tangents(contour)
    assume((np.abs(np.angle(np.roll(enter, -1) / leave)) < 3.0).all())  # no spikes whose sides may cross
    area = polygon(contour)
    assume(area.is_valid and area.exterior.is_ccw)
    expected = area.buffer(-distance, quad_segs=400)

    made = offset_path(contour, True, distance, 0.002)

    lines = [np.concatenate(flatten(made.path(i), 1e-4)) for i in range(len(made))]
    got = sum(_area(line) for line in lines)
    assert got == pytest.approx(expected.area, abs=0.02 + 2e-3 * expected.length)
    for line in lines:
        course = shapely.LineString(np.column_stack([line.real, line.imag]))
        assert course.distance(area.exterior) >= abs(distance) - 2e-3


def _area(line: npt.NDArray[np.complex128]) -> float:
    return float(0.5 * np.sum(line.real[:-1] * line.imag[1:] - line.real[1:] * line.imag[:-1]))


def test_offset_of_an_ellipse_into_its_narrow_ends() -> None:
    contour = Pieces.from_rows([ellipse_row(0j, 20 + 0j, 5j, 0.0, 2 * pi)])

    made = offset_path(contour, True, 3.0, 0.002)  # more than the radius of curvature at the ends, 1.25 mm

    assert len(made) == 1
    assert _area(np.concatenate(flatten(made.path(0), 1e-4))) == pytest.approx(87.18, abs=0.05)


def test_a_slot_as_wide_as_the_tool_does_not_break_the_path() -> None:
    points = [0, 20, 20 + 9j, 22 + 9j, 22, 42, 42 + 20j, 22 + 20j, 22 + 11j, 20 + 11j, 20 + 20j, 20j]
    rows = [
        bulge_row(complex(a), complex(b), 0) for a, b in zip(points, points[1:] + points[:1], strict=True)
    ]

    made = offset_path(Pieces.from_rows(rows), True, -1.0, 0.002)

    assert len(made) == 1
    assert made.closed.all()


@pytest.mark.parametrize(("side", "size"), [("outside", 24.0), ("inside", 16.0)])
@pytest.mark.parametrize(("direction", "climb"), [("climb", True), ("conventional", False)])
def test_side_and_direction(side: str, size: float, direction: str, climb: bool, tmp_path: Path) -> None:
    _, path = cut(square(), tmp_path, side=side, tool_radius=2.0, direction=direction)

    course = feed_line(path)
    low_x, low_y, high_x, high_y = course.bounds
    first = path.target[1] - path.target[0]
    middle = 0.5 * (path.target[1] + path.target[0])
    to_contour = np.array([10.0, 10.0]) - middle[:2]
    contour_left = first[0] * to_contour[1] - first[1] * to_contour[0] > 0

    assert (high_x - low_x, high_y - low_y) == pytest.approx((size, size))
    # climb: the tool is left of the contour in its direction; the contour's middle is left of it outside only
    tool_left = contour_left if side == "inside" else not contour_left
    assert tool_left == climb


@pytest.mark.parametrize("depth", [0.0, 4.0])
def test_g41_corrects_from_plunge_to_retract(depth: float, tmp_path: Path) -> None:
    made = machine(
        square(),
        tmp_path,
        job(side="outside", by="g41", tool_radius=1.5, direction="climb", depth=depth, pass_depth=2),
    )

    path, found = compiled(made.text)
    behind = Toolpath.join(list(ToolRadius().apply(iter([path]))))

    feeds = np.flatnonzero(path.kind == Kind.LINE)
    assert not found.counts
    assert made.text.count("G41 D1.5") == made.text.count("G40") == (2 if depth else 1)
    assert (path.radius[feeds] == 1.5).all()
    assert feed_line(path).bounds == pytest.approx((0, 0, 20, 20))
    assert feed_line(behind).bounds == pytest.approx((-1.5, -1.5, 21.5, 21.5))
    down = np.flatnonzero((behind.kind == Kind.LINE) & (behind.target[:, 2] < behind.starts()[:, 2]))
    contour = shapely.box(0, 0, 20, 20)
    assert all(shapely.Point(behind.target[i, :2]).distance(contour) > 1.5 - 1e-6 for i in down)


def test_open_paths_have_no_inside(tmp_path: Path) -> None:
    doc = new_drawing()
    doc.modelspace().add_line((0, 0), (10, 0))

    made, path = cut(doc, tmp_path, side="inside", tool_radius=1.0)

    assert codes(made) == {"NC614": 1}
    assert path.target[path.kind == Kind.LINE][-1, 0] == 10.0


def test_a_tool_that_does_not_fit_is_said(tmp_path: Path) -> None:
    doc = square(5.0)
    doc.modelspace().add_circle((30, 0), 8)

    made, path = cut(doc, tmp_path, side="inside", tool_radius=3.0)

    assert codes(made) == {"NC615": 1}
    assert path.target[path.kind == Kind.ARC, 0].min() == 25.0


def test_a_drawing_of_which_nothing_is_left_is_an_error(tmp_path: Path) -> None:
    made = machine(square(5.0), tmp_path, job(side="inside", tool_radius=3.0))

    assert codes(made) == {"NC615": 1, "NC604": 1}
    assert not made.result.programs


def test_depth_is_reached_in_equal_passes(tmp_path: Path) -> None:
    _, path = cut(square(), tmp_path, depth=5.0, pass_depth=2.0, plunge_feed=3.0, safe_height=8.0)

    heights = np.unique(np.round(path.target[path.kind == Kind.LINE, 2], 4))
    rapids = path.kind == Kind.POSITIONING
    across = rapids & (np.abs(np.diff(path.target[:, :2], axis=0, prepend=0)).sum(axis=1) > 0)
    assert heights == pytest.approx([-5.0, -3.3333, -1.6667])
    assert (path.target[across, 2] == 8.0).all()
    assert (path.feed[path.kind == Kind.LINE] == 3.0).sum() == 3


def test_tabs_hold_the_part(tmp_path: Path) -> None:
    _, path = cut(
        square(), tmp_path, depth=4.0, pass_depth=2.0, tabs={"count": 4, "length": 3, "height": 1.0}
    )

    deep, raised = feed_line(path, -4.0).length, feed_line(path, -3.0).length
    assert raised == pytest.approx(12.0)
    assert deep == pytest.approx(80.0 - 12.0)
    assert feed_line(path, -2.0).length == pytest.approx(80.0)


def test_overcut_goes_on_past_the_start(tmp_path: Path) -> None:
    _, plain = cut(square(), tmp_path)
    _, over = cut(square(), tmp_path, overcut=2.5)

    assert over.length[over.kind == Kind.LINE].sum() == pytest.approx(80.0 + 2.5)
    assert plain.length[plain.kind == Kind.LINE].sum() == pytest.approx(80.0)


def test_drilling_points_and_circles_in_pecks(tmp_path: Path) -> None:
    doc = new_drawing()
    doc.modelspace().add_point((5, 5))
    doc.modelspace().add_circle((15, 5), 2)
    doc.modelspace().add_line((0, 0), (1, 0))

    made, path = cut(
        doc, tmp_path, kind="drill", depth=6.0, pass_depth=2.0, feed=4.0, dwell=0.25, safe_height=3.0
    )

    holes = path.target[path.kind == Kind.LINE]
    assert codes(made) == {"NC612": 1}
    assert holes.tolist() == [[x, 5, z] for x in (5, 15) for z in (-2, -4, -6)]
    assert path.events.k[path.events.kind == EventKind.DWELL].tolist() == [0.25, 0.25]


def test_switches_and_m_functions_frame_the_contour(tmp_path: Path) -> None:
    made = machine(
        square(), tmp_path,
        Job.model_validate({
            "program": {"begin_m": [3], "end_m": [30], "park": [1, 2]},
            "operation": [{"switch": 4, "m_on": 7, "m_off": 8, "dwell": 0.5, "tool": 12, "lead_in": {"length": 1}}],
        }),
    )  # fmt: skip

    path, found = compiled(made.text)

    m = path.events.number[path.events.kind == EventKind.M_FUNCTION].tolist()
    switches = path.events.kind == EventKind.SWITCH
    assert not found.counts
    assert m == [3, 6, 7, 8, 30]
    assert path.events.k[path.events.number == 6].tolist() == [12.0]
    assert path.events.number[switches].tolist() == [4, -4]
    assert path.events.position[switches].tolist() == [0.0, 1.0]
    assert path.target[-1, :2].tolist() == [1.0, 2.0]


@pytest.mark.parametrize(
    ("program", "operation", "end"),
    [
        ({}, {}, "G1 Y0"),  # it comes back by itself
        ({"origin": [-5, 1]}, {}, "G0 X-5 Y1"),
        ({"park": [1, 2]}, {"m_off": 8}, "G0 X1 Y2"),
        ({}, {"depth": 1.0}, "G0 Z5"),
        ({"origin": [-5, 1], "end_m": [5]}, {"m_off": 8}, "M5"),
    ],
)
def test_programs_end_on_a_positioning_or_where_they_began(
    program: dict[str, Any], operation: dict[str, Any], end: str, tmp_path: Path
) -> None:
    made = machine(square(), tmp_path, Job.model_validate({"program": program, "operation": [operation]}))

    path, _ = compiled(made.text)
    moves = path.kind[(path.kind != Kind.M_FUNCTION) & (path.kind != Kind.DWELL)]
    assert made.text.splitlines()[-1].partition(" ")[2] == end
    assert moves[-1] == Kind.POSITIONING or path.end.tolist() == path.start.tolist()


@pytest.mark.parametrize("kind", ["line", "arc"])
@pytest.mark.parametrize("side", ["on", "outside", "inside"])
def test_leads_keep_clear_of_every_contour(kind: str, side: str, tmp_path: Path) -> None:
    doc = square(40.0)
    doc.modelspace().add_circle((20, 20), 9)
    doc.modelspace().add_circle((-4, 20), 2.5)
    radius = {} if side == "on" else {"tool_radius": 1.0, "side": side}
    lead = {"kind": kind, "length": 4.0}

    made = machine(doc, tmp_path, job(lead_in=lead, lead_out=lead, **radius))
    plain = machine(doc, tmp_path, job(**radius))

    path, _ = compiled(made.text)
    contours = shapely.MultiLineString(
        [shapely.LinearRing([(0, 0), (40, 0), (40, 40), (0, 40)]), shapely.Point(20, 20).buffer(9, 300).exterior,
         shapely.Point(-4, 20).buffer(2.5, 300).exterior]
    )  # fmt: skip
    course = feed_line(compiled(plain.text)[0])
    leads = feed_line(path).difference(course.buffer(5e-3))
    assert leads.length > 6.0
    if side != "on":
        assert leads.distance(contours) >= 1.0 - 5e-3
    else:
        assert not leads.crosses(contours)


def test_a_lead_that_fits_nowhere_is_left_out_and_said(tmp_path: Path) -> None:
    doc = new_drawing()
    for x in (0.0, 0.02):
        doc.modelspace().add_lwpolyline([(x, x), (10 - x, x), (10 - x, 10 - x), (x, 10 - x)], close=True)

    made, _ = cut(doc, tmp_path, lead_in={"kind": "line", "length": 4, "angle": 90}, clearance=1.0)

    assert codes(made)["NC613"] >= 1


def test_operations_take_layers_and_colours(tmp_path: Path) -> None:
    doc = new_drawing()
    for number, (layer, color) in enumerate(
        [("CUT_1", 7), ("ENGRAVE", 7), ("OTHER", 1), ("NOTES", 3), ("LOST", 4)]
    ):
        doc.modelspace().add_line((0, number), (10, number), {"layer": layer, "color": color})
    plan = Job.model_validate({
        "operation": [
            {"name": "engraving", "layers": ["engrave"]},
            {"name": "cutting", "layers": ["cut*"], "feed": 7},
            {"name": "red", "colors": ["red"]},
            {"kind": "ignore", "colors": [3]},
        ]
    })  # fmt: skip

    made = machine(doc, tmp_path, plan)
    path, _ = compiled(made.text)

    assert [plan.name for plan in plan.operation[:3]] == ["engraving", "cutting", "red"]
    assert np.unique(path.target[path.kind == Kind.LINE, 1]).tolist() == [0, 1, 2]
    assert path.target[1, 1] == 1.0
    assert codes(made) == {"NC612": 1}
    assert "LOST" in next(iter(made.found)).message


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[[operation]]\nfeeed = 3", "unknown key"),
        ("[[operation]]\nfeed = -3", "operation.0.feed"),
        ("[[operation]]\nside = 'inside'", "needs a tool_radius"),
        ("[[operation]]\ncolors = ['mauve']", "none of red"),
        ("[[operation]]\ndepth = 1\ntabs = { height = 2 }", "tabs.height"),
        ("[[operation]\n", "TOML syntax"),
        ("[[operation]]\nby = 'g41'\novercut = 2", "tool-radius"),
        ("[[operation]]\nlead_in = { kind = 'spiral' }", "lead_in"),
    ],
)
def test_wrong_job_files_are_explained(text: str, message: str, tmp_path: Path) -> None:
    place = tmp_path / "job.toml"
    place.write_text(text)

    with pytest.raises(UsageError, match=message):
        load_job(place)


def test_the_sample_job(tmp_path: Path) -> None:
    from tests.importers.workshop import machine_file

    made = machine_file(ROOT / "samples" / "plate.dxf", load_job(ROOT / "samples" / "plate.job.toml"))

    path, found = compiled(made.text)
    outline = shapely.box(0, 0, 120, 80).buffer(-10).buffer(10, quad_segs=300)
    deep = feed_line(path, -5.5)
    assert not codes(made)
    assert not found.counts
    assert path.target[:, 2].min() == -6.0
    assert deep.difference(outline.buffer(1.5 - 5e-3, quad_segs=300)).length > 300
    assert deep.distance(outline.exterior) >= 1.5 - 5e-3
    assert Operation().levels == [0.0]
