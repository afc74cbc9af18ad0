"""Every example program of SoftMotion §3.2 and §3.3, against geometry computed here.

Nothing of nccompile.geometry or its kernels is used: a point of a curve comes from the stored centre, radii
and angles by `math`, and is then held against what the manual's text states.
"""

from __future__ import annotations

from math import cos, degrees, hypot, isclose, pi, radians, sin, sqrt

import numpy as np
import pytest

from nccompile.toolpath import Kind, Toolpath
from tests.decoder.decoding import kinds, path_of, read, switches, targets

Point = tuple[float, float]


def arc_points(path: Toolpath, row: int, count: int = 33) -> list[Point]:
    """Points of a circular arc in the direction of motion."""
    cx, cy, radius, start, sweep = path.curves.parameters[path.curve[row]][:5].tolist()
    angles = [start + sweep * i / (count - 1) for i in range(count)]
    return [(cx + radius * cos(a), cy + radius * sin(a)) for a in angles]


def near(a: Point, b: Point, tolerance: float = 1e-9) -> bool:
    return hypot(a[0] - b[0], a[1] - b[1]) <= tolerance


SEMICIRCLES = {
    "by radius": ["N10 G1 X100 Y100 F10", "N20 G2 X200 Y100 R50"],
    "by relative centre": ["N10 G1 X100 Y100 F10", "N15 G99", "N20 G2 X200 Y100 I50 J0"],
    "by absolute centre": ["N10 G1 X100 Y100 F10", "N15 G98", "N20 G2 X200 Y100 I150 J100"],
}


@pytest.mark.parametrize("blocks", SEMICIRCLES.values(), ids=SEMICIRCLES.keys())
def test_semicircle(blocks: list[str]) -> None:
    path = path_of(*blocks)
    assert kinds(path) == [Kind.LINE, Kind.ARC]
    points = arc_points(path, 1)
    assert near(points[0], (100, 100))
    assert near(points[-1], (200, 100))
    assert near(points[16], (150, 150))  # clockwise from west to east passes north
    assert all(isclose(hypot(x - 150, y - 100), 50, rel_tol=1e-12) for x, y in points)
    assert isclose(path.length[1], 50 * pi, rel_tol=1e-12)
    assert targets(path)[1] == [200, 100, 0]


def test_the_smaller_of_both_arcs_is_taken_with_a_radius() -> None:
    path = path_of("N10 G1 X100 F10", "N20 G3 X200 R80")
    *_, sweep = path.curves.parameters[0][:5].tolist()
    assert 0 < sweep < pi
    points = arc_points(path, 1)
    assert all(y <= 1e-9 for _, y in points)  # counter-clockwise from west to east bulges south
    assert near(points[-1], (200, 0))


@pytest.mark.parametrize("block", ["N20 G2 X10 Y0 I20 J0", "N20 G2 I20 J0"])
def test_full_circle_when_start_is_end(block: str) -> None:
    path = path_of("N10 G1 X10 F10", block)
    assert isclose(path.length[1], 2 * pi * 20, rel_tol=1e-12)
    points = arc_points(path, 1)
    assert near(points[0], (10, 0))
    assert near(points[8], (30, 20))  # clockwise: north of the centre after a quarter
    assert near(points[16], (50, 0))
    assert near(points[-1], (10, 0))


def test_a_centre_that_does_not_fit_gives_a_line() -> None:
    path, found = read("% a\nN10 G1 X100 Y100 F10\nN20 G2 X200 Y100 I40 J0")
    assert kinds(path) == [Kind.LINE, Kind.LINE]
    assert [f.code for f in found] == ["NC201"]
    assert "40 mm" in found[0].message
    assert "60 mm" in found[0].message


def test_ellipse() -> None:
    path = path_of("N10 G0 X100 Y100", "N15 G98", "N20 G8 X200 Y100 I150 J100 K45 R0.5 F10")
    assert kinds(path) == [Kind.POSITIONING, Kind.ELLIPSE]
    cx, cy, main, sub, direction, start, sweep = path.curves.parameters[0][:7].tolist()
    assert (cx, cy) == (pytest.approx(150, abs=1e-9), pytest.approx(100, abs=1e-9))
    assert sub / main == pytest.approx(0.5, rel=1e-12)
    assert degrees(direction) == pytest.approx(45)
    assert sweep == pytest.approx(-pi, abs=1e-9)  # clockwise, and both ends mirror each other in the centre

    # The ends lie 45 degrees off the main axis: with p = 50 cos 45, p²/a² + p²/b² = 1 and b = a/2.
    assert main == pytest.approx(50 * sqrt(2.5), rel=1e-12)

    def point(t: float) -> Point:
        xi, eta = main * cos(t), sub * sin(t)
        c, s = cos(direction), sin(direction)
        return cx + c * xi - s * eta, cy + s * xi + c * eta

    assert near(point(start), (100, 100))
    assert near(point(start + sweep), (200, 100))
    assert point(start + sweep / 2)[1] > 100  # clockwise from west to east passes north
    t = np.linspace(start, start + sweep, 200_001)
    xi, eta = main * np.cos(t), sub * np.sin(t)
    assert path.length[1] == pytest.approx(float(np.hypot(np.diff(xi), np.diff(eta)).sum()), rel=1e-9)


