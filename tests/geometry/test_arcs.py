"""Arcs by radius and centre: both ends exact, the right side, honest refusals."""

from __future__ import annotations

from math import atan2, cos, hypot, inf, isclose, pi, sin

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from nccompile.geometry import Curve, Impossible, arc_by_center, arc_by_radius
from nccompile.geometry.tolerance import allowed_mismatch
from nccompile.kernels.curves import ARC
from nccompile.toolpath.columns import Kind

DIGITS = 1e-14  # of the largest number that enters a point

coordinates = st.floats(-1e4, 1e4)
scales = st.sampled_from([1e-4, 1e-2, 1.0, 1e3, 1e6])
angles = st.floats(-pi, pi)
senses = st.booleans()


def ends_off(curve: Curve, x0: float, y0: float, x1: float, y1: float) -> float:
    """The greater distance [mm] of the curve's ends from the wanted ones."""
    (ax, ay), (bx, by) = curve.point(0.0), curve.point(1.0)
    return max(hypot(ax - x0, ay - y0), hypot(bx - x1, by - y1))


def allowed(curve: Curve) -> float:
    cx, cy, r, _, _ = curve.parameters
    return DIGITS * (abs(cx) + abs(cy) + r)


def test_the_kernel_counts_kinds_as_the_toolpath_does() -> None:
    from nccompile.kernels import curves

    assert (curves.ARC, curves.ELLIPSE, curves.POLYNOMIAL) == (Kind.ARC, Kind.ELLIPSE, Kind.POLYNOMIAL)


def test_the_manuals_semicircle_is_the_same_by_radius_and_by_centre() -> None:
    by_radius = arc_by_radius(100.0, 100.0, 200.0, 100.0, 50.0, ccw=False)
    by_center = arc_by_center(100.0, 100.0, 200.0, 100.0, 150.0, 100.0, ccw=False)
    assert by_radius == by_center
    assert by_radius.parameters == (150.0, 100.0, 50.0, pi, -pi)
    assert by_radius.point(0.5) == pytest.approx(
        (150.0, 150.0), abs=1e-12
    )  # clockwise from west: over the top


@given(coordinates, coordinates, scales, angles, st.floats(1e-6, 1.0), senses)
def test_an_arc_by_radius_meets_both_ends_and_stays_within_180_degrees(
    x: float, y: float, radius: float, heading: float, ratio: float, ccw: bool
) -> None:
    chord = 2.0 * radius * ratio
    x1, y1 = x + chord * cos(heading), y + chord * sin(heading)
    assume(1e-8 < hypot(x1 - x, y1 - y) <= 2.0 * radius)
    curve = arc_by_radius(x, y, x1, y1, radius, ccw)
    assert curve.kind == ARC
    assert ends_off(curve, x, y, x1, y1) <= allowed(curve) * 4
    assert (curve.parameters[4] > 0.0) == ccw
    assert abs(curve.parameters[4]) <= pi * (1.0 + 1e-15)
    cx, cy, r = curve.parameters[:3]
    mx, my = curve.point(0.37)
    assert isclose(hypot(mx - cx, my - cy), r, rel_tol=1e-12, abs_tol=allowed(curve))
    # The side of the chord the arc bulges to: right of the motion if counter-clockwise.
    side = (x1 - x) * (my - y) - (y1 - y) * (mx - x)
    assert (side if ccw else -side) <= 4 * allowed(curve) * chord


@given(coordinates, coordinates, scales, angles, st.floats(1e-3, 2 * pi - 1e-3), senses)
def test_an_arc_by_centre_has_the_sweep_it_was_made_from(
    cx: float, cy: float, radius: float, start: float, sweep: float, ccw: bool
) -> None:
    signed = sweep if ccw else -sweep
    x0, y0 = cx + radius * cos(start), cy + radius * sin(start)
    x1, y1 = cx + radius * cos(start + signed), cy + radius * sin(start + signed)
    noise = 1e-12 * (abs(cx) + abs(cy)) / radius  # the ends are rounded to the digits of the centre
    assume(hypot(x1 - x0, y1 - y0) > 1e-8 and noise < 1e-2 * min(sweep, 2 * pi - sweep))
    curve = arc_by_center(x0, y0, x1, y1, cx, cy, ccw)
    assert curve.parameters[4] == pytest.approx(signed, abs=4 * noise + 1e-12)
    assert curve.parameters[2] == pytest.approx(radius, rel=4 * noise / min(sweep, 2 * pi - sweep) + 1e-12)
    assert ends_off(curve, x0, y0, x1, y1) <= 4 * allowed(curve)
    assert curve.length == curve.parameters[2] * abs(curve.parameters[4])


