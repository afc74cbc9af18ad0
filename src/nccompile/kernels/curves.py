r"""Curve rows: everything of `curve_points`, curvature, and arc length with its inverse.

Arcs have their length in closed form; for the others the integral of the speed |P'(u)| has none, so a table
of nodes (u_i, s_i) is made once a curve and its inverse is asked each cycle:

    |P'|  \         /\             the speed of a flat ellipse or a near-cusp has sharp minima; the table
           \      /  \             starts with a node in each, so every interval holds a smooth piece,
            \____/    \___         and halves intervals until Gauss quadrature of 20 points agrees with
    u     0 |  ||  |  |  1         10 points
"""

from math import cos, inf, sin, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.curve_points import (
    ARC,
    ELLIPSE,
    POLYNOMIAL,
    Floats,
    derivative,
    derivative3,
    point,
    point3,
    second,
    second3,
    speed,
    tangent,
    tangent3,
)  # fmt: skip

__all__ = [
    "ARC", "ELLIPSE", "NODES", "POLYNOMIAL", "Floats", "curvature", "derivative", "derivative3",
    "in_plane_length", "in_plane_lengths", "is_cusp", "max_curvature", "parameter", "point", "point3",
    "second", "second3", "speed", "speed_extremes", "tabulate", "tangent", "tangent3",
]  # fmt: skip

NODES = 129
"""Rows of an arc-length table: two exact cusps need 2 x 2 x 23 halvings to leave less than 1e-14."""

_QUARTER = 1.5707963267948966

_CUSP = 1e-8  # relative: a slower speed minimum is a cusp; taken as 0 it moves a curve by 2e-9 of its size
_ROUNDING = 1e-15  # relative to the terms of a derivative: a product of vectors below it is none
_PARALLEL = 1e-9  # sine of an angle: directions at a cusp that differ by less are one line
_SAME_LENGTH = 2e-14  # relative: 10 and 20 points agree; the kept 20-point value is better by many digits
_FOUND = 5e-14  # relative to the whole length: the inverse stops here
_NEWTON = 1e-8  # relative to the distance to both nodes: the next Newton step ends below rounding
_STEPS = 64  # bisection alone would end in 53

# Gauss-Legendre quadrature of 10 points on -1..1 (Abramowitz and Stegun, table 25.4), positive half.
_ABSCISSAE = (
    0.14887433898163122, 0.4333953941292472, 0.6794095682990244, 0.8650633666889845, 0.9739065285171717,
)  # fmt: skip
_WEIGHTS = (
    0.2955242247147528, 0.2692667193099965, 0.219086362515982, 0.1494513491505804, 0.06667134430868814,
)  # fmt: skip


@kernel
def curvature(kind: int, p: Floats, u: float) -> float:
    """|dT/ds| at u [1/mm], |P' x P''| / |P'|³; 0 for a straight piece.

    Where the speed is 0 (a cusp): 0 if the curve comes and goes on one line, else inf.  What the rounding of a
    cubic's terms can make of P' x P'' counts as 0.
    """
    if kind == ARC:
        r = float(p[2])
        return 1.0 / r if r > 0.0 else inf
    x, y, z = derivative3(kind, p, u)
    x2, y2, z2 = second3(kind, p, u)
    size = sqrt(x * x + y * y + z * z)
    bend = _cross(x, y, z, x2, y2, z2)
    if kind == POLYNOMIAL:
        terms = 0.0
        for i in range(0, 12, 4):
            terms += abs(p[i + 1]) + 2.0 * abs(p[i + 2]) + 3.0 * abs(p[i + 3])
        most = sqrt(x2 * x2 + y2 * y2 + z2 * z2)
        if bend <= _ROUNDING * terms * most:
            x3, y3, z3 = float(p[3]), float(p[7]), float(p[11])
            turn = _cross(x2, y2, z2, x3, y3, z3)
            if size > _ROUNDING * terms or turn <= _PARALLEL * terms * most:
                return 0.0
            return inf
    cube = size * size * size
    if cube == 0.0:
        return inf
    return bend / cube


