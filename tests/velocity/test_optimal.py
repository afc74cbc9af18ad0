"""Planner `time-optimal`: against toppra on splines, limits in every cycle, equality of routes."""

from __future__ import annotations

import logging
from dataclasses import replace
from math import inf, isclose, pi, radians, sqrt

import numpy as np
import pytest
import toppra
from hypothesis import given, settings
from hypothesis import strategies as st
from toppra import algorithm, constraint

from nccompile.backend.samples import SampleBlock, sample
from nccompile.machine.limits import AxisLimits
from nccompile.machine.model import default_machine
from nccompile.passes.velocity import LOOK_AHEAD, PLANNERS, TIME_OPTIMAL, PlanSettings
from nccompile.passes.velocity.planner import plan, row_times
from nccompile.runtime.task import CyclicTask
from nccompile.source import Source
from nccompile.toolchain import Compilation, Options
from nccompile.toolpath.columns import Curves, Floats, Kind, Plane, Toolpath
from nccompile.toolpath.lengths import path_lengths
from tests.velocity.random_paths import Builder, cut, paths
from tests.velocity.toppra_oracle import compare

AXES = ("X", "Y", "Z", "A")
GENERIC = PlanSettings.from_machine(default_machine(), AXES, planner=TIME_OPTIMAL)
V, A = 200.0, 1500.0
logging.getLogger("toppra").setLevel(logging.ERROR)


def free(axes: int = 3) -> PlanSettings:
    none = np.full(axes, inf)
    limits = AxisLimits(np.full(axes, V), np.full(axes, A), none, none)
    return PlanSettings(limits, 1e5, 1e5, 1e5, pi, 1e-3, 0, planner=TIME_OPTIMAL, rapid_stops=False)


GENERIC3 = PlanSettings.from_machine(default_machine(), AXES[:3], planner=TIME_OPTIMAL)


def spline_rows(cubics: list[Floats]) -> Toolpath:
    """Cubics in space, (3, 4) with the constant first, as a path."""
    n = len(cubics)
    path = Toolpath.empty(("X", "Y", "Z"), cubics[0][:, 0]).replace(
        kind=np.full(n, Kind.POLYNOMIAL, np.uint8), target=np.array([c.sum(axis=1) for c in cubics]),
        curve=np.arange(n, dtype=np.int32), curves=Curves.from_rows([(Plane.SPACE, list(c.ravel())) for c in cubics]),
        length=np.zeros(n), feed=np.full(n, 1000.0), accel=np.full(n, 3000.0), decel=np.full(n, 3000.0),
        radius=np.zeros(n), mark=np.zeros(n, np.uint16), profile=np.zeros(n, np.uint16),
        line=np.arange(1, n + 1, dtype=np.int32),
    )  # fmt: skip
    return path.replace(length=path_lengths(path))


def spline_path(points: Floats) -> tuple[Toolpath, toppra.SplineInterpolator]:
    """A cubic spline through points as polynomials, and as toppra has it."""
    knots = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    spline = toppra.SplineInterpolator(knots, points)
    h = np.diff(knots)
    c = spline.cspl.c  # (4, pieces, 3), highest power first
    cubics = [c[::-1, i].T * h[i] ** np.arange(4) for i in range(len(h))]
    path = spline_rows(cubics)
    return path.replace(feed=np.zeros(len(h)), target=points[1:]), spline


def toppra_time(spline: toppra.SplineInterpolator) -> float:
    v = constraint.JointVelocityConstraint(np.tile([-V, V], (3, 1)))
    a = constraint.JointAccelerationConstraint(
        np.tile([-A, A], (3, 1)), discretization_scheme=constraint.DiscretizationType.Interpolation
    )
    grid = np.linspace(0.0, spline.duration, 2001)
    solver = algorithm.TOPPRA(
        [v, a], spline, gridpoints=grid, solver_wrapper="seidel", parametrizer="ParametrizeConstAccel"
    )
    result = solver.compute_trajectory(0, 0)
    assert result is not None
    return float(result.duration)


def planned(path: Toolpath, options: PlanSettings, size: int = 4096) -> Toolpath:
    return Toolpath.join(list(plan(cut(path, size), options)))


