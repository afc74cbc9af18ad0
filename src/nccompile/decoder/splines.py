"""Runs of G5 blocks as cardinal splines, one piece late (SoftMotion §3.2.6).

P0 --G5--> P1 --G5--> P2 --G5--> P3 --G1-->
the tangent at P1 is known when P2 is read, that at P3 when the line after it is: so one piece is open
at any time, and a run of any length needs the memory of one piece.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, sqrt
from typing import TypeAlias

from nccompile.decoder.core import Core
from nccompile.decoder.switches import place_switches
from nccompile.decoder.words import Statement
from nccompile.geometry import Curve, cardinal_spline
from nccompile.toolpath.columns import Kind

__all__ = ["SplineRun"]

Point: TypeAlias = tuple[float, float]


@dataclass(slots=True)
class _Piece:
    """The open piece: its row, the point before it in the run, its ends, the tangent it starts with."""

    row: int
    statement: Statement
    before: Point | None
    begin: Point
    end: Point
    tangent: Point | None
    dz: float


class SplineRun:
    """The run of spline points that is being read, if any."""

    def __init__(self, core: Core) -> None:
        self._core = core
        self._open: _Piece | None = None

    @property
    def is_open(self) -> bool:
        """Whether the last piece waits for what follows it."""
        return self._open is not None

    def point(self, statement: Statement, target: list[float], dz: float) -> int:
        """Adds the piece to a new point; returns its row.

        dz: travel of Z that counts as path length [mm].
        """
        modal = self._core.modal
        begin, end = (modal.position[0], modal.position[1]), (target[0], target[1])
        before, tangent = None, None
        if self._open is not None:
            before = self._open.begin
            self._shape(end, None)
        else:
            tangent = _unit(modal.leaving)
        row = self._core.add(Kind.POLYNOMIAL, target, 0.0, statement.line)
        self._core.path.unshaped = row
        self._open = _Piece(row, statement, before, begin, end, tangent, dz)
        return row

    def close(self, direction: Point | None) -> None:
        """Ends the run: the path goes on in this direction (any length), or None if that is free."""
        if self._open is not None:
            self._core.modal.leaving = self._shape(None, _unit(direction))
            self._open = None

    def _shape(self, following: Point | None, tangent: Point | None) -> Curve:
        """Gives the open piece its curve, now that what follows it is known."""
        piece = self._open
        assert piece is not None
        points = [piece.begin, piece.end] if piece.before is None else [piece.before, piece.begin, piece.end]
        at = len(points) - 2
        if following is not None:
            points.append(following)
        curve = cardinal_spline(points, piece.tangent, tangent)[at]
        length = curve.length
        if piece.dz != 0.0:
            length = sqrt(length * length + piece.dz * piece.dz)
        self._core.path.bend(piece.row, curve, length)
        place_switches(self._core, piece.statement, piece.row, length)
        return curve


def _unit(direction: Curve | Point | None) -> Point | None:
    if direction is None:
        return None
    x, y = direction.end_tangent if isinstance(direction, Curve) else direction
    size = hypot(x, y)
    return (x / size, y / size) if size > 0.0 else None
