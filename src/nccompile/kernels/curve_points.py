"""Points, derivatives and tangents of a curve row; `kernels.curves` has them all and adds the arc length.

A curve row `p` is f8 (12,), laid out by its kind; u in 0..1 runs from its start to its end:

    ARC         cu cv r start sweep                    P = c + r (cos a, sin a),           a = start + sweep u
    ELLIPSE     cu cv main sub direction start sweep   P = c + R(direction) (main cos a, sub sin a)
    POLYNOMIAL  cubics in t = u: p[0:4] first, p[4:8] second, p[8:12] third coordinate, constant term first

Angles in rad, sweep > 0 is counter-clockwise; R turns by the direction of the main axis.  Plane curves have
p[8:12] = 0, so a polynomial's speed may always be taken in space.
"""

from math import cos, sin, sqrt
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = [
    "ARC", "ELLIPSE", "POLYNOMIAL", "derivative", "derivative3", "point", "point3", "put_hermite", "second",
    "second3", "speed", "tangent", "tangent3",
]  # fmt: skip

Floats: TypeAlias = npt.NDArray[np.float64]

ARC = 2
ELLIPSE = 3
POLYNOMIAL = 4


@kernel
def point(kind: int, p: Floats, u: float) -> tuple[float, float]:
    """The plane coordinates [mm] at u."""
    if kind == ARC:
        a = float(p[3]) + float(p[4]) * u
        r = float(p[2])
        return float(p[0]) + r * cos(a), float(p[1]) + r * sin(a)
    if kind == ELLIPSE:
        a = float(p[5]) + float(p[6]) * u
        x = float(p[2]) * cos(a)
        y = float(p[3]) * sin(a)
        c = cos(float(p[4]))
        s = sin(float(p[4]))
        return float(p[0]) + (c * x - s * y), float(p[1]) + (s * x + c * y)
    x = float(p[0]) + u * (float(p[1]) + u * (float(p[2]) + u * float(p[3])))
    y = float(p[4]) + u * (float(p[5]) + u * (float(p[6]) + u * float(p[7])))
    return x, y


@kernel
def point3(kind: int, p: Floats, u: float) -> tuple[float, float, float]:
    """The three coordinates at u of a polynomial in space; the third one of a plane kind is 0."""
    x, y = point(kind, p, u)
    z = 0.0
    if kind == POLYNOMIAL:
        z = float(p[8]) + u * (float(p[9]) + u * (float(p[10]) + u * float(p[11])))
    return x, y, z


@kernel
def derivative(kind: int, p: Floats, u: float) -> tuple[float, float]:
    """dP/du in the plane [mm]."""
    if kind == ARC:
        sweep = float(p[4])
        a = float(p[3]) + sweep * u
        v = float(p[2]) * sweep
        return -v * sin(a), v * cos(a)
    if kind == ELLIPSE:
        sweep = float(p[6])
        a = float(p[5]) + sweep * u
        x = -(float(p[2]) * sweep) * sin(a)
        y = (float(p[3]) * sweep) * cos(a)
        c = cos(float(p[4]))
        s = sin(float(p[4]))
        return c * x - s * y, s * x + c * y
    x = float(p[1]) + u * (2.0 * float(p[2]) + u * (3.0 * float(p[3])))
    y = float(p[5]) + u * (2.0 * float(p[6]) + u * (3.0 * float(p[7])))
    return x, y


@kernel
def derivative3(kind: int, p: Floats, u: float) -> tuple[float, float, float]:
    """dP/du in space of a polynomial [mm]; the third one of a plane kind is 0."""
    x, y = derivative(kind, p, u)
    z = 0.0
    if kind == POLYNOMIAL:
        z = float(p[9]) + u * (2.0 * float(p[10]) + u * (3.0 * float(p[11])))
    return x, y, z


@kernel
def second(kind: int, p: Floats, u: float) -> tuple[float, float]:
    """d²P/du² in the plane [mm]."""
    if kind == ARC:
        sweep = float(p[4])
        a = float(p[3]) + sweep * u
        v = float(p[2]) * sweep * sweep
        return -v * cos(a), -v * sin(a)
    if kind == ELLIPSE:
        sweep = float(p[6])
        a = float(p[5]) + sweep * u
        x = -(float(p[2]) * sweep * sweep) * cos(a)
        y = -(float(p[3]) * sweep * sweep) * sin(a)
        c = cos(float(p[4]))
        s = sin(float(p[4]))
        return c * x - s * y, s * x + c * y
    return 2.0 * float(p[2]) + 6.0 * float(p[3]) * u, 2.0 * float(p[6]) + 6.0 * float(p[7]) * u


@kernel
def second3(kind: int, p: Floats, u: float) -> tuple[float, float, float]:
    """d²P/du² in space of a polynomial [mm]; the third one of a plane kind is 0."""
    x, y = second(kind, p, u)
    z = 0.0
    if kind == POLYNOMIAL:
        z = 2.0 * float(p[10]) + 6.0 * float(p[11]) * u
    return x, y, z


@kernel
def speed(kind: int, p: Floats, u: float) -> float:
    """ds/du [mm], in space for a polynomial."""
    x, y, z = derivative3(kind, p, u)
    return sqrt(x * x + y * y + z * z)


@kernel
def tangent3(kind: int, p: Floats, u: float) -> tuple[float, float, float]:
    """The unit tangent at u; (0, 0, 0) for a curve without extent.

    Where the first derivative vanishes (control points that coincide at an end), the direction is the limit
    from inside the curve: P'(u + h) = h P'' + h²/2 P''' with h > 0 in the first half and h < 0 in the second.
    """
    x, y, z = derivative3(kind, p, u)
    size = sqrt(x * x + y * y + z * z)
    if kind == POLYNOMIAL:
        x2, y2, z2 = second3(kind, p, u)
        x3, y3, z3 = 6.0 * float(p[3]), 6.0 * float(p[7]), 6.0 * float(p[11])
        size2 = sqrt(x2 * x2 + y2 * y2 + z2 * z2)
        size3 = sqrt(x3 * x3 + y3 * y3 + z3 * z3)
        side = 1.0 if u < 0.5 else -1.0
        if size <= 1e-13 * (size2 + size3):
            x, y, z, size = side * x2, side * y2, side * z2, size2
            if size2 <= 1e-13 * size3:
                x, y, z, size = x3, y3, z3, size3
    if size == 0.0:
        return 0.0, 0.0, 0.0
    return x / size, y / size, z / size


@kernel
def tangent(kind: int, p: Floats, u: float) -> tuple[float, float]:
    """The unit tangent at u of a plane curve; (0, 0) for a curve without extent."""
    x, y, _ = tangent3(kind, p, u)
    return x, y


@kernel
def put_hermite(p0: float, d0: float, p1: float, d1: float, out: Floats, at: int) -> None:
    """Writes the powers of the cubic from p0 to p1 with the derivatives d0 and d1 at its ends."""
    step = p1 - p0
    out[at] = p0
    out[at + 1] = d0
    out[at + 2] = 3.0 * step - 2.0 * d0 - d1
    out[at + 3] = d0 + d1 - 2.0 * step
