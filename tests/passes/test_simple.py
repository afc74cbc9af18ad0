"""compress, flatten, limit-arc-feed, transform, reverse, split, move-start: numbers and invariants."""

from __future__ import annotations

from math import cos, hypot, pi, radians, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from nccompile.errors import UsageError
from nccompile.machine.model import default_machine
from nccompile.passes.compress import Compress
from nccompile.passes.flatten import Flatten
from nccompile.passes.limit_arc_feed import LimitArcFeed
from nccompile.passes.measure import samples
from nccompile.passes.move_start import MoveStart
from nccompile.passes.reverse import Reverse
from nccompile.passes.split import Split
from nccompile.passes.transform import Transform
from nccompile.passes.velocity import PLANNERS
from nccompile.passes.velocity.planner import plan
from nccompile.passes.velocity.settings import PlanSettings
from nccompile.toolpath.columns import Kind, Mark, Plane, Toolpath
from tests.passes.every import dense
from tests.passes.paths import Probe, Sketch, paths, run, same


def test_compress_merges_collinear_lines_of_equal_feed() -> None:
    path = (
        Sketch()
        .to(1, 1, 1)
        .to(2, 2, 2)
        .switch(3, 0.5)
        .to(4, 4, 4)
        .to(5, 5, 5, feed=9.0)
        .to(5, 5, 5)
        .to(9, 5)
        .path()
    )
    out, report = run(Compress(), path)
    assert out.target[:, 0].tolist() == [4.0, 5.0, 9.0]
    assert out.length[0] == pytest.approx(4 * sqrt(3), rel=1e-12)
    assert out.events.segment.tolist() == [0]
    assert out.events.position[0] == pytest.approx(1.5 / 4)
    assert report.deviation is not None
    assert report.deviation < 1e-9


def test_compress_keeps_what_turns_back_and_what_puts_a_set_position_out() -> None:
    path = Sketch().to(2, 0).to(1, 0).to(3, 0).jump(7, 7).to(7, 7).to(7, 7).path()
    out, _ = run(Compress(), path)
    assert out.kind.tolist() == [Kind.LINE] * 3 + [Kind.SET_POSITION, Kind.LINE]


@settings(max_examples=40, deadline=None)
@given(paths())
def test_compress_does_not_move_the_path_and_twice_is_once(path: Toolpath) -> None:
    once, report = run(Compress(), path)
    assert same(run(Compress(), once)[0], once)
    assert (report.deviation or 0.0) <= 3e-9
    assert len(once.events) == len(path.events)


def test_flatten_by_angle_of_a_full_circle() -> None:
    path = Sketch((10, 0)).arc(10.0, 2 * pi, turn=pi / 2).path()
    out, report = run(Flatten(angle=10.0, arcs=True), path)
    assert len(out) == 37  # 36 lines would bend by 10 degrees, which is not below 10
    assert report.deviation == pytest.approx(10 * (1 - cos(pi / 37)), rel=0.05)


def test_flatten_by_length() -> None:
    path = Sketch().ellipse(10.0, 0.5, 0.0, 2.0, 0.3).path()
    out, _ = run(Flatten(length=0.5), path)
    assert len(out) == int(np.ceil(path.length[0] / 0.5))
    assert np.ptp(out.length) < 0.01 * out.length[0]


@settings(max_examples=20, deadline=None)
@given(paths(most=6), st.sampled_from([0.001, 0.05]))
def test_flatten_keeps_the_tolerance(path: Toolpath, tolerance: float) -> None:
    out, report = run(Flatten(tolerance=tolerance, arcs=True), path)
    assert not (out.curve >= 0).any()
    assert (report.deviation or 0.0) <= tolerance + 1e-9
    assert np.array_equal(out.end, path.end)
    assert same(run(Flatten(tolerance=tolerance, arcs=True), out)[0], out)


def test_limit_arc_feed_bounds_the_acceleration() -> None:
    path = Sketch().to(10, 0, feed=100).arc(1.0, 1.0, feed=100).to(20, 20, feed=100).path()
    out, _ = run(LimitArcFeed(accel=1000.0), path)
    assert out.feed.tolist() == pytest.approx([100, sqrt(1000), 100])
    assert run(LimitArcFeed(per_radius=10.0), path)[0].feed[1] == pytest.approx(10.0)


