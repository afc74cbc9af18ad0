"""Planner `jerk`: limits at the ends of parts and between them, against a reference optimum, equality of routes."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import pi, sqrt
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from nccompile.backend.samples import SampleBlock, sample
from nccompile.machine.model import default_machine
from nccompile.passes.velocity import JERK, LOOK_AHEAD, PlanSettings, jerk
from nccompile.passes.velocity.planner import plan, row_times
from nccompile.toolpath.columns import Floats, Ints, Kind, Toolpath
from nccompile.toolpath.verify import verify
from tests.velocity.random_paths import Builder, cut, paths

AXES = ("X", "Y", "Z", "A")
MACHINE = default_machine()
OPTIONS = PlanSettings.from_machine(MACHINE, AXES, planner=JERK)
X = MACHINE.axes["X"]
JERK_X = 40.0 * X.acceleration


class Rows:
    """Rows for `jerk.profile`."""

    def __init__(
        self, length: Floats, top: Floats, node: Floats, accel: Floats, decel: Floats, limit: Floats
    ):
        self.length, self.top, self.accel, self.decel, self.limit = length, top, accel, decel, limit
        self.node = np.minimum(np.minimum(node, top), np.append(top[1:], 0.0))

    def planned(self) -> tuple[Ints, Floats]:
        found = jerk.profile(self.length, self.top, self.node, self.accel, self.decel, self.limit)
        assert found is not None
        return found[0], found[1]


def spread(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers of all magnitudes of a range."""
    return st.floats(np.log(low), np.log(high)).map(lambda x: float(np.exp(x)))


def either(draw: st.DrawFn, n: int, value: float, values: st.SearchStrategy[float]) -> Floats:
    """The same value n times, or n others."""
    if draw(st.booleans()):
        return np.full(n, value)
    return np.array(draw(st.lists(values, min_size=n, max_size=n)))


@st.composite
def rows(draw: st.DrawFn) -> Rows:
    """Rows of one magnitude or of many, with limits that change or do not."""
    n = draw(st.integers(1, 12))
    sizes = spread(draw(st.sampled_from([1e-6, 1e-2, 0.1])), draw(st.sampled_from([1.0, 1e3])))
    top = either(draw, n, 100.0, spread(0.01, 300.0))
    shares = st.one_of(st.just(1.0), st.just(0.0), st.floats(0.0, 1.0))
    return Rows(
        either(draw, n, 0.3, sizes), top, top * either(draw, n, 1.0, shares), either(draw, n, 1e3, spread(100.0, 1e4)),
        either(draw, n, 1e3, spread(100.0, 1e4)), either(draw, n, 5e4, spread(3e3, 1e6)),
    )  # fmt: skip


def states(length: Floats, row: Ints, ends: Floats) -> tuple[Floats, Floats, Floats]:
    """Length (m,), start (m, 2) of (v, a) and time (m,) of parts, the time from the mean velocity.

    v changes by (a0 + a1) T / 2, and the mean of v is less than the mean of its ends by jerk T² / 12.
    """
    first = np.append(True, row[1:] != row[:-1])
    size = ends[:, 0] - np.where(first, 0.0, np.append(0.0, ends[:-1, 0]))
    start = np.vstack([[0.0, 0.0], ends[:-1, 1:]])
    mean = 0.5 * (start[:, 0] + ends[:, 1])
    time = size / mean
    for _ in range(60):
        time = size / (mean - (ends[:, 2] - start[:, 1]) * time / 12.0)
    return size, start, time


