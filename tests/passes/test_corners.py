"""round-corners and smooth-corners: numbers of single corners, continuity, regions, stops, axes, chunks."""

from __future__ import annotations

from math import cos, pi, radians, sin, sqrt, tan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.kernels.curves import curvature
from nccompile.passes.base import Pass
from nccompile.passes.round_corners import RoundCorners
from nccompile.passes.smooth_corners import SmoothCorners
from nccompile.toolpath.columns import Kind, Mark, Plane, Toolpath
from tests.passes.paths import Probe, Sketch, paths, run, same
from tests.passes.places import curvature_at


@pytest.mark.parametrize(
    "p", [RoundCorners(radius=0.3), SmoothCorners(), SmoothCorners(distance=2.0)], ids=repr
)
@settings(max_examples=12)
@given(path=paths(most=12))
def test_chunks_do_not_matter_between_marks(p: Pass, path: Toolpath) -> None:
    whole, _ = run(p, path)
    assert np.array_equal(whole.end, path.end)
    for size in (1, 7):
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
        .ellipse(6, 0.5, 0.3, 2.0, 5.5)
        .path()
    )
    out, report = run(RoundCorners(radius=0.8, everywhere=True), path)
    assert report.counts["corners"] == 3
    for i in range(len(out) - 1):
        one, two = Probe(out, i), Probe(out, i + 1)
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
        one, two = Probe(out, i), Probe(out, i + 1)
        assert one.tangent(one.length) @ two.tangent(0.0) == pytest.approx(1.0, abs=1e-9)
        assert one.curvature(one.length) == pytest.approx(two.curvature(0.0), abs=1e-7)
    assert curvature(Kind.ARC, np.array([0, 0, 2.0] + [0.0] * 9), 0.5) == 0.5
    assert curvature_at(Kind.ARC, 0, np.array([0, 0, 2.0, 0.0, 1.0] + [0.0] * 7), 0.0)[0] == pytest.approx(
        -0.5
    )


def test_corners_parallel_to_another_plane_are_arcs_there() -> None:
    out, _ = run(RoundCorners(radius=2.0, everywhere=True), Sketch().to(10, 0, 10).to(20, 0, 0).path())
    assert out.kind.tolist() == [Kind.LINE, Kind.ARC, Kind.LINE]
    assert out.curves.plane[0] == Plane.ZX
    assert out.curves.parameters[0, :3] == pytest.approx([10 - 2 * sqrt(2), 10, 2])


@pytest.mark.parametrize("tolerance", [0.01, 1e-3, 1e-5])
def test_lines_in_space_get_an_arc_in_their_plane(tolerance: float) -> None:
    path = Sketch().to(10, 3, 10).to(20, 8, 0).path()
    out, report = run(RoundCorners(radius=2.0, everywhere=True, tolerance=tolerance), path)
    assert (out.curves.plane == Plane.SPACE).all()
    one, two = Probe(path, 0).tangent(0.0), Probe(path, 1).tangent(0.0)
    turn = float(np.arccos(one @ two))
    center = path.target[0, :3] + (two - one) / np.linalg.norm(two - one) * 2.0 / np.cos(turn / 2)
    for i in np.flatnonzero(out.kind == Kind.POLYNOMIAL):
        probe = Probe(out, int(i))
        for share in np.linspace(0, 1, 9):
            assert np.linalg.norm(probe.point(float(share) * probe.length) - center) == pytest.approx(
                2.0, abs=tolerance
            )
    assert report.deviation == pytest.approx(2.0 / np.cos(turn / 2) - 2.0, abs=0.01)


def test_a_sharp_corner_is_missed_by_the_radius_at_most() -> None:
    for degrees in (100.0, 119.0, 130.0, 150.0, 175.0, 179.0):
        path = Sketch().to(100, 0).to(100 + 100 * cos(radians(degrees)), 100 * sin(radians(degrees))).path()
        out, _ = run(RoundCorners(radius=2.0, everywhere=True), path)
        arc = Probe(out, 1)
        missed = float(np.linalg.norm(arc.point(0.5 * arc.length) - path.target[0, :3]))
        wanted = 2.0 / cos(radians(degrees) / 2) - 2.0
        assert missed == pytest.approx(min(wanted, 2.0), abs=1e-9)
        assert bool(arc.p[2] > 2.0 - 1e-9) is (degrees < 120.0)