def test_limit_arc_feed_slows_junctions_by_the_jump_of_curvature() -> None:
    path = Sketch().to(10, 0, feed=100).arc(4.0, 1.0, feed=100).arc(4.0, -1.0, feed=100).path()
    out, report = run(LimitArcFeed(jump=100.0), path)
    assert report.counts["junctions slowed"] == 2
    slow = out.feed[out.feed < 100].tolist()
    assert slow == pytest.approx([sqrt(100 * 4.0), sqrt(100 * 2.0)])  # 1/4, then 1/4 - (-1/4)
    assert np.abs(out.length.sum() - path.length.sum()) < 1e-9
    assert np.array_equal(out.end, path.end)


def test_limit_arc_feed_on_a_helix_and_between_planes() -> None:
    helix = Sketch().arc(3.0, 2.0, dz=6.0, feed=100).path()
    out, _ = run(LimitArcFeed(accel=100.0), helix)
    assert out.feed[0] == pytest.approx(sqrt(100.0 * (3.0**2 + (6.0 / 2.0) ** 2) / 3.0))  # k = r / (r² + c²)
    upright = run(Transform(matrix="1 0 0; 0 0 -1; 0 1 0"), Sketch().arc(4.0, 1.0, feed=100).path())[0]
    flat = Sketch().arc(4.0, -1.0, feed=100).path()
    flat = run(Transform(rotate=-np.degrees(1.0)), run(Reverse(), flat)[0])[0]
    move = upright.start - flat.end
    flat = run(Transform(x=move[0], y=move[1], z=move[2]), flat)[0]
    both, report = run(LimitArcFeed(jump=100.0), Toolpath.join([flat, upright]))
    assert report.counts["junctions slowed"] == 1
    k0, k1 = Probe(flat, 0).curvature(flat.length[0]), Probe(upright, 0).curvature(0.0)
    assert both.feed.min() == pytest.approx(sqrt(100.0 / np.linalg.norm(k1 - k0)))
    assert both.feed.min() != pytest.approx(sqrt(100.0 / 0.5))


@pytest.mark.parametrize("planner", PLANNERS)
def test_planned_velocities_keep_the_limits_of_arcs_and_their_ends(planner: str) -> None:
    path = (
        Sketch()
        .to(10, 0, feed=100)
        .arc(4.0, 1.0, feed=100)
        .arc(4.0, -1.0, feed=100)
        .to(30, 9, feed=100)
        .path()
    )
    limited, _ = run(LimitArcFeed(jump=100.0, accel=300.0), path)
    settings = PlanSettings.from_machine(
        default_machine(), path.axes, angle_tolerance_deg=180.0, time_law="trapezoid", planner=planner, window=None,
        junction_deviation=None,
    )  # fmt: skip
    out = Toolpath.join(list(plan([limited], settings)))
    assert out.v_end is not None
    at = np.cumsum(out.length)
    for place, most in zip(np.cumsum(path.length), (sqrt(400.0), sqrt(200.0)), strict=False):
        row = int(np.argmin(np.abs(at - place)))
        assert out.v_end[row] <= most * (1 + 1e-9)
    arcs = out.kind == Kind.ARC
    assert out.v_end[arcs].max() <= sqrt(300.0 * 4.0) * (1 + 1e-9)


def test_a_feed_that_is_not_programmed_is_limited_too() -> None:
    path = Sketch().arc(1.0, 1.0, feed=0.0).path()
    assert run(LimitArcFeed(accel=25.0), path)[0].feed[0] == 5.0


def test_transform_turns_about_a_point_as_the_manual_says() -> None:
    path = Sketch().to(10, 0).arc(5.0, pi / 2).path()
    out, _ = run(Transform(rotate=90.0, cx=10.0), path)
    by_three = run(Transform(x=10.0), run(Transform(rotate=90.0), run(Transform(x=-10.0), path)[0])[0])[0]
    assert out.target[0, :2].tolist() == [10.0, 0.0]
    assert out.target == pytest.approx(by_three.target)


@settings(max_examples=30, deadline=None)
@given(paths(most=8), st.floats(-180, 180), st.sampled_from(["", "x", "xy", "z"]), st.floats(0.1, 3))
def test_transform_maps_every_point(path: Toolpath, angle: float, mirror: str, scale: float) -> None:
    p = Transform(rotate=angle, mirror=mirror, scale=scale, y=2.0)
    out, _ = run(p, path)
    before, after = samples(path)[0], samples(out)[0]
    assert len(before) == len(after)
    c, s = cos(radians(angle)), np.sin(radians(angle))
    signs = np.array([-1.0 if a in mirror else 1.0 for a in "xyz"])
    turned = before * signs @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) * scale + [0, 2, 0]
    assert np.abs(turned - after).max(initial=0.0) <= 1e-8 + 1e-12 * np.abs(before).max(initial=0.0)


