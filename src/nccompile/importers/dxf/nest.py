"""Which contour lies inside which: the containment tree of the closed paths, and where the open ones are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from nccompile.importers.dxf.grid import Indices
from nccompile.importers.dxf.join import Paths
from nccompile.importers.dxf.pieces import Complexes, flatten

__all__ = ["Nesting", "nest", "outlines"]

FINENESS = 0.02
"""Chord height [mm] of the polygons that are compared."""


@dataclass(frozen=True)
class Nesting:
    """For each of n paths: parent i8 (n,), the path that must come after it, -1 if none: the smallest closed path
    around it, or where contours cross one of those around what is in it; depth i8 (n,), how
    many are around it; area f8 (n,) [mm²], positive for counter-clockwise contours, 0 for open paths.
    """

    parent: Indices
    depth: Indices
    area: npt.NDArray[np.float64]

    @classmethod
    def flat(cls, count: int) -> Nesting:
        """No path inside another one."""
        return cls(np.full(count, -1), np.zeros(count, np.int64), np.zeros(count))


def outlines(paths: Paths, fineness: float = FINENESS) -> list[Complexes]:
    """Every path as a polyline, a closed one with its first point again at the end."""
    flat = flatten(paths.pieces, fineness)
    lines = []
    for i in range(len(paths)):
        parts = flat[paths.first[i] : paths.first[i + 1]]
        lines.append(np.concatenate([parts[0][:1], *(part[1:] for part in parts)]))
    return lines


def nest(paths: Paths) -> Nesting:
    """The containment tree.

    A path is inside a contour if most of five points along it are; so touching at a vertex does not matter.
    Contours that cross each other are not inside each other, or in each other's order.
    """
    import shapely  # noqa: PLC0415

    n = len(paths)
    parent, depth, area = np.full(n, -1), np.zeros(n, np.int64), np.zeros(n)
    lines = outlines(paths)
    rings = [i for i in range(n) if paths.closed[i] and len(lines[i]) > 3]
    if not rings:
        return Nesting(parent, depth, area)
    area[rings] = [_signed_area(lines[i]) for i in rings]
    low = np.array([[z.real.min(), z.imag.min()] for z in lines])
    high = np.array([[z.real.max(), z.imag.max()] for z in lines])
    boxes = shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1])
    ring = np.array(rings)
    inside, outside = shapely.STRtree(boxes[ring]).query(boxes, predicate="covered_by")
    size = np.abs(area)
    pairs = (ring[outside] != inside) & (size[ring[outside]] > size[inside])
    inside, outside = inside[pairs], ring[outside[pairs]]
    if not len(inside):
        return Nesting(parent, depth, area)
    within, probe = np.unique(inside, return_inverse=True)
    around, polygon = np.unique(outside, return_inverse=True)
    points = np.array([_spread(lines[i]) for i in within.tolist()])[probe]
    shapes = (np.column_stack([lines[i].real, lines[i].imag]) for i in around.tolist())
    polygons = np.array([shapely.Polygon(shape) for shape in shapes])
    shapely.prepare(polygons)
    votes = shapely.contains_xy(polygons[polygon][:, None], points.real, points.imag).sum(axis=1)
    held = votes >= 3
    inside, holder = inside[held], outside[held]
    np.add.at(depth, inside, 1)
    return Nesting(_followers(n, inside, holder, size), depth, area)


def _followers(n: int, inside: Indices, holder: Indices, size: npt.NDArray[np.float64]) -> Indices:
    """Shape (n,): one path that must come after each, such that all that are around it come after it.

    That is the smallest one around it.  Where contours cross, what is inside two of them has two that need not
    follow each other; then the larger one is made to follow the smaller.
    """
    parent = np.full(n, -1)
    after: dict[int, set[int]] = {}
    for i, j in zip(inside.tolist(), holder.tolist(), strict=True):
        after.setdefault(i, set()).add(j)
    ranked = np.lexsort((np.arange(n), size)).tolist()
    rank = {i: place for place, i in enumerate(ranked)}
    for i in ranked:
        later = after.pop(i, None)
        if later:
            parent[i] = min(later, key=rank.__getitem__)
            later.discard(int(parent[i]))
            if later:
                after.setdefault(int(parent[i]), set()).update(later)
    return parent


def _spread(line: Complexes) -> Complexes:
    """Five points along a polyline; the same wherever a closed one begins and whichever way it goes."""
    if line[0] == line[-1]:
        lowest = int(np.lexsort((line.imag[:-1], line.real[:-1]))[0])
        line = np.concatenate([line[lowest:-1], line[: lowest + 1]])
    length = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(line)))])
    at = length[-1] * np.array([0.1, 0.3, 0.5, 0.7, 0.9])
    points: Complexes = np.interp(at, length, line.real) + 1j * np.interp(at, length, line.imag)
    return points


def _signed_area(line: Complexes) -> float:
    """Area of a closed polyline [mm²], counter-clockwise positive; about its first point, to keep its digits."""
    z = line - line[0]
    return float(0.5 * np.sum(z.real[:-1] * z.imag[1:] - z.real[1:] * z.imag[:-1]))
