"""Planner `jerk`: limits of the smoothed motion in every cycle, caps kept on the way, equality of all routes."""

from __future__ import annotations

from dataclasses import replace
from math import isclose, pi, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.backend.samples import SampleBlock, sample
from nccompile.machine.model import default_machine
from nccompile.passes.velocity import JERK, PlanSettings, plan, row_times
from nccompile.runtime.interpolator import Interpolator
from nccompile.runtime.ring import RingBuffer
from nccompile.toolpath.columns import Floats, Toolpath
from nccompile.toolpath.verify import verify
from tests.velocity.random_paths import Builder, cut, paths

AXES = ("X", "Y", "Z", "A")
OPTIONS = PlanSettings.from_machine(default_machine(), AXES, planner=JERK)
X = default_machine().axes["X"]
JERK_X = 40.0 * X.acceleration


def planned(path: Toolpath, size: int = 4096) -> list[Toolpath]:
    return list(plan(cut(path, size), OPTIONS))


def sampled(chunks: list[Toolpath], cycle: float = 1e-3) -> SampleBlock:
    blocks = list(sample(chunks, cycle, 0, OPTIONS.smoothing))
    return SampleBlock(*(np.concatenate(column) for column in zip(*blocks, strict=True)))


def block(chunks: list[Toolpath], cycle: float = 1e-3) -> Interpolator:
    ring = RingBuffer(AXES, sum(len(c) for c in chunks))
    for chunk in chunks:
        ring.push(chunk)
    ring.close()
    return Interpolator(ring, chunks[0].start, cycle, OPTIONS.smoothing)


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


def within_limits(position: Floats, cycle: float) -> None:
    # rounding of three differences of positions up to 1e3 mm
    v = np.diff(position[:, 0], prepend=position[0, 0]) / cycle
    a = np.diff(v, prepend=0.0) / cycle
    j = np.diff(a, prepend=0.0) / cycle
    noise = 4e-16 * np.abs(position[:, 0]).max() * 8
    assert np.abs(v).max() <= X.velocity * (1 + 1e-6)
    assert np.abs(a).max() <= X.acceleration * (1 + 1e-6) + noise / cycle**2
    assert np.abs(j).max() <= JERK_X * (1 + 1e-6) + noise / cycle**3


@settings(max_examples=20, deadline=None)
@given(straights(), st.sampled_from([1e-3, 1e-4]))
def test_velocity_acceleration_and_jerk_are_inside_the_limits(path: Toolpath, cycle: float) -> None:
    if cycle < 1e-3 and path.length.sum() / path.feed.min() > 2.0:
        cycle = 1e-3
    samples = sampled(planned(path), cycle)
    within_limits(samples.position, cycle)
    assert np.array_equal(samples.position[-1], path.target[-1])
    assert samples.velocity[-1] == 0.0


@settings(max_examples=20, deadline=None)
@given(straights())
def test_no_feed_is_exceeded_anywhere(path: Toolpath) -> None:
    samples = sampled(planned(path))
    way = np.concatenate([[0.0], np.cumsum(path.length)])
    s = np.cumsum(samples.velocity) * 1e-3
    low = np.clip(
        np.searchsorted(way, np.maximum(s - samples.velocity * 1e-3, 0.0) + 1e-9) - 1, 0, len(path) - 1
    )
    high = np.clip(np.searchsorted(way, s - 1e-9) - 1, 0, len(path) - 1)
    for i in np.flatnonzero(samples.velocity > 0.0):  # rows touched within the cycle
        assert samples.velocity[i] <= path.feed[low[i] : max(low[i], high[i]) + 1].max() * (1 + 1e-9)


@settings(max_examples=25, deadline=None)
@given(straights(), st.lists(st.tuples(st.integers(1, 300), st.floats(0.01, 2.0), st.booleans()), max_size=5))
def test_override_and_stops_keep_the_limits(path: Toolpath, changes: list[tuple[int, float, bool]]) -> None:
    ipo = block(planned(path))
    position = []
    for wait, override, stop in [*changes, (1, 1.0, False)]:
        ipo.inputs.override, ipo.inputs.slow_stop = override, stop
        position += [ipo.advance(1, patient=False).position[0].copy() for _ in range(wait)]
    while not ipo.outputs.done:
        position += list(ipo.advance(500, patient=False).position.copy())
    within_limits(np.array(position), 1e-3)
    assert np.allclose(position[-1], path.target[-1], rtol=0.0, atol=1e-9)


