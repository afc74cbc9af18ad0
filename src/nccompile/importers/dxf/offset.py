"""Tool radius by geometry: the path of a tool that touches a contour on one side of it.

Every piece is moved aside by the radius, corners are closed by arcs about their vertex, everything is cut where
it crosses, and the parts that come nearer to the contour than the radius are dropped.  What is left is joined:
none, one or several paths.  Lines stay lines and arcs stay arcs.
"""

from __future__ import annotations

from itertools import pairwise
from math import ceil, cos, pi, sin

import numpy as np
import numpy.typing as npt

from nccompile.importers.dxf.crossings import crossings
from nccompile.importers.dxf.fit import arcs_for_cubics
from nccompile.importers.dxf.grid import Indices, cluster
from nccompile.importers.dxf.join import Paths, meet
from nccompile.importers.dxf.leads import line_string
from nccompile.importers.dxf.order import reversed_paths
from nccompile.importers.dxf.pieces import (
    PieceKind,
    Pieces,
    Row,
    arc_row,
    cubic_row,
    end_tangents,
    flatten,
    lengths,
    line_row,
    sample,
)

__all__ = ["offset_path"]

NEAR = 3e-5
"""[mm] A part of the moved path may be this much nearer to the contour than the radius: the chord height of
the polyline that stands for the contour, and rounding at tangent places."""

FINE = 1e-5
"""Chord height [mm] of that polyline."""

MEET = 1e-3
"""[mm] Ends of parts that are one point: crossings are left a little late where the paths cross at a flat angle."""

FLAT_RADIUS = 2e4
"""Arcs of a larger radius [mm] are moved as lines: where they cross others has too few digits."""

CORNER = 1e-4
"""Bend [rad] below which pieces go on smoothly."""


def offset_path(path: Pieces, closed: bool, distance: float, tolerance: float) -> Paths:
    """The path moved to its left by `distance` [mm] (negative: to its right), in the same direction.

    Args:     path: pieces that follow each other;  tolerance: of ellipses and cubics, which become arcs [mm].
    Returns:  no path at all where the tool does not fit.
    """
    contour = _lines_and_arcs(path, tolerance)
    raw = _moved(contour, closed, distance)
    parts = _cut(raw)
    keep = _far_enough(parts, contour, abs(distance))
    kept = parts.take(keep)
    return _directed(_chains(kept, closed), contour, distance)


def _chains(parts: Pieces, closed: bool) -> Paths:
    """The parts joined from end to start, in their direction.

    Where several parts leave a point the one that followed in the contour goes on, so a stretch that is run
    both ways (a slot as wide as the tool) does not fall apart.  Of a closed contour only closed paths remain.
    """
    node = cluster(np.concatenate([parts.start, parts.end]), MEET) if len(parts) else np.zeros(0, np.int64)
    tail, head = node[: len(parts)], node[len(parts) :]
    leaving: dict[int, list[int]] = {}
    rows = np.flatnonzero((tail != head) | parts.is_full)
    for i in (_without_dead_ends(rows, tail, head) if closed else rows).tolist():
        leaving.setdefault(int(tail[i]), []).append(i)
    entered = set(head.tolist())
    begins = sorted(range(len(parts)), key=lambda i: (int(tail[i]) in entered, i))
    order: list[int] = []
    first: list[int] = [0]
    rings: list[bool] = []
    for begin in begins:
        if begin not in leaving.get(int(tail[begin]), ()):
            continue
        chain = _follow(begin, tail, head, leaving)
        ring = bool(head[chain[-1]] == tail[begin])
        if ring or not closed:
            order += chain
            first.append(len(order))
            rings.append(ring)
    made = parts.take(np.array(order, np.int64))
    made = made.replace(entity=np.zeros(len(order), np.int32))
    return meet(
        Paths(made, np.array(first), np.array(rings, bool), np.zeros(len(rings), np.int64)), 20 * MEET
    )


def _without_dead_ends(rows: Indices, tail: Indices, head: Indices) -> Indices:
    """The parts that something leads to and something leads away from: crossings at flat angles leave stubs."""
    while True:
        on = np.isin(head[rows], tail[rows]) & np.isin(tail[rows], head[rows])
        if on.all():
            return rows
        rows = rows[on]


def _follow(begin: int, tail: Indices, head: Indices, leaving: dict[int, list[int]]) -> list[int]:
    """The parts from one on until none leaves or the first point is reached again; they are used up."""
    chain = [begin]
    leaving[int(tail[begin])].remove(begin)
    while head[chain[-1]] != tail[begin] and leaving.get(int(head[chain[-1]])):
        choices = leaving[int(head[chain[-1]])]
        following = min(choices, key=lambda i: (i <= chain[-1], i))
        choices.remove(following)
        chain.append(following)
    return chain


def _lines_and_arcs(path: Pieces, tolerance: float) -> Pieces:
    """The path with arcs instead of ellipses and cubics."""
    rows: list[Row] = []
    for i, kind in enumerate(path.kind.tolist()):
        if kind == PieceKind.ELLIPSE:
            rows += _ellipse_cubics(path.p[i])
        elif kind == PieceKind.ARC and path.p[i, 2] > FLAT_RADIUS:
            (line,) = flatten(path.take([i]), FINE)
            rows += [line_row(complex(a), complex(b)) for a, b in pairwise(line)]
        else:
            rows.append(
                (kind, path.start[i].real, path.start[i].imag, path.end[i].real, path.end[i].imag, *path.p[i])
            )
    pieces = Pieces.from_rows(rows, path.layer[0], path.color[0], path.entity[0])
    whole = Paths(pieces, np.array([0, len(pieces)]), np.zeros(1, bool), np.zeros(1, np.int64))
    return arcs_for_cubics(whole, tolerance).pieces


