"""Curves cut before planning: the parts are the curve, cusps are junctions, compiled and plain kernels agree."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile import kernels
from nccompile.kernels.curve_parts import PARTS
from nccompile.kernels.curves import NODES, parameter, point3, tabulate, tangent3
from nccompile.machine.model import default_machine
from nccompile.passes.velocity import LOOK_AHEAD, PLANNERS, SOFTMOTION, TIME_OPTIMAL, PlanSettings
from nccompile.passes.velocity.cuts import cut_at_bends
from nccompile.toolpath.columns import Floats, Toolpath
from nccompile.toolpath.verify import verify
from tests.velocity.test_optimal import spline_rows

OPTIONS = {
    name: PlanSettings.from_machine(default_machine(), ("X", "Y", "Z"), planner=name) for name in PLANNERS
}
numbers = st.floats(-50.0, 50.0).map(lambda x: round(x, 3))


@st.composite
def cubics(draw: st.DrawFn) -> Floats:
    """Coefficients (3, 4) of a cubic by its control points; often one that turns back on a line."""
    control = np.array([[draw(numbers) for _ in range(3)] for _ in range(4)])
    if draw(st.booleans()):
        control = (
            control[0] + np.outer([draw(numbers) for _ in range(4)], control[1] - control[0] + 1.0) / 50.0
        )
    a, b, c, d = control
    return np.stack([a, 3 * (b - a), 3 * (a - 2 * b + c), d - a + 3 * (b - c)], axis=1)


@settings(max_examples=30, deadline=None)
@given(cubics(), st.sampled_from([SOFTMOTION, LOOK_AHEAD, TIME_OPTIMAL]))
def test_the_parts_are_the_curve(cubic: Floats, planner: str) -> None:
    path = spline_rows([cubic])
    if path.length[0] < 1e-3:
        return
    parts = cut_at_bends(path, OPTIONS[planner])
    verify(parts)
    assert 1 <= len(parts) <= PARTS
    assert np.array_equal(parts.end, path.end)
    assert np.isclose(parts.length.sum(), path.length[0], rtol=1e-8)
    p, nodes_u, nodes_s = path.curves.parameters[0], np.empty(NODES), np.empty(NODES)
    count = tabulate(4, p, nodes_u, nodes_s)
    for i, s in enumerate(np.cumsum(parts.length)):
        here = point3(
            4, p, parameter(4, p, nodes_u, nodes_s, count, min(float(s), float(nodes_s[count - 1])))
        )
        assert np.allclose(here, parts.target[i], rtol=0.0, atol=1e-6)


@pytest.mark.parametrize("planner", PLANNERS)
def test_a_cusp_is_a_junction_of_half_a_turn(planner: str) -> None:
    cubic = (
        np.outer([0.6, 0.8, 0.1], [0.0, -0.3, 0.5, 0.0]) * 50.0
    )  # back and forth on a line, turning at u = 0.3
    parts = cut_at_bends(spline_rows([cubic]), OPTIONS[planner])
    tables = parts.curves.parameters
    turns = [
        float(np.dot(tangent3(4, tables[i], 1.0), tangent3(4, tables[i + 1], 0.0)))
        for i in range(len(tables) - 1)
    ]
    assert sum(turn < -1.0 + 1e-9 for turn in turns) == 1
    assert all(abs(turn) > 1.0 - 1e-9 for turn in turns)


@settings(max_examples=20, deadline=None)
@given(cubics())
def test_no_part_turns_more_than_asked_for(cubic: Floats) -> None:
    path = spline_rows([cubic])
    parts = cut_at_bends(path, OPTIONS[TIME_OPTIMAL])
    if path.length[0] < 1e-3 or len(parts) > PARTS // 2:
        return  # a point has no direction; where there is no room the rest comes as it is
    for p in parts.curves.parameters:
        cosine = float(np.dot(tangent3(4, p, 0.0), tangent3(4, p, 1.0)))
        assert cosine >= np.cos(1.25 * pi / 180.0) - 1e-9


@settings(max_examples=8, deadline=None)
@given(st.lists(cubics(), min_size=1, max_size=2), st.sampled_from([LOOK_AHEAD, TIME_OPTIMAL]))
def test_compiled_and_plain_kernels_give_the_same_bits(shapes: list[Floats], planner: str) -> None:
    for shape in shapes:
        plain: Toolpath = cut_at_bends(spline_rows([shape]), OPTIONS[planner])
        before = kernels.compiled()
        kernels.use(compiled=True)
        try:
            machine = cut_at_bends(spline_rows([shape]), OPTIONS[planner])
        finally:
            kernels.use(compiled=before)
        assert np.array_equal(plain.curves.parameters, machine.curves.parameters)
        assert np.array_equal(plain.length, machine.length)
