"""The planner: manual's rules, machine limits, look-ahead against a plain reference, chunk independence."""

from __future__ import annotations

from dataclasses import replace
from math import isclose, pi, radians, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile import kernels
from nccompile.machine.model import default_machine
from nccompile.passes.velocity import PlanSettings
from nccompile.passes.velocity.planner import Planner, plan, row_times
from nccompile.toolpath.columns import Kind, Toolpath
from tests.velocity.random_paths import Builder, cut, paths

AXES = ("X", "Y", "Z", "A")


def generic(tolerance_deg: float = 20.0, law: str = "trapezoid") -> PlanSettings:
    return PlanSettings.from_machine(default_machine(), AXES, angle_tolerance_deg=tolerance_deg, time_law=law)


def planned(path: Toolpath, options: PlanSettings | None = None, size: int = 10_000) -> Toolpath:
    return Toolpath.join(list(plan(cut(path, size), options or generic())))


def ends(path: Toolpath) -> list[float]:
    assert path.v_end is not None
    return [float(v) for v in path.v_end]


def test_transition_rules_of_the_manual() -> None:
    # SoftMotion §3.2: 0 next to G0, 0 above the angle tolerance, else the lower command velocity
    build = Builder()
    build.line(100, 0.0, 50)
    build.line(100, radians(5), 30)  # below the tolerance: the lower of both
    build.line(100, radians(45), 40)  # above: stop
    build.line(100, 0.0, 40, kind=Kind.POSITIONING)  # positioning: stop on both sides
    build.line(100, 0.0, 40)
    assert ends(planned(build.path())) == [30.0, 0.0, 0.0, 0.0, 0.0]
    # the same with 50 degrees of tolerance: the bend of 45 degrees is no stop, only the axes' velocity step
    assert ends(planned(build.path(), generic(50)))[1] > 0.0


def test_the_angle_tolerance_is_met_exactly() -> None:
    for tolerance, bend, stops in [
        (10, 10.0001, True),
        (10, 9.9999, False),
        (0.001, 0.0011, True),
        (0.001, 0.0009, False),
    ]:
        build = Builder()
        build.line(50, 0.0, 20)
        build.line(50, radians(bend), 20)
        assert (ends(planned(build.path(), generic(tolerance)))[0] == 0.0) is stops


def test_tangent_line_and_arc_do_not_slow_down_and_the_arc_keeps_its_acceleration() -> None:
    build = Builder()
    build.line(200, 0.0, 300, 5000, 5000)
    build.arc(5.0, pi, 0.0, 300, 100, 100)
    build.line(200, 0.0, 300, 5000, 5000)
    path = planned(build.path())
    assert path.v_limit is not None
    top = float(path.v_limit[1])
    # tangential 100 leaves sqrt(5000² - 100²) of the axis for the curve
    assert isclose(top * top / 5.0, sqrt(5000.0**2 - 100.0**2), rel_tol=1e-12)
    assert ends(path)[:2] == [top, top]


def test_rapid_velocity_is_the_machines_where_it_names_one() -> None:
    build = Builder()
    build.line(100, 0.0, 10, kind=Kind.POSITIONING)
    options = generic()
    assert planned(build.path(), options).feed[0] == 10.0  # SoftMotion: F holds for G0 too
    limits = options.limits
    rapid = np.array([120.0, 90.0, 50.0, np.inf])
    named = PlanSettings(
        type(limits)(limits.velocity, limits.acceleration, limits.velocity_step, rapid),
        options.feed, options.accel, options.decel, options.angle_tolerance, options.cycle, options.law,
    )  # fmt: skip
    assert planned(build.path(), named).feed[0] == 120.0


def test_velocity_step_bounds_a_corner_and_a_row_of_tiny_corners() -> None:
    step, cycle = 10.0, 1e-3  # of the generic machine
    build = Builder()
    build.line(100, 0.0, 400, 5000, 5000)
    build.line(100, radians(15), 400, 5000, 5000)
    corner = ends(planned(build.path()))[0]
    jump = max(1 - np.cos(radians(15)), np.sin(radians(15)))
    assert isclose(corner, step / jump, rel_tol=1e-9)
    # chords of 0.02 mm that turn by 1 degree each: many corners a cycle share the step
    dense = Builder()
    dense.line(100, 0.0, 400, 5000, 5000)
    for _ in range(300):
        dense.line(0.02, radians(1), 400, 5000, 5000)
    path = planned(dense.path())
    v = np.array(ends(path)[5:-5])
    per_cycle = v * cycle / 0.02
    assert (np.maximum(per_cycle, 1.0) * v * radians(1) <= step).all()


@settings(max_examples=60, deadline=None)
@given(paths(), st.sampled_from(["trapezoid", "sigmoid"]))
def test_look_ahead_equals_a_plain_two_pass_reference(path: Toolpath, law: str) -> None:
    options = generic(law=law)
    whole = planned(path, options)
    assert whole.v_limit is not None
    assert whole.v_junction is not None
    n = len(whole)
    top = np.minimum(whole.feed, whole.v_limit)
    v = np.zeros(n)
    for j in range(n - 2, -1, -1):
        cap = min(whole.v_junction[j], top[j], top[j + 1])
        v[j] = min(cap, sqrt(v[j + 1] ** 2 + 2 * whole.decel[j + 1] * whole.length[j + 1]))
    before = 0.0
    for j in range(n):
        v[j] = before = min(v[j], sqrt(before**2 + 2 * whole.accel[j] * whole.length[j]))
    assert np.allclose(ends(whole), v, rtol=1e-12, atol=1e-12)


@settings(max_examples=40, deadline=None)
@given(paths(most=40))
def test_the_plan_does_not_depend_on_the_chunk_size(path: Toolpath) -> None:
    whole = planned(path)
    for size in (1, 2, 7):
        other = planned(path, size=size)
        for name in ("v_limit", "v_junction", "v_end", "feed", "accel", "decel", "target", "line"):
            assert np.array_equal(getattr(whole, name), getattr(other, name)), name


@settings(max_examples=15, deadline=None)
@given(paths())
def test_compiled_and_plain_kernels_give_the_same_bits(path: Toolpath) -> None:
    plain = planned(path)
    before = kernels.compiled()
    kernels.use(compiled=True)
    try:
        machine = planned(path)
        times = row_times(machine, 0.0)
    finally:
        kernels.use(compiled=before)
    for name in ("v_limit", "v_junction", "v_end", "accel", "decel"):
        assert np.array_equal(getattr(plain, name), getattr(machine, name)), name
    assert np.array_equal(times, row_times(plain, 0.0))


def test_a_window_too_small_for_the_braking_distance_is_slower_but_safe() -> None:
    build = Builder()
    for _ in range(400):
        build.line(0.5, 0.0, 300, 2000, 50)
    path = build.path()
    narrow = Planner(replace(generic(), window=20))
    chunks: list[Toolpath] = []
    for chunk in cut(path, 5):
        chunks += narrow.feed(chunk)
    chunks += narrow.finish()
    small, large = Toolpath.join(chunks), planned(path)
    assert len(small) == len(path)
    assert (np.array(ends(small)) <= np.array(ends(large)) + 1e-9).all()
    v = np.array([0.0, *ends(small)])
    assert (v[:-1] ** 2 - v[1:] ** 2 <= 2 * 50 * 0.5 * (1 + 1e-9)).all()


def test_dwell_time_counts() -> None:
    build = Builder()
    build.line(10, 0.0, 20)
    build.still(Kind.DWELL, seconds=0.7)
    assert row_times(planned(build.path()), 0.0)[1] == pytest.approx(0.7)
