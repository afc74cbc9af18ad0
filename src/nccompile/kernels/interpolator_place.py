"""Where the path is: position and direction at a path length of a planned row (SoftMotion §6.2.8)."""

from __future__ import annotations

from math import sqrt

from nccompile.kernels import kernel
from nccompile.kernels.curves import derivative, derivative3, parameter, point3
from nccompile.kernels.interpolator_rows import ARC, Floats, Rows
from nccompile.kernels.planes import SPACE, plane_axes

__all__ = ["direction", "locate"]


@kernel
def locate(rows: Rows, row: int, s: float, nodes_u: Floats, nodes_s: Floats, count: int, out: Floats) -> None:
    """Writes the position at path length `s` of a row to `out` (k,); the row's very end is its target.

    X-Y (the curve's plane) run on the curve, all other axes linearly in path length, or where the S-profile
    is on with 10 w³ - 15 w⁴ + 6 w⁵ of w = s / L, which starts and ends at rest (SoftMotion §6.2.8).
    """
    length = rows.length[row]
    if s >= length:
        for a in range(len(out)):
            out[a] = rows.target[row, a]
        return
    w = s / length
    bits = rows.profile[row]
    for a in range(len(out)):
        share = w
        if (bits >> a) & 1:
            share = w * w * w * (10.0 + w * (6.0 * w - 15.0))
        begin = rows.start[row, a]
        out[a] = begin + (rows.target[row, a] - begin) * share
    curve = rows.curve[row]
    if curve >= 0:
        p, kind = rows.parameters[curve], rows.kind[row]
        u = w if kind == ARC else parameter(kind, p, nodes_u, nodes_s, count, w * nodes_s[count - 1])
        x, y, z = point3(kind, p, u)
        first, second = plane_axes(rows.plane[curve])
        out[first] = x
        out[second] = y
        if rows.plane[curve] == SPACE:
            out[2] = z


@kernel
def direction(
    rows: Rows, row: int, s: float, nodes_u: Floats, nodes_s: Floats, count: int, out: Floats
) -> None:
    """Writes the unit direction of the path in X, Y, Z at path length `s` of a row to `out` (3,)."""
    length = rows.length[row]
    w = min(s / length, 1.0) if length > 0.0 else 1.0
    bits = rows.profile[row]
    for a in range(3):
        slope = rows.target[row, a] - rows.start[row, a]
        if (bits >> a) & 1:
            slope *= 30.0 * w * w * (1.0 - w) * (1.0 - w)
        out[a] = slope
    curve = rows.curve[row]
    if curve >= 0:
        p = rows.parameters[curve]
        kind = rows.kind[row]
        plane = rows.plane[curve]
        if kind == ARC:
            in_plane = p[2] * abs(p[4])
            u = w
        else:
            in_plane = nodes_s[count - 1]
            u = parameter(kind, p, nodes_u, nodes_s, count, w * in_plane)
        if plane == SPACE:
            out[0], out[1], out[2] = derivative3(kind, p, u)
        else:
            du, dv = derivative(kind, p, u)
            size = sqrt(du * du + dv * dv)
            scale = in_plane / size if size > 0.0 else 0.0
            first, second = plane_axes(plane)
            out[first] = du * scale
            out[second] = dv * scale
    size = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2])
    for a in range(3):
        out[a] = out[a] / size if size > 0.0 else 0.0