def _ellipse_cubics(p: npt.NDArray[np.float64]) -> list[Row]:
    """Cubics of at most 15 degrees: each is within 1e-8 of the main half-axis."""
    centre, axis = complex(p[0], p[1]), complex(cos(p[4]), sin(p[4]))
    count = max(1, ceil(abs(p[6]) / (pi / 12)))
    step = float(p[6]) / count
    handle = 4.0 / 3.0 * np.tan(step / 4.0)

    def at(t: float) -> complex:
        return centre + axis * complex(p[2] * cos(t), p[3] * sin(t))

    def along(t: float) -> complex:
        return axis * complex(-p[2] * sin(t), p[3] * cos(t))

    angles = [float(p[5]) + step * k for k in range(count + 1)]
    return [
        cubic_row(at(t), at(t) + handle * along(t), at(u) - handle * along(u), at(u))
        for t, u in pairwise(angles)
    ]


def _moved(contour: Pieces, closed: bool, distance: float) -> Pieces:
    """All pieces moved aside, with an arc about every corner between them."""
    enter, leave = end_tangents(contour)
    rows: list[Row] = []
    n = len(contour)
    for i in range(n):
        rows += _moved_piece(contour, i, distance, complex(enter[i]), complex(leave[i]))
        j = (i + 1) % n
        if j == 0 and not closed:
            break
        bend = float(np.angle(enter[j] / leave[i]))
        if abs(bend) > CORNER:
            normal = 1j * complex(leave[i]) * (1.0 if distance > 0 else -1.0)
            rows.append(arc_row(complex(contour.end[i]), abs(distance), float(np.angle(normal)), bend))
    return Pieces.from_rows(rows, contour.layer[0], contour.color[0], 0)


def _moved_piece(contour: Pieces, i: int, distance: float, enter: complex, leave: complex) -> list[Row]:
    """One piece moved to its left; an arc whose radius the tool does not fit into becomes a line across."""
    a, b = complex(contour.start[i]), complex(contour.end[i])
    moved_a, moved_b = a + 1j * enter * distance, b + 1j * leave * distance
    if contour.kind[i] == PieceKind.ARC:
        cx, cy, radius, start, sweep = contour.p[i, :5].tolist()
        new = radius - distance if sweep > 0 else radius + distance
        if new > 1e-6:
            return [arc_row(complex(cx, cy), new, start, sweep)]
    return [line_row(moved_a, moved_b)] if moved_a != moved_b else []


def _cut(raw: Pieces) -> Pieces:
    """Every piece cut where it crosses or touches another one."""
    places = crossings(raw)
    rows: list[Row] = []
    for i in range(len(raw)):
        u = [0.0, *(t for t in sorted(places.get(i, ())) if 1e-12 < t < 1 - 1e-12), 1.0]
        for low, high in pairwise(u):
            rows += _part(raw, i, low, high)
    return Pieces.from_rows(rows, raw.layer[0], raw.color[0], 0)


def _part(raw: Pieces, i: int, low: float, high: float) -> list[Row]:
    """The stretch low..high of a line or arc."""
    if raw.kind[i] == PieceKind.ARC:
        cx, cy, radius, start, sweep = raw.p[i, :5].tolist()
        row = arc_row(complex(cx, cy), radius, start + sweep * low, sweep * (high - low))
        return [row] if radius * abs(sweep) * (high - low) > 1e-7 else []
    a, b = complex(raw.start[i]), complex(raw.end[i])
    p, q = a + (b - a) * low, a + (b - a) * high
    return [line_row(p, q)] if abs(q - p) > 1e-7 else []


def _far_enough(parts: Pieces, contour: Pieces, distance: float) -> npt.NDArray[np.bool_]:
    """Which parts keep the distance from the whole contour, at three places each."""
    import shapely  # noqa: PLC0415

    lines = [line_string(z) for z in flatten(contour, FINE)]
    tree = shapely.STRtree(lines)
    probes = sample(parts, np.array([0.2, 0.5, 0.8]))
    points = shapely.points(probes.real.ravel(), probes.imag.ravel())
    (which, _), found = tree.query_nearest(points, return_distance=True, all_matches=False)
    nearest = np.full(points.shape, np.inf)
    nearest[which] = found
    far: npt.NDArray[np.bool_] = np.all(nearest.reshape(-1, 3) >= distance - NEAR, axis=1)
    return far


def _directed(paths: Paths, contour: Pieces, distance: float) -> Paths:
    """The paths run so that the contour lies on the side it was moved from."""
    import shapely  # noqa: PLC0415

    if not len(paths):
        return paths
    whole = shapely.MultiLineString([line_string(z) for z in flatten(contour, FINE)])
    wrong = []
    for i in range(len(paths)):
        path = paths.path(i)
        row: Indices = np.array([int(np.argmax(lengths(path)))])
        middle = sample(path.take(row), np.array([0.499, 0.5, 0.501]))[0]
        tangent = (middle[2] - middle[0]) / abs(middle[2] - middle[0])
        foot, mirror = middle[1] - 1j * tangent * distance, middle[1] + 1j * tangent * distance
        off = [whole.distance(shapely.Point(z.real, z.imag)) for z in (foot, mirror)]
        wrong.append(off[1] < off[0])
    return reversed_paths(paths, np.array(wrong, bool))
