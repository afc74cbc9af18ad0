"""Paths made ready for output: cubics as arcs where there are no cubics, ends on the grid of the last decimal.

Rounding comes before ordering, so that a drawing and the drawing of its own output are machined alike.
"""

from __future__ import annotations

from math import pi

import numpy as np
import numpy.typing as npt

from nccompile.geometry.biarcs import arcs_of_cubics
from nccompile.importers.dxf.grid import Indices
from nccompile.importers.dxf.join import Paths
from nccompile.importers.dxf.pieces import Complexes, PieceKind, Pieces, sample, similar

__all__ = ["arcs_for_cubics", "on_grid", "round_to"]

HALF_TURN = pi * (1.0 + 1e-9)
"""Arcs beyond this are halved before they are rounded: their ends say too little about their far side."""


def arcs_for_cubics(paths: Paths, tolerance: float) -> Paths:
    """The paths with lines and arcs, within `tolerance` [mm], instead of cubics."""
    pieces = paths.pieces
    cubic = np.flatnonzero(pieces.kind == PieceKind.CUBIC)
    if not len(cubic):
        return paths
    p = pieces.p[cubic]
    inner = [p[:, 0] + 1j * p[:, 1], p[:, 2] + 1j * p[:, 3]]
    arcs = arcs_of_cubics(np.column_stack([pieces.start[cubic], *inner, pieces.end[cubic]]), tolerance)
    source = cubic[arcs.cubic]
    made = pieces.take(source).replace(start=arcs.start, end=arcs.end)
    bent = arcs.sweep != 0.0
    centre = arc_centres(arcs.start, arcs.end, np.where(bent, arcs.sweep, 1.0))
    radial = arcs.start - centre
    rows = np.zeros_like(made.p)
    rows[:, :5] = np.column_stack([centre.real, centre.imag, np.abs(radial), np.angle(radial), arcs.sweep])
    rows[~bent] = 0.0
    kind = np.where(bent, PieceKind.ARC, PieceKind.LINE).astype(np.uint8)
    return _exchange(paths, cubic, made.replace(kind=kind, p=rows), source)


def arc_centres(start: Complexes, end: Complexes, sweep: npt.NDArray[np.float64]) -> Complexes:
    """Centres of the arcs over the chords start -> end with these sweeps: M + i chord / (2 tan(sweep / 2))."""
    centres: Complexes = 0.5 * (start + end) + 0.5j * (end - start) / np.tan(0.5 * sweep)
    return centres


def on_grid(paths: Paths, decimals: int) -> Paths:
    """The paths with every end rounded to the decimals; what becomes a point is left out.

    Pieces are turned and scaled to their rounded ends, which moves no point of them by more than about the
    rounding.  Arcs above a half turn are halved for that; full circles move as a whole.
    """
    paths = _halved(paths)
    pieces = paths.pieces
    start, end = round_to(pieces.start, decimals), round_to(pieces.end, decimals)
    full = pieces.is_full
    circle = full & (pieces.kind == PieceKind.ARC)
    if circle.any():
        pieces, start = _circles_on_grid(pieces, circle, start, decimals)
    end = np.where(full, start, end)
    keep = (start != end) | full | (pieces.kind == PieceKind.POINT)
    kept = similar(pieces.take(keep), start[keep], end[keep])
    return _rebuild(paths, kept, np.flatnonzero(keep))


def _circles_on_grid(
    pieces: Pieces, circle: npt.NDArray[np.bool_], start: Complexes, decimals: int
) -> tuple[Pieces, Complexes]:
    """Full circles with centre and radius rounded, so that all four quarter points are on the grid."""
    p = pieces.p.copy()
    p[circle, :2] = np.round(p[circle, :2], decimals) + 0.0
    p[circle, 2] = np.maximum(np.round(p[circle, 2], decimals), 10.0**-decimals)
    p[circle, 3] = np.where(np.abs(np.sin(2 * p[circle, 3])) < 1e-9, p[circle, 3], 0.0)
    p[circle, 3] = np.round(p[circle, 3] / (pi / 2)) * (pi / 2)
    begin = p[circle, 0] + 1j * p[circle, 1] + p[circle, 2] * np.round(np.exp(1j * p[circle, 3]))
    start = start.copy()
    start[circle] = begin
    at = pieces.start.copy()
    at[circle] = begin
    return pieces.replace(p=p, start=at, end=np.where(circle, at, pieces.end)), start


