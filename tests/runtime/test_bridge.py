"""ControlAxisByPos: within the limits at every cycle, no slower than it has to be, exact at the end."""

from __future__ import annotations

from math import ceil, sqrt

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.runtime.bridge import Brake, Bridge

T = 0.001
POSITION = st.floats(-20, 20)
VELOCITY = st.floats(10, 500)
ACCELERATION = st.floats(10, 20_000)


@settings(max_examples=80, deadline=None)
@given(
    st.lists(st.tuples(POSITION, POSITION, VELOCITY, ACCELERATION), min_size=1, max_size=4),
    st.sampled_from([7, 999, 4096]),
)
def test_each_axis_keeps_its_limits_and_takes_its_shortest_time(
    axes: list[tuple[float, float, float, float]], block: int
) -> None:
    start, target, v, a = (np.array(column) for column in zip(*axes, strict=True))
    way = Bridge(start, target, v, a, T)
    path = np.concatenate([way.positions(first, block) for first in range(0, len(way), block)])
    assert len(path) == len(way) >= 1
    np.testing.assert_array_equal(path[-1], target)
    moved = np.vstack([start, path])
    velocity = np.diff(moved, axis=0) / T
    steps = np.diff(np.vstack([0 * start, velocity, 0 * start]), axis=0)
    assert np.all(np.abs(velocity) <= v * (1 + 1e-9) + 1e-9)
    assert np.all(np.abs(steps) <= a * T * (1 + 1e-9) + 1e-8)
    for i, d in enumerate(np.abs(target - start)):  # arrival: the textbook time, rounded up to a cycle
        time = d / v[i] + v[i] / a[i] if d >= v[i] ** 2 / a[i] else 2 * sqrt(d / a[i])
        arrived = int(np.argmax(np.abs(path[:, i] - target[i]) <= 1e-9)) + 1
        assert arrived <= max(1, ceil(time / T)) <= len(path) + 1


@settings(max_examples=100, deadline=None)
@given(st.lists(st.tuples(POSITION, st.floats(-300, 300), ACCELERATION), min_size=1, max_size=4))
def test_braking_stops_with_the_acceleration(axes: list[tuple[float, float, float]]) -> None:
    position, v, a = (np.array(column) for column in zip(*axes, strict=True))
    stop = Brake(position, v, a, T)
    path = np.vstack([position, stop.positions(0, len(stop))])
    velocity = np.vstack([v, np.diff(path, axis=0) / T, 0 * v])
    assert np.all(np.abs(np.diff(velocity, axis=0)) <= a * T * (1 + 1e-9) + 1e-8)
    np.testing.assert_allclose(path[-1] - position, v * np.abs(v) / (2 * a), atol=1e-9)
