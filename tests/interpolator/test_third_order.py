"""Third-order plans in the interpolator: as planned at override 1, inside velocity, acceleration and jerk always."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.backend.samples import sample
from nccompile.runtime.interpolator import Interpolator
from nccompile.runtime.ring import RingBuffer
from nccompile.toolpath.columns import Floats, Toolpath
from tests.interpolator.third_order import ACCEL, DECEL, JERK, derivatives, plans

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


@settings(max_examples=30, deadline=None)
@given(plans(), st.sampled_from([1e-3, 1e-4, 7e-3]))
def test_samples_are_the_plan(path: Toolpath, cycle: float) -> None:
    blocks = list(sample([path], cycle))
    ways = np.concatenate([b.velocity for b in blocks]) * cycle
    assert_inside(ways, cycle, 100.0)
    assert blocks[-1].position[-1] == pytest.approx(path.end, abs=1e-12)
    # the way over time, by integrating the plan's accelerations finely
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


@settings(max_examples=60, deadline=None)
@given(plans(), SCRIPTS, st.sampled_from([1e-3, 1e-3, 1e-4]))
def test_stops_and_overrides_stay_inside_from_any_state(
    path: Toolpath, script: list[tuple[int, tuple[str, float]]], cycle: float
) -> None:
    ipo = block(path, cycle)
    ways = run(ipo, script, 60_000, 1500)
    assert_inside(ways, cycle)
    assert ipo.outputs.done
    assert ways.sum() == pytest.approx(path.length.sum(), abs=1e-9)
    assert np.array_equal(ipo.outputs.set_position, path.end)
