"""Runs of small lines become arcs (helices) or lines: the kernel of the pass `fit-arcs`.

All circles through the ends S, E of a run form a pencil; m, the height of the arc over the middle of the chord
(signed, 0 is the straight line), names one of them:

              . - ~ P ~ - .            F(m) = signed distance of a point P = (x, y) above the arc, in the frame
          . '       |m      ' .               of the chord (S = (-d, 0), E = (d, 0)):
        S ----------+---------- E             2 m (x² + y² - d²) - 2 y (m² - d²)
       (-d,0)               (d,0)      F = - ---------------------------------------------
                                             sqrt((2mx)² + (2my - m² + d²)²) + m² + d²

with no singularity at m = 0.  F falls with m at the rate w = (2 (d² - x² - y²) + 4 y m) / denominator on the
arc, so a point allows the m within  m + (F -+ tolerance) / w: an interval.  The intersection of all of them is
the set of arcs that keep the tolerance; its middle is taken and checked again with plain distances: every
vertex, and every chord at its point nearest to the centre.  Angles must advance from vertex to vertex, so
the largest of these distances bounds the distance of polyline and arc both ways.

Own derivation; the pencil as in M. Held et al., "biarc approximation within tolerance bands", 2005.
"""

from math import atan2, inf, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.planes import plane_axes

__all__ = ["fit_arcs", "fit_run"]

Floats = npt.NDArray[np.float64]

_TURN = 6.283185307179586
_WIDEST = 5.9  # sweep [rad]: a full circle needs a break, its ends would not fix it
_STRAIGHT = 1e-4  # part of the tolerance: a flatter arc is a line
_STEP = 0.8  # greatest angle of one chord [rad]


@kernel
def _interval(
    points: Floats, u: int, v: int, first: int, last: int, tolerance: float, m: float
) -> tuple[float, float]:
    """The heights m that keep all inner vertices of first..last within the tolerance, by the tangent at m."""
    sx = float(points[first, u])
    sy = float(points[first, v])
    dx = float(points[last, u]) - sx
    dy = float(points[last, v]) - sy
    chord = sqrt(dx * dx + dy * dy)
    if chord <= 0.0:
        return 1.0, -1.0
    dx /= chord
    dy /= chord
    d = 0.5 * chord
    low = -inf
    high = inf
    square = d * d
    mm = m * m
    for i in range(first + 1, last):
        ex = float(points[i, u]) - sx
        ey = float(points[i, v]) - sy
        x = ex * dx + ey * dy - d
        y = ey * dx - ex * dy
        power = x * x + y * y - square
        a = 2.0 * m * x
        b = 2.0 * m * y - mm + square
        bottom = sqrt(a * a + b * b) + mm + square
        f = (2.0 * m * power - 2.0 * y * (mm - square)) / bottom
        w = (4.0 * y * m - 2.0 * power) / bottom
        if w > 1e-9:
            low = max(low, m + (f - tolerance) / w)
            high = min(high, m + (f + tolerance) / w)
        elif abs(f) > tolerance:
            return 1.0, -1.0
    return low, high


@kernel
def _height(points: Floats, u: int, v: int, first: int, last: int, at: int) -> float:
    """The height m of the arc through the vertices first, at, last; inf if the chord has no length.

    m / d = tan(sweep / 4), and by the inscribed angle the sweep is 2 pi - 2 (angle at `at`) on its side.
    """
    ax = float(points[first, u]) - float(points[at, u])
    ay = float(points[first, v]) - float(points[at, v])
    bx = float(points[last, u]) - float(points[at, u])
    by = float(points[last, v]) - float(points[at, v])
    cross = ax * by - ay * bx
    dot = ax * bx + ay * by
    dx = bx - ax
    dy = by - ay
    d = 0.5 * sqrt(dx * dx + dy * dy)
    angle = atan2(cross, dot)  # + if `at` is left of the chord first -> last
    half = 0.5 * (3.141592653589793 - abs(angle))  # a quarter of the sweep
    if d == 0.0 or half >= 1.56:
        return inf
    t = float(np.tan(half)) * d
    return t if angle > 0.0 else -t


