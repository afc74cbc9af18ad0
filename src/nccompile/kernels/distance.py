"""Distances from points to segments of a path, for measuring what a pass did to it.

A path is given by its columns: kinds, start and end positions in X, Y, Z, curve rows with their plane.  The
place nearest to a point is looked for on a few neighbouring segments only, so a distance found here is never
less than the true one.
"""

from math import atan2, inf, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curve_parts import way_share
from nccompile.kernels.curve_points import ARC, POLYNOMIAL, Floats, derivative3, point3
from nccompile.kernels.planes import SPACE, embed

__all__ = ["deviations", "distance", "place_on", "sample_rows"]

_TURN = 6.283185307179586
_SCAN = 32  # first guesses along a curve without closed form: the sides of a flat ellipse are near each other
_STEPS = 24  # of a search that narrows by 4 when the distance no longer falls
_SAME = 1e-3


@kernel
def place_on(
    kind: int, plane: int, p: Floats, a: Floats, b: Floats, u: float
) -> tuple[float, float, float]:  # fmt: skip
    """The point [mm] at curve parameter u of a segment from a to b (Shape (>= 3,) each), third axis included."""
    if kind < ARC or kind > POLYNOMIAL:
        return (
            float(a[0]) + u * (float(b[0]) - float(a[0])),
            float(a[1]) + u * (float(b[1]) - float(a[1])),
            float(a[2]) + u * (float(b[2]) - float(a[2])),
        )
    x, y, z = point3(kind, p, u)
    if plane == SPACE:
        return x, y, z
    third = 2 - plane  # XY leaves Z over, ZX leaves Y, YZ leaves X
    rise = float(b[third]) - float(a[third])
    way = way_share(kind, p, u) if rise != 0.0 else u
    return embed(plane, x, y, float(a[third]) + way * rise)


@kernel
def distance(kind: int, plane: int, p: Floats, a: Floats, b: Floats, x: float, y: float, z: float) -> float:
    """Distance [mm] of the point (x, y, z) from a segment (an upper bound for helices and free curves)."""
    if kind < ARC or kind > POLYNOMIAL:
        dx = float(b[0]) - float(a[0])
        dy = float(b[1]) - float(a[1])
        dz = float(b[2]) - float(a[2])
        ex = x - float(a[0])
        ey = y - float(a[1])
        ez = z - float(a[2])
        size = dx * dx + dy * dy + dz * dz
        t = (ex * dx + ey * dy + ez * dz) / size if size > 0.0 else 0.0
        t = min(max(t, 0.0), 1.0)
        ex -= t * dx
        ey -= t * dy
        ez -= t * dz
        return sqrt(ex * ex + ey * ey + ez * ez)
    best = inf
    rise = 0.0 if plane == SPACE else float(b[2 - plane]) - float(a[2 - plane])
    if kind == ARC and rise == 0.0:
        u = _angle_share(plane, p, x, y, z)
        for guess in (0.0, 1.0, u):
            px, py, pz = place_on(kind, plane, p, a, b, guess)
            best = min(best, sqrt((px - x) * (px - x) + (py - y) * (py - y) + (pz - z) * (pz - z)))
        return best
    at = 0.0
    for i in range(_SCAN + 1):
        px, py, pz = place_on(kind, plane, p, a, b, i / _SCAN)
        d = sqrt((px - x) * (px - x) + (py - y) * (py - y) + (pz - z) * (pz - z))
        if d < best:
            best = d
            at = i / _SCAN
    width = 1.0 / _SCAN
    for _ in range(_STEPS):
        before = best
        closed = rise == 0.0 or kind == ARC
        tries = 3 if closed else 2
        base = at
        for j in range(tries):
            guess = base - width if j == 0 else base + width
            if j == 2:
                px, py, pz = place_on(kind, plane, p, a, b, base)
                dx, dy, dz = _in_space(plane, kind, p, base, rise)
                speed = dx * dx + dy * dy + dz * dz
                if speed == 0.0:
                    continue
                guess = base + ((x - px) * dx + (y - py) * dy + (z - pz) * dz) / speed
            guess = min(max(guess, 0.0), 1.0)
            px, py, pz = place_on(kind, plane, p, a, b, guess)
            d = sqrt((px - x) * (px - x) + (py - y) * (py - y) + (pz - z) * (pz - z))
            if d < best:
                best = d
                at = guess
        if before - best <= _SAME * best:
            width *= 0.25
    return best


@kernel
def _in_space(plane: int, kind: int, p: Floats, u: float, rise: float) -> tuple[float, float, float]:
    """dP/du as X, Y, Z; the third axis of a plane moves by `rise` over the whole curve."""
    x, y, z = derivative3(kind, p, u)
    return embed(plane, x, y, z if plane == SPACE else rise)


@kernel
def _angle_share(plane: int, p: Floats, x: float, y: float, z: float) -> float:
    """Where on an arc, 0..1, the ray from its centre through a point meets it; the nearer end if nowhere."""
    u, v = x, y
    if plane == 1:
        u, v = z, x
    elif plane == 2:
        u, v = y, z
    start = float(p[3])
    sweep = float(p[4])
    turn = atan2(v - float(p[1]), u - float(p[0])) - start
    if sweep < 0.0:
        turn = -turn
    turn -= _TURN * float(np.floor(turn / _TURN))
    size = abs(sweep)
    if turn <= size:
        return turn / size
    return 1.0 if turn - size < _TURN - turn else 0.0


@kernel
def deviations(
    kinds: npt.NDArray[np.uint8], planes: npt.NDArray[np.int64], rows: Floats, points: Floats,
    sample: Floats, near: npt.NDArray[np.int64], reach: int,
) -> float:  # fmt: skip
    """The greatest distance [mm] of samples from a path.

    Args:     kinds: Shape (n,);  planes: Shape (n,), 0..3;  rows: Shape (n, 12);  points: Shape (n + 1, 3), start
              position and ends;  sample: Shape (m, 3);  near: Shape (m,), a segment near each sample;
              reach: how many segments before and after it are looked at.
    """
    worst = 0.0
    n = len(kinds)
    for k in range(len(sample)):
        x = float(sample[k, 0])
        y = float(sample[k, 1])
        z = float(sample[k, 2])
        best = inf
        at = int(near[k])
        for off in range(reach + 1):
            for side in range(2):
                i = at + off if side == 0 else at - off
                if 0 <= i < n and (off > 0 or side == 0) and best > worst:
                    d = distance(int(kinds[i]), int(planes[i]), rows[i], points[i], points[i + 1], x, y, z)
                    best = min(best, d)
        worst = max(worst, best)
    return worst


@kernel
def sample_rows(
    kinds: npt.NDArray[np.uint8], planes: npt.NDArray[np.int64], rows: Floats, points: Floats,
    owner: npt.NDArray[np.int64], u: Floats, out: Floats,
) -> None:  # fmt: skip
    """Fills out, Shape (m, 3), with the points at u of the segments `owner` (columns as in `deviations`)."""
    for k in range(len(owner)):
        i = int(owner[k])
        x, y, z = place_on(int(kinds[i]), int(planes[i]), rows[i], points[i], points[i + 1], float(u[k]))
        out[k, 0] = x
        out[k, 1] = y
        out[k, 2] = z