@settings(max_examples=15, deadline=None)
@given(paths(most=5), st.floats(-80, 80), st.floats(-80, 80))
def test_a_tilted_frame_keeps_the_tolerance(path: Toolpath, roll: float, yaw: float) -> None:
    out, _ = run(Transform(roll=roll, yaw=yaw, tolerance=0.01), path)
    back, _ = run(Transform(yaw=-yaw), out)
    back, _ = run(Transform(roll=-roll, tolerance=0.01), back)
    for i in range(len(path)):
        if path.curve[i] >= 0:
            rows = np.flatnonzero(back.line == path.line[i])
            middle = Probe(path, i).point(0.37 * path.length[i])
            near = min(
                float(np.linalg.norm(middle - q)) for q in samples(back.rows(rows[0], rows[-1] + 1))[0]
            )
            assert near <= path.length[i] / 20 + 0.02
    assert np.abs(back.end - path.end).max() <= 1e-7


_parts = st.floats(-3.0, 3.0)


@settings(max_examples=40)
@given(paths(most=6, flat=True), st.tuples(_parts, _parts, _parts, _parts), st.sampled_from([0, 1, 2]))
def test_a_matrix_that_keeps_planes_maps_every_point(
    path: Toolpath, m: tuple[float, float, float, float], turn: int
) -> None:
    if abs(m[0] * m[3] - m[1] * m[2]) < 0.01:
        return
    flat = np.array([[m[0], m[1], 0.4], [m[2], m[3], -0.7], [0.0, 0.0, 1.5]])
    whole = np.roll(flat, turn, axis=0)
    p = Transform(matrix="; ".join(" ".join(map(repr, row)) for row in whole.tolist()), z=1.0)
    out, report = run(p, path)
    before, after = samples(path)[0] @ whole.T + [0, 0, 1], samples(out)[0]
    assert len(before) == len(after)  # nothing was split: arcs are ellipses, ellipses and cubics are exact
    digits = 1e-8 + 1e-12 * np.abs(before).max(initial=0.0)
    assert np.abs(before - after).max(initial=0.0) <= digits
    assert (report.deviation or 0.0) <= 1e-6 + 1e3 * digits


@settings(max_examples=12)
@given(paths(most=2, stops=False), st.lists(_parts, min_size=9, max_size=9))
def test_any_matrix_keeps_the_tolerance(path: Toolpath, numbers: list[float]) -> None:
    whole = np.array(numbers).reshape(3, 3)
    if abs(np.linalg.det(whole)) < 0.1 or path.length.max() > 10.0:
        return
    p = Transform(matrix="; ".join(" ".join(map(repr, row)) for row in whole.tolist()), tolerance=0.02)
    out, report = run(p, path)
    exact, made = dense(path, 0.05) @ whole.T, dense(out, 0.01)
    if len(exact):
        assert float(np.max(cKDTree(made).query(exact)[0])) <= 0.02 + 0.005 + 1e-9 * np.abs(exact).max()
    assert report.deviation is not None
    assert report.deviation <= 0.02 * p.frame.stretch[1] / p.frame.stretch[0] + 1e-6


def test_a_circle_becomes_an_ellipse_and_an_ellipse_a_circle() -> None:
    out, _ = run(Transform(matrix="2 0 0; 0 1 0; 0 0 1"), Sketch((5, 0)).arc(5.0, pi, turn=pi / 2).path())
    assert out.kind.tolist() == [Kind.ELLIPSE]
    assert out.curves.parameters[0, :4] == pytest.approx([0, 0, 10, 5])
    assert out.end[:2] == pytest.approx([-10, 0])


@pytest.mark.parametrize(
    "matrix", ["1 0 0; 0 1 0", "1 0 0; 0 1 0; 0 0 x", "1 0 0; 0 1 0; 1 1 0", "1 2; 3 4; 5 6"]
)
def test_matrices_that_are_none_are_refused(matrix: str) -> None:
    with pytest.raises(UsageError, match="matrix"):
        Transform(matrix=matrix)


def test_a_right_angle_keeps_arcs_in_another_plane() -> None:
    out, _ = run(Transform(roll=90.0), Sketch().arc(5.0, 1.0).path())
    assert out.kind[0] == Kind.ARC
    assert out.curves.plane[0] == Plane.ZX


