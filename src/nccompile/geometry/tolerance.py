"""Every epsilon of the geometry, with its reason; no literal tolerance elsewhere.

Programs carry 3 or 4 decimals in mm.  The end of an arc and its centre are rounded on their own, so the two
radii of a correct program differ by up to about 1.5e-3 mm; hand-written ones and inch programs converted to
mm by up to 3e-3 mm.  Computing in binary64 adds about 1e-16 of the largest coordinate.
"""

__all__ = [
    "ARC_MISMATCH", "ARC_MISMATCH_MOST", "ARC_MISMATCH_RATIO", "COINCIDENT", "LENGTH_RATIO", "MEETING", "MEETING_RATIO",
    "PARALLEL", "allowed_mismatch",
]  # fmt: skip

ARC_MISMATCH = 0.01
"""[mm] A radius may differ at the two ends of an arc, a semicircle's R be too small, or a point miss its
ellipse by this much: three times the worst real program, and below what a machine that mills with 0.01 mm
shows on the part."""

ARC_MISMATCH_RATIO = 1e-3
"""The same for large arcs, as a part of the radius: programs that state the centre with few digits."""

ARC_MISMATCH_MOST = 0.5
"""[mm] More than this is a mistake at any radius."""

COINCIDENT = 1e-9
"""[mm] Points nearer than this are one point: sums of relative moves (0.1 + 0.2) miss by 1e-16 of the path,
and no program states a picometre.  Decides between a full circle and an arc of no length."""

PARALLEL = 1e-9
"""Sine of the angle below which two directions are parallel: a parabola's tangents that flat meet nowhere."""

MEETING = 2e-9
"""[mm] A curve's ends may miss the chain's positions by this much: the end of a full circle is the start to
COINCIDENT, and the rest is for rounding.  The interpolator puts out the chain's position at the very end."""

MEETING_RATIO = 1e-14
"""The same as a part of the largest number in the curve row: a radius of 1e6 mm has digits of 1e-10 mm, and
an end point is computed from some tens of them."""

LENGTH_RATIO = 1e-12
"""A stored length may differ from the geometry's by this part of itself."""


def allowed_mismatch(radius: float) -> float:
    """How far [mm] the ends of an arc of this radius may be from one circle."""
    return min(max(ARC_MISMATCH, ARC_MISMATCH_RATIO * radius), ARC_MISMATCH_MOST)
