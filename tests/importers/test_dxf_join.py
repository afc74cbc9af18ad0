"""Coherent paths: joining against ezdxf's edgeminer, gaps, doubles and overlaps."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np
import pytest
from ezdxf import edgeminer
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.importers.dxf.clean import remove_doubles
from nccompile.importers.dxf.grid import close_pairs, cluster
from nccompile.importers.dxf.join import Paths, join_pieces
from nccompile.importers.dxf.pieces import Pieces, Row, arc_row, bulge_row, lengths, line_row
from tests.importers.workshop import codes, machine, new_drawing, pieces_of

GAP = 0.01


def joined(pieces: Pieces, gap: float = GAP) -> tuple[Paths, list[str]]:
    paths, places = join_pieces(pieces, np.zeros(len(pieces), np.int64), gap)
    return paths, [place.code for place in places]


def cleaned(pieces: Pieces) -> tuple[Pieces, list[str]]:
    left, _, places = remove_doubles(pieces, np.zeros(len(pieces), np.int64), 0.001)
    return left, [place.code for place in places]


def square(x: float, y: float, side: float) -> list[Row]:
    corners = [complex(x, y), complex(x + side, y), complex(x + side, y + side), complex(x, y + side)]
    return [line_row(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]


nodes = st.tuples(st.integers(0, 6), st.integers(0, 6)).map(lambda z: complex(*z))


@given(st.sets(st.tuples(nodes, nodes).filter(lambda e: e[0] != e[1]).map(lambda e: tuple(sorted(e, key=str))),
               min_size=1, max_size=40))  # fmt: skip
@settings(max_examples=150, deadline=None)
def test_paths_are_the_simple_chains_of_edgeminer(edges: set[tuple[complex, complex]]) -> None:
    ordered = sorted(edges, key=str)
    paths, _ = joined(pieces_of([line_row(a, b) for a, b in ordered]), gap=0.0)

    oracle = edgeminer.Deposit(
        [edgeminer.make_edge((a.real, a.imag), (b.real, b.imag), length=abs(b - a)) for a, b in ordered]
    )
    chains = edgeminer.find_all_simple_chains(oracle)
    expected = sorted(
        sorted(
            sorted([(round(e.start.x), round(e.start.y)), (round(e.end.x), round(e.end.y))]) for e in chain
        )
        for chain in chains
    )
    got = sorted(
        sorted(sorted([(round(a.real), round(a.imag)), (round(b.real), round(b.imag))])
               for a, b in zip(paths.path(i).start, paths.path(i).end, strict=True))
        for i in range(len(paths))
    )  # fmt: skip
    assert got == expected


@given(st.integers(0, 10_000))
@settings(max_examples=40, deadline=None)
def test_shuffled_and_turned_contours_join_again(seed: int) -> None:
    random = np.random.default_rng(seed)
    rows = [row for k in range(8) for row in square(20 * k, 0, 10)]
    rows = [rows[i] for i in random.permutation(len(rows))]
    turned = [line_row(complex(*r[3:5]), complex(*r[1:3])) if random.random() < 0.5 else r for r in rows]

    paths, places = joined(pieces_of(turned))

    assert len(paths) == 8
    assert paths.closed.all()
    assert not places
    for i in range(8):
        path = paths.path(i)
        assert (path.end == np.roll(path.start, -1)).all()


def test_gaps_up_to_the_tolerance_are_closed_half_way_and_reported() -> None:
    rows = [line_row(0j, 10 + 0j), line_row(10.006 + 0j, 20 + 0j)]

    paths, codes_found = joined(pieces_of(rows))

    assert codes_found == ["NC607"]
    assert len(paths) == 1
    assert paths.path(0).end[0] == paths.path(0).start[1] == pytest.approx(10.003)


def test_larger_gaps_stay_open_and_are_reported() -> None:
    paths, codes_found = joined(pieces_of([line_row(0j, 10 + 0j), line_row(10.05 + 0j, 20 + 0j)]))

    assert codes_found == ["NC608"]
    assert len(paths) == 2
    assert not paths.closed.any()


def test_a_contour_with_a_gap_is_never_closed_silently(tmp_path: Path) -> None:
    doc = new_drawing()
    doc.modelspace().add_lwpolyline([(0, 0), (10, 0), (10, 10), (0, 10), (0, 0.05)])

    made = machine(doc, tmp_path)
    wider = machine(doc, tmp_path, gap=0.1)

    assert not made.result.paths[0].closed.any()
    assert codes(made) == {"NC608": 1}
    assert wider.result.paths[0].closed.all()
    assert codes(wider) == {"NC607": 1}
    (place,) = wider.result.places
    assert place.size == pytest.approx(0.05)


def test_an_arc_that_nearly_closes_gets_a_bridge_instead_of_a_distortion() -> None:
    gap = 0.008
    arc = arc_row(0j, 50.0, 0.0, 2 * pi - gap / 50.0)

    paths, codes_found = joined(pieces_of([arc]))

    assert codes_found == ["NC607"]
    assert paths.closed.all()
    assert paths.path(0).p[0, 2] == pytest.approx(50.0, abs=1e-12)
    assert lengths(paths.path(0)).sum() == pytest.approx(2 * pi * 50.0, abs=1e-6)


def test_paths_of_different_layers_do_not_join(tmp_path: Path) -> None:
    doc = new_drawing()
    doc.modelspace().add_line((0, 0), (10, 0), {"layer": "A"})
    doc.modelspace().add_line((10, 0), (20, 5), {"layer": "B"})

    assert len(machine(doc, tmp_path).result.paths[0]) == 2


def test_doubles_go_whatever_their_direction() -> None:
    rows = [*square(0, 0, 10), line_row(10 + 0j, 0j), arc_row(50j, 5, 0, 2), arc_row(50j, 5, 2, -2)]

    left, codes_found = cleaned(pieces_of(rows))

    assert len(left) == 5
    assert codes_found == ["NC609", "NC609"]


@pytest.mark.parametrize("angle", [0.0, 0.3, pi / 2, 3.0])
def test_overlapping_lines_become_one(angle: float) -> None:
    turn = complex(np.cos(angle), np.sin(angle))
    rows = [line_row(0j, 10 * turn), line_row(15 * turn, 5 * turn), line_row(20 * turn, 30 * turn)]

    left, codes_found = cleaned(pieces_of(rows))

    assert sorted(np.round(lengths(left), 9)) == [10, 15]
    assert codes_found == ["NC609"]


def test_overlapping_arcs_become_one_and_a_circle_swallows_its_arcs() -> None:
    rows = [
        arc_row(0j, 5, 0, 2),
        arc_row(0j, 5, 3, -2),
        arc_row(9 + 0j, 2, 0, 2 * pi),
        arc_row(9 + 0j, 2, 5, 2),
    ]

    left, codes_found = cleaned(pieces_of(rows))

    assert sorted(np.round(left.p[:, 4], 9)) == [3, round(2 * pi, 9)]
    assert codes_found == ["NC609", "NC609"]


def test_loose_lines_give_way_to_a_polyline_which_stays_whole() -> None:
    contour = Pieces.from_rows(square(0, 0, 10), 0, 7, 0)
    loose = Pieces.from_rows([line_row(4 + 0j, 15 + 0j)], 0, 7, 1)

    left, codes_found = cleaned(Pieces.join([contour, loose]))

    assert codes_found == ["NC609"]
    assert len(left) == 5
    assert (left.start[-1], left.end[-1]) == (10, 15)


def test_two_contours_with_a_common_stretch_both_stay_and_are_reported() -> None:
    a, b = Pieces.from_rows(square(0, 0, 10), 0, 7, 0), Pieces.from_rows(square(10, 2, 5), 0, 7, 1)

    left, codes_found = cleaned(Pieces.join([a, b]))

    assert len(left) == 8
    assert codes_found == ["NC610"]


def test_parallel_neighbours_are_no_doubles() -> None:
    rows = [line_row(0j, 10 + 0j), line_row(0.002j, 10 + 0.002j), bulge_row(0j, 10 + 0j, 0.1)]

    left, codes_found = cleaned(pieces_of(rows))

    assert len(left) == 3
    assert not codes_found


@given(st.lists(st.tuples(st.floats(-3, 3), st.floats(-3, 3)), min_size=1, max_size=60), st.floats(0.05, 1.0))
@settings(max_examples=100, deadline=None)
def test_close_pairs_are_all_pairs(points: list[tuple[float, float]], reach: float) -> None:
    z = np.array([complex(*p) for p in points])

    i, j = close_pairs(z, reach)

    got = {tuple(sorted(pair)) for pair in zip(i.tolist(), j.tolist(), strict=True)}
    assert len(got) == len(i)
    assert got == {(a, b) for a in range(len(z)) for b in range(a + 1, len(z)) if abs(z[a] - z[b]) <= reach}


def test_a_star_of_many_lines_is_one_node() -> None:
    ends = 1000 * np.exp(2j * pi * np.arange(3000) / 3000)
    paths, places = joined(pieces_of([line_row(0j, complex(z)) for z in ends]))

    assert len(paths) == 3000
    assert not places
    assert len(np.unique(cluster(np.zeros(3000, complex), 1e-4))) == 1
