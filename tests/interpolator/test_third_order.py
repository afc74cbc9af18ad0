"""Third-order plans in the interpolator: as planned at override 1, inside velocity, acceleration and jerk always."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.backend.samples import sample
from nccompile.kernels.interpolator_rate import plan_time, rate_at
from nccompile.kernels.interpolator_stop import brake_phases, cube_root, step_phases
from nccompile.runtime.interpolator import Interpolator
from nccompile.runtime.ring import RingBuffer
from nccompile.toolpath.columns import Floats, Toolpath
from tests.interpolator.third_order import ACCEL, DECEL, JERK, derivatives, levels, plan_of, plans

TOP = 150.0
SLACK = 1.0 + 1e-6

COMMANDS = st.one_of(
    st.tuples(st.just("override"), st.sampled_from([0.01, 0.3, 0.7, 1.0, 1.2, 2.0])),
    st.tuples(st.sampled_from(["slow_stop", "quick_stop", "single_step"]), st.booleans()),
)
SCRIPTS = st.lists(st.tuples(st.integers(0, 1200), COMMANDS), max_size=8)


def block(path: Toolpath, cycle: float) -> Interpolator:
    along = np.array([1.0, 0.5, 0.0]) / np.sqrt(1.25)  # a quick stop may use DECEL along the path
    ring = RingBuffer(path.axes, len(path), acceleration=DECEL * along)
    ring.push(path)
    ring.close()
    ipo = Interpolator(ring, path.start, cycle)
    ipo.inputs.quick_deceleration = 5000.0
    return ipo


def run(ipo: Interpolator, script: list[tuple[int, tuple[str, float]]], cycles: int, released: int) -> Floats:
    """Ways of single cycles; at cycle `released` every stop is taken back and the override is 1."""
    ways = []
    for n in range(cycles):
        for at, (name, value) in script:
            if at == n and n < released:
                setattr(ipo.inputs, name, value)
        if n == released:
            inputs = ipo.inputs
            inputs.slow_stop = inputs.quick_stop = inputs.single_step = False
            inputs.override = 1.0
        burst = ipo.advance(1, patient=False)
        ways.append(float(burst.velocity[0]) * ipo.cycle)
        if ipo.outputs.done:
            break
    return np.array(ways)


def assert_inside(ways: Floats, cycle: float, top: float = TOP) -> None:
    v, a, j = derivatives(ways, cycle)
    rounding = 1e-12 / cycle**3
    assert ways.min() >= 0.0
    assert v.max() <= top * SLACK
    assert a.max() <= ACCEL * SLACK + rounding * cycle
    assert -a.min() <= DECEL * SLACK + rounding * cycle
    assert np.abs(j).max() <= JERK * SLACK + rounding


@settings(max_examples=8, deadline=None)
@given(plans(), st.sampled_from([1e-3, 1e-4, 7e-3]))
def test_samples_are_the_plan(path: Toolpath, cycle: float) -> None:
    blocks = list(sample([path], cycle))
    ways = np.concatenate([b.velocity for b in blocks]) * cycle
    assert_inside(ways, cycle, 100.0)
    assert blocks[-1].position[-1] == pytest.approx(path.end, abs=1e-12)
    # the way over time, by integrating the plan's accelerations finely
    assert path.v_end is not None
    assert path.a_end is not None
    begin = np.concatenate([[0.0], path.v_end[:-1]])
    before = np.concatenate([[0.0], path.a_end[:-1]])
    mean = 0.5 * (begin + path.v_end)
    times = 2 * path.length / (mean + np.sqrt(mean * mean + (before - path.a_end) * path.length / 3))
    assert abs((len(ways) - 1) * cycle - times.sum()) <= cycle * (1 + 1e-6)
    t = np.arange(len(ways)) * cycle
    ends = np.concatenate([[0.0], np.cumsum(times)])
    assert np.interp(ends, t, np.cumsum(ways)) == pytest.approx(
        np.concatenate([[0.0], np.cumsum(path.length)]), abs=ACCEL * cycle**2 / 4 + 1e-9
    )


@settings(max_examples=10, deadline=None)
@given(plans(), SCRIPTS, st.sampled_from([1e-3, 1e-3, 1e-3, 1e-4]))
def test_stops_and_overrides_stay_inside_from_any_state(
    path: Toolpath, script: list[tuple[int, tuple[str, float]]], cycle: float
) -> None:
    ipo = block(path, cycle)
    ways = run(ipo, script, 60_000, 1500)
    assert_inside(ways, cycle)
    assert ipo.outputs.done
    assert ways.sum() == pytest.approx(path.length.sum(), abs=1e-9)
    assert np.array_equal(ipo.outputs.set_position, path.end)


@pytest.mark.parametrize(("velocity", "cycles"), [(10.0, (1384, 1388, 1392)), (30.0, (2033, 2037, 2043))])
def test_an_override_just_before_a_stop_stays_inside(velocity: float, cycles: tuple[int, ...]) -> None:
    path = plan_of(levels([velocity], [0.05]))
    for n in cycles:
        assert_inside(run(block(path, 1e-4), [(n, ("override", 0.01))], 60_000, 3000), 1e-4)


@pytest.mark.parametrize(("velocity", "released"), [(10.0, 604), (20.0, 458), (30.0, 571)])
def test_the_jerk_is_greatest_where_the_change_of_a_rate_turns(velocity: float, released: int) -> None:
    path = plan_of(levels([velocity], [0.05], 0.5 * JERK))
    assert_inside(run(block(path, 1e-4), [(0, ("override", 0.3))], 60_000, released), 1e-4)


@settings(max_examples=8, deadline=None)
@given(plans(), SCRIPTS, st.integers(2, 700))
def test_the_size_of_bursts_changes_no_bit(
    path: Toolpath, script: list[tuple[int, tuple[str, float]]], burst: int
) -> None:
    times = sorted({0, *(at for at, _ in script), 1500})
    single = run(block(path, 1e-3), script, 4000, 1500)
    ipo = block(path, 1e-3)
    ways: list[Floats] = []
    for begin, end in zip(times, [*times[1:], 4000], strict=True):
        for at, (name, value) in script:
            if at == begin and at < 1500:
                setattr(ipo.inputs, name, value)
        if begin == 1500:
            inputs = ipo.inputs
            inputs.slow_stop = inputs.quick_stop = inputs.single_step = False
            inputs.override = 1.0
        left = end - begin
        while left and not ipo.outputs.done:
            done = ipo.advance(min(burst, left), patient=False)
            ways.append(done.velocity * 1e-3)
            left -= len(done)
    assert np.array_equal(np.concatenate(ways), single)


@settings(max_examples=8, deadline=None)
@given(plans(), st.lists(st.integers(0, 250), min_size=1, max_size=30), st.sampled_from([1.0, 0.5, 1.4]))
def test_missing_rows_brake_inside_the_limits(path: Toolpath, waits: list[int], override: float) -> None:
    ring = RingBuffer(path.axes, len(path))
    ipo = Interpolator(ring, path.start, 1e-3)
    ipo.inputs.override = override
    ways: list[float] = []
    at = 0
    for wait in [0, *waits]:
        at += ring.push(path, at, max(1, len(path) // 8)) if at < len(path) else 0
        for _ in range(wait):
            ways += (ipo.advance(1, patient=False).velocity * 1e-3).tolist()
    at += ring.push(path, at) if at < len(path) else 0
    ring.close()
    while not ipo.outputs.done:
        ways += (ipo.advance(1, patient=False).velocity * 1e-3).tolist()
    assert at == len(path)
    assert_inside(np.array(ways), 1e-3, max(1.0, override) * TOP)
    assert sum(ways) == pytest.approx(path.length.sum(), abs=1e-9)


@pytest.mark.parametrize(("cuts", "room", "most"), [(1, 2, 800), (3, 4, 700), (17, 12, 1000), (60, 48, 800)])
def test_a_queue_that_never_holds_a_ramp_runs_slower(cuts: int, room: int, most: int) -> None:
    path = plan_of(levels([50.0, 20.0], [0.05, 0.0]), cuts)
    ring = RingBuffer(path.axes, room)
    ipo = Interpolator(ring, path.start, 1e-3)
    ways: list[float] = []
    at = 0
    while not ipo.outputs.done and len(ways) < most:
        at += ring.push(path, at) if at < len(path) else 0
        if at == len(path):
            ring.close()
        ways += (ipo.advance(1, patient=False).velocity * 1e-3).tolist()
    assert ipo.outputs.done
    assert_inside(np.array(ways), 1e-3)
    assert sum(ways) == pytest.approx(path.length.sum(), abs=1e-9)


@given(st.floats(0.0, 150.0), st.floats(-900.0, 700.0), st.floats(100.0, 1000.0), st.floats(1e3, 1e5))
def test_a_stop_ends_at_rest_without_acceleration(v: float, a: float, decel: float, jerk: float) -> None:
    possible, t1, j1, t2, t3 = brake_phases(v, a, decel, jerk)
    assert possible or a < 0.0
    if not possible:
        return
    least = a
    for t, j in ((t1, j1), (t2, 0.0), (t3, jerk)):
        assert t >= 0.0
        v, a = v + t * (a + 0.5 * t * j), a + t * j
        least = min(least, a)
        assert v >= -1e-7
    assert (v, a) == pytest.approx((0.0, 0.0), abs=1e-4)
    assert abs(j1) <= jerk
    assert -least <= max(decel, 900.0) * SLACK


@given(st.floats(1e-4, 500.0), st.floats(0.1, 150.0), st.floats(100.0, 2000.0), st.floats(1e3, 1e5))
def test_a_single_step_covers_its_length_inside_its_limits(
    length: float, top: float, accel: float, jerk: float
) -> None:
    j, ramp, hold, cruise = step_phases(length, top, accel, jerk)
    assert min(ramp, hold, cruise) >= 0.0
    assert j * ramp <= accel * SLACK
    peak = j * ramp * (ramp + hold)
    assert peak <= top * SLACK
    assert peak * (2 * ramp + hold + cruise) == pytest.approx(length, rel=1e-9)
    assert peak == pytest.approx(top) or cruise == 0.0


@given(st.floats(0.0, 2.0), st.floats(-1.0, 1.0), st.floats(1e-3, 0.5), st.floats(0.0, 0.5))
def test_a_change_of_the_rate_is_smooth_and_its_time_the_integral(
    r0: float, dr: float, ramp: float, level: float
) -> None:
    t = np.linspace(0.0, 2.2 * ramp + level, 401)
    rate = np.array([rate_at(x, r0, dr, ramp, level) for x in t])
    passed = np.array([plan_time(x, r0, dr, ramp, level) for x in t])
    step = t[1]
    assert rate[-1] == pytest.approx((r0 + dr, 0.0, 0.0), abs=1e-12)
    assert np.abs(np.diff(rate[:, 1])).max() <= abs(dr) / ((ramp + level) * ramp) * step * (1 + 1e-6) + 1e-12
    integral = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:, 0] + rate[:-1, 0])) * step])
    assert passed == pytest.approx(integral, abs=1e-4 * (t[-1] + 1.0))


@given(st.floats(1e-12, 1e12))
def test_the_cube_root_is_one(x: float) -> None:
    assert cube_root(x) == pytest.approx(x ** (1 / 3), rel=1e-12)
