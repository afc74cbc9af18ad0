"""Limits as arrays; axes and travel of a path, with sampled curves as the independent measure."""

from __future__ import annotations

from math import inf, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.diagnostics import Diagnostics
from nccompile.machine.extents import extents
from nccompile.machine.limits import check_axes, check_travel, limits, missing_axes, offsets, travel
from nccompile.machine.model import Machine, default_machine, parse
from nccompile.source import Source
from nccompile.toolpath.columns import Curves, Floats, Kind, Plane, Toolpath
from tests.runtime.paths import planned

TEXT = """
[machine]
name = "small"
[axes.X]
min = -10
max = 10
velocity = 100
acceleration = 1000
velocity_step = 5
rapid = 80
[axes.Y]
min = -10
max = 10
velocity = 50
acceleration = 500
velocity_step = 2
"""
SOURCE = Source("part.nc", "\n".join(f"  N{i} G1" for i in range(1, 100)))


def small(more: str = "") -> Machine:
    return parse(TEXT + more, "small.toml")


def test_limits_follow_the_order_of_the_axes() -> None:
    at = limits(small(), ("Y", "X", "Z"))
    assert at.velocity.tolist() == [50, 100, inf]
    assert at.acceleration.tolist() == [500, 1000, inf]
    assert at.velocity_step.tolist() == [2, 5, inf]
    assert at.rapid.tolist() == [inf, 80, inf]  # without the key G0 runs at the program's F
    low, high = travel(small(), ("X", "Z"))
    assert (low.tolist(), high.tolist()) == ([-10, -inf], [10, inf])
    assert offsets(small("[kinematics]\noffset = { Y = 3 }"), ("X", "Y")).tolist() == [0, 3]


def test_missing_axes() -> None:
    assert missing_axes(small(), ("X", "Y", "Z", "A")) == ("Z", "A")
    assert missing_axes(default_machine(), tuple("XYZABCPQUVW")) == ()


def found(check: object, path: Toolpath, machine: Machine) -> list[tuple[str, int, str]]:
    diagnostics = Diagnostics()
    check(path, machine, SOURCE, diagnostics)  # type: ignore[operator]
    return [(d.code, d.span.line, d.message) for d in diagnostics]


def test_only_an_axis_that_moves_is_missed() -> None:
    still = planned([[1, 0, 5], [2, 0, 5]], [0, 0, 5])
    assert found(check_axes, still, small()) == []
    moving = planned([[1, 0, 0], [2, 0, 5], [3, 0, 6]])
    assert found(check_axes, moving, small()) == [("NC401", 2, "the machine small has no axis Z")]


def test_travel_is_reported_once_for_each_time_it_is_left() -> None:
    path = planned([[5, 0, 0], [12, 0, 0], [15, 0, 0], [5, 0, 0], [5, -11, 0], [5, 0, 0]])
    wanted = [
        ("NC402", 2, "axis X reaches 12 mm, beyond its maximum of 10 mm"),
        ("NC402", 5, "axis Y reaches -11 mm, beyond its minimum of -10 mm"),
    ]
    assert found(check_travel, path, small()) == wanted
    by_row = [f for i in range(6) for f in found(check_travel, path.rows(i, i + 1), small())]
    assert by_row == wanted  # whatever the chunks


def test_a_start_outside_is_reported_and_offsets_count() -> None:
    path = planned([[1, 0, 0]], [11, 0, 0])
    assert found(check_travel, path, small()) == [
        ("NC402", 1, "axis X reaches 11 mm, beyond its maximum of 10 mm")
    ]
    shifted = small("[kinematics]\noffset = { X = -2 }")
    assert found(check_travel, path, shifted) == []
    assert found(check_travel, planned([[-9, 0, 0]]), shifted)[0][2].startswith("axis X reaches -11 mm")


def test_a_path_on_the_limit_is_inside() -> None:
    assert found(check_travel, planned([[10, -10, 0], [10 + 1e-12, 10, 0]]), small()) == []
    assert found(check_travel, Toolpath.empty(), small()) == []


def curved(kind: Kind, plane: Plane, parameters: list[float], ends: Floats) -> Toolpath:
    path = planned([ends[1]], ends[0].tolist())
    return path.replace(
        kind=np.array([kind], np.uint8),
        curve=np.zeros(1, np.int32),
        curves=Curves.from_rows([(int(plane), parameters)]),
    )


def test_an_arc_that_bulges_out_is_found() -> None:
    """A half circle of radius 8 about (5, 0) from (5, 8) to (5, -8): its ends are inside, X = 13 is not."""
    arc = curved(Kind.ARC, Plane.XY, [5, 0, 8, pi / 2, -pi], np.array([[5, 8, 0], [5, -8, 0.0]]))
    assert found(check_travel, arc, small()) == [
        ("NC402", 1, "axis X reaches 13 mm, beyond its maximum of 10 mm")
    ]


