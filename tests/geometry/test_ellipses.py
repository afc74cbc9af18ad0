"""Ellipses: the manual's example, lengths against elliptic integrals, ends met."""

from __future__ import annotations

from math import cos, hypot, pi, radians, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import ellipe, ellipeinc

from nccompile.geometry import Curve, Impossible, ellipse_by_center
from nccompile.kernels.curves import ELLIPSE

ratios = st.sampled_from([1.0, 0.5, 0.1, 1e-2, 1e-3])
sizes = st.sampled_from([1e-4, 1.0, 1e2, 1e6])


def ellipse(main: float, ratio: float, start: float, sweep: float) -> Curve:
    return Curve(ELLIPSE, 0, (3.0, -2.0, main, main * ratio, 0.4, start, sweep))


def legendre_length(main: float, ratio: float, start: float, sweep: float) -> float:
    """Main half-axis x the incomplete integral of the second kind, from the end of the sub axis."""
    m = 1.0 - ratio * ratio
    return float(abs(main * (ellipeinc(pi / 2 - start, m) - ellipeinc(pi / 2 - start - sweep, m))))


def test_the_manuals_ellipse() -> None:
    curve = ellipse_by_center(100.0, 100.0, 200.0, 100.0, 150.0, 100.0, radians(45.0), 0.5, ccw=False)
    cx, cy, main, sub, direction, _, sweep = curve.parameters
    assert (cx, cy, direction) == (150.0, 100.0, radians(45.0))
    # (-50, 0) in main-axis coordinates is (-50, 50) / sqrt 2, so main² = 1250 + 4 x 1250
    assert main == pytest.approx(np.sqrt(6250.0), rel=1e-15)
    assert sub == main * 0.5
    assert sweep == pytest.approx(-pi, rel=1e-15)
    assert curve.point(0.0) == pytest.approx((100.0, 100.0), rel=1e-14)
    assert curve.point(1.0) == pytest.approx((200.0, 100.0), rel=1e-14)
    assert curve.point(0.5)[1] > 100.0  # clockwise from west: over the top
    assert curve.length == pytest.approx(2.0 * main * ellipe(0.75), rel=1e-14)  # half of the circumference
    for u in np.linspace(0.0, 1.0, 21).tolist():
        x, y = curve.point(u)
        xi = (x - 150.0) * cos(direction) + (y - 100.0) * sin(direction)
        eta = (y - 100.0) * cos(direction) - (x - 150.0) * sin(direction)
        assert (xi / main) ** 2 + (eta / sub) ** 2 == pytest.approx(1.0, rel=1e-13)


@given(sizes, ratios, st.floats(-pi, pi), st.floats(0.5, 2 * pi), st.booleans())
def test_lengths_agree_with_elliptic_integrals(
    main: float, ratio: float, start: float, sweep: float, ccw: bool
) -> None:
    signed = sweep if ccw else -sweep
    assert ellipse(main, ratio, start, signed).length == pytest.approx(
        legendre_length(main, ratio, start, signed), rel=1e-12
    )


@pytest.mark.parametrize("ratio", [1.0, 0.3, 1e-3, 1e-4, 1e-6])
def test_full_ellipses_have_the_complete_integral(ratio: float) -> None:
    assert ellipse(10.0, ratio, 1.234, 2 * pi).length == pytest.approx(
        40.0 * ellipe(1 - ratio * ratio), rel=1e-12
    )


@given(
    st.floats(0.1, 1e3), st.floats(1e-3, 1.0), st.floats(-7.0, 7.0), st.floats(-pi, pi), st.floats(0.2, 6.0),
    st.booleans(),
)  # fmt: skip
def test_both_ends_are_met(
    main: float, ratio: float, direction: float, start: float, sweep: float, ccw: bool
) -> None:
    made = Curve(ELLIPSE, 0, (7.0, -3.0, main, main * ratio, direction, start, sweep if ccw else -sweep))
    (x0, y0), (x1, y1) = made.point(0.0), made.point(1.0)
    curve = ellipse_by_center(x0, y0, x1, y1, 7.0, -3.0, direction, ratio, ccw)
    assert curve.parameters[3] == pytest.approx(main * ratio, rel=1e-6)
    (ax, ay), (bx, by) = curve.point(0.0), curve.point(1.0)
    assert max(hypot(ax - x0, ay - y0), hypot(bx - x1, by - y1)) <= 1e-13 * (10.0 + main)


def test_start_equal_to_end_is_a_full_ellipse() -> None:
    curve = ellipse_by_center(10.0, 0.0, 10.0, 0.0, 0.0, 0.0, 0.0, 0.25, ccw=False)
    assert curve.parameters == (0.0, 0.0, 10.0, 2.5, 0.0, 0.0, -2 * pi)


def test_a_rounded_end_is_met_by_moving_the_centre() -> None:
    curve = ellipse_by_center(30.0, 0.0, 0.0, 10.004, 0.0, 0.0, 0.0, 1.0 / 3.0, ccw=True)
    assert curve.point(1.0) == pytest.approx((0.0, 10.004), abs=1e-13)
    assert curve.point(0.0) == pytest.approx((30.0, 0.0), abs=1e-13)
    assert hypot(*curve.parameters[:2]) < 0.02
    assert curve.parameters[3] / curve.parameters[2] == pytest.approx(1.0 / 3.0, rel=1e-15)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            (30.0, 0.0, 0.0, 10.5, 0.0, 0.0, 0.0, 1 / 3),
            r"the end is 0\.5 mm off the ellipse through the start",
        ),
        ((30.0, 0.0, 0.0, 10.0, 0.0, 0.0, 0.0, 0.0), "the ratio of the axes must be greater than 0, not 0"),
        ((30.0, 0.0, 0.0, 10.0, 30.0, 0.0, 0.0, 0.5), "the centre is the start point of the ellipse"),
        ((30.0, 0.0, 0.0, float("nan"), 0.0, 0.0, 0.0, 0.5), "not a finite number"),
    ],
)
def test_an_impossible_ellipse_says_why(
    arguments: tuple[float, float, float, float, float, float, float, float], message: str
) -> None:
    with pytest.raises(Impossible, match=message):
        ellipse_by_center(*arguments, True)