@pytest.mark.parametrize("variable", ["O$g_i$ ", ""], ids=["named", "implicit"])
def test_five_times_loop(variable: str) -> None:
    condition = " K$g_i$" if variable else ""
    path = path_of(
        f"N1000 G36 {variable}D5",
        "N1010 G1 X100 F100 E100 E-100",
        "N1020 G1 X0",
        f"N1030 G37 {variable}D-1",
        f"N1040 G20 L1010{condition}",
    )
    assert targets(path) == [[100, 0, 0], [0, 0, 0]] * 5
    assert path.line.tolist() == [3, 4] * 5
    assert path.accel.tolist() == [100] * 10
    assert path.decel.tolist() == [100] * 10
    assert path.length.tolist() == [100] * 10


def test_switch_at_a_quarter() -> None:
    path = path_of("N90 G1 X20 Y20 F10", "N100 G1 X100 Y40 H-2 O0.25")
    assert switches(path) == [(1, -2, 0.25)]
    begin, end = path.target
    assert (begin + 0.25 * (end - begin))[:2].tolist() == [40, 25]


def test_m_function_waits() -> None:
    path = path_of("N90 M10")
    assert kinds(path) == [Kind.M_FUNCTION]
    assert switches(path) == [(0, 10, 0.0)]


def test_set_position_sequence() -> None:
    path = path_of("N10 G92 X100 Y100", "N20 G1 X100 Y100 F10", "N30 G92 X50 Y100")
    assert path.start.tolist() == [100, 100, 0]  # before any motion it sets the start position
    assert kinds(path) == [Kind.LINE, Kind.SET_POSITION]  # the line of length 0 gives the position out once
    assert path.length.tolist() == [0, 0]
    assert targets(path) == [[100, 100, 0], [50, 100, 0]]


def test_of_several_set_positions_only_the_last_is_given_out() -> None:
    path = path_of("G1 X5 F10", "G92 X100", "G92 X60 Y7", "G92 X50", "G1 X51")
    assert kinds(path) == [Kind.LINE, Kind.SET_POSITION, Kind.LINE]
    assert targets(path) == [[5, 0, 0], [50, 7, 0], [51, 7, 0]]


def test_between_two_set_positions_a_line_gives_the_first_out() -> None:
    path = path_of("G1 X5 F10", "G92 X100 Y100", "G1 X100 Y100", "G92 X50 Y100")
    assert kinds(path) == [Kind.LINE, Kind.SET_POSITION, Kind.LINE, Kind.SET_POSITION]
    assert targets(path)[1:] == [[100, 100, 0], [100, 100, 0], [50, 100, 0]]


def test_split_at_half_leaves_the_path_as_it_was() -> None:
    """§3.3: the line to (40, 50) divided at 0.5 gets the additional position (20, 40)."""
    whole = path_of("N10 G01 X40.0 Y50.0 F10 H1 O0.5", "N20 G01 X123.000000 Y73.550000", start={"Y": 30.0})
    halves = path_of(
        "N0 G01 X20.000000 Y40.000000 F10",
        "N10 G01 X40.000000 Y50.000000",
        "N20 G01 X123.000000 Y73.550000",
        start={"Y": 30.0},
    )
    begin, end = whole.start, whole.target[0]
    assert (begin + 0.5 * (end - begin)).tolist() == halves.target[0].tolist() == [20, 40, 0]
    assert halves.length[0] == halves.length[1] == whole.length[0] / 2
    assert targets(halves)[1:] == targets(whole)


def test_header_and_first_example() -> None:
    path = path_of(
        "N10 G01 X100 Y100 E100 F100 E-200",
        "N20 G01 Z40 F20",
        "N30 G03 X-100 R200 F100",
    )
    assert kinds(path) == [Kind.LINE, Kind.LINE, Kind.ARC]
    assert targets(path) == [[100, 100, 0], [100, 100, 40], [-100, 100, 40]]
    assert path.feed.tolist() == [100, 20, 100]
    assert path.accel.tolist() == [100] * 3
    assert path.decel.tolist() == [200] * 3
    points = arc_points(path, 2)
    assert near(points[0], (100, 100))
    assert near(points[-1], (-100, 100))
    assert all(hypot(x, y - (100 - 100 * sqrt(3))) == pytest.approx(200, rel=1e-12) for x, y in points)
    assert points[16][1] > 100  # counter-clockwise from east to west passes north
    assert path.length[2] == pytest.approx(radians(60) * 200, rel=1e-12)


def test_variable_as_radius() -> None:
    path = path_of("N10 G2 X100 F10 R$g_fVar$", defines={"G_FVAR": 50.0})
    assert path.length[0] == pytest.approx(50 * pi, rel=1e-12)


def test_letters_have_no_case_and_leading_zeros_do_not_count() -> None:
    one, two = path_of("N10 G01 X1 F10"), path_of("n010g1x01f10")
    assert targets(one) == targets(two)
    assert kinds(one) == kinds(two)


def test_a_block_without_instruction_repeats_the_last() -> None:
    path = path_of("N10 G1 X1 F10", "N20 X2", "N30 G0 X3", "N40 X4")
    assert kinds(path) == [Kind.LINE, Kind.LINE, Kind.POSITIONING, Kind.POSITIONING]
