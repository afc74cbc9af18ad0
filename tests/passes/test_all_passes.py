"""What holds for every registered pass: chunks, source lines, events, additional axes, deviation, plain kernels."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from nccompile import kernels
from nccompile.errors import UsageError
from nccompile.passes.base import Report
from nccompile.passes.option import REGISTRY
from nccompile.passes.reverse import reversed_path
from nccompile.toolpath.columns import Floats, Kind, Toolpath
from tests.passes.every import EVERY, Turned, dense
from tests.passes.paths import Probe, Sketch, paths, run, same

SIZES = (1, 7, 1000)


def test_every_registered_pass_is_tested_here() -> None:
    assert {turned.made.name for turned in EVERY} == set(REGISTRY)


@st.composite
def inputs(draw: st.DrawFn, turned: Turned) -> Toolpath:
    """A path on which the pass can act; each of its events has a number of its own."""
    path = draw(paths(most=10, marks=not turned.closed, stops=not turned.closed))
    if turned.closed:
        path = Toolpath.join([path, reversed_path(path)])
    return path.replace(
        events=replace(path.events, number=np.arange(1, len(path.events) + 1, dtype=np.int32))
    )


def applied(turned: Turned, path: Toolpath, size: int = 0) -> tuple[Toolpath, Report] | None:
    """The pass over the path, None if there is nothing that it could act on."""
    try:
        return run(turned.made, path, size)
    except UsageError:
        assert turned.made.name in ("split", "move-start")
        return None


def state(path: Toolpath, at: int) -> Floats:
    """The position on all axes of event `at`."""
    row, share = int(path.events.segment[at]), float(path.events.position[at])
    start, end = path.starts()[row], path.target[row]
    here = start + share * (end - start)
    if path.kind[row] <= Kind.POLYNOMIAL and path.length[row] > 0.0:
        probe = Probe(path, row)
        here[:3] = probe.point(share * probe.length)
    return np.asarray(here)


@pytest.mark.parametrize("turned", EVERY, ids=str)
@settings(max_examples=15)
@given(data=st.data())
def test_chunks_do_not_matter(turned: Turned, data: st.DataObject) -> None:
    path = data.draw(inputs(turned))
    whole = applied(turned, path)
    for size in SIZES:
        part = applied(turned, path, size)
        assert (part is None) is (whole is None)
        if part is not None and whole is not None:
            assert same(part[0], whole[0])
            assert whole[1].segments_in == part[1].segments_in == len(path)
            assert whole[1].segments_out == part[1].segments_out == len(whole[0])


@pytest.mark.parametrize("turned", EVERY, ids=str)
@settings(max_examples=25)
@given(data=st.data())
def test_events_lines_and_axes_are_kept(turned: Turned, data: st.DataObject) -> None:
    path = data.draw(inputs(turned))
    result = applied(turned, path)
    if result is None:
        return
    out, _ = result
    assert set(out.line.tolist()) <= set(path.line.tolist())
    before, after = path.events, out.events
    assert sorted(after.number.tolist()) == before.number.tolist()
    if not turned.closed:
        numbers = after.number.tolist()
        assert (numbers[::-1] if turned.spec == "reverse" else numbers) == before.number.tolist()
    digits = 1e-9 * float(np.abs(path.target).max(initial=1.0))
    for at, number in enumerate(after.number.tolist()):
        old = number - 1
        assert (after.kind[at], after.k[at], after.o[at]) == (before.kind[old], before.k[old], before.o[old])
        was, now = state(path, old), state(out, at)
        was[:3] = turned.place(was[None, :3])[0]
        assert np.linalg.norm(was[:3] - now[:3]) <= turned.slack + digits
        if turned.slack <= 1e-6:
            assert now[3] == pytest.approx(was[3], abs=1e-6)
    every = np.append(path.target[:, 3], path.start[3])
    assert out.target[:, 3].min(initial=every[0]) >= every.min() - 1e-9
    assert out.target[:, 3].max(initial=every[0]) <= every.max() + 1e-9


@pytest.mark.parametrize("turned", [t for t in EVERY if t.slack < np.inf], ids=str)
@settings(max_examples=4)
@given(data=st.data())
def test_the_reported_deviation_is_not_too_small(turned: Turned, data: st.DataObject) -> None:
    path = data.draw(inputs(turned))
    path = path.replace(mark=path.mark * np.uint16(0))
    result = applied(turned, path)
    if result is None or path.length.sum() > 300.0:
        return
    out, report = result
    step = 0.02
    one, two = turned.place(dense(path, step)), dense(out, step)
    if not len(one) or not len(two):
        return
    worst = max(float(np.max(cKDTree(a).query(b)[0])) for a, b in ((one, two), (two, one)))
    assert report.deviation is not None
    assert report.deviation >= worst - 2.0 * step


def small() -> Toolpath:
    """A short path with every kind of segment, events, corners of all sorts, and a run of small chords."""
    sketch = (
        Sketch()
        .to(10, 0, 0, 3, d=0.5)
        .switch(1, 0.7)
        .arc(3.0, 2.0, turn=0.7)
        .arc(2.0, -1.5, turn=1.0, dz=1.0)
    )
    sketch.to(20, 15, 1, 5).m(7).ellipse(4.0, 0.5, 0.2, 2.0, 0.3).cubic(5.0, 1.0, (5.0, 3.0), (4.0, -6.0))
    for i in range(1, 40):
        sketch.to(float(40 + 8 * np.sin(i / 12)), float(20 - 8 * np.cos(i / 12)))
    sketch.to(30, 30, 4).switch(-1, 0.5).to(30, 30, 4).jump(0, 0).to(5, 0, kind=Kind.POSITIONING).to(9, 0).to(
        12, 0
    )
    return sketch.path()


@pytest.mark.parametrize("turned", EVERY, ids=str)
def test_plain_kernels_give_the_same_bits(turned: Turned) -> None:
    path = small()
    if turned.closed:
        path = path.rows(0, 4)
        path = Toolpath.join([path, reversed_path(path)])
    compiled = applied(turned, path)
    kernels.use(compiled=False)
    plain = applied(turned, path)
    assert compiled is not None
    assert plain is not None
    assert same(plain[0], compiled[0])
    assert plain[1].deviation == compiled[1].deviation