@settings(max_examples=120, deadline=None)
@given(rows())
def test_every_limit_is_kept_at_the_ends_of_parts_and_between_them(given_rows: Rows) -> None:
    row, ends = given_rows.planned()
    size, start, time = states(given_rows.length, row, ends)
    assert np.array_equal(np.unique(row), np.arange(len(given_rows.length)))
    assert (np.diff(row) >= 0).all()
    assert (size > 0.0).all()
    v0, a0 = start.T
    v1, a1 = ends[:, 1], ends[:, 2]
    # A place is known to 1e-16 of its row, a velocity next to a stop to what that is over the distance.
    noise = 1e-15 * given_rows.length[row] / size
    assert (np.abs(v0 + 0.5 * (a0 + a1) * time - v1) <= (1e-9 + noise) * np.maximum(v0, v1)).all()
    rate = (a1 - a0) / time
    assert (np.abs(rate) <= given_rows.limit[row] * (1 + 1e-6 + noise)).all()
    for a in (a0, a1):
        assert (a <= given_rows.accel[row] * (1 + 1e-9)).all()
        assert (-a <= given_rows.decel[row] * (1 + 1e-9)).all()
    assert (a0 * a1 >= -1e-9).all()  # no part passes its top, so the greatest velocity is at an end
    assert (np.maximum(v0, v1) <= given_rows.top[row] * (1 + 1e-9)).all()
    assert (np.minimum(v0, v1) >= 0.0).all()
    last = np.append(row[1:] != row[:-1], True)
    assert (v1[last] <= given_rows.node * (1 + 1e-9)).all()
    assert (ends[np.flatnonzero(last)[given_rows.node == 0.0], 1:] == 0.0).all()


def reference(given_rows: Rows, cells: int) -> float:
    """Time of the best profile found on equal steps from rest to rest, equal limits in all rows.

    In x = v² the limits are |x'| <= 2 a and |x''| v <= 2 j, a linear program with v of the one before.  Within s of
    a stop no jerk-limited motion is faster than v = j t² / 2, s = j t³ / 6.
    """
    a, j = float(given_rows.accel[0]), float(given_rows.limit[0])
    way = float(given_rows.length.sum())
    step = way / cells
    s = np.arange(1, cells) * step
    edge = np.cumsum(given_rows.length)
    top = given_rows.top[np.minimum(np.searchsorted(edge, s), len(edge) - 1)]
    for at, cap in zip(edge[:-1], given_rows.node[:-1], strict=True):
        nearest = np.abs(s - at) <= 0.5 * step
        top[nearest] = np.minimum(top[nearest], cap)
    top = np.minimum(top, 0.5 * j * (6.0 * np.minimum(s, way - s) / j) ** (2.0 / 3.0))
    n = len(s)
    first = (np.eye(n + 1, n) - np.eye(n + 1, n, -1)) / step
    second = (np.eye(n, n, 1) - 2.0 * np.eye(n) + np.eye(n, n, -1)) / step**2
    v = top
    for _ in range(20):
        found = linprog(
            -1.0 / v**3, A_ub=np.vstack([first, -first, second, -second]),
            b_ub=np.concatenate([np.full(2 * n + 2, 2.0 * a), 2.0 * j / v, 2.0 * j / v]),
            bounds=np.column_stack([np.zeros(n), top**2]), method="highs",
        )  # fmt: skip
        v = 0.5 * (v + np.sqrt(found.x))
    assert (np.abs(second @ v**2) * v <= 2.0 * j * 1.15).all()
    ends = np.concatenate([[0.0], v, [0.0]])
    time = 2.0 * step / (ends[1:] + ends[:-1])
    return float(time.sum() + 0.5 * (time[0] + time[-1]))  # from rest the mean of v is a third of the end


@pytest.mark.parametrize("seed", range(4))
def test_the_time_is_near_the_optimum(seed: int) -> None:
    random = np.random.default_rng(seed)
    n = int(random.integers(2, 7))
    top = random.uniform(5.0, 60.0, n)
    given_rows = Rows(
        random.uniform(0.1, 2.0, n), top, top * random.choice([1.0, 0.3, 0.6], n), np.full(n, 1000.0),
        np.full(n, 1000.0), np.full(n, 5e4),
    )  # fmt: skip
    time = states(given_rows.length, *given_rows.planned())[2].sum()
    best = reference(given_rows, 100)
    assert 0.97 * best <= time <= 1.04 * best


def test_a_move_from_rest_to_rest_has_the_closed_form_time() -> None:
    a, j = 1000.0, 5e4
    for length in (1e-3, 0.1, 1.0, 20.0, 400.0):
        one = np.array([length])
        given_rows = Rows(one, one * 0 + 100.0, one, one * 0 + a, one * 0 + a, one * 0 + j)
        time = states(given_rows.length, *given_rows.planned())[2].sum()
        if length <= 2.0 * a**3 / j**2:
            expected = (32.0 * length / j) ** (1.0 / 3.0)
        elif length <= 100.0 * (100.0 / a + a / j):
            expected = a / j + sqrt((a / j) ** 2 + 4.0 * length / a)
        else:
            expected = length / 100.0 + 100.0 / a + a / j
        assert time == pytest.approx(expected, rel=1e-9)


