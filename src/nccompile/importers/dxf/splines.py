"""B-splines of any degree, rational or not, to cubic Bezier pieces.

Every knot span is a Bezier curve whose control points are blossom values: point j of the span [t0, t1] is the
polar form with p - j arguments t0 and j arguments t1 (Ramshaw; de Boor's algorithm with changing arguments).
Weights ride along as a third, homogeneous coordinate.  A polynomial of degree up to three is then a cubic
exactly.  Others are halved until the cubic with the same ends and end derivatives stays within the tolerance.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import comb

import numpy as np

from nccompile.importers.dxf.pieces import Complexes, Floats, Row, cubic_row, line_row

__all__ = ["bezier_pieces", "spline_rows"]

DEPTH = 24
"""Halvings of one knot span at most: a factor of 16 million in the parameter."""

PROBES = np.linspace(0.0, 1.0, 13)[1:-1]


def spline_rows(
    degree: int, knots: Sequence[float], points: Sequence[complex], weights: Sequence[float], tolerance: float
) -> list[Row]:
    """The spline as LINE rows (degree 1) or CUBIC rows no farther than `tolerance` [mm] from it.

    Raises ValueError if the numbers of knots, points and weights do not fit together.
    """
    if degree < 1 or len(knots) != len(points) + degree + 1:
        raise ValueError(f"{len(knots)} knots do not fit {len(points)} control points of degree {degree}")
    if weights and len(weights) != len(points):
        raise ValueError(f"{len(weights)} weights for {len(points)} control points")
    rows: list[Row] = []
    w = np.asarray(weights, float) if len(weights) else np.ones(len(points))
    if (w <= 0).any():
        raise ValueError("weights must be greater than 0")
    z = np.asarray(points, complex) * w
    for zs, ws in bezier_pieces(degree, np.asarray(knots, float), z, w):
        rows += _cubics(zs, ws, tolerance, 0)
    return rows


def bezier_pieces(degree: int, knots: Floats, z: Complexes, w: Floats) -> Iterator[tuple[Complexes, Floats]]:
    """Homogeneous Bezier control points (z w, w), each of shape (degree + 1,), of every knot span."""
    for i in range(degree, len(knots) - degree - 1):
        t0, t1 = knots[i], knots[i + 1]
        if t1 <= t0:
            continue
        zs, ws = np.zeros(degree + 1, complex), np.zeros(degree + 1)
        for j in range(degree + 1):
            dz, dw = z[i - degree : i + 1].copy(), w[i - degree : i + 1].copy()
            for level in range(1, degree + 1):
                t = t1 if level <= j else t0
                for at in range(degree, level - 1, -1):
                    low = knots[i - degree + at]
                    high = knots[i + 1 + at - level]
                    share = (t - low) / (high - low)
                    dz[at] += (dz[at - 1] - dz[at]) * (1.0 - share)
                    dw[at] += (dw[at - 1] - dw[at]) * (1.0 - share)
            zs[j], ws[j] = dz[degree], dw[degree]
        yield zs, ws


def _cubics(zs: Complexes, ws: Floats, tolerance: float, depth: int) -> list[Row]:
    """One homogeneous Bezier curve as rows."""
    degree = len(zs) - 1
    polynomial = bool(np.all(np.abs(ws - ws[0]) <= 1e-14 * abs(ws[0])))
    if polynomial and degree == 1:
        return [line_row(complex(zs[0] / ws[0]), complex(zs[1] / ws[1]))]
    if polynomial and degree <= 3:
        return [cubic_row(*_elevate(zs / ws))]
    a, b = zs[0] / ws[0], zs[-1] / ws[-1]
    c1 = a + degree / 3.0 * ws[1] / ws[0] * (zs[1] / ws[1] - a)
    c2 = b + degree / 3.0 * ws[-2] / ws[-1] * (zs[-2] / ws[-2] - b)
    s = 1.0 - PROBES
    cubic = s**3 * a + 3 * s**2 * PROBES * c1 + 3 * s * PROBES**2 * c2 + PROBES**3 * b
    if depth == DEPTH or np.abs(cubic - _evaluate(zs, ws, PROBES)).max() <= tolerance:
        return [cubic_row(complex(a), complex(c1), complex(c2), complex(b))]
    (zl, zr), (wl, wr) = _halve(zs), _halve(ws)
    left = _cubics(zl, wl.real, tolerance, depth + 1)
    return left + _cubics(zr, wr.real, tolerance, depth + 1)


def _elevate(z: Complexes) -> tuple[complex, complex, complex, complex]:
    """Four control points of a polynomial of degree two or three."""
    if len(z) == 4:
        return complex(z[0]), complex(z[1]), complex(z[2]), complex(z[3])
    return (
        complex(z[0]),
        complex(z[0] + 2.0 / 3.0 * (z[1] - z[0])),
        complex(z[2] + 2.0 / 3.0 * (z[1] - z[2])),
        complex(z[2]),
    )


def _evaluate(zs: Complexes, ws: Floats, t: Floats) -> Complexes:
    n = len(zs) - 1
    basis = np.array([comb(n, k) * t**k * (1.0 - t) ** (n - k) for k in range(n + 1)])
    points: Complexes = (zs @ basis) / (ws @ basis)
    return points


def _halve(z: Complexes | Floats) -> tuple[Complexes, Complexes]:
    """Control points of both halves (de Casteljau at 1/2)."""
    row = np.asarray(z, complex)
    left, right = [row[0]], [row[-1]]
    while len(row) > 1:
        row = 0.5 * (row[:-1] + row[1:])
        left.append(row[0])
        right.append(row[-1])
    return np.array(left), np.array(right[::-1])
