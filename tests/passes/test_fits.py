"""fit-arcs and fit-splines: tolerance both ways, corners, exact recoveries, helices, axes, chunks."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline
from scipy.spatial import cKDTree

from nccompile import kernels
from nccompile.kernels.spline_basis import pad_knots, span_basis, span_powers
from nccompile.kernels.spline_errors import chord_errors
from nccompile.passes import runs
from nccompile.passes.base import Pass
from nccompile.passes.fit_arcs import FitArcs
from nccompile.passes.fit_splines import FitSplines
from nccompile.passes.measure import samples
from nccompile.toolpath.columns import Kind, Plane, Toolpath
from tests.passes.paths import SIZES, Sketch, paths, run, same

FITS: list[Pass] = [FitArcs(), FitArcs(tolerance=0.05, least=2), FitSplines(), FitSplines(tolerance=0.05)]


def polyline(points: Sequence[tuple[float, ...]], feed: float = 50.0) -> Toolpath:
    sketch = Sketch(points[0])
    for p in points[1:]:
        sketch.to(p[0], p[1], p[2] if len(p) > 2 else 0.0, p[3] if len(p) > 3 else 0.0, feed=feed)
    return sketch.path()


def curve(n: int, seed: int = 0, z: float = 0.0) -> list[tuple[float, ...]]:
    """A smooth wavy contour in n chords, rounded like a post-processor does."""
    t = np.linspace(0, 2 * pi, n + 1)
    r = 40 + 6 * np.cos(5 * t + seed) + 2 * np.cos(11 * t)
    return [
        (round(a * cos(b), 3), round(a * sin(b), 3), round(z * sin(3 * b), 3))
        for a, b in zip(r, t, strict=True)
    ]


def dense(path: Toolpath, count: int) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    return samples(path, np.full(len(path), count))[0]


def farthest(one: Toolpath, two: Toolpath) -> float:
    """Largest distance of samples of both paths, by a k-d tree: the spacing of samples is the error."""
    a, b = dense(one, 400), dense(two, 4000)
    return max(float(np.max(cKDTree(x).query(y)[0])) for x, y in ((a, b), (b, a)))


@pytest.mark.parametrize("p", FITS, ids=repr)
@settings(max_examples=15, deadline=None)
@given(path=paths(most=14))
def test_any_path_passes_and_chunks_do_not_matter(p: Pass, path: Toolpath) -> None:
    whole, report = run(p, path)
    assert (report.deviation or 0.0) <= p.tolerance * (1 + 1e-6)  # type: ignore[attr-defined]
    assert len(whole.events) == len(path.events)
    for size in SIZES[:2]:
        assert same(run(p, path, size)[0], whole)


@pytest.mark.parametrize("p", [FitArcs(), FitSplines()], ids=repr)
@pytest.mark.parametrize("z", [0.0, 2.0])
def test_tolerance_both_ways_on_dense_samples(p: Pass, z: float) -> None:
    path = polyline(curve(1200, z=z))
    out, report = run(p, path)
    assert report.deviation is not None
    assert report.deviation <= 0.005
    near = farthest(path, out)
    assert near <= 0.005 + 0.002
    assert abs(near - report.deviation) <= 0.002
    assert len(out) < len(path) / (5 if z == 0.0 else 1.5)
    for size in SIZES:
        assert same(run(p, path, size)[0], out)


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 1000), st.integers(60, 400), st.floats(0.001, 0.1))
def test_random_contours_keep_the_tolerance(seed: int, n: int, tolerance: float) -> None:
    path = polyline(curve(n, seed))
    for p in (FitArcs(tolerance=tolerance), FitSplines(tolerance=tolerance)):
        assert (run(p, path)[1].deviation or 0.0) <= tolerance


def test_an_arc_is_found_again() -> None:
    t = np.linspace(0, 1.5 * pi, 200)
    out, _ = run(FitArcs(), polyline([(10 * cos(a), 10 * sin(a)) for a in t]))
    assert len(out) == 1
    assert out.kind[0] == Kind.ARC
    assert out.curves.parameters[0, 2] == pytest.approx(10.0, abs=0.005)
    assert out.curves.parameters[0, 4] == pytest.approx(1.5 * pi, abs=1e-3)


def test_a_helix_and_an_arc_in_another_plane_are_found() -> None:
    t = np.linspace(0, 4, 100)
    helix, _ = run(FitArcs(), polyline([(10 * cos(a), 10 * sin(a), a / 8) for a in t]))
    assert len(helix) == 1
    zx, _ = run(FitArcs(), polyline([(10 * cos(a), 3.0, 10 * sin(a)) for a in t]))
    assert len(zx) == 1
    assert zx.curves.plane[0] == Plane.ZX
    assert len(run(FitArcs(planes=False), polyline([(10 * cos(a), 3.0, 10 * sin(a)) for a in t]))[0]) > 20


def test_a_straight_run_becomes_one_line() -> None:
    out, _ = run(FitArcs(), polyline([(i * 0.5, 0.003 * (i % 2)) for i in range(50)]))
    assert out.kind.tolist() == [Kind.LINE]


@pytest.mark.parametrize("p", [FitArcs(), FitSplines()], ids=repr)
def test_sharp_corners_stay_exact(p: Pass) -> None:
    t = np.linspace(0, 2, 80)
    points = [(10 * cos(a), 10 * sin(a)) for a in t]
    corner = points[-1]
    points += [(corner[0] + 0.1 * i, corner[1]) for i in range(1, 40)]
    out, _ = run(p, polyline(points))
    assert min(np.abs(out.target[:, :2] - corner).sum(axis=1)) == 0.0


def cubics(path: Toolpath) -> np.ndarray[tuple[int, int, int], np.dtype[np.float64]]:
    """Powers of the cubics of a path: Shape (m, 3, 4)."""
    return path.curves.parameters[path.curve[path.curve >= 0]].reshape(-1, 3, 4)


def kinks(path: Toolpath) -> tuple[float, float]:
    """The greatest change of direction [rad] and of curvature [1/mm] at the joints of a path of cubics."""
    p = cubics(path)
    assert np.abs(p.sum(axis=2)[:-1] - p[1:, :, 0]).max() < 1e-9
    first, last = p[:, :, 1], p[:, :, 1] + 2 * p[:, :, 2] + 3 * p[:, :, 3]
    unit = [v / np.linalg.norm(v, axis=1, keepdims=True) for v in (first, last)]
    bend = [
        np.cross(v, w) / np.linalg.norm(v, axis=1, keepdims=True) ** 3
        for v, w in ((first, 2 * p[:, :, 2]), (last, 2 * p[:, :, 2] + 6 * p[:, :, 3]))
    ]
    return float(np.abs(unit[1][:-1] - unit[0][1:]).max()), float(np.abs(bend[1][:-1] - bend[0][1:]).max())


@pytest.mark.parametrize("z", [0.0, 2.0])
def test_splines_are_smooth_to_the_second_derivative(z: float) -> None:
    out, _ = run(FitSplines(), polyline(curve(800, z=z)))
    assert len(out) > 10
    turn, bend = kinks(out)
    assert turn < 1e-7
    assert bend < 1e-6


def test_splines_are_smooth_across_changes_of_feed_and_cuts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runs, "LONGEST", 200)
    sketch = Sketch()
    points = curve(900)
    sketch.at[:2] = sketch.start[:2] = points[0][:2]
    for i, (x, y, _) in enumerate(points[1:]):
        sketch.to(x, y, feed=50.0 if i < 333 else 40.0)
    path = sketch.path()
    out, report = run(FitSplines(), path)
    assert (report.deviation or 0.0) <= 0.005
    turn, bend = kinks(out)
    assert turn < 1e-7
    assert bend < 1e-6
    for vertex in (200, 333, 533, 733):  # every 200 segments from the corner or the change of feed on
        assert np.abs(out.target[:, :2] - points[vertex][:2]).sum(axis=1).min() == 0.0
    assert out.feed[np.abs(out.target[:, :2] - points[333][:2]).sum(axis=1).argmin()] == 50.0
    for size in SIZES:
        assert same(run(FitSplines(), path, size)[0], out)


def test_directions_at_kept_corners_are_those_of_the_chords() -> None:
    t = np.linspace(0, 2, 80)
    points = [(10 * cos(a), 10 * sin(a)) for a in t]
    corner = points[-1]
    points += [(corner[0] + 0.5 * sin(0.1 * i) + 0.1 * i, corner[1] + 0.3 * i) for i in range(1, 40)]
    path = polyline(points)
    out, _ = run(FitSplines(), path)
    p = cubics(out)
    last, first = p[:, :2, 1:].dot([1.0, 2.0, 3.0]), p[:, :2, 1]
    at = int(np.abs(out.target[:, :2] - corner).sum(axis=1).argmin())
    steps = np.diff(np.array(points), axis=0)
    for got, chord in ((first[0], 0), (last[at], 78), (first[at + 1], 79), (last[-1], -1)):
        cross = got[0] * steps[chord, 1] - got[1] * steps[chord, 0]
        assert abs(cross) <= 1e-6 * np.linalg.norm(got) * np.linalg.norm(steps[chord])
        assert got @ steps[chord] > 0


def test_a_long_line_hands_its_direction_to_the_spline_behind_it() -> None:
    line = [(-20.0, 0.0), (0.0, 0.0)]
    t = np.linspace(0.02, 1.5, 60)
    out, _ = run(FitSplines(), polyline(line + [(10 * sin(a), 10 - 10 * cos(a)) for a in t]))
    assert out.kind[:2].tolist() == [Kind.LINE, Kind.POLYNOMIAL]
    p = cubics(out)[0, :2]
    assert abs(p[1, 1]) <= 1e-6 * p[0, 1]


@pytest.mark.parametrize("z", [0.0, 2.0])
def test_kernels_give_the_same_bits_as_plain_python(z: float) -> None:
    path = polyline(curve(120, z=z))
    for p in (FitArcs(), FitSplines()):
        compiled, _ = run(p, path)
        kernels.use(compiled=False)
        assert same(run(p, path)[0], compiled)
        kernels.use(compiled=True)


@given(st.lists(st.floats(0.2, 5.0), min_size=1, max_size=8), st.integers(0, 1000))
def test_pieces_of_a_spline_are_those_of_scipy_and_knots_move_it_as_said(
    spans: list[float], seed: int
) -> None:
    n = len(spans)
    knots = np.concatenate([[0.0], np.cumsum(spans)])
    t, basis, rows = np.zeros(n + 7), np.zeros((n, 7, 4)), np.zeros((n, 8))
    pad_knots(knots, n, t)
    span_basis(t, n, basis)
    control = np.random.default_rng(seed).normal(size=(n + 3, 2))
    span_powers(basis, n, 2, control.ravel(), 2, rows)
    v = np.linspace(0.0, 1.0, 7)[1:-1]
    u = np.concatenate([a + h * v for a, h in zip(knots[:-1], spans, strict=True)])
    owner, at = np.repeat(np.arange(n), 5), np.concatenate([h * v for h in spans])
    powers = at[:, None] ** np.arange(4)
    got = np.einsum("ip,icp->ic", powers, rows.reshape(n, 2, 4)[owner])
    assert got == pytest.approx(BSpline(t, control, 3)(u), abs=1e-9)
    for k in range(1, n):
        step = 1e-4 * min(spans)
        moved = [BSpline(t + sign * step * (np.arange(n + 7) == k + 3), control, 3)(u) for sign in (1, -1)]
        slope = (moved[0] - moved[1]) / (2 * step)
        jump = 6 * (rows[k, [3, 7]] - rows[k - 1, [3, 7]])
        shape = np.array([
            basis[j, k - j + 5] @ q if -1 <= k - j <= 1 else 0.0 for j, q in zip(owner, powers, strict=True)
        ])  # fmt: skip
        # slope + jump shape is a spline on the same knots.
        rest = slope + shape[:, None] * jump
        splines = BSpline.design_matrix(u, t, 3).toarray()
        left = rest - splines @ np.linalg.lstsq(splines, rest, rcond=None)[0]
        assert np.abs(left).max() <= 1e-5 * max(1.0, float(np.abs(slope).max()))


@given(st.integers(0, 10_000))
def test_the_bound_of_a_span_covers_its_chords(seed: int) -> None:
    draw = np.random.default_rng(seed)
    knots = np.concatenate([[0.0], np.cumsum(draw.uniform(0.5, 2.0, 3))])
    t, basis, rows = np.zeros(10), np.zeros((3, 7, 4)), np.zeros((3, 8))
    pad_knots(knots, 3, t)
    span_basis(t, 3, basis)
    control = np.column_stack([np.linspace(0, knots[-1], 6), np.zeros(6)]) + draw.normal(0, 0.3, (6, 2))
    span_powers(basis, 3, 2, control.ravel(), 2, rows)
    u = np.linspace(0, knots[-1], int(draw.integers(3, 9)))
    spline = BSpline(t, control, 3)
    points = spline(u) + draw.normal(0, 0.1, (len(u), 2))
    errors, tangent = np.zeros(3), np.zeros((len(u), 2))
    bound = chord_errors(points, points, t, 3, rows, u, tangent, errors, True)
    assert bound == errors.max()
    assert np.all(np.diff(u) >= 0)
    s = np.linspace(0, 1, 200)[:, None]
    true = 0.0
    for i in range(len(u) - 1):
        chord = points[i] + s * (points[i + 1] - points[i])
        true = max(true, np.linalg.norm(chord - spline(u[i] + s[:, 0] * (u[i + 1] - u[i])), axis=1).max())
    assert true <= bound * (1 + 1e-9)


@pytest.mark.parametrize("p", [FitArcs(), FitSplines()], ids=repr)
def test_additional_axes_stay_near_their_way_and_events_at_their_share(p: Pass) -> None:
    t = np.linspace(0, 3, 200)
    sketch = Sketch((10.0, 0.0, 0.0, 0.0))
    for i, a in enumerate(t[1:]):
        sketch.to(10 * cos(a), 10 * sin(a), 0.0, 20 * a)
        if i == 99:
            sketch.switch(7, 1.0)
    path = sketch.path()
    out, _ = run(p, path)
    assert len(out) < 20
    way = np.concatenate([[0.0], np.cumsum(out.length)]) / out.length.sum()
    assert np.abs(np.append(0.0, out.target[:, 3]) - 60 * way).max() < 0.02
    e = out.events
    at = way[e.segment[0]] + e.position[0] * out.length[e.segment[0]] / out.length.sum()
    assert at == pytest.approx(100 / 199, abs=1e-3)


def test_fits_are_stable_when_run_again() -> None:
    once, _ = run(FitArcs(), polyline(curve(600)))
    again, _ = run(FitArcs(), once)
    assert len(again) >= 0.7 * len(once)
    assert np.array_equal(again.end, once.end)


def wandering(seed: int) -> tuple[Toolpath, float]:
    """A run of coarse chords that bend here and there, and a tolerance of the size of their sag."""
    draw = np.random.default_rng(seed)
    n, bend, tolerance = int(draw.integers(5, 120)), draw.uniform(1, 29), 10 ** draw.uniform(-2.7, -0.7)
    if seed % 2:
        turn = np.cumsum(np.radians(draw.uniform(-bend, bend, n)))
        size = draw.uniform(0.2, 0.8, n)
    else:
        wave = np.sin(np.arange(n) * draw.uniform(0.3, 2) + draw.uniform(0, 6))
        turn = np.radians(bend) * wave + 0.1 * draw.normal(size=n)
        size = np.full(n, 0.33)
    x, y = (np.round(np.cumsum(size * f(turn)), 3).tolist() for f in (np.cos, np.sin))
    return polyline([(0.0, 0.0), *zip(x, y, strict=True)]), float(tolerance)


@pytest.mark.parametrize("seed", [641, 1885, *range(40)])  # 641: joints of the spline inside the chords
def test_coarse_bending_runs_keep_the_tolerance(seed: int) -> None:
    path, tolerance = wandering(seed)
    for p in (FitArcs(tolerance=tolerance, least=2), FitSplines(tolerance=tolerance)):
        assert (run(p, path)[1].deviation or 0.0) <= tolerance