@kernel
def _cross(x: float, y: float, z: float, x2: float, y2: float, z2: float) -> float:
    """The size of the product of two vectors."""
    cx = y * z2 - z * y2
    cy = z * x2 - x * z2
    cz = x * y2 - y * x2
    return sqrt(cx * cx + cy * cy + cz * cz)


@kernel
def is_cusp(kind: int, p: Floats, u: float) -> bool:
    """Whether a curve turns back at u, one of its speed extremes: the speed of a cubic is 0 but for rounding."""
    if kind != POLYNOMIAL or not 1e-9 < u < 1.0 - 1e-9:
        return False
    return speed(kind, p, u) <= _CUSP * (speed(kind, p, 0.0) + speed(kind, p, 0.5) + speed(kind, p, 1.0))


@kernel
def max_curvature(kind: int, p: Floats) -> float:
    """The greatest curvature on the curve [1/mm]; inf at a cusp inside it.

    Ellipse: it is greatest where the speed is least, on a main axis or at an end.  Polynomial: the greatest
    of 65 places and of the speed minima, sharpened by golden section between the neighbours of the best.
    """
    if kind == ARC:
        return curvature(kind, p, 0.0)
    cuts = np.empty(8)
    count = speed_extremes(kind, p, cuts)
    best = max(curvature(kind, p, 0.0), curvature(kind, p, 1.0))
    for i in range(count):
        if is_cusp(kind, p, float(cuts[i])):
            return inf
        best = max(best, curvature(kind, p, float(cuts[i])))
    if kind == ELLIPSE:
        return best
    at = 0
    top = -1.0
    for i in range(65):
        value = curvature(kind, p, i / 64.0)
        if value > top:
            top = value
            at = i
    low = max(at - 1, 0) / 64.0
    high = min(at + 1, 64) / 64.0
    for _ in range(48):
        a = high - 0.6180339887498949 * (high - low)
        b = low + 0.6180339887498949 * (high - low)
        ka = curvature(kind, p, a)
        kb = curvature(kind, p, b)
        top = max(top, ka, kb)
        if ka > kb:
            high = b
        else:
            low = a
    return max(best, top)


@kernel
def _root(q0: float, q1: float, q2: float, q3: float, low: float, high: float) -> float:
    """The root of a cubic that is monotone on low..high; -1 if its sign does not change there."""
    at_low = q0 + low * (q1 + low * (q2 + low * q3))
    at_high = q0 + high * (q1 + high * (q2 + high * q3))
    if (at_low > 0.0) == (at_high > 0.0):
        return -1.0
    for _ in range(60):
        mid = 0.5 * (low + high)
        value = q0 + mid * (q1 + mid * (q2 + mid * q3))
        if (value > 0.0) == (at_low > 0.0):
            low = mid
        else:
            high = mid
    return 0.5 * (low + high)


@kernel
def speed_extremes(kind: int, p: Floats, cuts: Floats) -> int:
    """Fills the places 0 < u < 1, ascending, where the speed has a minimum or maximum; returns their number.

    Ellipse: at multiples of 90° of the eccentric angle (at most 5).  Polynomial: d|P'|²/dt = 2 P'.P'' is a
    cubic; it is monotone between the roots of its own derivative, so bisection finds each of its <= 3 roots.
    """
    count = 0
    if kind == ELLIPSE:
        start = float(p[5])
        sweep = float(p[6])
        if sweep == 0.0:
            return 0
        first = start / _QUARTER
        last = (start + sweep) / _QUARTER
        low = int(np.ceil(min(first, last)))
        high = int(np.floor(max(first, last)))
        for i in range(high - low + 1):
            n = low + i if sweep > 0.0 else high - i
            u = (n * _QUARTER - start) / sweep
            if 0.0 < u < 1.0 and count < len(cuts):
                cuts[count] = u
                count += 1
        return count
    q0 = q1 = q2 = q3 = 0.0
    for i in range(3):
        c1 = float(p[4 * i + 1])
        c2 = float(p[4 * i + 2])
        c3 = float(p[4 * i + 3])
        q0 += 2.0 * c1 * c2
        q1 += 6.0 * c1 * c3 + 4.0 * c2 * c2
        q2 += 18.0 * c2 * c3
        q3 += 18.0 * c3 * c3
    # Derivative q1 + 2 q2 t + 3 q3 t²; its roots, ascending, split 0..1 into monotone pieces.
    edge1 = edge2 = 0.0
    square = q2 * q2 - 3.0 * q3 * q1
    if q3 > 0.0 and square > 0.0:
        edge1 = min(max((-q2 - sqrt(square)) / (3.0 * q3), 0.0), 1.0)
        edge2 = min(max((-q2 + sqrt(square)) / (3.0 * q3), 0.0), 1.0)
    low_edge = 0.0
    for i in range(3):
        high_edge = edge1 if i == 0 else (edge2 if i == 1 else 1.0)
        if high_edge > low_edge:
            u = _root(q0, q1, q2, q3, low_edge, high_edge)
            if 0.0 < u < 1.0 and (count == 0 or u > cuts[count - 1]):
                cuts[count] = u
                count += 1
            low_edge = high_edge
    return count


