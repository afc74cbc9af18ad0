"""Arcs, ellipses, parabolas and splines in the decoder; points computed here from the stored rows."""

from __future__ import annotations

from math import cos, hypot, sin

import numpy as np
import pytest

from nccompile.toolpath import Kind, Toolpath
from tests.decoder.decoding import kinds, path_of, read, switches, targets

Pair = tuple[float, float]


def cubic(path: Toolpath, row: int, t: float) -> tuple[Pair, Pair]:
    """Point and unit tangent of a polynomial segment."""
    p = path.curves.parameters[path.curve[row]].tolist()
    x = p[0] + t * (p[1] + t * (p[2] + t * p[3]))
    y = p[4] + t * (p[5] + t * (p[6] + t * p[7]))
    dx = p[1] + t * (2 * p[2] + 3 * t * p[3])
    dy = p[5] + t * (2 * p[6] + 3 * t * p[7])
    size = hypot(dx, dy)
    return (x, y), (dx / size, dy / size)


def arc_tangent(path: Toolpath, row: int, at_end: bool) -> Pair:
    """Unit tangent of an arc in the direction of motion."""
    _, _, _, start, sweep = path.curves.parameters[path.curve[row]][:5].tolist()
    angle = start + (sweep if at_end else 0.0)
    sign = 1.0 if sweep > 0 else -1.0
    return -sign * sin(angle), sign * cos(angle)


def test_parabola_is_tangent_to_the_lines_through_its_intersection() -> None:
    path = path_of("G1 X10 Y0 F10", "G6 X30 Y0 I10 J20")
    assert kinds(path)[1] == Kind.POLYNOMIAL
    (x0, y0), first = cubic(path, 1, 0.0)
    (x1, y1), last = cubic(path, 1, 1.0)
    assert (x0, y0, x1, y1) == pytest.approx((10, 0, 30, 0))
    assert first == pytest.approx((10 / hypot(10, 20), 20 / hypot(10, 20)))
    assert last == pytest.approx((10 / hypot(10, 20), -20 / hypot(10, 20)))
    assert cubic(path, 1, 0.5)[0] == pytest.approx((20, 10))  # the vertex halves the height of the triangle


def test_absolute_intersection_of_a_parabola() -> None:
    assert np.array_equal(
        path_of("G1 X10 F10", "G6 X30 I10 J20").curves.parameters,
        path_of("G1 X10 F10", "G98", "G6 X30 I20 J20").curves.parameters,
    )


def test_spline_passes_its_points_without_kinks() -> None:
    path = path_of("G1 X10 F10", "G5 X20 Y5", "G5 X30 Y-5", "X40 Y0", "G1 X50 Y0")
    assert kinds(path) == [Kind.LINE, *[Kind.POLYNOMIAL] * 3, Kind.LINE]
    assert cubic(path, 1, 0.0)[1] == pytest.approx((1, 0), abs=1e-12)  # the line before
    assert cubic(path, 3, 1.0)[1] == pytest.approx((1, 0), abs=1e-12)  # the line after
    for row in (1, 2):
        (end, leaves), (begin, enters) = cubic(path, row, 1.0), cubic(path, row + 1, 0.0)
        assert end == pytest.approx(begin)
        assert leaves == pytest.approx(enters, abs=1e-12)
    chord = np.array([40 - 20, 0 - 5]) / hypot(20, 5)
    assert cubic(path, 2, 1.0)[1] == pytest.approx(tuple(chord))  # parallel to the chord of the neighbours


def test_spline_joins_arcs_and_ellipses_and_parabolas() -> None:
    path = path_of("G2 X10 Y0 R8 F10", "G5 X20 Y-8", "G5 X30 Y0", "G3 X40 Y0 R9")
    assert cubic(path, 1, 0.0)[1] == pytest.approx(arc_tangent(path, 0, True), abs=1e-12)
    assert cubic(path, 2, 1.0)[1] == pytest.approx(arc_tangent(path, 3, False), abs=1e-12)
    path = path_of("G6 X10 Y0 I5 J5 F10", "G5 X20 Y-8", "G6 X30 Y0 I2 J-3")
    assert cubic(path, 1, 0.0)[1] == pytest.approx(cubic(path, 0, 1.0)[1], abs=1e-12)
    assert cubic(path, 1, 1.0)[1] == pytest.approx(cubic(path, 2, 0.0)[1], abs=1e-12)
    path = path_of("G1 X-5 F10", "G1 X0", "G5 X20 Y-8", "G9 X40 Y-8 I10 J0 K0 R0.5")
    assert cubic(path, 2, 1.0)[1] == pytest.approx((0, -1), abs=1e-9)  # an ellipse leaves its vertex square