@given(
    st.floats(0.5, 500.0), angles, st.floats(0.05, pi), senses, st.floats(-0.004, 0.004), st.floats(-pi, pi)
)
def test_a_rounded_end_moves_the_centre_and_is_met(
    radius: float, start: float, sweep: float, ccw: bool, error: float, where: float
) -> None:
    signed = sweep if ccw else -sweep
    x0, y0 = radius * cos(start), radius * sin(start)
    x1 = radius * cos(start + signed) + error * cos(where)
    y1 = radius * sin(start + signed) + error * sin(where)
    curve = arc_by_center(x0, y0, x1, y1, 0.0, 0.0, ccw)
    assert ends_off(curve, x0, y0, x1, y1) <= 4 * allowed(curve)
    for u in (0.25, 0.5, 0.75):  # no point is farther from the programmed circle than the tolerance
        px, py = curve.point(u)
        assert abs(hypot(px, py) - radius) <= allowed_mismatch(radius)


def test_a_tiny_arc_with_rounded_ends_keeps_its_radius() -> None:
    # 2 um of a 50 mm radius, ends rounded to 0.5 um: the bisector is tilted by 14 degrees.
    curve = arc_by_center(50.0, 0.0, 49.9995, 0.002, 0.0, 0.0, ccw=True)
    assert curve.parameters[2] == pytest.approx(50.0, abs=1e-3)
    assert 0.0 < curve.parameters[4] < 1e-4
    assert ends_off(curve, 50.0, 0.0, 49.9995, 0.002) < 1e-11


def test_a_nearly_full_circle_whose_ends_do_not_fit_is_refused() -> None:
    with pytest.raises(Impossible, match=r"only 0\.002\d* mm apart"):
        arc_by_center(50.0, 0.0, 49.9995, -0.002, 0.0, 0.0, ccw=True)


@pytest.mark.parametrize("ccw", [True, False])
def test_start_equal_to_end_is_a_full_circle(ccw: bool) -> None:
    curve = arc_by_center(10.0, 0.0, 10.0, 0.0, 4.0, 8.0, ccw)
    assert curve.parameters == (4.0, 8.0, 10.0, atan2(-8.0, 6.0), 2 * pi if ccw else -2 * pi)
    assert curve.length == 20.0 * pi
    # 0.1 + 0.2 is not 0.3: sums of relative moves still close the circle
    assert abs(arc_by_center(0.3, 0.0, 0.1 + 0.2, 0.0, 1.0, 0.0, ccw).parameters[4]) == 2 * pi


def test_tangents_are_square_to_the_radius_in_the_direction_of_motion() -> None:
    curve = arc_by_center(0.0, 0.0, 20.0, 0.0, 10.0, 0.0, ccw=False)
    assert curve.start_tangent == pytest.approx((0.0, 1.0), abs=1e-15)
    assert curve.end_tangent == pytest.approx((0.0, -1.0), abs=1e-15)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0.0, 0.0, 20.0, 0.0, 9.0), r"the radius 9 mm is 1 mm too small: start and end are 20 mm apart"),
        ((0.0, 0.0, 20.0, 0.0, 0.0), "the radius must be greater than 0, not 0"),
        ((0.0, 0.0, 20.0, 0.0, -10.0), "the radius must be greater than 0, not -10"),
        ((0.0, 0.0, 20.0, 0.0, inf), "the radius must be greater than 0, not inf"),
        ((5.0, 5.0, 5.0, 5.0, 3.0), "start and end of the arc are the same point"),
    ],
)
def test_an_impossible_radius_says_why(
    arguments: tuple[float, float, float, float, float], message: str
) -> None:
    with pytest.raises(Impossible, match=message):
        arc_by_radius(*arguments, True)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            (0.0, 0.0, 20.0, 0.0, 10.5, 0.0),
            r"10\.5 mm from the start but 9\.5 mm from the end \(1 mm difference",
        ),
        ((0.0, 0.0, 20.0, 0.0, 0.0, 0.0), "the centre is the start point"),
        ((0.0, 0.0, 20.0, 0.0, 20.0, 0.0), "the centre is the end point"),
        ((0.0, 0.0, 20.0, 0.0, inf, 0.0), "not a finite number"),
    ],
)
def test_an_impossible_centre_says_why(
    arguments: tuple[float, float, float, float, float, float], message: str
) -> None:
    with pytest.raises(Impossible, match=message):
        arc_by_center(*arguments, True)


def test_a_radius_too_small_by_rounding_becomes_a_semicircle() -> None:
    curve = arc_by_radius(0.0, 0.0, 20.0, 0.0, 9.995, ccw=True)
    assert curve.parameters[2] == 10.0
    assert curve.parameters[4] == pi