@kernel
def _holds(
    points: Floats, u: int, v: int, w: int, first: int, last: int, tolerance: float, m: float, row: Floats
) -> bool:
    """Whether the arc of height m keeps the tolerance; fills row: cu, cv, radius, start, sweep (radius 0: a line).

    Checks plain distances: radial ones in the plane, the third axis and additional axes against their value
    linear in the way.
    """
    k = points.shape[1]
    sx = float(points[first, u])
    sy = float(points[first, v])
    dx = float(points[last, u]) - sx
    dy = float(points[last, v]) - sy
    chord = sqrt(dx * dx + dy * dy)
    d = 0.5 * chord
    line = abs(m) <= _STRAIGHT * tolerance
    cu = cv = radius = start = sweep = 0.0
    if not line:
        radius = (m * m + d * d) / (2.0 * abs(m))
        c = (m * m - d * d) / (2.0 * m)
        cu = sx + 0.5 * dx - c * dy / chord
        cv = sy + 0.5 * dy + c * dx / chord
        quarter = atan2(abs(m), d)
        sweep = 4.0 * quarter if m < 0.0 else -4.0 * quarter
        start = atan2(sy - cv, sx - cu)
        if 4.0 * quarter > _WIDEST:
            return False
    total = abs(sweep)
    side = 1.0 if sweep > 0.0 else -1.0
    before = 0.0
    gone = 0.0
    lifted = 0.0
    cross = 0.0
    ox = sx
    oy = sy
    for i in range(first + 1, last + 1):
        x = float(points[i, u])
        y = float(points[i, v])
        size = sqrt((x - ox) * (x - ox) + (y - oy) * (y - oy))
        off = 0.0
        step = 0.0
        if line:
            share = ((x - sx) * dx + (y - sy) * dy) / (chord * chord)
            off = ((y - sy) * dx - (x - sx) * dy) / chord
        else:
            r1 = sqrt((x - cu) * (x - cu) + (y - cv) * (y - cv))
            off = r1 - radius
            cross = (ox - cu) * (y - cv) - (oy - cv) * (x - cu)
            dot = (ox - cu) * (x - cu) + (oy - cv) * (y - cv)
            step = side * atan2(cross, dot)
            gone += step
            share = gone / total
            if step > _STEP or step <= 0.0:
                return False
        if i == last:
            share = 1.0
            off = 0.0
        if share <= before:
            return False
        rise = float(points[last, w]) - float(points[first, w])
        lift = float(points[i, w]) - (float(points[first, w]) + share * rise)
        lift = abs(lift) + step * step * abs(float(points[i, w]) - float(points[i - 1, w])) / 8.0
        if not line:
            # The point of the chord nearest to the centre, if it is inside the chord.
            along = ((cu - ox) * (x - ox) + (cv - oy) * (y - oy)) / (size * size) if size > 0.0 else 0.0
            if 0.0 < along < 1.0:
                sag = radius - abs(cross) / size
                if sag > 0.0 and sag * sag + max(lift, lifted) * max(lift, lifted) > tolerance * tolerance:
                    return False
        if off * off + lift * lift > tolerance * tolerance:
            return False
        for c in range(3, k):
            a = float(points[first, c])
            if abs(float(points[i, c]) - a - share * (float(points[last, c]) - a)) > tolerance:
                return False
        before = share
        lifted = lift
        ox = x
        oy = y
    row[0] = cu
    row[1] = cv
    row[2] = radius
    row[3] = start
    row[4] = sweep
    return True


@kernel
def fit_run(
    points: Floats, u: int, v: int, w: int, first: int, last: int, tolerance: float, row: Floats
) -> bool:
    """The arc or line from vertex first to last within the tolerance; fills row as `_holds`."""
    middle = (first + last) // 2
    m = _height(points, u, v, first, last, middle)
    if not abs(m) < inf:
        return False
    dx = float(points[last, u]) - float(points[first, u])
    dy = float(points[last, v]) - float(points[first, v])
    d = 0.5 * sqrt(dx * dx + dy * dy)
    if abs(m) > 30.0 * d:
        return False
    for _ in range(2):
        low, high = _interval(points, u, v, first, last, tolerance, m)
        if low > high:
            return False
        flat = low <= 0.0 <= high and abs(m) < tolerance
        if flat and _holds(points, u, v, w, first, last, tolerance, 0.0, row):
            return True
        m = 0.5 * (low + high)
        if _holds(points, u, v, w, first, last, tolerance, m, row):
            return True
    return False


@kernel
def _plane(points: Floats, first: int, last: int) -> int:
    """The plane 0..2 whose third axis moves least between two vertices: X-Y if in doubt."""
    best = 0
    least = inf
    for plane in range(3):
        third = 2 - plane
        moved = 0.0
        for i in range(first + 1, last + 1):
            moved += abs(float(points[i, third]) - float(points[i - 1, third]))
        if moved < least:
            least = moved
            best = plane
    return best


@kernel
def fit_arcs(
    points: Floats, breaks: npt.NDArray[np.bool_], tolerance: float, least: int, planes: bool,
    ends: npt.NDArray[np.int64], rows: Floats, kinds: npt.NDArray[np.int64],
) -> int:  # fmt: skip
    """Cuts a run of lines greedily into the longest arcs and lines; returns their number.

    Args:     points: Shape (n + 1, k), vertices;  breaks: Shape (n + 1,), vertices that stay (0 and n do);
              least: lines an arc must replace;  planes: arcs in Z-X and Y-Z too;
              ends, kinds: Shape (n,), out: last vertex of each piece; -1 for a line, else the plane of an arc;
              rows: Shape (n, 5), out.

    The length of a piece is found by doubling and bisection, so each line is looked at a few times only.
    """
    n = len(points) - 1
    count = 0
    first = 0
    row = np.zeros(5)
    limit = 0
    while first < n:
        if limit <= first:
            limit = first + 1
            while limit < n and not breaks[limit]:
                limit += 1
        plane = _plane(points, first, min(first + 3, limit)) if planes else 0
        u, v = plane_axes(plane)
        w = 2 - plane
        good = first + 1
        rows[count, 2] = 0.0
        bad = limit + 1
        step = 2
        while first + step < bad:
            at = first + step
            if fit_run(points, u, v, w, first, at, tolerance, row):
                good = at
                for c in range(5):
                    rows[count, c] = row[c]
                if at == limit:
                    break
                step = min(2 * step, limit - first)
            else:
                bad = at
        while bad - good > 1:
            at = (good + bad) // 2
            if fit_run(points, u, v, w, first, at, tolerance, row):
                good = at
                for c in range(5):
                    rows[count, c] = row[c]
            else:
                bad = at
        straight = rows[count, 2] == 0.0
        if not straight and good - first < least:
            good = first + 1
            straight = True
            rows[count, 2] = 0.0
        ends[count] = good
        kinds[count] = -1 if straight else plane
        count += 1
        first = good
    return count
