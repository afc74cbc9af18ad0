"""Parabolas and cardinal splines: ends, tangents, smooth joints, degenerate points."""

from __future__ import annotations

from itertools import pairwise
from math import asinh, hypot, sqrt

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from nccompile.geometry import Impossible, cardinal_spline, parabola_by_tangents

points = st.lists(st.tuples(st.floats(-100.0, 100.0), st.floats(-100.0, 100.0)), min_size=3, max_size=8)


def test_a_parabola_has_its_tangents_through_the_intersection() -> None:
    curve = parabola_by_tangents(0.0, 0.0, 20.0, 0.0, 10.0, 10.0)
    half = sqrt(0.5)
    assert curve.start_tangent == pytest.approx((half, half), rel=1e-15)
    assert curve.end_tangent == pytest.approx((half, -half), rel=1e-15)
    assert curve.point(0.5) == (10.0, 5.0)  # half way between chord and intersection
    # y = x - x²/20: twice the closed length of a parabola from its top to slope 1
    assert curve.length == pytest.approx(10.0 * (sqrt(2.0) + asinh(1.0)), rel=1e-14)


@given(st.tuples(*[st.floats(-50.0, 50.0)] * 6))
def test_a_parabola_meets_its_ends(c: tuple[float, ...]) -> None:
    cross = (c[4] - c[0]) * (c[3] - c[5]) - (c[5] - c[1]) * (c[2] - c[4])
    assume(abs(cross) > 1e-3)
    curve = parabola_by_tangents(*c)
    assert curve.point(0.0) == (c[0], c[1])
    assert curve.point(1.0) == pytest.approx((c[2], c[3]), abs=1e-12)


def test_a_parabola_that_had_to_turn_back_is_refused() -> None:
    with pytest.raises(Impossible, match=r"5 mm beyond them: the parabola had to turn back"):
        parabola_by_tangents(0.0, 0.0, 10.0, 0.0, 15.0, 0.0)
    straight = parabola_by_tangents(0.0, 0.0, 10.0, 0.0, 4.0, 0.0)
    assert straight.length == pytest.approx(10.0, rel=1e-15)
    with pytest.raises(Impossible, match="not a finite number"):
        parabola_by_tangents(0.0, 0.0, 10.0, 0.0, float("inf"), 0.0)


@given(points, st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))
def test_pieces_meet_with_one_tangent(path: list[tuple[float, float]], start: float, end: float) -> None:
    steps = [hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(path)]
    assume(min(steps) > 1e-3)
    around = [hypot(c[0] - a[0], c[1] - a[1]) for a, c in zip(path, path[2:], strict=False)]
    assume(min(around) > 1e-3)
    first, last = (np.cos(start), np.sin(start)), (np.cos(end), np.sin(end))
    pieces = cardinal_spline(path, first, last)
    assert len(pieces) == len(path) - 1
    assert pieces[0].start_tangent == pytest.approx(first, abs=1e-12)
    assert pieces[-1].end_tangent == pytest.approx(last, abs=1e-9)
    for a, b, piece in zip(path, path[1:], pieces, strict=False):
        assert piece.point(0.0) == a
        assert piece.point(1.0) == pytest.approx(b, abs=1e-12)
    for one, other in pairwise(pieces):
        assert one.end_tangent == pytest.approx(other.start_tangent, abs=1e-8)


def test_equal_chords_give_the_textbook_cardinal_spline() -> None:
    path = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (20.0, 10.0)]
    middle = cardinal_spline(path, None, None)[1]
    # Catmull-Rom: M1 = (P2 - P0) / 2, M2 = (P3 - P1) / 2
    assert (middle.parameters[1], middle.parameters[5]) == (5.0, 5.0)
    x = middle.parameters[1] + 2 * middle.parameters[2] + 3 * middle.parameters[3]
    y = middle.parameters[5] + 2 * middle.parameters[6] + 3 * middle.parameters[7]
    assert (x, y) == (5.0, 5.0)


def test_free_ends_have_no_cubic_term() -> None:
    pieces = cardinal_spline([(0.0, 0.0), (10.0, 5.0), (25.0, 0.0)], None, None)
    for piece in pieces:
        assert (piece.parameters[3], piece.parameters[7]) == pytest.approx((0.0, 0.0), abs=1e-13)


def test_a_lone_piece_with_free_ends_is_the_chord() -> None:
    (piece,) = cardinal_spline([(1.0, 2.0), (4.0, 6.0)], None, None)
    assert piece.parameters == (1.0, 3.0, 0.0, 0.0, 2.0, 4.0, 0.0, 0.0)
    assert piece.length == pytest.approx(5.0, rel=1e-15)


def test_points_on_a_line_stay_on_it() -> None:
    for piece in cardinal_spline([(0.0, 0.0), (1.0, 1.0), (7.0, 7.0), (9.0, 9.0)], None, None):
        for u in (0.2, 0.5, 0.9):
            x, y = piece.point(u)
            assert x == pytest.approx(y, abs=1e-14)


def test_coincident_points_make_pieces_without_extent() -> None:
    path = [(0.0, 0.0), (10.0, 0.0), (10.0, 0.0), (10.0, 10.0)]
    pieces = cardinal_spline(path, None, None)
    assert [piece.length > 0.0 for piece in pieces] == [True, False, True]
    assert pieces[0].end_tangent == pytest.approx(pieces[2].start_tangent, abs=1e-12)
    assert pieces[1].start_tangent == (0.0, 0.0)


def test_a_reversal_stops_instead_of_kinking_sideways() -> None:
    out, back = cardinal_spline([(0.0, 0.0), (10.0, 0.0), (0.0, 0.0)], None, None)
    assert out.end_tangent == (1.0, 0.0)
    assert back.start_tangent == (-1.0, 0.0)
    assert out.length == pytest.approx(10.0, rel=1e-14)


def test_a_circle_through_eight_points_stays_round() -> None:
    angles = np.linspace(0.0, 2 * np.pi, 9)
    path = [(10 * float(np.cos(a)), 10 * float(np.sin(a))) for a in angles]
    pieces = cardinal_spline(path, (0.0, 1.0), (0.0, 1.0))
    off = [abs(hypot(*piece.point(u)) - 10.0) for piece in pieces for u in (0.25, 0.5, 0.75)]
    assert max(off) < 0.15
    assert sum(piece.length for piece in pieces) == pytest.approx(20 * np.pi, rel=0.01)
