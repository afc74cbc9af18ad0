"""Cubic B-splines span by span, as powers, and how a spline changes when one of its knots moves.

    S(u) = sum c(i) B(i, u)            on the span j, between t(j) and t(j+1), v = u - t(j):
                                       B(j+a) = b0 + b1 v + b2 v² + b3 v³,  a = 0..3

Moving the knot t(k) adds, up to splines on the same knots, J F(k, u): J is the jump of the third derivative there
and F a cubic with support t(k-1)..t(k+2) whose second derivative jumps by 1 at t(k).  With A, H, E the lengths of
these three spans and v the distance to t(k+2), t(k+1):

     α (u - t(k-1))³   |  E² + 3 E v + 3 v² + γ v³  |  (v')³ / E       all over 6 (1 + γ H - α A)

     γ = - (E² + 3 E H + 3 H² + A (E + 2 H)) / (H² (H + A)),   α = - (E + 2 H + γ H²) / A²

Source:   C. de Boor, A Practical Guide to Splines, 1978, chapter X; F is an own derivation.
"""

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = ["pad_knots", "span_basis", "span_powers"]

Floats = npt.NDArray[np.float64]


@kernel
def pad_knots(knots: Floats, spans: int, t: Floats) -> None:
    """The knots with the end ones repeated: t, Shape (>= spans + 7,)."""
    for i in range(3):
        t[i] = knots[0]
        t[spans + 4 + i] = knots[spans]
    for i in range(spans + 1):
        t[3 + i] = knots[i]


@kernel
def span_basis(t: Floats, spans: int, basis: Floats) -> None:
    """Fills basis, Shape (spans, 7, 4), with the powers of B(j)..B(j+3) and of F(j-1), F(j), F(j+1) on each span j.

    t: padded knots, Shape (spans + 7,).
    """
    for j in range(spans):
        for a in range(7):
            for p in range(4):
                basis[j, a, p] = 0.0
        k = j + 3
        at = float(t[k])
        h = float(t[k + 1]) - at
        h1 = float(t[k + 1] - t[k - 1])
        h2 = float(t[k + 1] - t[k - 2])
        g1 = float(t[k + 2]) - at
        g2 = float(t[k + 3]) - at
        b1 = float(t[k + 2] - t[k - 1])
        d1 = at - float(t[k - 1])
        d2 = at - float(t[k - 2])
        # de Boor's recursion, in powers of v: quadratic B-splines q0 (falls), q1, q2 (rises), from linear ones.
        m0 = 1.0 / (h * h1)
        m1 = 1.0 / (h * g1)
        q00 = h * h * m0
        q01 = -2.0 * h * m0
        q02 = m0
        q10 = d1 * h * m0
        q11 = (h - d1) * m0 + g1 * m1
        q12 = -m0 - m1
        q22 = m1
        w0 = 1.0 / h2
        w1 = 1.0 / b1
        w2 = 1.0 / g2
        basis[j, 0, 0] = w0 * h * q00
        basis[j, 0, 1] = w0 * (h * q01 - q00)
        basis[j, 0, 2] = w0 * (h * q02 - q01)
        basis[j, 0, 3] = -w0 * q02
        basis[j, 1, 0] = w0 * d2 * q00 + w1 * g1 * q10
        basis[j, 1, 1] = w0 * (d2 * q01 + q00) + w1 * (g1 * q11 - q10)
        basis[j, 1, 2] = w0 * (d2 * q02 + q01) + w1 * (g1 * q12 - q11)
        basis[j, 1, 3] = w0 * q02 - w1 * q12
        basis[j, 2, 0] = w1 * d1 * q10
        basis[j, 2, 1] = w1 * (d1 * q11 + q10)
        basis[j, 2, 2] = w1 * (d1 * q12 + q11) + w2 * g2 * q22
        basis[j, 2, 3] = w1 * q12 - w2 * q22
        basis[j, 3, 3] = w2 * q22
    for k in range(1, spans):
        before = float(t[k + 3] - t[k + 2])
        h = float(t[k + 4] - t[k + 3])
        e = float(t[k + 5] - t[k + 4])
        g = -(e * e + 3.0 * e * h + 3.0 * h * h + before * (e + 2.0 * h)) / (h * h * (h + before))
        f = -(e + 2.0 * h + g * h * h) / (before * before)
        unit = 1.0 / (6.0 * (1.0 + g * h - f * before))
        basis[k - 1, 6, 3] = unit * f
        # v = h - (u - t(k)) on the span k
        basis[k, 5, 0] = unit * (e * e + 3.0 * e * h + 3.0 * h * h + g * h * h * h)
        basis[k, 5, 1] = -unit * (3.0 * e + 6.0 * h + 3.0 * g * h * h)
        basis[k, 5, 2] = unit * (3.0 + 3.0 * g * h)
        basis[k, 5, 3] = -unit * g
        if e > 0.0 and k + 1 < spans:
            basis[k + 1, 4, 0] = unit * e * e
            basis[k + 1, 4, 1] = -unit * 3.0 * e
            basis[k + 1, 4, 2] = unit * 3.0
            basis[k + 1, 4, 3] = -unit / e


@kernel
def span_powers(basis: Floats, spans: int, dims: int, control: Floats, stride: int, rows: Floats) -> None:
    """Fills rows, Shape (spans, 4 dims), with the powers of v on each span: four numbers a coordinate.

    control: coordinate c of control point i is control[stride * i + c].
    """
    for j in range(spans):
        for c in range(dims):
            for p in range(4):
                value = 0.0
                for a in range(4):
                    value += float(basis[j, a, p]) * float(control[stride * (j + a) + c])
                rows[j, 4 * c + p] = value
