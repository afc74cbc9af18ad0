"""Lines that share a stretch of one straight line, arcs that share a stretch of one circle."""

from __future__ import annotations

from math import pi, tau

import numpy as np

from nccompile.importers.dxf.grid import Indices, cluster
from nccompile.importers.dxf.pieces import Complexes, Floats, PieceKind, Pieces, arc_row, line_row

__all__ = ["arc_overlaps", "line_overlaps", "merged_arcs", "merged_lines"]

FAN = 0.02
"""Directions [rad] that are searched together: turned by their mean, boxes around such lines are thin."""

Interval = tuple[float, float]


def line_overlaps(pieces: Pieces, group: Indices, tolerance: float) -> tuple[Indices, Indices]:
    """Pairs of lines of one group that run along each other, within `tolerance` [mm], for more than it.

    Lines are searched fan by fan of directions; two rows of fans, shifted by half, leave no pair out.
    """
    lines = np.flatnonzero(
        (pieces.kind == PieceKind.LINE) & (np.abs(pieces.end - pieces.start) > 4 * tolerance)
    )
    angle = np.angle(pieces.end[lines] - pieces.start[lines]) % pi
    firsts, seconds = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    for shift in (0.0, 0.5):
        fan = np.floor(angle / FAN + shift).astype(np.int64)
        fan[angle > pi - FAN * (0.5 + shift)] = 0
        for number in np.unique(fan):
            rows = lines[fan == number]
            if len(rows) > 1:
                i, j = _along(pieces, rows, (number - shift + 0.5) * FAN, tolerance)
                same = group[i] == group[j]
                firsts.append(i[same])
                seconds.append(j[same])
    return np.concatenate(firsts), np.concatenate(seconds)


def _along(pieces: Pieces, rows: Indices, direction: float, tolerance: float) -> tuple[Indices, Indices]:
    """The overlapping pairs among lines of about one direction."""
    import shapely  # noqa: PLC0415

    turn = np.exp(-1j * direction)
    a, b = pieces.start[rows] * turn, pieces.end[rows] * turn
    pad = tolerance
    boxes = shapely.box(
        np.minimum(a.real, b.real), np.minimum(a.imag, b.imag) - pad,
        np.maximum(a.real, b.real), np.maximum(a.imag, b.imag) + pad,
    )  # fmt: skip
    i, j = shapely.STRtree(boxes).query(boxes)
    once = i < j
    i, j = i[once], j[once]
    long = np.abs(b[i] - a[i]) >= np.abs(b[j] - a[j])
    i, j = np.where(long, i, j), np.where(long, j, i)
    unit = (b[i] - a[i]) / np.abs(b[i] - a[i])
    from_a, from_b = (a[j] - a[i]) / unit, (b[j] - a[i]) / unit
    low, high = np.minimum(from_a.real, from_b.real), np.maximum(from_a.real, from_b.real)
    shared = np.minimum(high, np.abs(b[i] - a[i])) - np.maximum(low, 0.0)
    aside = np.maximum(np.abs(from_a.imag), np.abs(from_b.imag))
    hit = (aside <= tolerance) & (shared > tolerance)
    return rows[i[hit]], rows[j[hit]]


def arc_overlaps(pieces: Pieces, group: Indices, tolerance: float) -> tuple[Indices, Indices]:
    """Pairs of arcs of one group on one circle that share more than `tolerance` [mm] of it."""
    arcs = np.flatnonzero(pieces.kind == PieceKind.ARC)
    if len(arcs) < 2:
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    centre = cluster(pieces.p[arcs, 0] + 1j * pieces.p[arcs, 1], tolerance)
    radius = cluster(pieces.p[arcs, 2] + 0j, tolerance)
    circle = np.column_stack([group[arcs], centre, radius])
    order = arcs[np.lexsort(circle.T)]
    change = np.any(np.diff(circle[np.lexsort(circle.T)], axis=0) != 0, axis=1)
    firsts, seconds = [], []
    for rows in np.split(order, np.flatnonzero(change) + 1):
        stretches = [(i, *_turns(pieces, i)) for i in rows] if len(rows) > 1 else []
        for at, (i, low, high) in enumerate(stretches):
            slack = tolerance / float(pieces.p[i, 2])
            for j, other_low, other_high in stretches[at + 1 :]:
                shared = sum(
                    max(0.0, min(high, other_high + turn) - max(low, other_low + turn))
                    for turn in (-tau, 0.0, tau)
                )
                if shared > slack:
                    firsts.append(i)
                    seconds.append(j)
    return np.array(firsts, np.int64), np.array(seconds, np.int64)