SMALL = st.floats(-20, 20)
UNIT = np.linspace(0.0, 1.0, 20_001)


def boxed(path: Toolpath, plane: Plane, course: list[Floats]) -> None:
    """The box holds the sampled course and touches it on every side."""
    low, high = extents(path)
    for axis, values in zip({0: (0, 1), 1: (2, 0), 2: (1, 2), 3: (0, 1, 2)}[int(plane)], course, strict=True):
        size = 1.0 + np.abs(values).max()
        assert low[0, axis] <= values.min() + 1e-12 * size
        assert high[0, axis] >= values.max() - 1e-12 * size
        assert low[0, axis] >= values.min() - 1e-5 * size
        assert high[0, axis] <= values.max() + 1e-5 * size


def place(plane: Plane, course: list[Floats]) -> Floats:
    ends = np.zeros((2, 3))
    for axis, values in zip({0: (0, 1), 1: (2, 0), 2: (1, 2), 3: (0, 1, 2)}[int(plane)], course, strict=True):
        ends[:, axis] = values[0], values[-1]
    return ends


@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from([Plane.XY, Plane.ZX, Plane.YZ]), SMALL, SMALL, st.floats(0.1, 20), st.floats(0.01, 1),
    st.floats(-7, 7), st.floats(-7, 7), st.floats(-2 * pi, 2 * pi),
)  # fmt: skip
def test_boxes_of_ellipses(
    plane: Plane, cu: float, cv: float, main: float, ratio: float, d: float, start: float, sweep: float
) -> None:
    e = start + sweep * UNIT
    u = cu + main * np.cos(e) * np.cos(d) - main * ratio * np.sin(e) * np.sin(d)
    v = cv + main * np.cos(e) * np.sin(d) + main * ratio * np.sin(e) * np.cos(d)
    path = curved(Kind.ELLIPSE, plane, [cu, cv, main, main * ratio, d, start, sweep], place(plane, [u, v]))
    boxed(path, plane, [u, v])


@settings(max_examples=60, deadline=None)
@given(SMALL, SMALL, st.floats(0.1, 20), st.floats(-7, 7), st.floats(-2 * pi, 2 * pi))
def test_boxes_of_arcs(cu: float, cv: float, r: float, start: float, sweep: float) -> None:
    angle = start + sweep * UNIT
    course = [cu + r * np.cos(angle), cv + r * np.sin(angle)]
    boxed(curved(Kind.ARC, Plane.ZX, [cu, cv, r, start, sweep], place(Plane.ZX, course)), Plane.ZX, course)


@settings(max_examples=60, deadline=None)
@given(st.sampled_from([Plane.XY, Plane.SPACE]), st.lists(SMALL, min_size=12, max_size=12))
def test_boxes_of_cubics(plane: Plane, c: list[float]) -> None:
    coordinates = 3 if plane is Plane.SPACE else 2
    course = [
        sum((c[4 * i + power] * UNIT**power for power in range(4)), np.zeros(len(UNIT)))
        for i in range(coordinates)
    ]
    boxed(curved(Kind.POLYNOMIAL, plane, c[: 4 * coordinates], place(plane, course)), plane, course)


def test_a_jump_does_not_pass_the_points_between() -> None:
    path = planned([[9, 0, 0]], [-50, 0, 0], kind=Kind.SET_POSITION)
    low, high = extents(path)
    assert (low[0, 0], high[0, 0]) == (9, 9)


@pytest.mark.parametrize("letter", list("XYZ"))
def test_kinematics_of_the_gantry(letter: str) -> None:
    from nccompile.kinematics import build

    machine = parse(
        '[machine]\nname = "m"\n'
        + "".join(f"[axes.{a}]\nvelocity=9\nacceleration=9\nvelocity_step=1\n" for a in "XYZ" if a != letter)
        + f"[kinematics]\noffset = {{ {'Y' if letter != 'Y' else 'X'} = 2.5 }}",
        "m.toml",
    )
    gantry = build(machine, ("X", "Y", "Z"))
    assert gantry.axes == tuple(a for a in "XYZ" if a != letter)
    points = np.arange(12.0).reshape(4, 3)
    at = gantry.to_axes(points)
    for column, a in enumerate(gantry.axes):
        shift = machine.kinematics.offset.get(a, 0.0)
        np.testing.assert_array_equal(at[:, column], points[:, "XYZ".index(a)] + shift)
    back = gantry.to_path(at)
    kept = ["XYZ".index(a) for a in gantry.axes]
    np.testing.assert_array_equal(back[:, kept], points[:, kept])
    assert not back[:, "XYZ".index(letter)].any()


def test_a_gantry_without_offsets_changes_no_bit() -> None:
    from nccompile.kinematics import build

    points = np.array([[0.1, -0.0, 1e-300]])
    assert build(default_machine(), ("X", "Y", "Z")).to_axes(points) is points
