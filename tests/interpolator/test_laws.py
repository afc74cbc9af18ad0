"""Time laws against finite differences of themselves: closed forms of distance and velocity belong together."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nccompile.kernels.timelaw import (
    LAW_NAMES,
    jerk_distance,
    jerk_time,
    jerk_velocity,
    law_distance,
    law_times,
    law_velocity,
    peak_factor,
)

STEP = 1e-6


@pytest.mark.parametrize("law", range(len(LAW_NAMES)))
@given(st.floats(0.0, 40.0), st.floats(50.0, 90.0), st.floats(0.0, 40.0), st.floats(0.01, 0.99))
def test_velocity_is_the_slope_of_distance(law: int, v0: float, top: float, v1: float, part: float) -> None:
    t1, t2, t3, vp, v_end = law_times(80.0, v0, top, v1, 300.0, 500.0)
    t = part * (t1 + t2 + t3)
    if min(abs(t - t1), abs(t - t1 - t2)) < 2 * STEP:
        return
    ahead, behind = (law_distance(law, t + d, t1, t2, t3, v0, vp, v_end) for d in (STEP, -STEP))
    assert (ahead - behind) / (2 * STEP) == pytest.approx(
        law_velocity(law, t, t1, t2, t3, v0, vp, v_end), abs=1e-6
    )


@pytest.mark.parametrize("law", range(len(LAW_NAMES)))
def test_every_law_covers_the_same_way_and_peaks_as_told(law: int) -> None:
    t1, t2, t3, vp, v1 = law_times(100.0, 10.0, 50.0, 20.0, 200.0, 400.0)
    for until, way in ((t1, 30.0 * t1), (t1 + t2 + t3, 100.0)):
        assert law_distance(law, until, t1, t2, t3, 10.0, vp, v1) == pytest.approx(way, rel=1e-12)
    t = np.linspace(0.0, t1, 4001)
    v = np.array([law_velocity(law, x, t1, t2, t3, 10.0, vp, v1) for x in t])
    peak = float((np.diff(v) / np.diff(t)).max())
    assert peak == pytest.approx(200.0 * peak_factor(law), rel=1e-5)
    assert [peak_factor(n) for n in range(3)] == [1.0, pi / 2, 1.5]


def test_the_acceleration_of_the_parabolic_law_is_a_parabola() -> None:
    t = np.linspace(0.0, 0.25, 101)
    v = np.array([law_velocity(2, x, 0.25, 1.0, 0.25, 0.0, 50.0, 0.0) for x in t])
    middle = 0.5 * (t[1:] + t[:-1])
    parabola = 6.0 * 200.0 * (middle / 0.25) * (1.0 - middle / 0.25)
    assert np.diff(v) / np.diff(t) == pytest.approx(parabola, abs=0.2)


@given(
    st.floats(0.0, 100.0),
    st.floats(0.0, 900.0),
    st.sampled_from([-3e4, -5e3, 0.0, 5e3, 3e4]),
    st.floats(1e-4, 0.2),
)
def test_the_time_of_a_constant_jerk_is_found_from_its_ends(
    v0: float, a0: float, jerk: float, t: float
) -> None:
    if a0 + jerk * t < 0.0:  # the law is for accelerations of one sign
        t = -a0 / jerk
    way, v1 = jerk_distance(t, v0, a0, jerk), jerk_velocity(t, v0, a0, jerk)
    if way < 1e-9:
        return
    # forward, and the same motion run back as braking
    assert jerk_time(way, v0, v1, a0, a0 + jerk * t) == pytest.approx(t, rel=1e-6)
    assert jerk_time(way, v1, v0, -(a0 + jerk * t), -a0) == pytest.approx(t, rel=1e-6)
    slope = (jerk_distance(t + STEP, v0, a0, jerk) - jerk_distance(t - STEP, v0, a0, jerk)) / (2 * STEP)
    assert slope == pytest.approx(v1, rel=1e-6, abs=1e-6)