def _turns(pieces: Pieces, row: int) -> Interval:
    """The angles an arc covers, counter-clockwise, beginning in 0..2 pi."""
    start, sweep = float(pieces.p[row, 3]), float(pieces.p[row, 4])
    low = (start if sweep > 0 else start + sweep) % tau
    return low, low + abs(sweep)


def _union(intervals: list[Interval], slack: float) -> list[Interval]:
    """The intervals with those that share more than `slack` made one."""
    out: list[Interval] = []
    for low, high in sorted(intervals):
        if out and low < out[-1][1] - slack:
            out[-1] = (out[-1][0], max(out[-1][1], high))
        else:
            out.append((low, high))
    return out


def _without(intervals: list[Interval], taken: list[Interval], slack: float) -> list[Interval]:
    """What is left of the intervals outside those taken; rests up to `slack` go too."""
    for low, high in taken:
        rest = [(a, min(b, low)) for a, b in intervals] + [(max(a, high), b) for a, b in intervals]
        intervals = [(a, b) for a, b in rest if b - a > slack]
    return sorted(set(intervals))


def merged_lines(part: Pieces, loose: np.typing.NDArray[np.bool_], tolerance: float) -> Pieces:
    """The loose lines of one straight line as few as possible, without what the others cover."""
    longest = int(np.argmax(np.abs(part.end - part.start)))
    origin = complex(part.start[longest])
    unit = complex(part.end[longest] - part.start[longest])
    unit /= abs(unit)

    def places(points: Complexes) -> Floats:
        along: Floats = ((points - origin) / unit).real
        return along

    ends = np.sort(np.column_stack([places(part.start), places(part.end)]), axis=1)
    own = [(float(a), float(b)) for a, b in ends[loose]]
    others = [(float(a), float(b)) for a, b in ends[~loose]]
    rest = _without(_union(own, tolerance), others, tolerance)
    exact = dict(zip(places(part.start), part.start, strict=True)) | dict(
        zip(places(part.end), part.end, strict=True)
    )
    rows = [
        line_row(complex(exact.get(a, origin + a * unit)), complex(exact.get(b, origin + b * unit)))
        for a, b in rest
    ]
    return Pieces.from_rows(rows, part.layer[0], part.color[0], part.entity[0])


def merged_arcs(part: Pieces, loose: np.typing.NDArray[np.bool_], tolerance: float) -> Pieces:
    """The loose arcs of one circle as few as possible, without what the others cover."""
    centre, radius = complex(part.p[0, 0], part.p[0, 1]), float(part.p[0, 2])
    slack = tolerance / radius
    own = _union([_turns(part, i) for i in np.flatnonzero(loose).tolist()], slack)
    while len(own) > 1 and own[-1][1] - tau > own[0][0] + slack:
        own = _union([(own[-1][0] - tau, own[-1][1] - tau), *own[:-1]], slack)
    if own and own[0][1] - own[0][0] >= tau - slack:
        own = [(own[0][0], own[0][0] + tau)]
    for i in np.flatnonzero(~loose).tolist():
        low, high = _turns(part, i)
        own = _without(own, [(low + turn, high + turn) for turn in (-tau, 0.0, tau)], slack)
    rows = [arc_row(centre, radius, a, b - a) for a, b in own]
    return Pieces.from_rows(rows, part.layer[0], part.color[0], part.entity[0])
