"""The box that each segment stays in: exact for arcs, ellipses and cubics, all segments at once.

A coordinate of a curve is greatest or least at an end or where its derivative is zero.  For an arc these are
the multiples of 90 degrees, for an ellipse two eccentric angles and those opposite, for a cubic the roots of
a quadratic.  Axes outside the curve's plane run monotonically (linear or in the S-profile): the ends do.
"""

from __future__ import annotations

import numpy as np

from nccompile.toolpath.columns import Floats, Kind, Plane, Toolpath

__all__ = ["extents"]

_AXES = {Plane.XY: (0, 1), Plane.ZX: (2, 0), Plane.YZ: (1, 2)}
_FULL = 2.0 * np.pi


def extents(chunk: Toolpath) -> tuple[Floats, Floats]:
    """Least and greatest coordinates of each segment [mm or deg]: two arrays of shape (n, k)."""
    starts = chunk.starts()
    jumps = chunk.kind == Kind.SET_POSITION
    starts = np.where(jumps[:, None], chunk.target, starts)  # the path is not passed between the two
    low, high = np.minimum(starts, chunk.target), np.maximum(starts, chunk.target)
    curved = np.flatnonzero(chunk.curve >= 0)
    if not len(curved):
        return low, high
    tables = chunk.curve[curved]
    kinds, planes = chunk.kind[curved], chunk.curves.plane[tables]
    for kind in (Kind.ARC, Kind.ELLIPSE, Kind.POLYNOMIAL):
        for plane in Plane:
            here = (kinds == kind) & (planes == plane)
            if here.any():
                _widen(low, high, curved[here], kind, plane, chunk.curves.parameters[tables[here]])
    return low, high


def _widen(low: Floats, high: Floats, rows: np.ndarray, kind: Kind, plane: Plane, p: Floats) -> None:
    """Takes the inner extremes of some curves of one kind and plane into the boxes `low`, `high`."""
    axes = (0, 1, 2) if plane == Plane.SPACE else _AXES[plane]
    for coordinate, axis in enumerate(axes):
        if kind == Kind.POLYNOMIAL:
            values = _cubic_extremes(p[:, 4 * coordinate : 4 * coordinate + 4])
        else:
            values = _ellipse_extremes(p if kind == Kind.ELLIPSE else _as_ellipse(p), coordinate)
        low[rows, axis] = np.fmin(low[rows, axis], np.fmin.reduce(values, axis=1))
        high[rows, axis] = np.fmax(high[rows, axis], np.fmax.reduce(values, axis=1))


def _as_ellipse(arc: Floats) -> Floats:
    """Arc rows (centre, radius, start, sweep) as ellipse rows with equal half-axes."""
    zero = np.zeros(len(arc))
    return np.column_stack([arc[:, 0], arc[:, 1], arc[:, 2], arc[:, 2], zero, arc[:, 3], arc[:, 4]])


def _ellipse_extremes(p: Floats, coordinate: int) -> Floats:
    """Shape (m, 2): coordinate u (0) or v (1) at its two extremes, NaN where the sweep does not pass them.

    u = cu + main cos e cos d - sub sin e sin d     du/de = 0 at tan e = -sub sin d / (main cos d)
    v = cv + main cos e sin d + sub sin e cos d     dv/de = 0 at tan e =  sub cos d / (main sin d)
    """
    centre, main, sub, direction = p[:, coordinate], p[:, 2], p[:, 3], p[:, 4]
    cos_part = main * (np.cos(direction) if coordinate == 0 else np.sin(direction))
    sin_part = sub * (-np.sin(direction) if coordinate == 0 else np.cos(direction))
    amplitude = np.hypot(cos_part, sin_part)
    angle = np.arctan2(sin_part, cos_part)
    first = np.minimum(p[:, 5], p[:, 5] + p[:, 6])
    values = np.column_stack([centre + amplitude, centre - amplitude])
    passed = np.column_stack([angle - first, angle + np.pi - first]) % _FULL <= np.abs(p[:, 6])[:, None]
    return np.where(passed, values, np.nan)


def _cubic_extremes(c: Floats) -> Floats:
    """Shape (m, 2): c0 + c1 t + c2 t² + c3 t³ where its derivative is zero in 0..1, NaN where it is not.

    With a = 3 c3, b = c2, d = b² - a c1 and q = -(b + sign(b) sqrt(d)) the roots are q / a and c1 / q;
    this form of the quadratic formula does not cancel.
    """
    a, b = 3.0 * c[:, 3], c[:, 2]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        q = -(b + np.copysign(np.sqrt(b * b - a * c[:, 1]), b))
        roots = np.column_stack([q / a, c[:, 1] / q])
        inside = (roots >= 0.0) & (roots <= 1.0)
    t = np.where(inside, roots, np.nan)
    return c[:, 0:1] + t * (c[:, 1:2] + t * (c[:, 2:3] + t * c[:, 3:4]))
