"""Machining order: inner contours before outer ones, then short rapids; start points of closed paths.

The result depends on the geometry alone, not on the order of the drawing: paths are first put into a canonical
order, equal distances go to the lower one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from nccompile.importers.dxf.grid import Indices
from nccompile.importers.dxf.join import Paths
from nccompile.importers.dxf.pieces import Complexes, PieceKind, Pieces, end_tangents, lengths, reverse, split
from nccompile.kernels import expect_work
from nccompile.kernels.nearest import near_stops, nearest_first
from nccompile.kernels.tour import improve, tour_length

__all__ = ["StartPoint", "order_paths", "rapid_length", "reversed_paths"]

NEIGHBOURS = 10
ROUNDS = 60
WORK_A_STOP = 25
"""Kernel steps a stop costs, in units of `nccompile.kernels.LARGE`: 800 paths turn compilation on."""

LARGE_TOUR, MOST_TRIES, KICK = 200, 12, 50
"""Paths from which a tour is not perturbed any more, perturbations, and stops that one may reach over."""

Floats = npt.NDArray[np.float64]
Ends: TypeAlias = tuple[Floats, Floats, Floats, Floats]
"""Entry x, y and exit x, y of all stops."""

QUARTERS = np.array([1, 1j, -1, -1j])


@dataclass(frozen=True)
class StartPoint:
    """Where closed paths begin: nearest, corner, longest, or given with the point `at` [mm]."""

    rule: str = "nearest"
    at: complex = 0j


def order_paths(
    paths: Paths, parent: Indices, fixed: npt.NDArray[np.bool_], start: StartPoint, origin: complex, seed: int
) -> Paths:
    """The paths in machining order, turned and started where the tour wants them.

    Args:     parent: path that must come after each, -1 for none;  fixed: open paths that keep their direction;
              origin: where the tool stands before the first;  seed: of the perturbations that the search tries.
    """
    canonical = _canonical(paths)
    back = np.empty_like(canonical)
    back[canonical] = np.arange(len(canonical))
    up = np.where(parent >= 0, back[parent], -1)[canonical]
    paths, fixed = paths.select(canonical), fixed[canonical]
    paths = reversed_paths(paths, _begins_higher(paths) & ~paths.closed & ~fixed)
    if start.rule == "longest":
        paths = _from_longest(paths)
    tour = Tour(paths, up, fixed, origin, start)
    tour.search(seed)
    if start.rule == "nearest" and paths.closed.any():
        for _ in range(2):
            tour.restart()
            tour.shorten()
        tour.restart()
    return tour.result()


def rapid_length(paths: Paths, origin: complex) -> float:
    """Length of all rapids between the paths in their order, from the origin [mm]."""
    enter, leave = paths.pieces.start[paths.first[:-1]], paths.pieces.end[paths.first[1:] - 1]
    return float(np.abs(enter - np.concatenate([[origin], leave[:-1]])).sum())


def _canonical(paths: Paths) -> Indices:
    """The paths sorted by the box around their vertices, then length; full circles by the box around them.

    So neither the direction nor the beginning of a path matters.  Rounding keeps what is equal equal.
    """
    pieces, first = paths.pieces, paths.first[:-1]
    circle = _full_circles(pieces)
    centre = pieces.p[:, 0] + 1j * pieces.p[:, 1]
    reach = pieces.p[:, 2] * (1 + 1j)
    low, high = np.where(circle, centre - reach, pieces.start), np.where(circle, centre + reach, pieces.end)
    ends = [np.where(circle, z, other) for z, other in ((low, pieces.end), (high, pieces.start))]
    keys = (
        paths.group,
        np.round(np.add.reduceat(lengths(pieces), first), 5),
        np.round(np.maximum.reduceat(np.maximum(high.imag, ends[1].imag), first), 5),
        np.round(np.maximum.reduceat(np.maximum(high.real, ends[1].real), first), 5),
        np.round(np.minimum.reduceat(np.minimum(low.imag, ends[0].imag), first), 5),
        np.round(np.minimum.reduceat(np.minimum(low.real, ends[0].real), first), 5),
    )
    order: Indices = np.lexsort(keys)
    return order


def _begins_higher(paths: Paths) -> npt.NDArray[np.bool_]:
    """Shape (n,): paths whose start lies right of their end, or above it."""
    a, b = paths.pieces.start[paths.first[:-1]], paths.pieces.end[paths.first[1:] - 1]
    return np.asarray((a.real > b.real) | ((a.real == b.real) & (a.imag > b.imag)), np.bool_)


class Tour:
    """The search's state: paths, their order and directions."""

    def __init__(
        self, paths: Paths, parent: Indices, fixed: npt.NDArray[np.bool_], origin: complex, start: StartPoint
    ) -> None:
        self.paths = paths
        self.circle = (np.diff(paths.first) == 1) & _full_circles(paths.pieces)[paths.first[:-1]]
        self.quarter = np.ones(len(paths), complex)
        """Direction from the centre to the start of each full circle: 1, i, -1 or -i."""
        self.parent = parent.astype(np.int64)
        self.fixed = fixed & ~paths.closed
        self.origin = origin
        n = len(paths)
        self.tour = np.arange(n)
        self.flip = np.zeros(n, bool)
        self.begin = paths.first[:-1].copy() if start.rule == "longest" else _begin_rows(paths, start)
        """The piece each path begins with."""
        self.enter = paths.pieces.start[self.begin]
        for i in np.flatnonzero(self.circle).tolist():
            ends = self._quarters(i)
            self._begin_circle(i, ends, np.abs(ends - start.at) if start.rule == "given" else -ends.real)
        self.leave = np.where(paths.closed, self.enter, paths.pieces.end[paths.first[1:] - 1])

    def _quarters(self, i: int) -> Complexes:
        """Where a full circle may begin: right, top, left, bottom."""
        p = self.paths.pieces.p[self.paths.first[i]]
        points: Complexes = complex(p[0], p[1]) + p[2] * QUARTERS
        return points

    def _begin_circle(self, i: int, ends: Complexes, way: npt.NDArray[np.float64]) -> None:
        best = int(np.argmin(np.round(way, 7)))
        self.quarter[i], self.enter[i] = QUARTERS[best], ends[best]

    def _columns(self) -> Ends:
        a, b = self.enter, self.leave
        return a.real.copy(), a.imag.copy(), b.real.copy(), b.imag.copy()

    def search(self, seed: int) -> None:
        """A tour by nearest neighbours, shortened, then perturbed."""
        n = len(self.tour)
        expect_work(n * WORK_A_STOP)
        side = max(1, min(1000, int(n**0.5)))
        nearest_first(
            *self._columns(),
            self.fixed,
            self.parent,
            self.origin.real,
            self.origin.imag,
            side,
            self.tour,
            self.flip,
        )
        self.shorten()
        self._perturb(seed)

    def shorten(self) -> None:
        """2-opt and Or-opt until nothing is saved."""
        n = len(self.tour)
        if n < 2:
            return
        columns = self._columns()
        apart = self.enter != self.leave
        px, py = (np.concatenate([columns[k], columns[k + 2][apart]]) for k in (0, 1))
        owner = np.concatenate([np.arange(n), np.flatnonzero(apart)])
        self.near = np.empty((n, min(NEIGHBOURS, n - 1)), np.int64)
        self.reach = np.empty(self.near.shape)
        side = max(1, min(1000, int(n**0.5)))
        near_stops(px, py, owner, n, self.near.shape[1], side, self.near, self.reach)
        self._improve(columns, np.zeros(n, bool))

    def _improve(self, columns: Ends, quiet: npt.NDArray[np.bool_]) -> None:
        improve(
            self.tour, self.flip, *columns, self.fixed, self.parent, self.near, self.reach, quiet,
            self.origin.real, self.origin.imag, ROUNDS,
        )  # fmt: skip

    def _perturb(self, seed: int) -> None:
        """Turns random stretches round and keeps what is shorter afterwards; small drawings only."""
        n = len(self.tour)
        tries = 0 if n < 5 or n > LARGE_TOUR else MOST_TRIES
        if not tries:
            return
        random = np.random.default_rng(seed)
        columns = self._columns()
        best = tour_length(self.tour, self.flip, *columns, self.origin.real, self.origin.imag)
        for _ in range(tries):
            held = self.tour.copy(), self.flip.copy()
            a, b, c = np.sort(random.integers(0, min(n, KICK) + 1, 3)) + random.integers(
                0, max(1, n - KICK + 1)
            )
            order = np.concatenate([np.arange(a), np.arange(b, c), np.arange(a, b), np.arange(c, n)])
            if not self._allowed(self.tour[order]):
                continue
            self.tour, self.flip = self.tour[order], self.flip[order]
            quiet = np.ones(n, bool)
            cuts = np.array([a - 1, a, a + c - b - 1, a + c - b, c - 1, c])
            quiet[self.tour[cuts[(cuts >= 0) & (cuts < n)]]] = False
            self._improve(columns, quiet)
            length = tour_length(self.tour, self.flip, *columns, self.origin.real, self.origin.imag)
            if length < best - 1e-9:
                best = length
            else:
                self.tour, self.flip = held

    def _allowed(self, tour: Indices) -> bool:
        """Whether every path comes before its parent."""
        place = np.empty(len(tour), np.int64)
        place[tour] = np.arange(len(tour))
        held = self.parent >= 0
        return bool(np.all(place[held] < place[self.parent[held]]))

    def restart(self) -> None:
        """Begins every closed path at the vertex that makes the way from and to its neighbours shortest."""
        pieces, first = self.paths.pieces, self.paths.first
        n = len(self.tour)
        for k, i in enumerate(self.tour.tolist()):
            if not self.paths.closed[i]:
                continue
            low, high = int(first[i]), int(first[i + 1])
            before = self.origin if k == 0 else self._exit(k - 1)
            places = self._quarters(i) if self.circle[i] else pieces.start[low:high]
            way = np.abs(places - before)
            if k + 1 < n:
                way = way + np.abs(places - self._entry(k + 1))
            if self.circle[i]:
                self._begin_circle(i, places, way)
            else:
                self.begin[i] = low + int(np.argmin(np.round(way, 7)))
                self.enter[i] = pieces.start[self.begin[i]]
            self.leave[i] = self.enter[i]

    def _exit(self, k: int) -> complex:
        i = self.tour[k]
        return complex(self.enter[i] if self.flip[k] else self.leave[i])

    def _entry(self, k: int) -> complex:
        i = self.tour[k]
        return complex(self.leave[i] if self.flip[k] else self.enter[i])

    def result(self) -> Paths:
        """The paths in tour order."""
        first = self.paths.first
        turned = Paths(self._rotated(), first, self.paths.closed, self.paths.group).select(self.tour)
        return reversed_paths(turned, self.flip & ~turned.closed)

    def _rotated(self) -> Pieces:
        """The pieces with every closed path beginning where it should."""
        first = self.paths.first
        counts = np.diff(first)
        low = np.repeat(first[:-1], counts)
        shift = np.repeat(self.begin - first[:-1], counts)
        index = low + (np.arange(first[-1]) - low + shift) % np.repeat(counts, counts)
        pieces = self.paths.pieces.take(index)
        rows = first[:-1][self.circle]
        p, start, end = pieces.p.copy(), pieces.start.copy(), pieces.end.copy()
        p[rows, 3] = np.angle(self.quarter[self.circle])
        start[rows] = end[rows] = self.enter[self.circle]
        return pieces.replace(p=p, start=start, end=end)


