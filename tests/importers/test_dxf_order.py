"""Machining order: the containment tree, inner before outer, short rapids, start points, determinism."""

from __future__ import annotations

import json
from math import pi
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.importers.dxf.join import Paths
from nccompile.importers.dxf.nest import nest
from nccompile.importers.dxf.order import StartPoint, order_paths, rapid_length
from nccompile.importers.dxf.pieces import Pieces, arc_row, line_row, sample
from nccompile.kernels import use

TOURS = json.loads((Path(__file__).parent / "tours.json").read_text())


def circles(centres: npt.NDArray[np.complex128], radii: npt.NDArray[np.float64]) -> Paths:
    rows = [arc_row(complex(c), float(r), 0.0, 2 * pi) for c, r in zip(centres, radii, strict=True)]
    n = len(rows)
    return Paths(
        Pieces.from_rows(rows, 0, 7, np.arange(n)), np.arange(n + 1), np.ones(n, bool), np.zeros(n, np.int64)
    )


def lines(ends: list[tuple[complex, complex]]) -> Paths:
    n = len(ends)
    rows = [line_row(a, b) for a, b in ends]
    return Paths(
        Pieces.from_rows(rows, 0, 7, np.arange(n)), np.arange(n + 1), np.zeros(n, bool), np.zeros(n, np.int64)
    )


def ordered(paths: Paths, start: StartPoint | None = None, fixed: bool = False, seed: int = 0) -> Paths:
    directions = np.full(len(paths), fixed)
    return order_paths(paths, nest(paths).parent, directions, start or StartPoint(), 0j, seed)


@pytest.mark.parametrize("name", sorted(TOURS))
def test_rapids_are_near_the_best_known_tour(name: str) -> None:
    points = np.array([complex(*p) for p in TOURS[name]["points"]])
    tiny = circles(points, np.full(len(points), 1e-6))

    length = rapid_length(ordered(tiny), 0j)

    assert length <= 1.25 * TOURS[name]["best"]
    assert length >= TOURS[name]["best"] * (1 - 1e-4)


@given(st.integers(0, 10_000))
@settings(max_examples=25, deadline=None)
def test_inner_contours_come_before_outer_ones(seed: int) -> None:
    random = np.random.default_rng(seed)
    n = 24
    paths = circles(random.uniform(0, 60, n) + 1j * random.uniform(0, 60, n), random.uniform(0.5, 25, n))

    done = ordered(paths)

    c, r = done.pieces.p[:, 0] + 1j * done.pieces.p[:, 1], done.pieces.p[:, 2]
    assert sorted(r) == sorted(paths.pieces.p[:, 2])
    inside = np.abs(c[:, None] - c[None, :]) + r[:, None] < r[None, :] - 1e-3
    before, after = np.nonzero(inside)
    assert (before < after).all()


@given(st.integers(0, 10_000))
@settings(max_examples=25, deadline=None)
def test_the_containment_tree_of_circles(seed: int) -> None:
    random = np.random.default_rng(seed)
    n = 20
    c, r = random.uniform(0, 60, n) + 1j * random.uniform(0, 60, n), random.uniform(0.5, 25, n)

    tree = nest(circles(c, r))

    gap = np.abs(c[:, None] - c[None, :])
    inside = gap + r[:, None] < r[None, :]
    clear = inside | (gap > r[:, None] + r[None, :]) | (gap + r[None, :] < r[:, None]) | np.eye(n, dtype=bool)
    for i in np.flatnonzero(clear.all(axis=1)):
        holders = np.flatnonzero(inside[i])
        assert tree.depth[i] == len(holders)
        assert tree.parent[i] == (holders[np.argmin(r[holders])] if len(holders) else -1)


def test_the_result_does_not_depend_on_the_order_of_the_drawing() -> None:
    random = np.random.default_rng(4)
    ends = [(complex(*a), complex(*b)) for a, b in random.uniform(0, 100, (40, 2, 2))]
    shuffled = [ends[i] for i in random.permutation(40)]

    assert np.array_equal(ordered(lines(ends)).pieces.start, ordered(lines(shuffled)).pieces.start)


def test_python_and_compiled_kernels_find_the_same_tour(monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(7)
    paths = lines([(complex(*a), complex(*b)) for a, b in random.uniform(0, 100, (60, 2, 2))])

    plain = ordered(paths)
    use(compiled=True)
    try:
        fast = ordered(paths)
    finally:
        use(compiled=False)

    assert np.array_equal(plain.pieces.start, fast.pieces.start)
    assert np.array_equal(plain.pieces.end, fast.pieces.end)


def test_open_paths_turn_round_unless_their_direction_is_fixed() -> None:
    rows = [(10 + 0j, 0j), (10 + 5j, 20 + 5j)]

    assert rapid_length(ordered(lines(rows)), 0j) == pytest.approx(5.0)
    assert rapid_length(ordered(lines(rows), fixed=True), 0j) > 5.0


def test_start_points() -> None:
    corners = [0j, 30 + 0j, 30 + 10j, 3 + 10j]
    rows = [line_row(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    path = Paths(Pieces.from_rows(rows, 0, 7, 0), np.array([0, 4]), np.ones(1, bool), np.zeros(1, np.int64))

    def begin(start: StartPoint) -> complex:
        return complex(ordered(path, start).pieces.start[0])

    assert begin(StartPoint("nearest")) == 0j
    assert begin(StartPoint("longest")) == 15 + 0j
    assert begin(StartPoint("given", 29 + 8j)) == 30 + 10j
    assert begin(StartPoint("corner")) == 0j  # 106.7 degrees, the others turn by 90 and 73.3


@pytest.mark.parametrize(("centre", "begin"), [(20 + 0j, 15 + 0j), (-20 + 1j, -15 + 1j), (1 - 30j, 1 - 25j)])
def test_circles_begin_at_the_quarter_next_to_the_tool(centre: complex, begin: complex) -> None:
    done = ordered(circles(np.array([centre]), np.array([5.0])))

    assert done.pieces.start == pytest.approx([begin])
    assert sample(done.pieces, np.array([0.0]))[:, 0] == pytest.approx(done.pieces.start)