@kernel
def _integral(kind: int, p: Floats, a: float, b: float) -> float:
    """Length of the piece a..b by Gauss-Legendre with 10 points (an ellipse or polynomial)."""
    half = 0.5 * (b - a)
    mid = 0.5 * (a + b)
    total = 0.0
    if kind == ELLIPSE:
        start = float(p[5])
        sweep = float(p[6])
        main = float(p[2]) * sweep
        sub = float(p[3]) * sweep
        for i in range(5):
            d = half * _ABSCISSAE[i]
            w = start + sweep * (mid + d)
            x = main * sin(w)
            y = sub * cos(w)
            w = start + sweep * (mid - d)
            x2 = main * sin(w)
            y2 = sub * cos(w)
            total += _WEIGHTS[i] * (sqrt(x * x + y * y) + sqrt(x2 * x2 + y2 * y2))
        return half * total
    x0, x1, x2 = float(p[1]), 2.0 * float(p[2]), 3.0 * float(p[3])
    y0, y1, y2 = float(p[5]), 2.0 * float(p[6]), 3.0 * float(p[7])
    z0, z1, z2 = float(p[9]), 2.0 * float(p[10]), 3.0 * float(p[11])
    for i in range(5):
        d = half * _ABSCISSAE[i]
        t = mid + d
        x = x0 + t * (x1 + t * x2)
        y = y0 + t * (y1 + t * y2)
        z = z0 + t * (z1 + t * z2)
        one = sqrt(x * x + y * y + z * z)
        t = mid - d
        x = x0 + t * (x1 + t * x2)
        y = y0 + t * (y1 + t * y2)
        z = z0 + t * (z1 + t * z2)
        total += _WEIGHTS[i] * (one + sqrt(x * x + y * y + z * z))
    return half * total


@kernel
def tabulate(kind: int, p: Floats, nodes_u: Floats, nodes_s: Floats) -> int:
    """Fills the arc-length table of a curve and returns the number of its rows, 2..NODES.

    nodes_u, nodes_s: Shape (NODES,); ascending, (0, 0) first, (1, length) last; the length [mm] is that in
    the plane (in space for a polynomial) to 1e-13 relative.  The unused end of both arrays is scratch: it
    holds the stack of intervals still to be taken up.
    """
    nodes_u[0] = 0.0
    nodes_s[0] = 0.0
    if kind == ARC:
        nodes_u[1] = 1.0
        nodes_s[1] = float(p[2]) * abs(float(p[4]))
        return 2
    cuts = np.empty(8)
    number = speed_extremes(kind, p, cuts)
    top = NODES  # the stack grows downwards; an entry is the end of an interval and its 10-point length
    high = 1.0
    rough = 0.0
    for i in range(number + 1):
        low = 0.0 if i == number else float(cuts[number - 1 - i])
        top -= 1
        nodes_u[top] = high
        nodes_s[top] = _integral(kind, p, low, high)
        rough += float(nodes_s[top])
        high = low
    count = 1
    a = 0.0
    length = 0.0
    while top < NODES:
        b = float(nodes_u[top])
        whole = float(nodes_s[top])
        mid = 0.5 * (a + b)
        left = _integral(kind, p, a, mid)
        right = _integral(kind, p, mid, b)
        both = left + right
        if abs(both - whole) <= _SAME_LENGTH * rough or top - count <= 1:
            length += both
            nodes_u[count] = b
            nodes_s[count] = length
            count += 1
            top += 1
            a = b
        else:
            nodes_s[top] = right
            top -= 1
            nodes_u[top] = mid
            nodes_s[top] = left
    return count