_legs = st.sampled_from(["line", "arc", "helix", "ellipse", "cubic"])
_turns = st.floats(0.05, 3.0).flatmap(lambda turn: st.sampled_from([turn, -turn]))


@st.composite
def corners(draw: st.DrawFn) -> Toolpath:
    """Two segments of any kind that may slope, with a corner between them."""
    sketch = Sketch((draw(st.sampled_from([0.0, 1e6])), 0.0, 0.0, 0.0))
    for turn in (0.0, draw(_turns)):
        size, kind = draw(st.floats(0.1, 50.0)), draw(_legs)
        heading = sketch.heading + turn
        if kind == "line":
            dz = draw(st.sampled_from([0.0, 0.0, 3.0]))
            x, y = sketch.at[0] + size * cos(heading), sketch.at[1] + size * sin(heading)
            sketch.to(x, y, sketch.at[2] + dz, sketch.at[3] + 5.0)
        elif kind in ("arc", "helix"):
            sweep = draw(st.floats(0.1, 6.0)) * draw(st.sampled_from([1.0, -1.0]))
            sketch.arc(size, sweep, turn, 2.0 if kind == "helix" else 0.0)
        elif kind == "ellipse":
            sketch.ellipse(size, draw(st.floats(0.3, 1.0)), draw(st.floats(0, 6)), 2.0, heading)
        else:
            m0 = (size * cos(heading), size * sin(heading))
            sketch.cubic(m0[0] - 0.3 * m0[1], m0[1] + 0.3 * m0[0], m0, (m0[0] - m0[1], m0[1] + m0[0]))
    return sketch.path()


def bends(out: Toolpath) -> float:
    """The greatest jump of direction at a joint."""
    return max(
        float(np.linalg.norm(Probe(out, i).tangent(Probe(out, i).length) - Probe(out, i + 1).tangent(0.0)))
        for i in range(len(out) - 1)
    )


@settings(max_examples=80)
@given(path=corners(), distance=st.floats(0.01, 20.0))
def test_smoothed_joints_are_continuous_in_direction_and_curvature(path: Toolpath, distance: float) -> None:
    out, report = run(SmoothCorners(distance=distance, everywhere=True), path)
    if not report.counts["corners"]:
        return
    digits = 1e-8 + 1e-15 * float(np.abs(path.target).max()) / min(float(out.length.min()), distance)
    assert bends(out) <= 100 * digits
    for i in range(len(out) - 1):
        one, two = Probe(out, i), Probe(out, i + 1)
        k0, k1 = one.curvature(one.length), two.curvature(0.0)
        assert np.abs(k0 - k1).max() <= (1e-6 + 100 * digits) * (
            1.0 + np.abs(k0).max() + 1.0 / out.length.min()
        )


@settings(max_examples=80)
@given(path=corners(), radius=st.floats(0.01, 20.0))
def test_rounded_joints_are_continuous_in_direction(path: Toolpath, radius: float) -> None:
    out, report = run(RoundCorners(radius=radius, everywhere=True), path)
    if not report.counts["corners"]:
        return
    digits = 1e-8 + 1e-15 * float(np.abs(path.target).max()) / min(float(out.length.min()), radius)
    assert bends(out) <= 100 * digits
    whole, first, last = path.length, float(out.length[0]), float(out.length[-1])
    assert first >= whole[0] * (0.5 - 1e-9)
    assert last >= whole[1] * (0.5 - 1e-9)
    flat = np.ptp(out.target[:, 2]) == 0.0 and path.start[2] == path.target[0, 2]
    if flat:
        assert out.kind[1] == Kind.ARC
        row = out.curves.parameters[out.curve[1]]
        assert row[2] <= radius * (1 + digits)
        assert np.linalg.norm(row[:2] - path.target[0, :2]) - row[2] <= radius * (1 + digits)


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
