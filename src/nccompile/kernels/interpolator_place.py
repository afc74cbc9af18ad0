"""Where the path is: position and direction at a path length of a planned row (SoftMotion §6.2.8)."""

from __future__ import annotations

from math import cos, sin, sqrt

from nccompile.kernels import kernel
from nccompile.kernels.curves import derivative, derivative3, parameter, point, point3
from nccompile.kernels.interpolator_rows import ARC, SPACE, Floats, Rows

__all__ = ["direction", "locate"]


@kernel
def locate(rows: Rows, row: int, s: float, nodes_u: Floats, nodes_s: Floats, count: int, out: Floats) -> None:
    """Writes the position at path length `s` of a row to `out` (k,); the row's very end is its target.

    X-Y (the curve's plane) run on the curve, all other axes linearly in path length, or where the S-profile
    is on with 10 w³ - 15 w⁴ + 6 w⁵ of w = s / L, which starts and ends at rest (SoftMotion §6.2.8).
    """
    axes = rows.target.shape[1]
    length = rows.length[row]
    if s >= length:
        for a in range(axes):
            out[a] = rows.target[row, a]
        return
    w = s / length
    bits = rows.profile[row]
    for a in range(axes):
        share = w
        if (bits >> a) & 1:
            share = w * w * w * (10.0 + w * (6.0 * w - 15.0))
        begin = rows.start[row, a]
        out[a] = begin + (rows.target[row, a] - begin) * share
    curve = rows.curve[row]
    if curve < 0:
        return
    p = rows.parameters[curve]
    kind = rows.kind[row]
    plane = rows.plane[curve]
    if kind == ARC:
        angle = p[3] + p[4] * w
        cu = p[0] + p[2] * cos(angle)
        cv = p[1] + p[2] * sin(angle)
    else:
        u = parameter(kind, p, nodes_u, nodes_s, count, w * nodes_s[count - 1])
        if plane == SPACE:
            x, y, z = point3(kind, p, u)
            out[0] = x
            out[1] = y
            out[2] = z
            return
        cu, cv = point(kind, p, u)
    if plane == 1:  # planes XY, ZX, YZ are axes (0, 1), (2, 0), (1, 2)
        out[2] = cu
        out[0] = cv
    else:
        out[plane // 2] = cu
        out[plane // 2 + 1] = cv


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
            if plane == 1:
                out[2] = du * scale
                out[0] = dv * scale
            else:
                out[plane // 2] = du * scale
                out[plane // 2 + 1] = dv * scale
    size = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2])
    for a in range(3):
        out[a] = out[a] / size if size > 0.0 else 0.0