def round_to(z: Complexes, decimals: int) -> Complexes:
    """Both coordinates rounded; no negative zero."""
    rounded: Complexes = np.round(z.real, decimals) + 0.0 + 1j * (np.round(z.imag, decimals) + 0.0)
    return rounded


def _halved(paths: Paths) -> Paths:
    """Wide arcs and closed cubics cut in the middle."""
    pieces = paths.pieces
    arc, ellipse = pieces.kind == PieceKind.ARC, pieces.kind == PieceKind.ELLIPSE
    sweep = np.abs(np.where(arc, pieces.p[:, 4], pieces.p[:, 6]))
    wide = (arc | ellipse) & (sweep > HALF_TURN) & ~pieces.is_full
    loop = (pieces.kind == PieceKind.CUBIC) & (pieces.start == pieces.end)
    rows = np.flatnonzero(wide | loop)
    if not len(rows):
        return paths
    parts = _halves_of(pieces.take(rows))
    return _exchange(paths, rows, parts, np.repeat(rows, 2))


def _halves_of(pieces: Pieces) -> Pieces:
    """Both halves of every piece, first and second in turn."""
    middle = sample(pieces, np.array([0.5]))[:, 0]
    first, second = pieces.p.copy(), pieces.p.copy()
    for kind, angle, sweep in ((PieceKind.ARC, 3, 4), (PieceKind.ELLIPSE, 5, 6)):
        on = pieces.kind == kind
        first[on, sweep] *= 0.5
        second[on, sweep] *= 0.5
        second[on, angle] += second[on, sweep]
    cubic = pieces.kind == PieceKind.CUBIC
    a, b = pieces.start[cubic], pieces.end[cubic]
    c1, c2 = (pieces.p[cubic, k] + 1j * pieces.p[cubic, k + 1] for k in (0, 2))
    ab, bc, cd = 0.5 * (a + c1), 0.5 * (c1 + c2), 0.5 * (c2 + b)
    abc, bcd = 0.5 * (ab + bc), 0.5 * (bc + cd)
    first[cubic, :4] = np.column_stack([ab.real, ab.imag, abc.real, abc.imag])
    second[cubic, :4] = np.column_stack([bcd.real, bcd.imag, cd.real, cd.imag])
    both = Pieces.join([pieces.replace(end=middle, p=first), pieces.replace(start=middle, p=second)])
    return both.take(np.arange(2 * len(pieces)).reshape(2, -1).T.ravel())


def _exchange(paths: Paths, rows: Indices, made: Pieces, source: Indices) -> Paths:
    """The paths with the pieces `rows` replaced by the pieces `made`, each in the place of its source row."""
    keep = np.ones(len(paths.pieces), bool)
    keep[rows] = False
    rest = np.flatnonzero(keep)
    origin = np.concatenate([rest, source])
    order = np.argsort(origin, kind="stable")
    everything = Pieces.join([paths.pieces.take(rest), made])
    return _rebuild(paths, everything.take(order), origin[order])


def _rebuild(paths: Paths, pieces: Pieces, origin: Indices) -> Paths:
    """Paths from pieces and the rows they stem from; paths without pieces are left out."""
    first = np.searchsorted(origin, paths.first)
    filled = first[1:] > first[:-1]
    return Paths(pieces, np.append(first[:-1][filled], first[-1]), paths.closed[filled], paths.group[filled])
