"""Polylines of a path, motion over time, and the pictures' bytes."""

from __future__ import annotations

from itertools import pairwise
from math import hypot
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from nccompile.errors import UsageError
from nccompile.toolpath.columns import EventKind, Floats, Kind, Toolpath
from nccompile.view.drawing import Drawing, draw, thin
from nccompile.view.motion import Caps, Motion, caps, envelope, gather
from nccompile.view.plot import save
from tests.toolpath.paths import Builder, rich


def runs(line: Floats) -> list[Floats]:
    """The pieces of a polyline between its NaN rows."""
    ends = np.flatnonzero(np.isnan(line[:, 0]))
    return [line[a + 1 : b] for a, b in pairwise([-1, *ends.tolist()])]


def test_rapids_and_feeds_are_separate_runs() -> None:
    b = Builder(axes=("X", "Y", "Z"), at=[0.0] * 3)
    b.add(Kind.POSITIONING, X=1.0).add(Kind.LINE, X=2.0).add(Kind.LINE, Y=1.0)
    b.add(Kind.SET_POSITION, X=9.0).add(Kind.LINE, X=10.0).add(Kind.M_FUNCTION).event(EventKind.M_FUNCTION, 5)
    b.add(Kind.LINE, Y=2.0).add(Kind.POSITIONING, Z=3.0)
    drawing = draw([b.path()])
    assert [run.tolist() for run in runs(drawing.rapid)] == [[[0, 0, 0], [1, 0, 0]], [[10, 2, 0], [10, 2, 3]]]
    assert [run.tolist() for run in runs(drawing.feed)] == [
        [[1, 0, 0], [2, 0, 0], [2, 1, 0]],
        [[9, 1, 0], [10, 1, 0]],
        [[10, 1, 0], [10, 2, 0]],
    ]
    assert [(spot.label, spot.point) for spot in drawing.spots] == [("M5", (10.0, 1.0, 0.0))]
    assert (drawing.start, drawing.end) == ((0.0, 0.0, 0.0), (10.0, 2.0, 3.0))


def test_curves_are_smooth_and_lie_on_themselves() -> None:
    path = rich()
    for at in np.flatnonzero(path.curve >= 0).tolist():
        one = path.rows(at, at + 1)
        drawing = draw([one])
        (run,) = runs(drawing.feed)
        assert run[0].tolist() == one.start[:3].tolist()
        assert run[-1].tolist() == one.target[0, :3].tolist()
        steps = np.diff(run, axis=0)
        straight = float(np.sqrt((steps**2).sum(axis=1)).sum())
        rise = float(one.target[0, 2] - one.start[2]) if one.profile[0] else 0.0
        wanted = hypot(float(one.length[0]), rise)  # Z in the S-profile is not in the length
        assert 0.999 * float(one.length[0]) <= straight <= wanted + 1e-9
        bend = (steps[1:] * steps[:-1]).sum(axis=1)
        assert (bend > 0.9 * np.sqrt((steps[1:] ** 2).sum(axis=1) * (steps[:-1] ** 2).sum(axis=1))).all()


def test_the_third_axis_of_a_helix_is_linear_in_its_length() -> None:
    helix = rich().rows(4, 5)
    (run,) = runs(draw([helix]).feed)
    assert run[:, 2] == pytest.approx(np.linspace(-1.0, -4.0, len(run)), abs=1e-12)


def test_switches_stand_at_their_share_of_the_length() -> None:
    found = {spot.label: spot.point for spot in draw([rich()]).spots if spot.kind == "switch"}
    assert found["H2"] == (0.0, 0.0, 10.0)
    assert found["H-2"] == pytest.approx((0.0, 0.0, 7.25))
    assert found["H7"] == pytest.approx((10.0, 10.0, -1.0), abs=1e-12)  # top of the semicircle
    assert found["H8"] == pytest.approx((0.0, 0.0, -4.0), abs=1e-12)


@given(st.integers(1, 20))
def test_the_drawing_does_not_depend_on_the_chunks(size: int) -> None:
    path = rich()
    whole, parts = draw([path]), draw([path.rows(at, at + size) for at in range(0, len(path), size)])
    assert whole.rapid.tobytes() == parts.rapid.tobytes()
    assert whole.feed.tobytes() == parts.feed.tobytes()
    assert whole.spots == parts.spots


def test_a_path_without_segments_has_an_empty_drawing() -> None:
    drawing = draw([Toolpath.empty()])
    assert (len(drawing.rapid), len(drawing.feed), drawing.spots) == (0, 0, ())
    low, high = drawing.box()
    assert low.tolist() == high.tolist() == [0.0, 0.0, 0.0]
    assert draw([]).end == (0.0, 0.0, 0.0)


@given(st.lists(st.tuples(st.floats(0, 10), st.floats(0, 10), st.integers(0, 9)), max_size=60))
def test_thinning_leaves_no_point_farther_than_a_cell_from_the_line(
    points: list[tuple[float, float, int]],
) -> None:
    line = np.array([(np.nan, np.nan) if gap == 0 else (x, y) for x, y, gap in points]).reshape(-1, 2)
    kept = thin(line, 0.5)
    real, left = line[~np.isnan(line[:, 0])], kept[~np.isnan(kept[:, 0])]
    for point in real:
        assert np.abs(left - point).max(axis=1).min() <= 0.5
    assert len(runs(np.vstack([kept, [[np.nan, np.nan]]]))) >= 1
    assert {tuple(p) for p in left.tolist()} <= {tuple(p) for p in real.tolist()}


