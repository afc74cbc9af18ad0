"""Doubles and overlaps: what is drawn twice is machined once.

    doubles    an entity that follows another one all along, whatever its direction      -> the first stays
    overlaps   loose lines on one line, loose arcs on one circle, sharing a stretch      -> one line or arc

Loose means an entity of one piece.  Polylines and splines stay whole: a contour must not come apart because a
loose line runs along it; there the loose line gives way.  Where two polylines share a stretch both stay, and
the finding says so.  Only pieces of the same group (layer or operation) are compared.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from nccompile.importers.dxf.grid import Indices, cluster, components
from nccompile.importers.dxf.overlaps import arc_overlaps, line_overlaps, merged_arcs, merged_lines
from nccompile.importers.dxf.pieces import PieceKind, Pieces, lengths, sample

__all__ = ["Place", "remove_doubles"]


class Place(NamedTuple):
    """Something found in a drawing: NC code, where, how large [mm], on which layer."""

    code: str
    at: complex
    size: float
    layer: int


def remove_doubles(pieces: Pieces, group: Indices, tolerance: float) -> tuple[Pieces, Indices, list[Place]]:
    """The drawing without doubles and overlaps, its groups, and the places where something was removed.

    Args: tolerance: distance [mm] within which two curves are the same.
    """
    keep, places = _whole_entities(pieces, group, tolerance)
    pieces, group = pieces.take(keep), group[keep]
    loose = _is_loose(pieces)
    for find, merge in ((line_overlaps, merged_lines), (arc_overlaps, merged_arcs)):
        i, j = find(pieces, group, tolerance)
        both_whole = ~loose[i] & ~loose[j]
        different = both_whole & (pieces.entity[i] != pieces.entity[j])
        places += [
            Place(
                "NC610",
                complex(pieces.start[a]),
                float(np.abs(pieces.end[a] - pieces.start[a])),
                int(pieces.layer[a]),
            )
            for a in np.unique(i[different])
        ]
        i, j = i[~both_whole], j[~both_whole]
        pieces, group, removed = _merge(pieces, group, loose, components(len(pieces), i, j), merge, tolerance)
        places += removed
        loose = _is_loose(pieces)
    return pieces, group, places


def _is_loose(pieces: Pieces) -> npt.NDArray[np.bool_]:
    """Shape (n,): pieces that are an entity of their own."""
    _, inverse, counts = np.unique(pieces.entity, return_inverse=True, return_counts=True)
    loose: npt.NDArray[np.bool_] = counts[inverse] == 1
    return loose


def _whole_entities(
    pieces: Pieces, group: Indices, tolerance: float
) -> tuple[npt.NDArray[np.bool_], list[Place]]:
    """Which pieces stay when every entity that doubles an earlier one goes.

    Two pieces are the same if their ends, quarter points and middles are, from either side.  An entity is the
    same as another one if their pieces are, in any order.  Pieces of a few tolerances are never compared.
    """
    keep = np.ones(len(pieces), bool)
    size = lengths(pieces)
    points = sample(pieces, np.array([0.0, 0.25, 0.5, 0.75, 1.0]))
    point_kind = pieces.kind == PieceKind.POINT
    large = np.flatnonzero((size > 8 * tolerance) | point_kind)
    if len(large) < 2:
        return keep, []
    label = cluster(points[large].ravel(), tolerance).reshape(-1, 5)
    outer, inner = np.sort(label[:, [0, 4]], axis=1), np.sort(label[:, [1, 3]], axis=1)
    rows = np.column_stack([group[large], point_kind[large], outer, inner, label[:, 2]])
    _, same = np.unique(rows, axis=0, return_inverse=True)
    number = np.full(len(pieces), -1)
    number[large] = same.ravel()
    first: dict[tuple[int, ...], int] = {}
    places = []
    order = np.argsort(pieces.entity, kind="stable")
    starts = np.flatnonzero(np.r_[True, np.diff(pieces.entity[order]) != 0])
    for rows_of_one in np.split(order, starts[1:]):
        key = tuple(sorted(number[rows_of_one].tolist()))
        if key[0] < 0:
            continue
        if key in first:
            keep[rows_of_one] = False
            a = rows_of_one[0]
            places.append(
                Place("NC609", complex(pieces.start[a]), float(size[rows_of_one].sum()), int(pieces.layer[a]))
            )
        first.setdefault(key, int(rows_of_one[0]))
    return keep, places


def _merge(
    pieces: Pieces,
    group: Indices,
    loose: npt.NDArray[np.bool_],
    label: Indices,
    merge: Callable[[Pieces, npt.NDArray[np.bool_], float], Pieces],
    tolerance: float,
) -> tuple[Pieces, Indices, list[Place]]:
    """Every component of overlapping pieces replaced by what remains of it."""
    sizes = np.bincount(label, minlength=len(pieces))
    touched = np.flatnonzero(sizes[label] > 1)
    if not len(touched):
        return pieces, group, []
    keep = np.ones(len(pieces), bool)
    new, new_groups, places = [pieces], [group], []
    order = touched[np.argsort(label[touched], kind="stable")]
    borders = np.flatnonzero(np.diff(label[order])) + 1
    for rows in np.split(order, borders):
        part = pieces.take(rows)
        rest = merge(part, loose[rows], tolerance)
        before = float(lengths(part.take(loose[rows])).sum())
        gone = before - float(lengths(rest).sum())
        keep[rows[loose[rows]]] = False
        new.append(rest)
        new_groups.append(np.full(len(rest), group[rows[0]]))
        places.append(Place("NC609", complex(part.start[0]), gone, int(part.layer[0])))
    mask = np.concatenate([keep, np.ones(sum(len(p) for p in new[1:]), bool)])
    everything = Pieces.join(new)
    fresh = everything.entity.copy()
    fresh[len(pieces) :] = int(pieces.entity.max()) + 1 + np.arange(len(fresh) - len(pieces))
    return everything.replace(entity=fresh).take(mask), np.concatenate(new_groups)[mask], places
