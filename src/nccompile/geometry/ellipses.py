"""Ellipse arcs by centre, direction of the main axis and ratio (SoftMotion §3.2.5)."""

from __future__ import annotations

from math import cos, hypot, isfinite, sin

from nccompile.geometry.arcs import meet
from nccompile.geometry.curve import XY, Curve, Impossible
from nccompile.geometry.tolerance import COINCIDENT, allowed_mismatch
from nccompile.kernels.curves import ELLIPSE

__all__ = ["ellipse_by_center"]


def ellipse_by_center(
    x0: float, y0: float, x1: float, y1: float, cx: float, cy: float,
    direction: float, ratio: float, ccw: bool,
) -> Curve:  # fmt: skip
    """The ellipse arc from (x0, y0) to (x1, y1) about (cx, cy); a full one if the ends are the same point.

    Turned by -direction about the centre and stretched by 1/ratio across the main axis, the ellipse is a
    circle whose radius is the main half-axis and whose angles are the eccentric ones:

               eta                                       eta / ratio
                |   . P                                     |   * P'
            ----+-------. xi           ->                 .-+-.     radius = hypot(xi, eta / ratio)
           (____|____)                                   (  +  )--- xi
                                                          '---'
    So each end gives a main half-axis a0, a1; they must agree.  Across the ellipse a difference a1 - a0 is
    about (a1 - a0) / |grad a| mm, with grad a = (xi, eta / ratio²) / a; that is the error reported.  A small
    one is taken up as in `arcs.meet`, in the stretched plane: the centre moves, direction and ratio stay,
    and both ends are met exactly.

    Args:     direction: of the main axis [rad], counter-clockwise from the first axis;
              ratio: sub axis / main axis, > 0 (SoftMotion asks for at most 1).
    Raises:   Impossible: ratio not above 0, an end at the centre, an end off the ellipse of the other.
    Source:   SoftMotion §3.2.5; own derivation.
    """
    if not (ratio > 0.0 and isfinite(ratio)):
        raise Impossible(f"the ratio of the axes must be greater than 0, not {ratio:.6g}")
    c, s = cos(direction), sin(direction)

    def stretched(x: float, y: float) -> tuple[float, float]:
        return c * (x - cx) + s * (y - cy), (c * (y - cy) - s * (x - cx)) / ratio

    xi0, eta0 = stretched(x0, y0)
    xi1, eta1 = stretched(x1, y1)
    a0, a1 = hypot(xi0, eta0), hypot(xi1, eta1)
    if not isfinite(a0 + a1):
        raise Impossible("the centre, the direction or an end of the ellipse is not a finite number")
    if min(a0, a1) <= COINCIDENT:
        raise Impossible(f"the centre is the {'start' if a0 <= a1 else 'end'} point of the ellipse")
    most = allowed_mismatch(max(a0, a1))
    error = abs(a1 - a0) * a1 / hypot(xi1, eta1 / ratio)
    if error > most:
        raise Impossible(
            f"the end is {error:.4g} mm off the ellipse through the start "
            f"(main half-axis {a0:.6g} mm by the start, {a1:.6g} mm by the end)"
        )
    circle = meet(xi0, eta0, xi1, eta1, 0.0, 0.0, ccw, most / min(ratio, 1.0))
    shift_x, shift_y = circle.cx, circle.cy * ratio
    return Curve(
        ELLIPSE,
        XY,
        (
            cx + (c * shift_x - s * shift_y),
            cy + (s * shift_x + c * shift_y),
            circle.radius,
            circle.radius * ratio,
            direction,
            circle.start,
            circle.sweep,
        ),
    )