def test_a_dwell_or_m_function_does_not_cut_a_spline() -> None:
    path = path_of("G5 X10 Y5 F10", "M5", "G4 T1", "G5 X20 Y0", "G1 X30 Y5")
    assert kinds(path) == [Kind.POLYNOMIAL, Kind.M_FUNCTION, Kind.DWELL, Kind.POLYNOMIAL, Kind.LINE]
    assert cubic(path, 0, 1.0)[1] == pytest.approx(cubic(path, 3, 0.0)[1], abs=1e-12)
    assert cubic(path, 3, 1.0)[1] == pytest.approx((10 / hypot(10, 5), 5 / hypot(10, 5)))


@pytest.mark.parametrize("after", ["G0 X30 Y30", "G1 Z5", "G92 X0"])
def test_a_spline_ends_free_where_the_path_does_not_go_on(after: str) -> None:
    alone = path_of("G1 X10 F10", "G5 X15 Y8", "G5 X20 Y5")
    followed = path_of("G1 X10 F10", "G5 X15 Y8", "G5 X20 Y5", after)
    assert np.array_equal(alone.curves.parameters, followed.curves.parameters)


def test_a_spline_point_over_its_predecessor_is_a_line() -> None:
    path = path_of("G5 X10 Y5 F10", "G5 Z-2", "G5 X20 Y0")
    assert kinds(path) == [Kind.POLYNOMIAL, Kind.LINE, Kind.POLYNOMIAL]
    assert path.length[1] == 2


def test_switches_on_a_spline_are_placed_by_its_final_length() -> None:
    path = path_of("G1 X10 F10", "G5 X20 Y5 Z3 H1 L2 H-1 L-2", "G1 X20 Y50")
    length = path.length[1]
    (_, on, first), (_, off, last) = switches(path)
    assert (on, off) == (1, -1)
    assert (first, last) == pytest.approx((2 / length, 1 - 2 / length), rel=1e-12)


def test_missing_centre_coordinate_is_that_of_the_start() -> None:
    relative = path_of("G1 X10 Y5 F10", "G2 X30 Y5 I10")
    absolute = path_of("G1 X10 Y5 F10", "G98", "G2 X30 Y5 I20")
    assert np.array_equal(relative.curves.parameters, absolute.curves.parameters)
    assert relative.curves.parameters[0, :2].tolist() == [20, 5]


def test_centre_wins_over_radius() -> None:
    path, found = read("% a\nG2 X20 Y0 I10 J0 R50 F10")
    assert path.curves.parameters[0, 2] == 10
    assert [f.code for f in found] == ["NC105"]


def test_helix_and_additional_axes_go_along() -> None:
    path = path_of("G1 X10 F10", "G3 X10 Y0 I-10 J0 Z-3 C360")
    assert targets(path)[1] == [10, 0, -3, 360]
    assert path.length[1] == pytest.approx(hypot(20 * 3.141592653589793, 3), rel=1e-12)


def test_s_profile_takes_z_out_of_the_length_of_an_arc() -> None:
    path = path_of("G1 X10 F10", "S3", "G3 X10 Y0 I-10 J0 Z-3")
    assert path.length[1] == pytest.approx(20 * 3.141592653589793, rel=1e-12)


@pytest.mark.parametrize(
    ("block", "code"),
    [
        ("G2 X10 Y0 R3", "NC201"),
        ("G3 X10", "NC201"),
        ("G2 X10 R-5", "NC201"),
        ("G8 X10 R0.5", "NC202"),
        ("G9 X10 I5 R0", "NC202"),
        ("G6 X10", "NC203"),
    ],
)
def test_what_cannot_be_becomes_a_line(block: str, code: str) -> None:
    path, found = read(f"% a\nF10\n{block}\nG1 X11")
    assert kinds(path) == [Kind.LINE, Kind.LINE]
    assert [f.code for f in found] == [code]
    assert targets(path)[0] == [10, 0, 0]