@given(st.integers(0, 3000), st.integers(1, 200))
def test_an_envelope_keeps_every_peak(m: int, bins: int) -> None:
    t = np.linspace(0.0, 1.0, m)
    y = np.sin(np.arange(m) * 1.7) * np.arange(m)
    places, values = envelope(t, y, bins)
    assert len(places) == len(values) <= max(2 * bins, 1)
    assert (np.diff(places) >= 0.0).all()
    if m:
        assert (values.min(), values.max()) == (y.min(), y.max())


class Block(NamedTuple):
    t: Floats
    position: Floats
    velocity: Floats


def ramp() -> Motion:
    """X accelerates by 100 mm/s² for a second, stops in one cycle, and jumps by 7 mm afterwards; Y rests."""
    t: Floats = np.arange(103, dtype=np.float64) * 0.01
    v = np.concatenate([np.arange(101.0), [0.0, 0.0]])
    x = np.cumsum(v) * 0.01
    x[-1] += 7.0
    position = np.column_stack([x, np.zeros(103), np.zeros(103)])
    return gather(
        ("X", "Y", "Z"), [Block(t[:50], position[:50], v[:50]), Block(t[50:], position[50:], v[50:])]
    )


def test_velocity_and_acceleration_are_difference_quotients() -> None:
    motion = ramp()
    assert motion.moving() == [0]
    v, a = motion.velocities()[:, 0], motion.accelerations()[:, 0]
    assert v[:101] == pytest.approx(np.arange(101.0), abs=1e-9)
    assert a[1:101] == pytest.approx(np.full(100, 100.0), abs=1e-6)
    assert a[101] == pytest.approx(-10000.0, rel=1e-9)
    assert np.isnan(v[102])  # the jump of a G92 is no velocity
    assert np.isnan(a[102])
    j = motion.jerks()[:, 0]
    assert j[2:101] == pytest.approx(np.zeros(99), abs=1e-3)
    assert j[101] == pytest.approx(-10100.0 / 0.01, rel=1e-9)


def test_caps_follow_the_times_of_the_rows() -> None:
    planned = [
        chunk.replace(
            feed=np.where(chunk.length > 0.0, 30.0, 0.0), v_limit=np.full(len(chunk), 50.0),
            v_junction=np.zeros(len(chunk)), v_end=np.zeros(len(chunk)),
        )
        for chunk in (rich().rows(0, 2), rich().rows(2, 5))
    ]  # fmt: skip
    found = caps(planned, lambda chunk, before: np.full(len(chunk), 0.5))
    assert found.t.tolist() == [0.0, 0.5, 1.0, 1.5, 2.0, 2.5]
    moving = np.concatenate([chunk.length > 0.0 for chunk in planned])
    assert np.array_equal(np.isfinite(found.feed[1:]), moving)
    assert set(found.limit[1:][moving]) == {50.0}


def test_nothing_sampled_is_an_empty_motion() -> None:
    motion = gather(("X",), [])
    assert motion.moving() == []
    assert motion.velocities().shape == motion.accelerations().shape == (0, 1)


class Bounds(NamedTuple):
    velocity: Floats
    acceleration: Floats
    jerk: Floats


BOUNDS = Bounds(*(np.array([bound, bound, np.inf]) for bound in (120.0, 1e4, 1e5)))


def colours(drawing: Path, colour: tuple[int, int, int]) -> int:
    """How many pixels of a picture have nearly this colour."""
    pixels = np.asarray(Image.open(drawing).convert("RGB")).astype(int)
    return int((np.abs(pixels - np.array(colour)).max(axis=2) < 40).sum())


def test_pictures_have_rapids_green_feeds_blue_and_the_same_bytes_again(tmp_path: Path) -> None:
    one, two = tmp_path / "one.png", tmp_path / "two.png"
    save(one, [rich()], ramp(), BOUNDS, title="rich")
    save(two, [rich()], ramp(), BOUNDS, title="rich")
    assert one.read_bytes() == two.read_bytes()
    assert colours(one, (0x2F, 0x9E, 0x44)) > 50
    assert colours(one, (0x1C, 0x5F, 0xB8)) > 500
    assert Image.open(one).size == (1760, 990)
    bounded = tmp_path / "bounded.png"
    save(bounded, [rich()], ramp(), BOUNDS, Caps(np.array([0.0, 1.0]), np.full(2, 90.0), np.full(2, 95.0)))
    assert colours(bounded, (0xE0, 0x31, 0x31)) > colours(one, (0xE0, 0x31, 0x31)) + 50
    plain = tmp_path / "plain.png"
    save(plain, [rich()])
    assert colours(plain, (0xD9, 0x48, 0x0F)) > 20  # switch points
    assert colours(plain, (0x70, 0x48, 0xA8)) > 20  # M functions


def test_an_empty_path_still_makes_a_picture(tmp_path: Path) -> None:
    file = tmp_path / "empty.svg"
    save(file, [Toolpath.empty()], gather(("X", "Y", "Z"), []), BOUNDS)
    text = file.read_text()
    assert "<svg" in text
    assert "<dc:date>" not in text


def test_an_unknown_picture_format_is_refused_and_leaves_no_file(tmp_path: Path) -> None:
    file = tmp_path / "path.bmp"
    with pytest.raises(UsageError, match=r"path\.bmp: pictures are written as png, svg or pdf"):
        save(file, [rich()])
    assert not file.exists()


def test_the_box_holds_everything_drawn() -> None:
    drawing = Drawing(
        np.empty((0, 3)), np.array([[0, 0, 0], [5, -2, 1], [np.nan] * 3]), (), (0, 0, 0), (9, 0, 0)
    )
    low, high = drawing.box()
    assert (low.tolist(), high.tolist()) == ([0.0, -2.0, 0.0], [9.0, 0.0, 1.0])