@settings(max_examples=12, deadline=None)
@given(paths(most=12), st.integers(1, 40), st.sampled_from([1, 3, 4096]))
def test_bursts_and_chunks_give_the_bits_of_the_sampler(path: Toolpath, n: int, size: int) -> None:
    chunks = planned(path)
    other = planned(path, size)
    whole = Toolpath.join(chunks)
    if not ((path.length > 0.0) & (path.length < 1e-9)).any():  # random lengths that underflow when squared
        verify(whole)
    for name in ("target", "v_limit", "v_junction", "v_end", "length", "accel"):
        assert np.array_equal(getattr(whole, name), getattr(Toolpath.join(other), name)), name
    reference = sampled(chunks)
    ipo = block(other)
    ipo.inputs.ack_m = True
    out = []
    for _ in range(2_000_000):
        out.append(ipo.advance(n).position.copy())
        if ipo.outputs.done:
            break
    assert np.array_equal(np.vstack(out), reference.position)
    assert np.array_equal(reference.position[-1], path.target[-1])


@settings(max_examples=20, deadline=None)
@given(paths(stops=False, most=12))
def test_the_time_is_that_of_the_plan(path: Toolpath) -> None:
    chunks = planned(path)
    whole = Toolpath.join(chunks)
    total = float(row_times(whole, 0.0, OPTIONS.smoothing).sum())
    for cycle in (1e-3, 5e-3):
        t = sampled(chunks, cycle).t[-1]
        assert total - 1e-9 <= t <= total + 2 * cycle


def test_a_move_from_rest_to_rest_has_the_closed_form_time() -> None:
    build = Builder()
    build.line(100, 0.0, 200, 2000, 2000)
    chunks = planned(build.path())
    expected = 100 / 200 + 200 / 2000 + OPTIONS.smoothing
    assert isclose(sampled(chunks).t[-1], expected, abs_tol=2e-3)


def test_a_corner_is_passed_at_its_velocity_and_no_faster() -> None:
    build = Builder()
    build.line(100, 0.0, 300, 5000, 5000)
    build.line(100, 0.3, 300, 5000, 5000)
    chunks = planned(build.path())
    whole = Toolpath.join(chunks)
    assert whole.v_junction is not None
    corner = X.velocity_step / np.sin(0.3)
    samples = sampled(chunks, 1e-4)
    s = np.cumsum(samples.velocity) * 1e-4
    at = int(np.searchsorted(s, 100.0))
    assert isclose(samples.velocity[at], corner, rel_tol=0.02)
    assert samples.velocity[at] <= corner * (1 + 1e-3)


def test_arcs_keep_the_jerk_of_the_axes_on_their_way() -> None:
    build = Builder()
    build.arc(8.0, 2 * pi, 0.0, 300, 4000, 4000)
    (chunk,) = planned(build.path())
    samples = sampled([chunk])
    j = np.diff(samples.position, n=3, axis=0) / 1e-9
    assert np.abs(j[5:-5]).max() <= JERK_X * 1.02


def test_smoothing_is_a_multiple_of_the_cycle_and_needs_the_planner() -> None:
    assert isclose(OPTIONS.smoothing, 2 / 40.0)
    assert replace(OPTIONS, planner="look-ahead").smoothing == 0.0


def test_emergency_stop_holds_the_set_position() -> None:
    build = Builder()
    for _ in range(10):
        build.line(10, 0.0, 200, 2000, 2000)
    ipo = block(planned(build.path()))
    held = ipo.advance(300, patient=False).position[-1].copy()
    ipo.inputs.emergency_stop = True
    assert (ipo.advance(20, patient=False).position == held).all()
    ipo.inputs.emergency_stop = False
    last = held
    while not ipo.outputs.done:
        out = ipo.advance(500, patient=False).position.copy()
        assert (np.diff(np.vstack([last, out])[:, 0]) >= 0.0).all()
        last = out[-1]
    assert last[0] == pytest.approx(100.0, abs=1e-9)
    assert sqrt(float((held**2).sum())) < 100.0
