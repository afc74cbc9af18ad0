"""Views, lengths and dump rows of segments."""

from __future__ import annotations

import json
from math import degrees, pi, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.toolpath.columns import Kind, Plane, Toolpath
from nccompile.toolpath.lengths import path_length, path_lengths, straight_lengths
from nccompile.toolpath.rows import rows
from nccompile.toolpath.views import (
    Arc,
    Dwell,
    Ellipse,
    Line,
    MFunction,
    Polynomial,
    Positioning,
    SetPosition,
    Switch,
    view,
)
from tests.toolpath.paths import paths, planned_line, rich

AXES = ("X", "Y", "Z", "A", "P")


def test_every_kind_has_its_view() -> None:
    path = rich()
    kinds = [type(view(path, i)) for i in range(len(path))]
    assert kinds == [
        SetPosition, Positioning, Line, Arc, Arc, MFunction, Ellipse, Polynomial, Polynomial, Polynomial, Dwell,
        Arc, Arc, Polynomial, Line, Line,
    ]  # fmt: skip
    assert [type(segment) for segment in path] == kinds
    assert path[-1] == view(path, len(path) - 1)
    with pytest.raises(IndexError):
        view(path, len(path))


def test_views_say_what_was_programmed() -> None:
    path = rich().replace(first=40)
    line, arc, m, ellipse, dwell = (path[i] for i in (2, 3, 5, 6, 10))
    assert isinstance(line, Line)
    assert (line.index, line.line, line.start["Z"], line.end["A"], line.length) == (42, 5, 10.0, 90.0, 11.0)
    assert line.switches == (Switch(2, 0.0), Switch(-2, 0.25))
    assert isinstance(arc, Arc)
    assert (arc.plane, arc.center, arc.radius, arc.sweep) == (Plane.XY, (10.0, 0.0), 10.0, -pi)
    assert isinstance(m, MFunction)
    assert (m.number, m.k, m.l, m.o) == (10, 1.5, -2.5, 'g "data"')
    assert isinstance(ellipse, Ellipse)
    assert ellipse.ratio == pytest.approx(0.6, rel=1e-15)
    assert ellipse.direction == 0.3
    assert isinstance(dwell, Dwell)
    assert dwell.seconds == 0.75
    spline, space = path[7], path[13]
    assert isinstance(spline, Polynomial)
    assert spline.point(1.0) == pytest.approx((30.0, 5.0), abs=1e-13)
    assert isinstance(space, Polynomial)
    assert len(space.coefficients) == 3
    assert space.point(1.0) == (50.0, 15.0, -1.0)


def length(to: tuple[float, ...], profile: int = 0, kind: Kind = Kind.LINE) -> float:
    return path_length(AXES, kind, (0.0,) * 5, to, profile=profile)


def test_the_length_is_that_in_x_y_z() -> None:
    assert length((3.0, 4.0, 12.0, 90.0, 5.0)) == 13.0
    assert length((0.0, 0.0, 0.0, 3.0, 4.0)) == 5.0  # only additional axes: their norm
    assert length((3.0, 4.0, 12.0, 0.0, 0.0), profile=4) == 5.0  # Z in the S-profile goes along
    assert length((0.0, 0.0, 12.0, 0.0, 0.0), profile=4) == 12.0  # nothing else moves
    assert length((0.0, 0.0, 12.0, 0.0, 7.0), profile=4) == 7.0
    assert length((0.0, 0.0, 12.0, 0.0, 7.0), profile=4 | 16) == 12.0
    assert length((0.0, 0.0, 0.0, 0.0, 7.0), profile=16) == 7.0
    assert length((0.0,) * 5) == 0.0
    for kind in (Kind.SET_POSITION, Kind.DWELL, Kind.M_FUNCTION):
        assert length((3.0, 4.0, 0.0, 0.0, 0.0), kind=kind) == 0.0


def test_a_helix_is_longer_than_its_circle() -> None:
    helix = rich()[4]
    assert isinstance(helix, Arc)
    assert helix.length == sqrt((10.0 * pi) ** 2 + 3.0**2)


def test_a_curve_without_extent_is_as_long_as_the_rest_moves() -> None:
    p = np.zeros(12)
    assert path_length(AXES, Kind.POLYNOMIAL, (0.0,) * 5, (0.0, 0.0, 2.0, 9.0, 9.0), Plane.XY, p) == 2.0
    assert path_length(AXES, Kind.POLYNOMIAL, (0.0,) * 5, (0.0, 0.0, 0.0, 3.0, 4.0), Plane.XY, p) == 5.0


@settings(max_examples=50)
@given(paths())
def test_columns_and_single_segments_have_the_same_length(path: Toolpath) -> None:
    starts = path.starts().tolist()
    single = [
        path_length(
            path.axes, int(path.kind[i]), starts[i], path.target[i].tolist(),
            None if c < 0 else int(path.curves.plane[c]), None if c < 0 else path.curves.parameters[c],
            int(path.profile[i]),
        )
        for i, c in enumerate(path.curve.tolist())
    ]  # fmt: skip
    assert path_lengths(path).tolist() == single == path.length.tolist()


@given(
    st.lists(
        st.tuples(*[st.sampled_from([0.0, 0.1, -3.0, 1e5])] * 5, st.integers(0, 31)), min_size=1, max_size=20
    )
)
def test_straight_lengths_equal_single_ones(cases: list[tuple[float, ...]]) -> None:
    delta = np.array([case[:5] for case in cases])
    profile = np.array([case[5] for case in cases], np.uint16)
    wanted = [length(case[:5], int(case[5])) for case in cases]
    assert straight_lengths(delta, profile).tolist() == wanted


def test_dump_rows_are_json_with_degrees_and_axis_keys() -> None:
    found = [json.loads(json.dumps(row, allow_nan=False)) for row in rows([rich()])]
    line, arc, m, ellipse, spline, dwell, zx, space = (found[i] for i in (2, 3, 5, 6, 7, 10, 11, 13))
    assert line["kind"] == "line"
    assert line["start"] == {"X": 0.0, "Y": 0.0, "Z": 10.0, "A": 0.0, "P": 0.0}
    assert (line["length"], line["feed"], line["line"], line["index"]) == (11.0, 20.0, 5, 2)
    assert line["switches"] == [{"number": 2, "position": 0.0}, {"number": -2, "position": 0.25}]
    assert "plane" not in line
    assert "v_end" not in line
    assert (arc["plane"], arc["center"], arc["radius"]) == ("XY", {"X": 10.0, "Y": 0.0}, 10.0)
    assert (arc["start_angle"], arc["sweep"]) == (180.0, -180.0)
    assert m["m"] == {"number": 10, "k": 1.5, "l": -2.5, "o": 'g "data"'}
    assert ellipse["direction"] == degrees(0.3)
    assert ellipse["sub_axis"] == pytest.approx(0.6 * ellipse["main_axis"])
    assert spline["coefficients"] == {"X": [0.0, 20.0, 10.0, 0.0], "Y": [0.0, 20.0, -15.0, 0.0]}
    assert dwell["seconds"] == 0.75
    assert zx["center"] == {"Z": -4.0, "X": 45.0}
    assert list(space["coefficients"]) == ["X", "Y", "Z"]


def test_dump_rows_of_a_planned_path_have_the_plan() -> None:
    first, last = rows([planned_line([1.0, 2.0])])
    assert (first["v_end"], first["accel"], first["decel"]) == (10.0, 100.0, 100.0)
    assert last["v_end"] == 0.0
