"""Lead-in and lead-out: how the tool comes to a contour without marking it.

        arc  . - ,                     line      \\
           .       \\                               \\  angle
    -------*--------+---->  contour    -----------*------>

A lead lies on the scrap side and must stay clear of every contour.  If it does not it is halved, a few times;
what then still does not fit is left out, and said so.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, pi, radians, sin
from typing import Any

import numpy as np
import numpy.typing as npt

from nccompile.importers.dxf.job import Lead
from nccompile.importers.dxf.join import Paths
from nccompile.importers.dxf.pieces import Complexes, Pieces, arc_row, flatten, line_row, reverse

__all__ = ["FINE", "Obstacles", "Room", "lead_in", "lead_out", "line_string"]

SHRINKS = 4
"""A lead is halved this often before it is given up."""

FINE = 1e-4
"""Chord height [mm] of what is compared."""

OWN = 0.05
"""The part of a lead next to the contour in which touching it is meant."""


PROBES = 24
"""Points of a lead whose distances are measured."""

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Room:
    """What a lead must keep clear of: all contours, by `beside` (how far the tool runs from its contour) and
    `clearance` more, and its own path, a polyline.  Lengths in mm.
    """

    obstacles: Obstacles
    own: Complexes
    beside: float
    clearance: float


class Obstacles:
    """All contours of a drawing, searchable by distance; nothing is built before the first lead asks."""

    def __init__(self, paths: Paths) -> None:
        self._paths = paths

    @cached_property
    def _tree(self) -> Any:
        import shapely  # noqa: PLC0415

        return shapely.STRtree([line_string(z) for z in flatten(self._paths.pieces, FINE)])

    def are_clear(self, points: Complexes, distances: Floats) -> bool:
        """Whether every point keeps its distance [mm] from every contour, and their polyline crosses none."""
        import shapely  # noqa: PLC0415

        if len(self._tree.query(line_string(points), predicate="intersects")):
            return False
        places = shapely.points(points.real, points.imag)
        _, found = self._tree.query_nearest(places, return_distance=True, all_matches=False)
        return bool(np.all(found >= distances))


def line_string(points: Complexes) -> Any:
    """A shapely line along complex points."""
    import shapely  # noqa: PLC0415

    return shapely.LineString(np.column_stack([points.real, points.imag]))


def lead_in(at: complex, tangent: complex, left: bool, lead: Lead, room: Room) -> Pieces | None:
    """The pieces that lead to `at`, arriving in the direction `tangent` from the left or right side of it.

    Returns: None if no length of the lead is clear.
    """
    for halving in range(SHRINKS + 1):
        made = _shape(at, tangent, left, lead, lead.length * 0.5**halving)
        if _fits(made, room):
            return made
    return None


def lead_out(at: complex, tangent: complex, left: bool, lead: Lead, room: Room) -> Pieces | None:
    """The pieces that lead away from `at`: a lead-in seen backwards."""
    made = lead_in(at, -tangent, not left, lead, room)
    return None if made is None else reverse(made)


def _shape(at: complex, tangent: complex, left: bool, lead: Lead, size: float) -> Pieces:
    side = 1.0 if left else -1.0
    if lead.kind == "line":
        away = -cos(radians(lead.angle)) + 1j * side * sin(radians(lead.angle))
        return Pieces.from_rows([line_row(at + size * away * tangent, at)])
    centre = at + 1j * side * size * tangent
    end_angle = float(np.angle(at - centre))
    made = Pieces.from_rows([arc_row(centre, size, end_angle - side * pi / 2, side * pi / 2)])
    return made.replace(end=np.array([at]))


def _fits(made: Pieces, room: Room) -> bool:
    """Whether a lead leaves its own path and keeps its distance from all contours.

    Next to the contour the lead is as near as the tool is meant to be.  At the length s from there it must be
    farther by s² / 4 L (a quarter arc is by three times that), up to the clearance or a twentieth of its length L.
    """
    points = np.concatenate(flatten(made, FINE))
    length = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(points)))])
    total = float(length[-1])
    away = total * np.linspace(1.0, OWN, PROBES)
    probes = np.interp(total - away, length, points.real) + 1j * np.interp(total - away, length, points.imag)
    if line_string(probes).intersects(line_string(room.own)):
        return False
    more = np.minimum(away**2 / (4.0 * total), room.clearance or 0.05 * total)
    return room.obstacles.are_clear(probes, room.beside + more - 2.0 * FINE * (room.beside > 0.0))