def test_other_ramps_up_and_down() -> None:
    one = np.array([200.0])
    given_rows = Rows(one, one * 0 + 100.0, one, one * 0 + 500.0, one * 0 + 2000.0, one * 0 + 1e4)
    time = states(given_rows.length, *given_rows.planned())[2].sum()
    up, down = 100 / 500 + 500 / 1e4, 2 * sqrt(100 / 1e4)  # too short for 2000 mm/s²
    assert time == pytest.approx(up + down + (200 - 50 * up - 50 * down) / 100, rel=1e-9)


def planned(path: Toolpath, size: int = 4096, options: PlanSettings = OPTIONS) -> Toolpath:
    return Toolpath.join(list(plan(cut(path, size), options)))


def seconds(path: Toolpath, options: PlanSettings) -> float:
    return float(row_times(planned(path, options=options), 0.0).sum())


COLUMNS = (
    "target",
    "length",
    "v_limit",
    "v_junction",
    "v_end",
    "a_end",
    "jerk",
    "accel",
    "decel",
    "profile",
    "line",
)


@settings(max_examples=30, deadline=None)
@given(path=paths(most=30), size=st.sampled_from([1, 3, 4096]))
def test_chunks_do_not_matter_and_blocks_keep_all_limits(path: Toolpath, size: int) -> None:
    before = jerk._BLOCK
    try:
        jerk._BLOCK = 6
        whole, other = planned(path), planned(path, size)
    finally:
        jerk._BLOCK = before
    for name in COLUMNS:
        assert np.array_equal(getattr(whole, name), getattr(other, name)), name
    assert np.array_equal(whole.events.segment, other.events.segment)
    if not ((path.length > 0.0) & (path.length < 1e-9)).any():  # random lengths that underflow when squared
        verify(whole)
    assert np.array_equal(whole.target[-1], path.target[-1])
    assert whole.v_end is not None
    assert whole.a_end is not None
    assert whole.v_end[-1] == whole.a_end[-1] == 0.0


@settings(max_examples=30, deadline=None)
@given(path=paths(most=25))
def test_it_is_never_faster_than_look_ahead_and_never_slower_with_a_larger_window(path: Toolpath) -> None:
    times = [seconds(path, replace(OPTIONS, window=window)) for window in (1, 100, None)]
    for small, large in pairwise(times):
        assert large <= small * (1 + 1e-9)
    assert times[-1] >= seconds(path, replace(OPTIONS, planner=LOOK_AHEAD)) * (1 - 1e-9)


def test_a_block_that_cannot_be_run_on_from_ends_where_the_one_before_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    build = Builder()
    for _ in range(12):
        build.line(3.0, 0.01, 100, 2000, 2000)
    through, calls = jerk.profile, []

    def refusing(*args: Any) -> tuple[Ints, Floats, int] | None:
        calls.append(len(args[0]))
        return None if len(calls) == 2 else through(*args)

    monkeypatch.setattr(jerk, "_BLOCK", 6)
    monkeypatch.setattr(jerk, "profile", refusing)
    whole = planned(build.path())
    verify(whole)
    assert whole.v_end is not None
    assert np.unique(whole.line[whole.v_end == 0.0]).tolist() == [6, 12]


def test_a_corner_is_passed_at_its_velocity() -> None:
    build = Builder()
    build.line(100, 0.0, 300, 5000, 5000)
    build.line(100, 0.3, 300, 5000, 5000)
    whole = planned(build.path())
    assert whole.v_end is not None
    assert whole.a_end is not None
    at = int(np.flatnonzero(whole.line == 1)[-1])
    assert whole.v_end[at] == pytest.approx(X.velocity_step / np.sin(0.3), rel=1e-12)
    assert whole.a_end[at] == 0.0