def sampled(path: Toolpath, cycle: float = 1e-3) -> SampleBlock:
    blocks = list(sample([path], cycle))
    return SampleBlock(*(np.concatenate(column) for column in zip(*blocks, strict=True)))


@pytest.mark.parametrize("seed", range(6))
def test_the_time_is_toppras_on_splines(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = np.cumsum(rng.normal(0.0, 15.0, (8, 3)), axis=0)
    path, spline = spline_path(points)
    ours = float(row_times(planned(path, free()), 0.0).sum())
    best = toppra_time(spline)
    assert best * (1 - 1e-3) <= ours <= best * 1.01


@pytest.mark.parametrize("seed", range(2))
def test_splines_keep_every_axis_inside_its_limits(seed: int) -> None:
    points = np.cumsum(np.random.default_rng(seed).normal(0.0, 15.0, (8, 3)), axis=0)
    path, _ = spline_path(points)
    for cycle in (1e-3, 1e-4):
        position = sampled(planned(path, free()), cycle).position
        v = np.diff(position, axis=0) / cycle
        noise = 4e-13 / cycle**2
        assert np.abs(v).max() <= V * (1 + 1e-6)
        assert np.abs(np.diff(v, axis=0) / cycle).max() <= A * (1 + 1e-6) + noise
        assert np.array_equal(position[-1], points[-1])


def test_the_time_is_toppras_on_lines_and_arcs() -> None:
    build = Builder()
    for turn, radius, sweep in ((0.0, 3.0, 2.0), (0.3, 0.4, -1.5), (0.0, 20.0, 0.8), (-1.0, 1.0, 4.0)):
        build.line(5.0 * radius, turn, 120.0)
        build.arc(radius, sweep, 0.0, 80.0)
    path = build.path()
    found = compare(path)
    assert (found.solved, found.unsolved) == (3, 0)
    assert found.best * (1 - 1e-3) <= found.ours <= found.best * 1.01


def test_cusps_and_near_cusps_keep_the_limits() -> None:
    # y' = (x')² + eps: at eps 0 the cubic turns back, near it the radius of the bend is about eps²
    for eps in (0.0, 1e-10, 1e-8, 1e-6, 1e-3):
        x, y = np.array([0.0, -0.4, 0.5, 0.0]), np.array([0.0, 0.16 + eps, -0.4, 1 / 3])
        turned = np.array([0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, 0.1 * y]) * 50.0
        path = spline_rows([turned])
        for planner in (TIME_OPTIMAL, LOOK_AHEAD):
            position = sampled(planned(path, replace(GENERIC3, planner=planner)), 1e-3).position
            dv = np.abs(np.diff(position, 2, axis=0)).max() / 1e-3
            step = (
                10.0 if planner == LOOK_AHEAD else 0.0
            )  # of the axes' velocity, at the creep through the bend
            assert dv <= 5000.0 * 1e-3 * (1 + 1e-6) + step + 4e-13 / 1e-3
            assert np.array_equal(position[-1], turned.sum(axis=1))


@pytest.mark.parametrize("planner", PLANNERS)
def test_a_spline_that_turns_back_runs_at_full_velocity_but_for_its_cusps(planner: str) -> None:
    text = "% c\nN10 G1 X1 F20\nN20 G5 X10\nN30 G5 X0\nN40 G5 X10\nN50 G1 X5\n"
    job = Compilation(Source("c.nc", text), Options(default_machine(), planner=planner, verify=True))
    whole = Toolpath.join(list(job.planned()))
    assert whole.v_end is not None
    assert whole.v_limit is not None
    assert (whole.v_limit[whole.curve >= 0] >= 20.0).any()
    report = CyclicTask(iter([whole]), default_machine()).run()
    assert report.outcome == "finished"
    assert job.time.seconds < 3.0  # 36 mm at 20 mm/s, four stops; the creep of 5 mm/s alone would take 5 s


def test_a_full_circle_runs_at_the_velocity_that_the_axes_allow() -> None:
    build = Builder()
    build.arc(10.0, 20 * pi / 10, 0.0, 1e4)
    path = build.path()
    options = PlanSettings(
        AxisLimits(np.full(4, 1e4), np.full(4, A), np.full(4, inf), np.full(4, inf)),
        1e4, 1e5, 1e5, pi, 1e-3, 0, planner=TIME_OPTIMAL,
    )  # fmt: skip
    whole = planned(path, options)
    assert whole.v_end is not None
    # an axis alone holds the whole centripetal acceleration where it points along it: v² / r = A
    quarter = whole.v_end[np.isclose(np.cumsum(whole.length), whole.length.sum() / 2)]
    assert isclose(float(quarter[0]) ** 2 / 10.0, A, rel_tol=3e-3)
    slow = planned(path, replace(options, planner=LOOK_AHEAD))
    assert row_times(whole, 0.0).sum() < row_times(slow, 0.0).sum()


@settings(max_examples=30, deadline=None)
@given(paths(stops=False, most=10))
def test_axes_stay_inside_their_limits_on_random_paths(path: Toolpath) -> None:
    axes = default_machine().axes
    whole = planned(path, GENERIC)
    position = sampled(whole).position
    v = np.diff(position, axis=0) / 1e-3
    dv = np.abs(np.diff(v, axis=0))
    for column, letter in enumerate(AXES):
        axis = axes[letter]
        assert np.abs(v[:, column]).max(initial=0.0) <= axis.velocity * (1 + 1e-6)
        bound = axis.acceleration * 1e-3 + axis.velocity_step + 1e-6 * axis.velocity
        assert dv[:, column].max(initial=0.0) <= bound
    assert np.array_equal(position[-1], path.target[-1])


@settings(max_examples=25, deadline=None)
@given(paths(most=12), st.sampled_from([None, 0.01]))
def test_never_slower_than_look_ahead_and_not_moved_by_chunks(
    path: Toolpath, deviation: float | None
) -> None:
    options = replace(GENERIC, junction_deviation=deviation)  # corners look at the lengths of whole segments
    whole = planned(path, options)
    other = planned(path, options, size=2)
    for name in ("target", "v_end", "v_limit", "v_junction", "accel", "decel"):
        assert np.array_equal(getattr(whole, name), getattr(other, name)), name
    slow = planned(path, replace(options, planner=LOOK_AHEAD))
    assert row_times(whole, 0.0).sum() <= row_times(slow, 0.0).sum() * (1 + 1e-3) + 1e-9


@settings(max_examples=20, deadline=None)
@given(
    paths(stops=False, most=8),
    st.lists(st.tuples(st.integers(1, 200), st.floats(0.05, 2.0), st.booleans()), max_size=4),
)
def test_override_and_stops_keep_the_limits(path: Toolpath, changes: list[tuple[int, float, bool]]) -> None:
    from nccompile.runtime.interpolator import Interpolator
    from nccompile.runtime.ring import RingBuffer

    whole = planned(path, GENERIC)
    ring = RingBuffer(AXES, len(whole))
    ring.push(whole)
    ring.close()
    ipo = Interpolator(ring, whole.start, 1e-3)
    position = []
    for wait, override, stop in [*changes, (1, 1.0, False)]:
        ipo.inputs.override, ipo.inputs.slow_stop = override, stop
        position += [ipo.advance(1, patient=False).position[0].copy() for _ in range(wait)]
    while not ipo.outputs.done:
        position += list(ipo.advance(500, patient=False).position.copy())
    axes = default_machine().axes
    v = np.diff(np.array(position), axis=0) / 1e-3
    for column, letter in enumerate(AXES):
        axis = axes[letter]
        assert np.abs(v[:, column]).max(initial=0.0) <= axis.velocity * (1 + 1e-6)
        dv = np.abs(np.diff(v[:, column])).max(initial=0.0)
        assert dv <= axis.acceleration * 1e-3 * 1.01 + axis.velocity_step + 1e-6 * axis.velocity
    assert np.allclose(position[-1], path.target[-1])


def test_straight_lines_take_the_axes_full_acceleration() -> None:
    build = Builder()
    build.line(50, radians(45), 400, 100, 100)
    whole = planned(build.path(), GENERIC)
    assert isclose(float(whole.accel[0]), 5000.0 * sqrt(2.0), rel_tol=1e-12)  # E is not a limit here
