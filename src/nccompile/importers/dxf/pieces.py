"""Pieces: the lines, arcs, ellipses and cubics of a drawing as numpy columns.

A piece is what a toolpath segment becomes later; it knows both of its ends, since a drawing has no order.

    LINE      no parameters
    ARC       centre x, centre y, radius, start angle, sweep                      [mm, rad; + is ccw]
    ELLIPSE   centre x, centre y, main half-axis, sub half-axis, direction, start, sweep   [mm, rad]
    CUBIC     inner control points x1, y1, x2, y2 of the Bezier form               [mm]
    POINT     start = end: a place to drill
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from enum import IntEnum
from math import atan, atan2, cos, pi, sin
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

__all__ = [
    "PARAMETERS",
    "Complexes",
    "PieceKind",
    "Pieces",
    "Row",
    "arc_row",
    "bulge_row",
    "cubic_row",
    "ellipse_row",
    "end_tangents",
    "flatten",
    "lengths",
    "line_row",
    "reverse",
    "sample",
    "similar",
    "split",
    "transform",
]

Complexes: TypeAlias = npt.NDArray[np.complex128]
Floats: TypeAlias = npt.NDArray[np.float64]
Ints: TypeAlias = npt.NDArray[np.int32]
Row: TypeAlias = tuple[float, ...]
"""kind, start x, start y, end x, end y and the seven parameters."""

PARAMETERS = 7
ROUND = 1e-9
"""Half-axes that differ by less than this, relative, make a circle: scale factors of CAD carry rounding."""


class PieceKind(IntEnum):
    """What a piece is."""

    LINE = 0
    ARC = 1
    ELLIPSE = 2
    CUBIC = 3
    POINT = 4


@dataclass(frozen=True)
class Pieces:
    """Columns of n pieces.

    kind: u1 (n,) `PieceKind`;  start, end: c16 (n,) [mm];  p: f8 (n, 7) parameters, unused ones 0;
    layer: i4 (n,) index of the layer's name;  color: i4 (n,) AutoCAD colour index;
    entity: i4 (n,) number of the entity in the drawing (pieces of one entity follow each other).
    """

    kind: npt.NDArray[np.uint8]
    start: Complexes
    end: Complexes
    p: Floats
    layer: Ints
    color: Ints
    entity: Ints

    def __len__(self) -> int:
        return len(self.kind)

    @classmethod
    def from_rows(
        cls, rows: Sequence[Row] | Floats, layer: Any = 0, color: Any = 7, entity: Any = 0
    ) -> Pieces:
        """Columns from `Row` tuples; layer, colour and entity number one for all or one each."""
        table = np.asarray(rows, float).reshape(-1, 5 + PARAMETERS)
        n = len(table)
        return cls(
            kind=table[:, 0].astype(np.uint8),
            start=table[:, 1] + 1j * table[:, 2],
            end=table[:, 3] + 1j * table[:, 4],
            p=table[:, 5:].copy(),
            layer=np.broadcast_to(np.asarray(layer, np.int32), n).copy(),
            color=np.broadcast_to(np.asarray(color, np.int32), n).copy(),
            entity=np.broadcast_to(np.asarray(entity, np.int32), n).copy(),
        )

    @classmethod
    def join(cls, parts: Sequence[Pieces]) -> Pieces:
        """One table from several."""
        if not parts:
            return cls.from_rows([])
        return cls(*(np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(cls)))

    def take(self, rows: Any) -> Pieces:
        """The pieces of an index, mask or slice."""
        return Pieces(*(getattr(self, f.name)[rows] for f in fields(self)))

    def replace(self, **columns: Any) -> Pieces:
        """A copy with some columns exchanged."""
        return replace(self, **columns)

    @property
    def is_full(self) -> npt.NDArray[np.bool_]:
        """Shape (n,): circles and ellipses that go all the way round."""
        sweep = np.where(self.kind == PieceKind.ARC, self.p[:, 4], self.p[:, 6])
        curved = (self.kind == PieceKind.ARC) | (self.kind == PieceKind.ELLIPSE)
        full: npt.NDArray[np.bool_] = curved & (np.abs(sweep) >= 2 * pi - 1e-12)
        return full


def line_row(a: complex, b: complex) -> Row:
    """A line."""
    return (PieceKind.LINE, a.real, a.imag, b.real, b.imag, 0, 0, 0, 0, 0, 0, 0)


def cubic_row(a: complex, c1: complex, c2: complex, b: complex) -> Row:
    """A cubic by its four control points."""
    return (PieceKind.CUBIC, a.real, a.imag, b.real, b.imag, c1.real, c1.imag, c2.real, c2.imag, 0, 0, 0)


def arc_row(centre: complex, radius: float, start: float, sweep: float) -> Row:
    """An arc; angles [rad], a positive sweep is counter-clockwise."""
    a = centre + radius * complex(cos(start), sin(start))
    b = a if abs(sweep) >= 2 * pi else centre + radius * complex(cos(start + sweep), sin(start + sweep))
    return (
        PieceKind.ARC,
        a.real,
        a.imag,
        b.real,
        b.imag,
        centre.real,
        centre.imag,
        radius,
        start,
        sweep,
        0,
        0,
    )


def ellipse_row(centre: complex, u: complex, v: complex, start: float, sweep: float) -> Row:
    """The curve centre + u cos t + v sin t for t from `start` to `start + sweep`, in its principal axes.

    u and v are any two conjugate half-diameters: the image of an ellipse under an affine map is given by the
    images of its half-axes.  With t = t0 + s and tan 2 t0 = 2 u.v / (|u|² - |v|²) the two become perpendicular.
    A circle comes back as an arc, a flat ellipse (sub half-axis 0) as one all the same.
    """
    dot = u.real * v.real + u.imag * v.imag
    turn = 0.5 * atan2(2.0 * dot, abs(u) ** 2 - abs(v) ** 2)
    main = u * cos(turn) + v * sin(turn)
    sub = v * cos(turn) - u * sin(turn)
    begin = start - turn
    if abs(sub) > abs(main):
        main, sub, begin = sub, -main, begin - pi / 2
    if main.real * sub.imag - main.imag * sub.real < 0.0:
        begin, sweep = -begin, -sweep
    big, small, direction = abs(main), abs(sub), atan2(main.imag, main.real)
    if big - small <= ROUND * big:
        return arc_row(centre, 0.5 * (big + small), begin + direction, sweep)
    axis = complex(cos(direction), sin(direction))

    def at(t: float) -> complex:
        return centre + axis * complex(big * cos(t), small * sin(t))

    a = at(begin)
    b = a if abs(sweep) >= 2 * pi else at(begin + sweep)
    return (
        PieceKind.ELLIPSE, a.real, a.imag, b.real, b.imag,
        centre.real, centre.imag, big, small, direction, begin, sweep,
    )  # fmt: skip


def bulge_row(a: complex, b: complex, bulge: float) -> Row:
    """A polyline's segment: bulge = tan(sweep / 4), 0 is straight.

    The centre lies on the chord's perpendicular bisector, (1 - bulge²) / (4 bulge) chords left of its middle.
    """
    if abs(bulge) < 1e-12 or a == b:
        return line_row(a, b)
    centre = 0.5 * (a + b) + 1j * (b - a) * (1.0 - bulge * bulge) / (4.0 * bulge)
    sweep = 4.0 * atan(bulge)
    radial = a - centre
    return (
        PieceKind.ARC, a.real, a.imag, b.real, b.imag,
        centre.real, centre.imag, abs(radial), atan2(radial.imag, radial.real), sweep, 0, 0,
    )  # fmt: skip


def reverse(pieces: Pieces, mask: npt.NDArray[np.bool_] | None = None) -> Pieces:
    """The pieces of the mask (None: all) run from their end to their start; the rest as they are."""
    on = np.ones(len(pieces), bool) if mask is None else mask
    p = pieces.p.copy()
    arc = on & (pieces.kind == PieceKind.ARC)
    p[arc, 3] += p[arc, 4]
    p[arc, 4] *= -1.0
    ellipse = on & (pieces.kind == PieceKind.ELLIPSE)
    p[ellipse, 5] += p[ellipse, 6]
    p[ellipse, 6] *= -1.0
    cubic = on & (pieces.kind == PieceKind.CUBIC)
    p[cubic, 0:4] = p[cubic][:, [2, 3, 0, 1]]
    return pieces.replace(
        start=np.where(on, pieces.end, pieces.start), end=np.where(on, pieces.start, pieces.end), p=p
    )


def similar(pieces: Pieces, start: Complexes, end: Complexes) -> Pieces:
    """The pieces turned, scaled and moved so that they run from `start` to `end`.

    A similarity z -> m z + k keeps the kind and the sweep of everything.  Pieces that start where they end
    (full circles) are only moved.
    """
    chord = pieces.end - pieces.start
    flat = np.abs(chord) > 0.0
    m = np.where(flat, (end - start) / np.where(flat, chord, 1.0), 1.0)
    turn, scale = np.angle(m), np.abs(m)
    p = pieces.p.copy()
    curved = (pieces.kind == PieceKind.ARC) | (pieces.kind == PieceKind.ELLIPSE)
    centre = start + m * (p[:, 0] + 1j * p[:, 1] - pieces.start)
    p[curved, 0], p[curved, 1] = centre.real[curved], centre.imag[curved]
    arc, ellipse = pieces.kind == PieceKind.ARC, pieces.kind == PieceKind.ELLIPSE
    p[arc, 2] *= scale[arc]
    p[arc, 3] += turn[arc]
    p[ellipse, 2:4] *= scale[ellipse, None]
    p[ellipse, 4] += turn[ellipse]
    cubic = pieces.kind == PieceKind.CUBIC
    for at in (0, 2):
        inner = start + m * (p[:, at] + 1j * p[:, at + 1] - pieces.start)
        p[cubic, at], p[cubic, at + 1] = inner.real[cubic], inner.imag[cubic]
    return pieces.replace(start=start, end=np.where(flat, end, start), p=p)


def transform(pieces: Pieces, u: complex, v: complex, offset: complex) -> Pieces:
    """The pieces under the affine map x + iy -> u x + v y + offset.

    Lines, points and cubics by their control points; arcs stay arcs where the map keeps circles (any rotation,
    mirror and uniform scale), else they become ellipses.
    """

    def move(z: Complexes) -> Complexes:
        moved: Complexes = u * z.real + v * z.imag + offset
        return moved

    p = pieces.p.copy()
    cubic = pieces.kind == PieceKind.CUBIC
    for at in (0, 2):
        inner = move(p[:, at] + 1j * p[:, at + 1])
        p[cubic, at], p[cubic, at + 1] = inner.real[cubic], inner.imag[cubic]
    start, end, kind = move(pieces.start), move(pieces.end), pieces.kind.copy()
    curved = (kind == PieceKind.ARC) | (kind == PieceKind.ELLIPSE)
    centre = move(p[:, 0] + 1j * p[:, 1])
    if abs(abs(u) - abs(v)) + abs((u * v.conjugate()).real) / max(abs(u), 1e-300) <= ROUND * abs(u):
        p[curved, 0], p[curved, 1] = centre.real[curved], centre.imag[curved]
        _turn(kind, p, u, -1.0 if (u.conjugate() * v).imag < 0.0 else 1.0)
        return pieces.replace(start=start, end=end, p=p)
    for i in np.flatnonzero(curved):
        _, main, sub, first, sweep = _conjugate(kind[i], pieces.p[i])
        row = ellipse_row(
            complex(centre[i]), u * main.real + v * main.imag, u * sub.real + v * sub.imag, first, sweep
        )
        kind[i], p[i] = row[0], row[5:]
    return pieces.replace(kind=kind, start=start, end=end, p=p)


def _turn(kind: npt.NDArray[np.uint8], p: Floats, u: complex, hand: float) -> None:
    """Turns and scales the radii and angles of arcs and ellipses by u, in place; hand -1 mirrors them first."""
    turn, scale = atan2(u.imag, u.real), abs(u)
    arc, ellipse = kind == PieceKind.ARC, kind == PieceKind.ELLIPSE
    p[arc, 2] *= scale
    p[arc, 3] = hand * p[arc, 3] + turn
    p[arc, 4] *= hand
    p[ellipse, 2:4] *= scale
    p[ellipse, 4] = hand * p[ellipse, 4] + turn
    p[ellipse, 5:7] *= hand


def _conjugate(kind: int, p: Floats) -> tuple[complex, complex, complex, float, float]:
    """Centre, two half-diameters, start and sweep of an arc or ellipse."""
    centre = complex(p[0], p[1])
    if kind == PieceKind.ARC:
        return centre, complex(p[2]), complex(0.0, p[2]), float(p[3]), float(p[4])
    axis = complex(cos(p[4]), sin(p[4]))
    return centre, p[2] * axis, 1j * p[3] * axis, float(p[5]), float(p[6])


def sample(pieces: Pieces, u: Floats) -> Complexes:
    """Shape (n, m): the points of every piece at the m parameters u in 0..1."""
    t = np.asarray(u, float)[None, :]
    a, b, p = pieces.start[:, None], pieces.end[:, None], pieces.p
    points: Complexes = a + (b - a) * t
    arc = pieces.kind == PieceKind.ARC
    if arc.any():
        q = p[arc]
        angle = q[:, 3:4] + q[:, 4:5] * t
        points[arc] = q[:, 0:1] + 1j * q[:, 1:2] + q[:, 2:3] * np.exp(1j * angle)
    ellipse = pieces.kind == PieceKind.ELLIPSE
    if ellipse.any():
        q = p[ellipse]
        angle = q[:, 5:6] + q[:, 6:7] * t
        local = q[:, 2:3] * np.cos(angle) + 1j * q[:, 3:4] * np.sin(angle)
        points[ellipse] = q[:, 0:1] + 1j * q[:, 1:2] + np.exp(1j * q[:, 4:5]) * local
    cubic = pieces.kind == PieceKind.CUBIC
    if cubic.any():
        q, s = p[cubic], 1.0 - t
        inner = 3 * s * t * (s * (q[:, 0:1] + 1j * q[:, 1:2]) + t * (q[:, 2:3] + 1j * q[:, 3:4]))
        points[cubic] = s**3 * a[cubic] + inner + t**3 * b[cubic]
    return points


def lengths(pieces: Pieces) -> Floats:
    """Shape (n,): arc lengths [mm]; exact for lines and arcs, to about 1e-4 for ellipses and cubics."""
    out = np.abs(pieces.end - pieces.start)
    arc = pieces.kind == PieceKind.ARC
    out[arc] = np.abs(pieces.p[arc, 2] * pieces.p[arc, 4])
    bent = (pieces.kind == PieceKind.ELLIPSE) | (pieces.kind == PieceKind.CUBIC)
    if bent.any():
        points = sample(pieces.take(bent), np.linspace(0.0, 1.0, 65))
        out[bent] = np.abs(np.diff(points, axis=1)).sum(axis=1)
    return out


def end_tangents(pieces: Pieces) -> tuple[Complexes, Complexes]:
    """Shape (n,) each: unit directions of every piece at its start and at its end; 0 for points."""
    a, b, p = pieces.start, pieces.end, pieces.p
    enter, leave = b - a, b - a
    arc, ellipse, cubic = (pieces.kind == k for k in (PieceKind.ARC, PieceKind.ELLIPSE, PieceKind.CUBIC))
    turn = 1j * np.sign(p[:, 4])
    enter = np.where(arc, turn * np.exp(1j * p[:, 3]), enter)
    leave = np.where(arc, turn * np.exp(1j * (p[:, 3] + p[:, 4])), leave)
    axis = np.exp(1j * p[:, 4]) * np.sign(p[:, 6])
    ends = [axis * (1j * p[:, 3] * np.cos(t) - p[:, 2] * np.sin(t)) for t in (p[:, 5], p[:, 5] + p[:, 6])]
    enter, leave = np.where(ellipse, ends[0], enter), np.where(ellipse, ends[1], leave)
    c1, c2 = p[:, 0] + 1j * p[:, 1], p[:, 2] + 1j * p[:, 3]
    enter = np.where(cubic, np.where(c1 != a, c1 - a, np.where(c2 != a, c2 - a, b - a)), enter)
    leave = np.where(cubic, np.where(c2 != b, b - c2, np.where(c1 != b, b - c1, b - a)), leave)
    return enter / np.maximum(np.abs(enter), 1e-300), leave / np.maximum(np.abs(leave), 1e-300)


def flatten(pieces: Pieces, tolerance: float) -> list[Complexes]:
    """One polyline a piece, no farther than about `tolerance` [mm] from it (chord heights)."""
    size = np.abs(pieces.end - pieces.start)
    steps = np.ones(len(pieces), int)
    arc, ellipse = pieces.kind == PieceKind.ARC, pieces.kind == PieceKind.ELLIPSE
    for mask, radius, sweep in ((arc, 2, 4), (ellipse, 2, 6)):
        angle = np.sqrt(8.0 * tolerance / np.maximum(pieces.p[mask, radius], 2 * tolerance))
        steps[mask] = np.ceil(np.abs(pieces.p[mask, sweep]) / angle)
    cubic = pieces.kind == PieceKind.CUBIC
    if cubic.any():
        q = pieces.p[cubic]
        c1, c2 = q[:, 0] + 1j * q[:, 1], q[:, 2] + 1j * q[:, 3]
        a, b = pieces.start[cubic], pieces.end[cubic]
        bend = np.maximum(np.abs(a - 2 * c1 + c2), np.abs(c1 - 2 * c2 + b))
        steps[cubic] = np.ceil(np.sqrt(0.75 * bend / tolerance))
    steps = np.clip(steps, np.where(size > 0, 1, 4), 4096)
    out: list[Complexes] = [np.zeros(0, complex)] * len(pieces)
    for count in np.unique(steps):
        rows = np.flatnonzero(steps == count)
        points = sample(pieces.take(rows), np.linspace(0.0, 1.0, count + 1))
        points[:, 0], points[:, -1] = pieces.start[rows], pieces.end[rows]
        for row, polyline in zip(rows, points, strict=True):
            out[row] = polyline
    return out


def split(pieces: Pieces, row: int, u: float) -> tuple[Pieces, Pieces]:
    """One piece cut at parameter u into two pieces."""
    one = pieces.take([row])
    at = sample(one, np.array([u]))[:, 0]
    first, second = one.p.copy(), one.p.copy()
    kind = int(one.kind[0])
    if kind == PieceKind.CUBIC:
        a, b = one.start[0], one.end[0]
        c1, c2 = complex(one.p[0, 0], one.p[0, 1]), complex(one.p[0, 2], one.p[0, 3])
        ab, bc, cd = a + (c1 - a) * u, c1 + (c2 - c1) * u, c2 + (b - c2) * u
        abc, bcd = ab + (bc - ab) * u, bc + (cd - bc) * u
        first[0, :4] = ab.real, ab.imag, abc.real, abc.imag
        second[0, :4] = bcd.real, bcd.imag, cd.real, cd.imag
    elif kind in {PieceKind.ARC, PieceKind.ELLIPSE}:
        angle, sweep = (3, 4) if kind == PieceKind.ARC else (5, 6)
        first[0, sweep] *= u
        second[0, angle] += one.p[0, sweep] * u
        second[0, sweep] *= 1.0 - u
    return one.replace(end=at, p=first), one.replace(start=at, p=second)
