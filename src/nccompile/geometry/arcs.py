"""Circular arcs by radius or by centre (SoftMotion §3.2.4)."""

from __future__ import annotations

from math import atan2, hypot, isfinite, pi, sqrt
from typing import NamedTuple

from nccompile.geometry.curve import XY, Curve, Impossible
from nccompile.geometry.tolerance import COINCIDENT, allowed_mismatch
from nccompile.kernels.curves import ARC

__all__ = ["Circle", "arc_by_center", "arc_by_radius", "meet", "through"]


class Circle(NamedTuple):
    """An arc's row: centre [mm], radius [mm], start angle and signed sweep [rad]."""

    cx: float
    cy: float
    radius: float
    start: float
    sweep: float


def arc_by_radius(x0: float, y0: float, x1: float, y1: float, radius: float, ccw: bool) -> Curve:
    r"""The arc of at most 180° from (x0, y0) to (x1, y1) with the given radius.

                  E                  C = M + h n        M: middle of the chord S-E,  d = |SE|
                / |                  h = sqrt(R² - (d/2)²)
           R  /   |  d/2             n: unit normal to the left of S->E
            /  h  |                  sweep = 2 atan2(d/2, h)
          C ----- M
            \     |                  Counter-clockwise the centre is on the left of the chord, clockwise on
           R  \   |  d/2             the right: h and sweep change their sign together.  atan2 instead of
                \ |                  asin(d / 2R) keeps all digits near the semicircle.
                  S

    Returns:  the arc; both ends are exact to rounding.  A radius too small by no more than `allowed_mismatch`
              becomes half the chord (a semicircle).
    Raises:   Impossible: radius not above 0, ends that coincide, ends farther apart than the diameter.
    Source:   SoftMotion §3.2.4; own derivation.
    """
    half = 0.5 * hypot(x1 - x0, y1 - y0)
    if not (radius > 0.0 and isfinite(radius)):
        raise Impossible(f"the radius must be greater than 0, not {radius:.6g}")
    if 2.0 * half <= COINCIDENT:
        raise Impossible("start and end of the arc are the same point, so its radius alone does not fix it")
    if half > radius:
        if half - radius > allowed_mismatch(radius):
            raise Impossible(
                f"the radius {radius:.6g} mm is {half - radius:.4g} mm too small: "
                f"start and end are {2.0 * half:.6g} mm apart"
            )
        radius = half
    return Curve(ARC, XY, tuple(_minor(x0, y0, x1, y1, float(radius), ccw)))


def arc_by_center(x0: float, y0: float, x1: float, y1: float, cx: float, cy: float, ccw: bool) -> Curve:
    """The arc from (x0, y0) to (x1, y1) about (cx, cy); a full circle if start and end are the same point.

    Raises:   Impossible: the centre is an end point, or the two radii differ by more than `allowed_mismatch`.
    Limits:   see `meet` for how a small difference is taken up.
    Source:   SoftMotion §3.2.4.
    """
    start = hypot(x0 - cx, y0 - cy)
    end = hypot(x1 - cx, y1 - cy)
    if not isfinite(start + end):
        raise Impossible("the centre or an end of the arc is not a finite number")
    if min(start, end) <= COINCIDENT:
        raise Impossible(f"the centre is the {'start' if start <= end else 'end'} point of the arc")
    if abs(end - start) > allowed_mismatch(max(start, end)):
        raise Impossible(
            f"the centre is {start:.6g} mm from the start but {end:.6g} mm from the end "
            f"({abs(end - start):.4g} mm difference)"
        )
    return Curve(ARC, XY, tuple(meet(x0, y0, x1, y1, cx, cy, ccw, allowed_mismatch(start))))


def meet(x0: float, y0: float, x1: float, y1: float, cx: float, cy: float, ccw: bool, most: float) -> Circle:
    """The circle next to the one about (cx, cy) that meets both ends exactly.

    Every circle through both ends has its centre on the perpendicular bisector of the chord, so the centre
    moves there on the shortest way, along the chord by m = (C - M).t:

            S ---- M ---- E  -> t        C' = C - m t      m = (r0² - r1²) / 2d
                   |   .
                   C'<- C

    On a short chord a rounding error of the ends moves the centre far (m grows with r / d), though an arc up
    to 180° hardly leaves its place.  If m > `most`, such an arc keeps its mean radius instead and stands on
    the chord as in `arc_by_radius`; a longer one would bulge by m on its far side.

    Args:     most: greatest move of the centre [mm].
    Raises:   Impossible: a sweep over 180° whose centre had to move by more than `most`.
    """
    d = hypot(x1 - x0, y1 - y0)
    if d <= COINCIDENT:
        radius = hypot(x0 - cx, y0 - cy)
        return Circle(cx, cy, radius, atan2(y0 - cy, x0 - cx), 2.0 * pi if ccw else -2.0 * pi)
    tx, ty = (x1 - x0) / d, (y1 - y0) / d
    move = (cx - 0.5 * (x0 + x1)) * tx + (cy - 0.5 * (y0 + y1)) * ty
    if abs(move) <= most:
        return through(x0, y0, x1, y1, cx - move * tx, cy - move * ty, ccw)
    left = tx * (cy - y0) - ty * (cx - x0) > 0.0
    if left != ccw:
        raise Impossible(
            f"start and end are only {d:.4g} mm apart: to meet both, the centre had to move by "
            f"{abs(move):.4g} mm"
        )
    radius = 0.5 * (hypot(x0 - cx, y0 - cy) + hypot(x1 - cx, y1 - cy))
    return _minor(x0, y0, x1, y1, max(radius, 0.5 * d), ccw)


def through(x0: float, y0: float, x1: float, y1: float, cx: float, cy: float, ccw: bool) -> Circle:
    """Radius and angles of the arc about (cx, cy), which is equally far from both ends.

    The sweep comes from cross and dot product of both radii: a small one keeps all its digits.
    """
    ax, ay, bx, by = x0 - cx, y0 - cy, x1 - cx, y1 - cy
    sweep = atan2(ax * by - ay * bx, ax * bx + ay * by)
    if ccw and sweep <= 0.0:
        sweep += 2.0 * pi
    if not ccw and sweep >= 0.0:
        sweep -= 2.0 * pi
    return Circle(cx, cy, hypot(ax, ay), atan2(ay, ax), sweep)


def _minor(x0: float, y0: float, x1: float, y1: float, radius: float, ccw: bool) -> Circle:
    """The arc of at most 180° with this radius >= half the chord (drawing: `arc_by_radius`)."""
    dx, dy = x1 - x0, y1 - y0
    d = hypot(dx, dy)
    half = 0.5 * d
    height = sqrt(max((radius - half) * (radius + half), 0.0))
    side = height / d if ccw else -height / d
    cx = 0.5 * (x0 + x1) - side * dy
    cy = 0.5 * (y0 + y1) + side * dx
    sweep = 2.0 * atan2(half, height)
    return Circle(cx, cy, radius, atan2(y0 - cy, x0 - cx), sweep if ccw else -sweep)
