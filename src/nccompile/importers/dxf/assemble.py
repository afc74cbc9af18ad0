"""Moves collected into toolpath chunks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from nccompile.importers.dxf.pieces import PieceKind, Pieces
from nccompile.toolpath import CHUNK, CURVE_PARAMETERS, Curves, EventKind, Events, Kind, Mark, Plane, Toolpath
from nccompile.toolpath.lengths import path_lengths

__all__ = ["Moves"]

Floats = npt.NDArray[np.float64]

_KIND = np.array([Kind.LINE, Kind.ARC, Kind.ELLIPSE, Kind.POLYNOMIAL, Kind.POSITIONING], np.uint8)
"""The segment kind of every piece kind; a point is a positioning."""


@dataclass
class Moves:
    """A toolpath under construction; position and feeds in mm and mm/s, X Y Z.

    Blocks of segments are kept as columns, so that a drawing of a million lines costs arrays, not objects.
    """

    start: tuple[float, float, float] = (0.0, 0.0, 0.0)
    accel: float = 0.0
    decel: float = 0.0
    tool: int | None = None
    notes: dict[int, list[str]] = field(default_factory=dict)
    rows: int = 0
    _kind: list[npt.NDArray[np.uint8]] = field(default_factory=list)
    _target: list[Floats] = field(default_factory=list)
    _curve: list[Floats] = field(default_factory=list)
    _feed: list[Floats] = field(default_factory=list)
    _mark: dict[int, int] = field(default_factory=dict)
    _radius: list[tuple[int, float]] = field(default_factory=list)
    _events: list[tuple[int, int, int, float, float, float, int]] = field(default_factory=list)
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def rapid(self, z: complex, height: float) -> None:
        """A positioning to x + iy and a height; nothing if it is where it stands."""
        self._straight(Kind.POSITIONING, z, height, 0.0)

    def line(self, z: complex, height: float, feed: float) -> None:
        """A feed move in a straight line; nothing if it is where it stands."""
        self._straight(Kind.LINE, z, height, feed)

    def _straight(self, kind: Kind, z: complex, height: float, feed: float) -> None:
        target = (z.real, z.imag, height)
        if target != self.at:
            self._add(np.array([kind], np.uint8), np.array([target]), np.zeros((1, CURVE_PARAMETERS)), feed)

    @property
    def ends_in_contact(self) -> bool:
        """Whether the last move is a feed move."""
        for kind in reversed(self._kind):
            moves = kind[(kind != Kind.M_FUNCTION) & (kind != Kind.DWELL)]
            if len(moves):
                return bool(moves[-1] != Kind.POSITIONING)
        return False

    def follow(self, pieces: Pieces, heights: Floats | float, feed: float) -> None:
        """The pieces one after the other, ending at the heights Z (one for all or one each)."""
        target = np.column_stack([pieces.end.real, pieces.end.imag, np.broadcast_to(heights, len(pieces))])
        self._add(_KIND[pieces.kind], target, curve_rows(pieces), feed)

    def bulk(self, pieces: Pieces, height: float, feed: float, rapids: npt.NDArray[np.bool_]) -> None:
        """Pieces at one height; those of the mask are positionings to their end."""
        kind = np.where(rapids, Kind.POSITIONING, _KIND[pieces.kind]).astype(np.uint8)
        target = np.column_stack([pieces.end.real, pieces.end.imag, np.full(len(pieces), height)])
        self._add(kind, target, curve_rows(pieces), feed)

    def wait(self, kind: Kind, number: int, k: float) -> None:
        """An M function (number, parameter K) or a dwell (k seconds) at the present place."""
        event = EventKind.DWELL if kind is Kind.DWELL else EventKind.M_FUNCTION
        self._events.append((self.rows, event, number, 0.0, k, 0.0, -1))
        self._add(np.array([kind], np.uint8), np.array([self.at]), np.zeros((1, CURVE_PARAMETERS)), 0.0)

    def switch(self, row: int, number: int, position: float) -> None:
        """A switch point on segment `row` at 0..1 of it; number < 0 switches off."""
        self._events.append((row, EventKind.SWITCH, number, position, 0.0, 0.0, -1))

    def mark(self, row: int, bits: Mark) -> None:
        """Adds mark bits to a segment."""
        self._mark[row] = self._mark.get(row, 0) | bits

    def radius(self, value: float) -> None:
        """The tool radius D [mm] from the next segment on."""
        self._radius.append((self.rows, value))

    def note(self, text: str) -> None:
        """A comment before the next segment."""
        self.notes.setdefault(self.rows, []).append(text)

    def _add(self, kind: npt.NDArray[np.uint8], target: Floats, curve: Floats, feed: float) -> None:
        if not len(kind):
            return
        self._kind.append(kind)
        self._target.append(target)
        self._curve.append(curve)
        self._feed.append(np.full(len(kind), feed))
        self.rows += len(kind)
        self.at = (float(target[-1, 0]), float(target[-1, 1]), float(target[-1, 2]))

    def chunks(self, size: int = CHUNK) -> Iterator[Toolpath]:
        """The toolpath; one empty chunk if there is no move."""
        whole = self._whole()
        for begin in range(0, max(1, len(whole)), size):
            chunk = whole.rows(begin, begin + size)
            yield chunk.replace(length=path_lengths(chunk))

    def _whole(self) -> Toolpath:
        empty = Toolpath.empty(start=np.array(self.start))
        if not self.rows:
            return empty
        n = self.rows
        kind = np.concatenate(self._kind)
        table = np.concatenate(self._curve)
        curved = np.isin(kind, (Kind.ARC, Kind.ELLIPSE, Kind.POLYNOMIAL))
        curve = np.full(n, -1, np.int32)
        curve[curved] = np.arange(int(curved.sum()), dtype=np.int32)
        mark = np.zeros(n, np.uint16)
        for row, bits in self._mark.items():
            mark[row] |= bits
        radius = np.zeros(n)
        for row, value in self._radius:
            radius[row:] = value
        feed = np.concatenate(self._feed)
        last = np.maximum.accumulate(np.where(feed > 0, np.arange(n), 0))
        return empty.replace(
            kind=kind,
            target=np.concatenate(self._target),
            curve=curve,
            length=np.zeros(n),
            feed=feed[last],
            accel=np.full(n, self.accel),
            decel=np.full(n, self.decel),
            mark=mark,
            radius=radius,
            profile=np.zeros(n, np.uint16),
            line=np.zeros(n, np.int32),
            curves=Curves(np.full(int(curved.sum()), Plane.XY, np.uint8), table[curved]),
            events=Events.from_rows(self._events),
        )


def curve_rows(pieces: Pieces) -> Floats:
    """Shape (n, 12): curve table rows of arcs, ellipses and cubics (as polynomials), zeros for the rest."""
    rows = np.zeros((len(pieces), CURVE_PARAMETERS))
    arc, ellipse = pieces.kind == PieceKind.ARC, pieces.kind == PieceKind.ELLIPSE
    rows[arc, :5] = pieces.p[arc, :5]
    rows[ellipse, :7] = pieces.p[ellipse, :7]
    cubic = pieces.kind == PieceKind.CUBIC
    p = pieces.p[cubic]
    a, b = pieces.start[cubic], pieces.end[cubic]
    c1, c2 = p[:, 0] + 1j * p[:, 1], p[:, 2] + 1j * p[:, 3]
    terms = (a, 3 * (c1 - a), 3 * (a - 2 * c1 + c2), b - a + 3 * (c1 - c2))
    for power, term in enumerate(terms):
        rows[cubic, power], rows[cubic, 4 + power] = term.real, term.imag
    return rows
