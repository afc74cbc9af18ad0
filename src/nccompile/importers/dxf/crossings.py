"""Where lines and arcs cross or touch each other."""

from __future__ import annotations

from math import atan2, sqrt, tau

import numpy as np

from nccompile.importers.dxf.pieces import PieceKind, Pieces, flatten

__all__ = ["crossings"]

TOUCH = 1e-7
"""[mm] Circles and lines that miss each other by less touch; crossings this far beyond an end count."""

BOX = 1e-6


def crossings(pieces: Pieces) -> dict[int, list[float]]:
    """For every piece the parameters 0..1 at which it crosses, touches or ends on another one.

    Pairs come from a tree of bounding boxes.  Where two run along each other, the ends of one on the other count.
    """
    import shapely  # noqa: PLC0415

    boxes = _boxes(pieces)
    i, j = shapely.STRtree(boxes).query(boxes)
    found: dict[int, list[float]] = {}
    for a, b in zip(i.tolist(), j.tolist(), strict=True):
        if a >= b:
            continue
        for point in _meet(pieces, a, b):
            for k in (a, b):
                u = _parameter(pieces, k, point)
                if u is not None:
                    found.setdefault(k, []).append(u)
    return found


def _boxes(pieces: Pieces) -> np.typing.NDArray[np.object_]:
    import shapely  # noqa: PLC0415

    lines = flatten(pieces, 0.05)
    low = np.array([[z.real.min(), z.imag.min()] for z in lines]) - 0.05 - BOX
    high = np.array([[z.real.max(), z.imag.max()] for z in lines]) + 0.05 + BOX
    boxes: np.typing.NDArray[np.object_] = shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1])
    return boxes


def _meet(pieces: Pieces, a: int, b: int) -> list[complex]:
    """Points that two pieces may have in common, before their extents are looked at."""
    kinds = pieces.kind[a], pieces.kind[b]
    if kinds == (PieceKind.ARC, PieceKind.ARC):
        points = _circles(pieces, a, b)
    elif PieceKind.ARC in kinds:
        arc, line = (a, b) if kinds[0] == PieceKind.ARC else (b, a)
        points = _line_circle(pieces, line, arc)
    else:
        points = _lines(pieces, a, b)
    ends = [complex(z) for k in (a, b) for z in (pieces.start[k], pieces.end[k])]
    return points + ends


def _lines(pieces: Pieces, a: int, b: int) -> list[complex]:
    p, q = complex(pieces.start[a]), complex(pieces.start[b])
    r, s = complex(pieces.end[a]) - p, complex(pieces.end[b]) - q
    cross = (r.conjugate() * s).imag
    if abs(cross) <= 1e-14 * abs(r) * abs(s):
        return []
    return [p + r * (((q - p).conjugate() * s).imag / cross)]


def _line_circle(pieces: Pieces, line: int, arc: int) -> list[complex]:
    p = complex(pieces.start[line])
    unit = complex(pieces.end[line]) - p
    unit /= abs(unit)
    centre, radius = complex(pieces.p[arc, 0], pieces.p[arc, 1]), float(pieces.p[arc, 2])
    foot = p + unit * ((centre - p) / unit).real
    gap = abs(centre - foot)
    if gap > radius + TOUCH:
        return []
    half = sqrt(max((radius - gap) * (radius + gap), 0.0))
    return [foot + half * unit, foot - half * unit]


def _circles(pieces: Pieces, a: int, b: int) -> list[complex]:
    a, b = (a, b) if pieces.p[a, 2] <= pieces.p[b, 2] else (b, a)  # from the smaller circle: keeps the digits
    p, q = (complex(pieces.p[k, 0], pieces.p[k, 1]) for k in (a, b))
    r, s = float(pieces.p[a, 2]), float(pieces.p[b, 2])
    d = abs(q - p)
    if d <= TOUCH or d > r + s + TOUCH or d < abs(r - s) - TOUCH:
        return []
    along = ((d - s) * (d + s) + r * r) / (2 * d)
    half = sqrt(max((r - along) * (r + along), 0.0))
    unit = (q - p) / d
    return [p + unit * complex(along, half), p + unit * complex(along, -half)]


def _parameter(pieces: Pieces, k: int, z: complex) -> float | None:
    """Where on piece k a point lies; None if it is off it."""
    a, b = complex(pieces.start[k]), complex(pieces.end[k])
    if pieces.kind[k] == PieceKind.ARC:
        cx, cy, radius, start, sweep = (float(v) for v in pieces.p[k, :5])
        radial: complex = z - complex(cx, cy)
        if abs(abs(radial) - radius) > 10 * TOUCH:
            return None
        turn: float = (atan2(radial.imag, radial.real) - start) % tau
        if sweep < 0:
            turn = (tau - turn) % tau
        slack = 10 * TOUCH / radius
        if turn > abs(sweep) + slack:
            return 0.0 if turn >= tau - slack else None
        return min(turn / abs(sweep), 1.0)
    place = (z - a) / (b - a)
    if abs(place.imag) * abs(b - a) > 10 * TOUCH:
        return None
    slack = 10 * TOUCH / abs(b - a)
    return min(max(place.real, 0.0), 1.0) if -slack <= place.real <= 1.0 + slack else None
