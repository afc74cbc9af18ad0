"""The time law of one segment against numerical integration and its own promises."""

from __future__ import annotations

from math import isclose, pi, sqrt

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from nccompile.kernels.timelaw import LAW_NAMES, SIGMOID, law_distance, law_times, law_velocity

velocities = st.floats(0.0, 500.0)
accels = st.floats(10.0, 5000.0)


@given(st.floats(1e-6, 1e4), velocities, st.floats(0.1, 500.0), velocities, accels, accels)
def test_the_law_covers_the_length_inside_its_limits(
    length: float, v0: float, v_top: float, v_end: float, a: float, d: float
) -> None:
    t1, t2, t3, vp, v1 = law_times(length, v0, v_top, min(v_end, v_top), a, d)
    assert min(t1, t2, t3) >= 0.0
    total = t1 + t2 + t3
    for law in range(len(LAW_NAMES)):
        assert isclose(law_distance(law, total, t1, t2, t3, v0, vp, v1), length, rel_tol=1e-9, abs_tol=1e-12)
    assert max(v0, v1) <= vp * (1 + 1e-9) or v0 > v_top
    assert vp <= max(v_top, v0, v1) * (1 + 1e-12)
    if t1 > 0:
        assert abs(vp - v0) / t1 <= max(a, d) * (1 + 1e-6)
    if t3 > 0:
        assert (vp - v1) / t3 <= d * (1 + 1e-6)


@given(
    st.floats(0.5, 100.0), st.floats(0.0, 50.0), st.floats(60.0, 200.0), st.floats(0.0, 50.0), accels, accels
)
def test_distance_is_the_integral_of_velocity(
    length: float, v0: float, v_top: float, v_end: float, a: float, d: float
) -> None:
    t1, t2, t3, vp, v1 = law_times(length, v0, v_top, v_end, a, d)
    total = t1 + t2 + t3
    t = np.linspace(0.0, total, 4001)
    for law in range(len(LAW_NAMES)):
        v = np.array([law_velocity(law, x, t1, t2, t3, v0, vp, v1) for x in t])
        s = np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1]) * np.diff(t))])
        mine = np.array([law_distance(law, x, t1, t2, t3, v0, vp, v1) for x in t])
        assert np.abs(mine - s).max() <= 1e-4 * length


def test_both_laws_take_the_same_time_and_the_sigmoid_peaks_at_half_pi() -> None:
    # SoftMotion §6.2.8: the sigmoid exceeds the programmed acceleration by pi/2 at most
    t1, t2, t3, vp, v1 = law_times(100.0, 0.0, 50.0, 0.0, 200.0, 400.0)
    assert (t1, t3) == (0.25, 0.125)
    assert isclose(t1 + t2 + t3, 0.25 + 0.125 + (100.0 - 50 * 0.375 / 2) / 50)
    t = np.linspace(0.0, t1, 2001)
    v = np.array([law_velocity(SIGMOID, x, t1, t2, t3, 0.0, vp, v1) for x in t])
    accel = np.diff(v) / np.diff(t)
    assert isclose(float(accel.max()), 200.0 * pi / 2, rel_tol=1e-5)
    assert accel[0] < 1.0
    assert accel[-1] < 1.0


def test_a_segment_too_short_to_brake_gives_the_reached_velocity() -> None:
    *_, v1 = law_times(1.0, 100.0, 100.0, 0.0, 1000.0, 1000.0)
    assert isclose(v1, sqrt(100.0**2 - 2000.0))


def test_a_planned_stop_is_a_stop_within_rounding() -> None:
    v0 = sqrt(2 * 333.3 * 7.7)
    *_, v1 = law_times(7.7 * (1 - 1e-13), v0, 200.0, 0.0, 100.0, 333.3)
    assert v1 == 0.0


def test_a_lowered_top_velocity_is_approached_by_braking() -> None:
    t1, t2, t3, vp, v1 = law_times(50.0, 100.0, 40.0, 0.0, 1000.0, 1000.0)
    assert (vp, v1) == (40.0, 0.0)
    assert isclose(t1, 0.06)
    assert t2 > 0
    assert isclose(t3, 0.04)