def _full_circles(pieces: Pieces) -> npt.NDArray[np.bool_]:
    circles: npt.NDArray[np.bool_] = pieces.is_full & (pieces.kind == PieceKind.ARC)
    return circles


def reversed_paths(paths: Paths, mask: npt.NDArray[np.bool_]) -> Paths:
    """The paths of the mask run backwards."""
    counts = np.diff(paths.first)
    low, high = np.repeat(paths.first[:-1], counts), np.repeat(paths.first[1:], counts)
    at = np.arange(paths.first[-1])
    rows = np.repeat(mask, counts)
    index = np.where(rows, low + high - 1 - at, at)
    return Paths(reverse(paths.pieces.take(index), rows), paths.first, paths.closed, paths.group)


def _begin_rows(paths: Paths, start: StartPoint) -> Indices:
    """The piece that each path begins with by the rule; `nearest` begins at the lower left until the tour says."""
    pieces = paths.pieces
    owner = np.repeat(np.arange(len(paths)), np.diff(paths.first))
    value: Floats
    if start.rule == "corner":
        value = -np.round(_corners(paths), 7)
    elif start.rule == "given":
        value = np.asarray(np.round(np.abs(pieces.start - start.at), 7), np.float64)
    else:
        value = np.round(pieces.start.real + pieces.start.imag, 7)
    ranked = np.lexsort((pieces.start.real, value, owner))
    rows: Indices = np.where(paths.closed, ranked[paths.first[:-1]], paths.first[:-1])
    return rows


def _corners(paths: Paths) -> npt.NDArray[np.float64]:
    """Shape (n,): how much a closed path turns at the start of every piece [rad]."""
    enter, leave = end_tangents(paths.pieces)
    before = np.arange(len(enter)) - 1
    before[paths.first[:-1]] = paths.first[1:] - 1
    return np.asarray(np.abs(np.angle(enter * leave[before].conj())), np.float64)


def _from_longest(paths: Paths) -> Paths:
    """Closed paths beginning in the middle of their longest piece (full circles stay)."""
    parts, first = [], [0]
    for i in range(len(paths)):
        path = paths.path(i)
        row = int(np.argmax(np.round(lengths(path), 7)))
        if paths.closed[i] and not path.is_full[row]:
            left, right = split(path, row, 0.5)
            path = Pieces.join([right, path.take(slice(row + 1, None)), path.take(slice(0, row)), left])
        parts.append(path)
        first.append(first[-1] + len(path))
    return Paths(Pieces.join(parts), np.array(first), paths.closed, paths.group)
