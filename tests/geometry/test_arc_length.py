"""Arc length of polynomials and its inverse, against a quadrature of another kind; curvature and tangents."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from math import hypot, inf

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from nccompile import kernels
from nccompile.kernels import curves as k
from nccompile.kernels.curves import ARC, ELLIPSE, POLYNOMIAL, Floats

# Six decimals: the roots of the independent quadrature do not stand leading terms near underflow.
coefficients = st.lists(st.integers(-(10**6), 10**6).map(lambda n: n / 1e6), min_size=8, max_size=8)
scales = st.sampled_from([1e-4, 1.0, 1e6])


def row(*values: float) -> Floats:
    p = np.zeros(12)
    p[: len(values)] = values
    return p


def table(kind: int, p: Floats) -> tuple[Floats, Floats, int]:
    nodes_u, nodes_s = np.empty(k.NODES), np.empty(k.NODES)
    return nodes_u, nodes_s, k.tabulate(kind, p, nodes_u, nodes_s)


def tanh_sinh_length(p: Floats, low: float = 0.0, high: float = 1.0) -> float:
    """Length of a cubic by double exponential quadrature between the minima of its speed.

    Substitution x = tanh(pi/2 sinh t): a trapezoidal rule that does not mind singular ends, so the corner of
    the speed at a cusp costs nothing once it is an end.
    """
    c = p.reshape(3, 4)
    velocity = np.column_stack([c[:, 1], 2 * c[:, 2], 3 * c[:, 3]])  # constant term first
    square = sum((np.polynomial.Polynomial(v) ** 2 for v in velocity), np.polynomial.Polynomial([0.0]))
    places = [complex(z) for z in square.deriv().roots()]
    cuts = sorted({low, high, *(z.real for z in places if low < z.real < high)})
    t = np.arange(-3.6, 3.6001, 1 / 64)
    x = np.tanh(np.pi / 2 * np.sinh(t))
    w = np.pi / 2 * np.cosh(t) / np.cosh(np.pi / 2 * np.sinh(t)) ** 2 / 64
    total = 0.0
    for a, b in pairwise(cuts):
        u = 0.5 * (a + b) + 0.5 * (b - a) * x
        v = np.array([np.polyval(row[::-1], u) for row in velocity])
        total += 0.5 * (b - a) * float((w * np.sqrt((v * v).sum(axis=0))).sum())
    return total


def closed_square(p: Floats) -> bool:
    """Whether the cubic is large enough to have a length that is not rounding alone."""
    return float(np.abs(p[[1, 2, 3, 5, 6, 7]]).max()) > 1e-3


@settings(max_examples=60)
@given(coefficients, scales)
def test_polynomial_lengths_agree_with_double_exponential_quadrature(c: list[float], scale: float) -> None:
    p = row(*c)
    assume(closed_square(p))
    assert k.in_plane_length(POLYNOMIAL, p * scale) == pytest.approx(tanh_sinh_length(p) * scale, rel=1e-12)


@pytest.mark.parametrize(
    "p",
    [
        row(0, 1, -3, 2, 0, 3, -9, 6),  # straight, to and fro
        row(0, 3, -6, 4, 0, 0, 3, -2),  # a cusp inside
        row(0, 1, -2.99, 3, 0, 1, -3, 3.001),  # nearly a cusp
        row(0, 0, 0, 1, 0, 0, 1, 0),  # no speed at the start
        row(0, 10, -30, 20, 0, 5, -5, 1),  # a loop
        row(1e6, 1, 2, 3, -1e6, 3, 2, 1),  # small, far from the origin
        row(0, 1, 2, 3, 0, -1, 4, 1, 0, 2, 0, -3),  # in space
    ],
)
def test_awkward_polynomials_have_their_length(p: Floats) -> None:
    assert k.in_plane_length(POLYNOMIAL, p) == pytest.approx(tanh_sinh_length(p), rel=1e-12)


def test_a_curve_without_extent_has_no_length() -> None:
    p = row(5, 0, 0, 0, 7)
    nodes_u, nodes_s, count = table(POLYNOMIAL, p)
    assert k.in_plane_length(POLYNOMIAL, p) == 0.0
    assert k.parameter(POLYNOMIAL, p, nodes_u, nodes_s, count, 0.0) == 0.0
    assert k.tangent(POLYNOMIAL, p, 0.0) == (0.0, 0.0)


@settings(max_examples=60)
@given(coefficients, scales, st.floats(0.0, 1.0))
def test_the_inverse_finds_the_length_asked_for(c: list[float], scale: float, share: float) -> None:
    p = row(*c)
    assume(closed_square(p))
    nodes_u, nodes_s, count = table(POLYNOMIAL, p * scale)
    length = float(nodes_s[count - 1])
    u = k.parameter(POLYNOMIAL, p * scale, nodes_u, nodes_s, count, share * length)
    assert 0.0 <= u <= 1.0
    assert tanh_sinh_length(p, 0.0, u) * scale == pytest.approx(share * length, abs=1e-12 * length)


@pytest.mark.parametrize(
    ("kind", "p"),
    [
        (ARC, row(0, 0, 5, 1, -4)),
        (ELLIPSE, row(0, 0, 10, 10, 0, -1, 6)),
        (ELLIPSE, row(0, 0, 10, 0.001, 0.5, 1, -6.2)),
        (POLYNOMIAL, row(0, 3, -6, 4, 0, 0, 3, -2)),
        (POLYNOMIAL, row(0, 10, -30, 20, 0, 5, -5, 1)),
    ],
)
def test_the_inverse_is_monotone_and_exact_at_both_ends(kind: int, p: Floats) -> None:
    nodes_u, nodes_s, count = table(kind, p)
    length = float(nodes_s[count - 1])
    found = [k.parameter(kind, p, nodes_u, nodes_s, count, s) for s in np.linspace(0.0, length, 801).tolist()]
    assert found[0] == 0.0
    assert found[-1] == 1.0
    assert all(a < b for a, b in pairwise(found))
    assert k.parameter(kind, p, nodes_u, nodes_s, count, -1.0) == 0.0
    assert k.parameter(kind, p, nodes_u, nodes_s, count, length * 1.1) == 1.0
    # Equal steps of length are equal chords up to the sagitta: the point runs at an even pace.
    points = [k.point(kind, p, u) for u in found]
    chords = [hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points)]
    assert max(chords) <= length / 800 * (1 + 1e-9)


def test_the_table_is_ascending_and_fits() -> None:
    for kind, p in (
        (ELLIPSE, row(0, 0, 1, 1e-12, 0, 0.3, 6.28)),
        (POLYNOMIAL, row(0, 3, -6, 4, 0, 0, 3, -2)),
    ):
        nodes_u, nodes_s, count = table(kind, p)
        assert 2 <= count <= k.NODES
        assert nodes_u[0] == nodes_s[0] == 0.0
        assert nodes_u[count - 1] == 1.0
        assert (np.diff(nodes_u[:count]) > 0).all()
        assert (np.diff(nodes_s[:count]) > 0).all()


@given(coefficients, st.floats(0.01, 0.99))
def test_derivatives_are_those_of_the_points(c: list[float], u: float) -> None:
    h = 1e-4
    for kind, p in (
        (POLYNOMIAL, row(*c)),
        (ARC, row(c[0], c[1], 2 + c[2], c[3], 3 * c[4])),
        (ELLIPSE, row(c[0], c[1], 2 + c[2], 1.5 + c[3], c[4], c[5], 3 * c[6])),
    ):
        before, here, after = (np.array(k.point(kind, p, v)) for v in (u - h, u, u + h))
        assert k.derivative(kind, p, u) == pytest.approx((after - before) / (2 * h), abs=1e-5)
        assert k.second(kind, p, u) == pytest.approx((after - 2 * here + before) / h**2, abs=1e-4)


def test_curvature_of_known_curves() -> None:
    assert k.curvature(ARC, row(0, 0, 4, 0, 1), 0.3) == 0.25
    assert k.max_curvature(ARC, row(0, 0, 4, 0, 1)) == 0.25
    ellipse = row(0, 0, 10, 4, 0.7, 1.0, 6.0)  # passes both ends of the main axis: a / b²
    assert k.max_curvature(ELLIPSE, ellipse) == pytest.approx(10 / 16, rel=1e-12)
    short = row(0, 0, 10, 4, 0.7, 1.2, 0.3)  # does not: the greatest is at an end
    assert k.max_curvature(ELLIPSE, short) == k.curvature(ELLIPSE, short, 0.0)
    parabola = row(-1, 2, 0, 0, 1, -4, 4)  # y = x² on -1..1: 2 at the top
    assert k.max_curvature(POLYNOMIAL, parabola) == pytest.approx(2.0, rel=1e-12)
    assert k.max_curvature(POLYNOMIAL, row(0, 3, 0, 0, 0, 4)) == 0.0
    assert k.curvature(POLYNOMIAL, row(0, 0, 1, 0, 0, 0, 0, 1), 0.0) == inf  # a cusp at its tip


@settings(max_examples=40)
@given(coefficients)
def test_no_place_bends_more_than_the_greatest_curvature(c: list[float]) -> None:
    p = row(*c)
    speeds = [k.speed(POLYNOMIAL, p, u) for u in np.linspace(0, 1, 301).tolist()]
    assume(min(speeds) > 0.05)
    most = max(k.curvature(POLYNOMIAL, p, u) for u in np.linspace(0, 1, 301).tolist())
    assert k.max_curvature(POLYNOMIAL, p) >= most * (1 - 1e-6)


def test_tangents_where_the_speed_is_zero_are_the_limit_from_inside() -> None:
    start = row(0, 0, 3, -2, 0, 0, 4, -1)  # P' = 0 at 0: direction of P''
    assert k.tangent(POLYNOMIAL, start, 0.0) == pytest.approx((0.6, 0.8), rel=1e-15)
    end = row(0, 6, -6, 2, 0, 8, -8, 8 / 3)  # P' = 6 (1 - t)², 8 (1 - t)²: straight up to a stop
    assert k.tangent(POLYNOMIAL, end, 1.0) == pytest.approx((0.6, 0.8), rel=1e-9)
    assert k.tangent3(POLYNOMIAL, row(0, 1, 0, 0, 0, 2, 0, 0, 0, 2), 0.5) == pytest.approx(
        (1 / 3, 2 / 3, 2 / 3)
    )


@contextmanager
def compiled_kernels() -> Iterator[None]:
    before = kernels.compiled()
    kernels.use(compiled=True)
    try:
        yield
    finally:
        kernels.use(compiled=before)


def everything() -> Floats:
    """What every kernel says about curves of every kind, as one array."""
    rows = [
        (ARC, row(1, 2, 3, 4, 5)),
        (ELLIPSE, row(0, 0, 10, 0.01, 0.1, 0.4, 5)),
        (POLYNOMIAL, row(0, 1, -3, 2, 0, 3, -9, 6.5)),
        (POLYNOMIAL, np.random.default_rng(7).normal(size=12)),
    ]
    found: list[float] = []
    for kind, p in rows:
        nodes_u, nodes_s, count = table(kind, p)
        found += [*nodes_u[:count], *nodes_s[:count], k.max_curvature(kind, p)]
        for s in np.linspace(0, nodes_s[count - 1], 23).tolist():
            u = k.parameter(kind, p, nodes_u, nodes_s, count, s)
            found += [u, *k.point3(kind, p, u), *k.tangent3(kind, p, u), *k.second3(kind, p, u)]
            found += [k.curvature(kind, p, u)]
    lengths = np.empty(len(rows))
    k.in_plane_lengths(
        np.array([kind for kind, _ in rows], np.uint8), np.array([p for _, p in rows]), lengths
    )
    return np.array([*found, *lengths])


def test_compiled_kernels_give_the_same_bits() -> None:
    with compiled_kernels():
        fast = everything()
    kernels.use(compiled=False)
    assert everything().tobytes() == fast.tobytes()
