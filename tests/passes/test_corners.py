"""round-corners and smooth-corners: numbers of single corners, continuity, regions, stops, axes, chunks."""

from __future__ import annotations

from math import pi, radians, sqrt, tan

import numpy as np
import pytest
from hypothesis import given, settings

from nccompile.geometry.parts import curvature_at
from nccompile.kernels.curves import curvature
from nccompile.passes.base import Pass
from nccompile.passes.corners import Leg
from nccompile.passes.round_corners import RoundCorners
from nccompile.passes.smooth_corners import SmoothCorners
from nccompile.toolpath.columns import Kind, Mark, Plane, Toolpath
from tests.passes.paths import SIZES, Sketch, paths, run, same

PASSES: list[Pass] = [
    RoundCorners(radius=1.0, everywhere=True),
    RoundCorners(radius=0.3),
    SmoothCorners(distance=1.0, everywhere=True),
    SmoothCorners(),
]


def leg(path: Toolpath, i: int) -> Leg:
    return Leg(path, i, path.starts()[i])


@pytest.mark.parametrize("p", PASSES, ids=repr)
@settings(max_examples=12, deadline=None)
@given(path=paths(most=12))
def test_any_path_passes_and_chunks_do_not_matter(p: Pass, path: Toolpath) -> None:
    whole, _ = run(p, path)
    assert np.array_equal(whole.end, path.end)
    assert len(whole.events) == len(path.events)
    for size in SIZES[:2]:
        assert same(run(p, path, size)[0], whole)


def test_a_right_angle_gets_an_arc_of_radius_d() -> None:
    path = Sketch().to(10, 0, d=2.0).mark(Mark.ROUND).to(10, 10).mark(Mark.CORNER_STOP).to(0, 10).path()
    out, report = run(RoundCorners(), path)
    assert out.kind.tolist() == [Kind.LINE, Kind.ARC, Kind.LINE, Kind.LINE]
    assert out.target[:2, :2] == pytest.approx(np.array([[8, 0], [10, 2]]))
    assert out.curves.parameters[0, :5] == pytest.approx([8, 2, 2, -pi / 2, pi / 2])
    assert report.deviation == pytest.approx(2 * (sqrt(2) - 1), abs=0.02)
    assert not (out.mark & Mark.ROUND).any()


def test_radius_of_the_pass_goes_before_d_and_distance_is_the_manuals_text() -> None:
    path = Sketch().to(10, 0, d=2.0).to(20, 10).path()
    by_radius, _ = run(RoundCorners(radius=3.0, everywhere=True), path)
    assert by_radius.curves.parameters[0, 2] == pytest.approx(3.0)
    assert by_radius.target[0, 0] == pytest.approx(10 - 3 * tan(pi / 8))
    by_distance, _ = run(RoundCorners(radius=3.0, everywhere=True, distance=True), path)
    assert by_distance.target[0, 0] == pytest.approx(7.0)


def test_the_cut_is_at_most_half_the_shorter_neighbour() -> None:
    out, _ = run(RoundCorners(radius=30.0, everywhere=True), Sketch().to(10, 0).to(10, 4).to(0, 4).path())
    assert out.target[0].tolist() == [8, 0, 0, 0]
    assert out.kind.tolist() == [Kind.LINE, Kind.ARC, Kind.ARC, Kind.LINE]
    smooth, _ = run(
        SmoothCorners(distance=30.0, everywhere=True), Sketch().to(10, 0).to(10, 4).to(0, 4).path()
    )
    assert smooth.target[0, 0] == 8.0


def test_corners_with_curves_are_touched() -> None:
    path = (
        Sketch()
        .to(10, 0)
        .arc(5.0, 2.0, turn=1.0)
        .arc(8.0, -2.0, turn=-1.2)
        .ellipse(6, 0.5, 0.3, 2.0, 0.0)
        .path()
    )
    out, report = run(RoundCorners(radius=0.8, everywhere=True), path)
    assert report.counts["corners"] == 3
    for i in range(len(out) - 1):
        one, two = leg(out, i), leg(out, i + 1)
        assert one.tangent(one.length) @ two.tangent(0.0) == pytest.approx(1.0, abs=1e-9)
    radii = [
        float(out.curves.parameters[out.curve[i], 2]) for i in range(len(out)) if out.kind[i] == Kind.ARC
    ]
    assert sum(abs(r - 0.8) < 1e-9 for r in radii) == 3


