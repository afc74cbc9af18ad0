"""Circular arcs by radius or by centre (SoftMotion §3.2.4)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nccompile.geometry.curve import XY, Curve, Impossible
from nccompile.geometry.tolerance import ARC_MISMATCH, ARC_MISMATCH_MOST, ARC_MISMATCH_RATIO, COINCIDENT
from nccompile.kernels import arcs as kernels
from nccompile.kernels.arcs import distance
from nccompile.kernels.curves import ARC

__all__ = ["TOLERANCES", "Circle", "arc_by_center", "arc_by_radius", "meet"]

TOLERANCES = (COINCIDENT, ARC_MISMATCH, ARC_MISMATCH_RATIO, ARC_MISMATCH_MOST)
"""What the kernels need of `geometry.tolerance`, in their order."""


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
    x0, y0, x1, y1, radius = float(x0), float(y0), float(x1), float(y1), float(radius)
    row = np.empty(5)
    status = kernels.by_radius(x0, y0, x1, y1, radius, bool(ccw), *TOLERANCES, row)
    if status == kernels.NO_RADIUS:
        raise Impossible(f"the radius must be greater than 0, not {radius:.6g}")
    if status == kernels.ONE_POINT:
        raise Impossible("start and end of the arc are the same point, so its radius alone does not fix it")
    if status == kernels.TOO_SMALL:
        half = 0.5 * distance(x1 - x0, y1 - y0)
        raise Impossible(
            f"the radius {radius:.6g} mm is {half - radius:.4g} mm too small: "
            f"start and end are {2.0 * half:.6g} mm apart"
        )
    return Curve(ARC, XY, tuple(row.tolist()))


def arc_by_center(x0: float, y0: float, x1: float, y1: float, cx: float, cy: float, ccw: bool) -> Curve:
    """The arc from (x0, y0) to (x1, y1) about (cx, cy); a full circle if start and end are the same point.

    Raises:   Impossible: the centre is an end point, or the two radii differ by more than `allowed_mismatch`.
    Limits:   see `meet` for how a small difference is taken up.
    Source:   SoftMotion §3.2.4.
    """
    x0, y0, x1, y1, cx, cy = float(x0), float(y0), float(x1), float(y1), float(cx), float(cy)
    row = np.empty(5)
    status = kernels.by_centre(x0, y0, x1, y1, cx, cy, bool(ccw), *TOLERANCES, row)
    if status == kernels.DONE:
        return Curve(ARC, XY, tuple(row.tolist()))
    if status == kernels.NOT_FINITE:
        raise Impossible("the centre or an end of the arc is not a finite number")
    start = distance(x0 - cx, y0 - cy)
    end = distance(x1 - cx, y1 - cy)
    if status == kernels.AT_CENTRE:
        raise Impossible(f"the centre is the {'start' if start <= end else 'end'} point of the arc")
    if status == kernels.APART:
        raise Impossible(
            f"the centre is {start:.6g} mm from the start but {end:.6g} mm from the end "
            f"({abs(end - start):.4g} mm difference)"
        )
    raise _too_near(x0, y0, x1, y1, float(row[0]))


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
    row = np.empty(5)
    status = kernels.meet(
        float(x0), float(y0), float(x1), float(y1), float(cx), float(cy), bool(ccw), float(most), COINCIDENT, row
    )  # fmt: skip
    if status == kernels.TOO_NEAR:
        raise _too_near(x0, y0, x1, y1, float(row[0]))
    return Circle(*row.tolist())


def _too_near(x0: float, y0: float, x1: float, y1: float, move: float) -> Impossible:
    return Impossible(
        f"start and end are only {distance(x1 - x0, y1 - y0):.4g} mm apart: to meet both, the centre had to "
        f"move by {abs(move):.4g} mm"
    )
