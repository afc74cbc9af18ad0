"""Circular arcs from their ends and radius or centre: the arithmetic that geometry and columnar decoding share.

Drawings and derivations: `geometry.arcs`.  Results go to `out`, Shape (5,): centre x, y, radius, start angle,
sweep.  Every function returns what kept it from making an arc, DONE if nothing did.
"""

from __future__ import annotations

from math import atan2, inf, pi, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = [
    "APART", "AT_CENTRE", "DONE", "NOT_FINITE", "NO_RADIUS", "ONE_POINT", "TOO_NEAR", "TOO_SMALL", "by_centre",
    "by_radius", "distance", "meet", "minor", "through",
]  # fmt: skip

Floats = npt.NDArray[np.float64]

DONE = 0
NO_RADIUS = 1  # the radius is not above 0
ONE_POINT = 2  # start and end coincide, so the radius does not fix the arc
TOO_SMALL = 3  # the ends are farther apart than the diameter
NOT_FINITE = 4
AT_CENTRE = 5  # the centre is an end
APART = 6  # both ends have different radii
TOO_NEAR = 7  # to meet both ends the centre had to move too far


@kernel
def distance(x: float, y: float) -> float:
    """The length of a vector; libraries differ in the last bit of `hypot`, IEEE operations do not."""
    return sqrt(x * x + y * y)


@kernel
def allowed(radius: float, mismatch: float, ratio: float, most: float) -> float:
    """How far the ends of an arc may be from one circle (`geometry.tolerance.allowed_mismatch`)."""
    return min(max(mismatch, ratio * radius), most)


@kernel
def minor(x0: float, y0: float, x1: float, y1: float, radius: float, ccw: bool, out: Floats) -> None:
    """The arc of at most 180 degrees with this radius >= half the chord."""
    dx = x1 - x0
    dy = y1 - y0
    d = distance(dx, dy)
    half = 0.5 * d
    height = sqrt(max((radius - half) * (radius + half), 0.0))
    side = height / d if ccw else -height / d
    cx = 0.5 * (x0 + x1) - side * dy
    cy = 0.5 * (y0 + y1) + side * dx
    sweep = 2.0 * atan2(half, height)
    out[0] = cx
    out[1] = cy
    out[2] = radius
    out[3] = atan2(y0 - cy, x0 - cx)
    out[4] = sweep if ccw else -sweep


@kernel
def through(
    x0: float, y0: float, x1: float, y1: float, cx: float, cy: float, ccw: bool, out: Floats
) -> None:  # fmt: skip
    """The arc about (cx, cy), which is equally far from both ends."""
    ax = x0 - cx
    ay = y0 - cy
    bx = x1 - cx
    by = y1 - cy
    sweep = atan2(ax * by - ay * bx, ax * bx + ay * by)
    if ccw and sweep <= 0.0:
        sweep += 2.0 * pi
    if not ccw and sweep >= 0.0:
        sweep -= 2.0 * pi
    out[0] = cx
    out[1] = cy
    out[2] = distance(ax, ay)
    out[3] = atan2(ay, ax)
    out[4] = sweep


@kernel
def meet(
    x0: float, y0: float, x1: float, y1: float, cx: float, cy: float, ccw: bool, most: float, coincident: float,
    out: Floats,
) -> int:  # fmt: skip
    """The arc on the circle next to the one about (cx, cy) that meets both ends; DONE or TOO_NEAR."""
    d = distance(x1 - x0, y1 - y0)
    if d <= coincident:
        out[0] = cx
        out[1] = cy
        out[2] = distance(x0 - cx, y0 - cy)
        out[3] = atan2(y0 - cy, x0 - cx)
        out[4] = 2.0 * pi if ccw else -2.0 * pi
        return DONE
    tx = (x1 - x0) / d
    ty = (y1 - y0) / d
    move = (cx - 0.5 * (x0 + x1)) * tx + (cy - 0.5 * (y0 + y1)) * ty
    if abs(move) <= most:
        through(x0, y0, x1, y1, cx - move * tx, cy - move * ty, ccw, out)
        return DONE
    left = tx * (cy - y0) - ty * (cx - x0) > 0.0
    if left != ccw:
        out[0] = move
        return TOO_NEAR
    radius = 0.5 * (distance(x0 - cx, y0 - cy) + distance(x1 - cx, y1 - cy))
    minor(x0, y0, x1, y1, max(radius, 0.5 * d), ccw, out)
    return DONE


@kernel
def by_radius(
    x0: float, y0: float, x1: float, y1: float, radius: float, ccw: bool, coincident: float, mismatch: float,
    ratio: float, most: float, out: Floats,
) -> int:  # fmt: skip
    """The arc of at most 180 degrees with the given radius; DONE, NO_RADIUS, ONE_POINT or TOO_SMALL."""
    half = 0.5 * distance(x1 - x0, y1 - y0)
    if not (radius > 0.0 and radius < inf):
        return NO_RADIUS
    if 2.0 * half <= coincident:
        return ONE_POINT
    if half > radius:
        if half - radius > allowed(radius, mismatch, ratio, most):
            return TOO_SMALL
        radius = half
    minor(x0, y0, x1, y1, radius, ccw, out)
    return DONE


@kernel
def by_centre(
    x0: float, y0: float, x1: float, y1: float, cx: float, cy: float, ccw: bool, coincident: float,
    mismatch: float, ratio: float, most: float, out: Floats,
) -> int:  # fmt: skip
    """The arc about a centre; DONE, NOT_FINITE, AT_CENTRE, APART or TOO_NEAR."""
    start = distance(x0 - cx, y0 - cy)
    end = distance(x1 - cx, y1 - cy)
    if not start + end < inf:
        return NOT_FINITE
    if min(start, end) <= coincident:
        return AT_CENTRE
    if abs(end - start) > allowed(max(start, end), mismatch, ratio, most):
        return APART
    return meet(x0, y0, x1, y1, cx, cy, ccw, allowed(start, mismatch, ratio, most), coincident, out)