def test_a_mirror_swaps_the_side_of_the_tool() -> None:
    path = Sketch().to(10, 0).mark(Mark.TOOL_LEFT).to(10, 10).mark(Mark.TOOL_STOP).path()
    assert run(Transform(mirror="x"), path)[0].mark.tolist() == [Mark.TOOL_RIGHT, Mark.TOOL_STOP]
    assert run(Transform(mirror="xy"), path)[0].mark.tolist() == path.mark.tolist()


def test_reverse_keeps_switches_at_their_place_and_regions() -> None:
    path = (
        Sketch()
        .to(10, 0)
        .mark(Mark.TOOL_LEFT)
        .switch(4, 0.2)
        .arc(5, 1.0)
        .mark(Mark.TOOL_STOP)
        .to(0, 0)
        .path()
    )
    out, _ = run(Reverse(), path)
    assert out.target[:, :2].tolist() == [path.target[1, :2].tolist(), [10.0, 0.0], [0.0, 0.0]]
    assert out.events.segment.tolist() == [2]
    assert out.events.position.tolist() == [0.8]
    assert out.mark.tolist() == [0, Mark.TOOL_RIGHT, Mark.TOOL_STOP]


@settings(max_examples=30, deadline=None)
@given(paths(marks=False))
def test_reverse_twice_is_the_path(path: Toolpath) -> None:
    back, _ = run(Reverse(), run(Reverse(), path)[0])
    assert np.array_equal(back.target, path.target)
    assert np.array_equal(back.kind, path.kind)
    assert back.length == pytest.approx(path.length, rel=1e-11)
    assert back.events.position == pytest.approx(path.events.position, abs=1e-15)


def test_split_as_in_the_manual() -> None:
    path = Sketch((0, 30)).to(40, 50).to(123, 73.55).path()
    out, _ = run(Split(segment=1, at=0.5), path)
    assert out.target[:, :2].tolist() == [[20, 40], [40, 50], [123, 73.55]]
    assert same(run(Split(line=1, at=0.5), path, 1)[0], out)


@settings(max_examples=30, deadline=None)
@given(paths(most=4), st.floats(0.01, 0.99))
def test_split_does_not_move_the_path(path: Toolpath, at: float) -> None:
    rows = [i for i in range(len(path)) if path.kind[i] <= Kind.POLYNOMIAL]
    if not rows:
        with pytest.raises(UsageError):
            run(Split(segment=1), path)
        return
    out, _ = run(Split(segment=rows[0] + 1, at=at), path)
    assert out.length.sum() == pytest.approx(path.length.sum(), rel=1e-9)
    assert len(out) == len(path) + 1
    assert len(out.events) == len(path.events)


def test_move_start_of_a_square() -> None:
    path = (
        Sketch()
        .to(5, 5, kind=Kind.POSITIONING)
        .to(10, 5)
        .to(10, 10)
        .to(5, 10)
        .to(5, 5)
        .to(0, 0, kind=0)
        .path()
    )
    out, _ = run(MoveStart(segment=4), path)
    assert out.target[:, :2].tolist() == [[10, 10], [5, 10], [5, 5], [10, 5], [10, 10], [0, 0]]
    with pytest.raises(UsageError, match="not closed"):
        run(MoveStart(segment=1), Sketch().to(5, 5).path())
    assert hypot(*out.target[-1, :2]) == 0.0


def test_another_start_of_a_contour_that_begins_the_path_moves_nothing() -> None:
    path = Sketch().to(10, 0).to(10, 10).to(0, 10).to(0, 0).path()
    out, report = run(MoveStart(segment=3), path)
    assert out.start[:2].tolist() == [10, 10]
    assert out.target[:, :2].tolist() == [[0, 10], [0, 0], [10, 0], [10, 10]]
    assert report.deviation == 0.0


def test_curves_with_more_pieces_than_there_is_room_for_at_once() -> None:
    sketch = Sketch()
    for radius in (50.0, 80.0, 100.0, 120.0):
        sketch.arc(radius, 6.0, 0.5, 1.0)
    path = sketch.path()
    out, report = run(Transform(roll=20.0, pitch=30.0, tolerance=1e-6), path)
    assert len(out) > 4 * 16
    assert report.deviation is not None
    assert report.deviation <= 1e-6
    assert sorted(set(out.line.tolist())) == [1, 2, 3, 4]
    lines, _ = run(Flatten(length=0.01, arcs=True), path)
    assert np.bincount(lines.line)[1:].tolist() == [30_000, 48_000, 60_000, 72_000]
    assert lines.target[lines.line.searchsorted([2, 3, 4, 5]) - 1].tolist() == path.target.tolist()