@kernel
def parameter(kind: int, p: Floats, nodes_u: Floats, nodes_s: Floats, count: int, s: float) -> float:
    """The u at arc length s [mm] from the start; 0 before the start, 1 after the end.

    Safeguarded Newton in the interval of the table that holds s:  u <- u - (S(u) - s) / |P'(u)|, with S by
    quadrature from the interval's first node.  The first guess is the cubic u(s) with the slopes 1/|P'| of
    both nodes, held monotone; two or three steps suffice.  S of the result is s to 1e-12 of the length.
    """
    length = float(nodes_s[count - 1])
    if s <= 0.0 or length <= 0.0:
        return 0.0
    if s >= length:
        return 1.0
    if kind == ARC:
        return s / length
    first = 0
    last = count - 1
    while last - first > 1:
        mid = (first + last) // 2
        if nodes_s[mid] <= s:
            first = mid
        else:
            last = mid
    a = float(nodes_u[first])
    b = float(nodes_u[last])
    want = s - float(nodes_s[first])
    whole = float(nodes_s[last]) - float(nodes_s[first])
    if want <= 0.0 or whole <= 0.0:
        return a
    x = want / whole
    va = speed(kind, p, a) * (b - a)
    vb = speed(kind, p, b) * (b - a)
    ma = whole / va if va * 3.0 > whole else 3.0  # slopes up to 3 keep the cubic monotone
    mb = whole / vb if vb * 3.0 > whole else 3.0
    u = a + (b - a) * x * (x * (3.0 - 2.0 * x) + (1.0 - x) * (ma * (1.0 - x) - mb * x))
    low = a
    high = b
    near = _NEWTON * min(want, whole - want)
    for _ in range(_STEPS):
        miss = _integral(kind, p, a, u) - want
        if abs(miss) <= _FOUND * length and abs(miss) > near:
            return u
        if miss > 0.0:
            high = u
        else:
            low = u
        v = speed(kind, p, u)
        step = u - miss / v if v > 0.0 else low
        if abs(miss) <= near:
            return min(max(step, a), b)
        if not low < step < high:
            step = 0.5 * (low + high)
        if step == u:
            return u
        u = step
    return u


@kernel
def in_plane_length(kind: int, p: Floats) -> float:
    """The length of a curve [mm] in its plane (in space for a polynomial), to 1e-13 relative."""
    if kind == ARC:
        return float(p[2]) * abs(float(p[4]))
    if kind == POLYNOMIAL:  # most run evenly: no minimum of the speed needs to be looked for
        halves = _integral(kind, p, 0.0, 0.5) + _integral(kind, p, 0.5, 1.0)
        if abs(halves - _integral(kind, p, 0.0, 1.0)) <= _SAME_LENGTH * halves:
            return halves
    nodes_u = np.empty(NODES)
    nodes_s = np.empty(NODES)
    count = tabulate(kind, p, nodes_u, nodes_s)
    return float(nodes_s[count - 1])


@kernel
def in_plane_lengths(kinds: npt.NDArray[np.uint8], rows: Floats, out: Floats) -> None:
    """`in_plane_length` of many curves: kinds u1 (m,), rows f8 (m, 12), out f8 (m,)."""
    for i in range(len(kinds)):
        out[i] = in_plane_length(int(kinds[i]), rows[i])