def test_rows_without_length_do_not_stop_the_path() -> None:
    plain, dotted = Builder(), Builder()
    for build in (plain, dotted):
        build.line(0.4, 0.0, 300, 2000, 2000)
        if build is dotted:
            build.line(0.0, 0.0, 300, 2000, 2000)
        build.line(40, 0.0, 300, 2000, 2000)
        build.still(Kind.DWELL, seconds=0.5)
        build.jump(3.0)
        build.line(0.0, 0.0, 300, 2000, 2000)
        build.line(2, 0.0, 300, 2000, 2000)
    assert seconds(dotted.path(), OPTIONS) == pytest.approx(seconds(plain.path(), OPTIONS), rel=1e-12)
    verify(planned(dotted.path()))


def test_a_path_without_a_move() -> None:
    build = Builder()
    build.still(Kind.DWELL, seconds=0.5)
    whole = planned(build.path())
    assert len(whole) == 1
    assert whole.is_third_order
    (empty,) = plan([build.path().rows(0, 0)], OPTIONS)
    assert len(empty) == 0
    assert empty.is_planned


def test_arcs_keep_the_jerk_of_the_axes_on_their_way() -> None:
    build = Builder()
    build.arc(8.0, 2 * pi, 0.0, 300, 4000, 4000)
    whole = planned(build.path())
    assert whole.v_end is not None
    assert whole.a_end is not None
    _, start, time = states(
        whole.length,
        np.arange(len(whole), dtype=np.int32),
        np.column_stack([whole.length, whole.v_end, whole.a_end]),
    )
    for (v, a), length, duration, a1 in zip(start, whole.length, time, whole.a_end, strict=True):
        t = np.linspace(0.0, duration, 50)
        rate = (a1 - a) / duration
        now, ramp = v + a * t + 0.5 * rate * t * t, a + rate * t
        assert np.sqrt((rate - now**3 / 64.0) ** 2 + (3.0 * now * ramp / 8.0) ** 2).max() <= JERK_X * (
            1 + 1e-9
        )
        assert length > 0.0


@st.composite
def straights(draw: st.DrawFn) -> Toolpath:
    """Lines behind each other with feeds and accelerations of their own, some turning back (a stop)."""
    build = Builder()
    for _ in range(draw(st.integers(1, 12))):
        build.line(
            draw(st.one_of(st.floats(0.05, 2.0), st.floats(2.0, 60.0))), draw(st.sampled_from([0.0, 0.0, 0.0, pi])),
            draw(st.floats(5.0, 450.0)), draw(st.floats(200.0, 9000.0)), draw(st.floats(200.0, 9000.0)),
        )  # fmt: skip
    return build.path()


@settings(max_examples=15, deadline=None)
@given(straights())
def test_the_axis_keeps_its_limits_in_every_cycle(path: Toolpath) -> None:
    cycle = 1e-3
    whole = planned(path)
    blocks = list(sample([whole], cycle))
    samples = SampleBlock(*(np.concatenate(column) for column in zip(*blocks, strict=True)))
    v = np.diff(samples.position[:, 0], prepend=0.0) / cycle
    a = np.diff(v, prepend=0.0) / cycle
    j = np.diff(a, prepend=0.0) / cycle
    noise = 4e-16 * np.abs(samples.position[:, 0]).max() * 8  # rounding of differences of positions
    assert np.abs(v).max() <= X.velocity * (1 + 1e-6)
    assert np.abs(a).max() <= X.acceleration * (1 + 1e-6) + noise / cycle**2
    assert np.abs(j).max() <= JERK_X * (1 + 1e-6) + noise / cycle**3
    assert np.array_equal(samples.position[-1], path.target[-1])
    total = float(row_times(whole, 0.0).sum())
    assert total - 1e-9 <= samples.t[-1] <= total + 2 * cycle


def test_an_s_profile_becomes_straight_parts_through_its_places() -> None:
    build = Builder()
    build.line(20.0, 0.0, 50, 2000, 2000, dz=4.0)
    path = build.path().replace(profile=np.array([1 << 2], np.uint16), length=np.array([20.0]))
    whole = planned(path)
    verify(whole)
    assert not (whole.profile & 0x7FFF).any()
    w = whole.target[:, 0] / 20.0
    smooth = w**3 * (10.0 - 15.0 * w + 6.0 * w * w)
    assert np.abs(whole.target[:, 2] - 4.0 * smooth).max() <= 2e-4 * 4.0
