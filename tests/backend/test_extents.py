"""The box of curves against densely sampled ones."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from nccompile.toolpath import Curves, Kind, Plane
from nccompile.toolpath.extents import extents
from tests.backend.paths import planned

angles = st.floats(-2 * pi, 2 * pi)
lengths = st.floats(0.01, 100.0)


@given(st.sampled_from([Plane.XY, Plane.ZX, Plane.YZ]), lengths, lengths, angles, angles, angles)
def test_ellipses(plane: Plane, main: float, sub: float, phi: float, start: float, sweep: float) -> None:
    theta = start + sweep * np.linspace(0, 1, 2001)
    u = 3 + main * np.cos(theta) * cos(phi) - sub * np.sin(theta) * sin(phi)
    v = -2 + main * np.cos(theta) * sin(phi) + sub * np.sin(theta) * cos(phi)
    order = {Plane.XY: (0, 1), Plane.ZX: (2, 0), Plane.YZ: (1, 2)}[plane]
    points = np.zeros((2001, 3))
    points[:, order[0]], points[:, order[1]] = u, v
    curves = Curves.from_rows([(plane, (3.0, -2.0, main, sub, phi, start, sweep))])
    path = planned([Kind.ELLIPSE], [points[-1].tolist()], curves, start=points[0])
    low, high = extents(path)
    slack = 1e-5 * max(main, sub)  # what a chord of the sampled curve may cut off
    assert (low <= points.min(axis=0) + 1e-9).all()
    assert (high >= points.max(axis=0) - 1e-9).all()
    assert np.allclose(low, points.min(axis=0), atol=slack)
    assert np.allclose(high, points.max(axis=0), atol=slack)


@given(st.lists(st.floats(-50, 50), min_size=12, max_size=12), st.booleans())
def test_polynomials(coefficients: list[float], in_space: bool) -> None:
    t = np.linspace(0, 1, 4001)[:, None] ** np.arange(4)
    rows = np.array(coefficients).reshape(3, 4)
    if not in_space:
        rows[2] = 0
    points = t @ rows.T
    curves = Curves.from_rows([(Plane.SPACE if in_space else Plane.XY, rows.ravel().tolist())])
    path = planned([Kind.POLYNOMIAL], [points[-1].tolist()], curves, start=points[0])
    low, high = extents(path)
    assert (low <= points.min(axis=0) + 1e-9).all()
    assert (high >= points.max(axis=0) - 1e-9).all()
    assert np.allclose(low, points.min(axis=0), atol=1e-4)
    assert np.allclose(high, points.max(axis=0), atol=1e-4)