@pytest.mark.parametrize("dz", [0.0, 3.0])
def test_smoothing_is_continuous_in_direction_and_curvature(dz: float) -> None:
    path = Sketch().to(10, 0, dz).to(10, 12, 0.0).arc(5.0, 2.0, turn=1.0).arc(4.0, -2.0, turn=1.0).path()
    out, report = run(SmoothCorners(distance=1.0, everywhere=True), path)
    assert report.counts["corners"] == 3
    for i in range(len(out) - 1):
        one, two = leg(out, i), leg(out, i + 1)
        assert one.tangent(one.length) @ two.tangent(0.0) == pytest.approx(1.0, abs=1e-9)
        assert one.curvature(one.length) == pytest.approx(two.curvature(0.0), abs=1e-7)
    assert curvature(Kind.ARC, np.array([0, 0, 2.0] + [0.0] * 9), 0.5) == 0.5
    assert curvature_at(Kind.ARC, 0, np.array([0, 0, 2.0, 0.0, 1.0] + [0.0] * 7), 0.0)[0] == pytest.approx(
        -0.5
    )


def test_lines_in_space_get_an_arc_in_their_plane() -> None:
    out, _ = run(RoundCorners(radius=2.0, everywhere=True), Sketch().to(10, 0, 10).to(20, 0, 0).path())
    rows = [i for i in range(len(out)) if out.kind[i] == Kind.POLYNOMIAL]
    assert out.curves.plane[0] == Plane.SPACE
    ends = [leg(out, rows[0]).point(0.0), leg(out, rows[-1]).point(leg(out, rows[-1]).length)]
    center = np.array([10, 0, 10 - 2 * sqrt(2)])
    for i in rows:
        for share in np.linspace(0, 1, 9):
            one = leg(out, i)
            assert np.linalg.norm(one.point(float(share) * one.length) - center) == pytest.approx(
                2.0, abs=1e-3
            )
    assert ends[0][2] == pytest.approx(ends[1][2])


def test_positionings_stops_and_small_bends_stay() -> None:
    path = (
        Sketch()
        .to(10, 0, kind=Kind.POSITIONING)
        .to(10, 10)
        .m(5)
        .to(0, 10)
        .to(-10, 10.1)
        .jump(0, 0)
        .to(5, 0)
        .path()
    )
    for p in (RoundCorners(radius=1.0, everywhere=True), SmoothCorners(distance=1.0, everywhere=True)):
        assert same(run(p, path)[0], path)


def test_switches_and_additional_axes_pass_a_corner_at_their_share() -> None:
    path = Sketch().to(10, 0, 0, 10).switch(1, 0.95).to(10, 10, 0, 20).switch(2, 0.05).switch(3, 0.5).path()
    for p in (RoundCorners(radius=1.0, everywhere=True), SmoothCorners(distance=1.0, everywhere=True)):
        for size in (0, 1):
            out, _ = run(p, path, size)
            assert out.target[:, 3].tolist() == pytest.approx([9.0, 11.0, 20.0])
            assert out.events.segment.tolist() == [1, 1, 2]
            assert out.events.position.tolist() == pytest.approx([0.25, 0.75, 4 / 9])


def test_the_angle_says_what_a_corner_is() -> None:
    path = Sketch().to(10, 0).to(20, 10 * tan(radians(9.0))).path()
    assert len(run(RoundCorners(radius=1.0, everywhere=True, angle=10.0), path)[0]) == 2
    assert len(run(RoundCorners(radius=1.0, everywhere=True, angle=8.0), path)[0]) == 3
