"""The reached distance between segments and their offsets, measured both ways on samples, not by the offset's formulas.

contour  ──x────────────x──      every sample of a piece looks for the nearest place of its segment,
           |            |        every sample of a segment for the nearest place of its pieces;
pieces   ──┴──x──────x──┴──      the greatest | distance - r | is the deviation
"""

from math import sqrt

from nccompile.kernels import kernel
from nccompile.kernels.boxes import Kinds, Rows
from nccompile.kernels.curve_points import ARC, POLYNOMIAL, Floats
from nccompile.kernels.gouges import foot
from nccompile.kernels.intersect import place

__all__ = ["distance_from", "offset_deviation"]

_SCAN = 8  # places at which a part of an ellipse or cubic is looked at first
_FINE = 1e-5  # of that part, where the search for its nearest place stops: the distance is off by far less
_GOLDEN = 0.6180339887498949


@kernel
def distance_from(kind: int, p: Floats, e: Floats, x: float, y: float, low: float, high: float) -> float:
    """Distance [mm] of (x, y) from a segment; of an ellipse or cubic from its part low..high, by search."""
    if not ARC < kind <= POLYNOMIAL:
        fx, fy = foot(kind, p, e, x, y)
        return sqrt((fx - x) * (fx - x) + (fy - y) * (fy - y))
    best = 1e300
    at = 0
    for i in range(_SCAN + 1):
        px, py = place(kind, p, e, low + (high - low) * i / _SCAN)
        gap = (px - x) * (px - x) + (py - y) * (py - y)
        if gap < best:
            best = gap
            at = i
    a = low + (high - low) * max(at - 1, 0) / _SCAN
    b = low + (high - low) * min(at + 1, _SCAN) / _SCAN
    while b - a > _FINE * (high - low):
        c = b - _GOLDEN * (b - a)
        f = a + _GOLDEN * (b - a)
        px, py = place(kind, p, e, c)
        one = (px - x) * (px - x) + (py - y) * (py - y)
        px, py = place(kind, p, e, f)
        two = (px - x) * (px - x) + (py - y) * (py - y)
        best = min(best, one, two)
        if one < two:
            b = f
        else:
            a = c
    return sqrt(best)


@kernel
def offset_deviation(
    owner: Rows, kinds: Kinds, curve: Rows, table: Floats, ends: Floats, d: Floats,
    piece: Rows, piece_kind: Kinds, piece_curve: Rows, piece_table: Floats, piece_ends: Floats, piece_part: Floats,
    samples: int,
) -> float:  # fmt: skip
    """The greatest | distance - |d| | [mm] of the pieces `piece` of the segments `owner`, both Shape (k,), both ways.

    A piece stands for the parameters of its segment that `piece_part` says, so only that part is searched;
    samples: of a curve, and at least two.
    """
    worst = 0.0
    for k in range(len(piece)):
        i = int(owner[k])
        q = int(piece[k])
        kind = int(kinds[i])
        p = table[max(int(curve[i]), 0)]
        is_free = ARC < kind <= POLYNOMIAL
        low = float(piece_part[q, 0])
        high = float(piece_part[q, 1])
        wide = 0.5 * (high - low) + 1e-6
        n = samples if is_free else 2
        r = abs(float(d[i]))
        for s in range(1, n + 1):
            u = s / (n + 1.0)
            x, y = place(int(piece_kind[q]), piece_table[max(int(piece_curve[q]), 0)], piece_ends[q], u)
            gap = distance_from(kind, p, ends[i], x, y, max(low - wide, 0.0), min(high + wide, 1.0))
            worst = max(worst, abs(gap - r))
            x, y = place(kind, p, ends[i], low + u * (high - low))
            gap = 1e300
            for near in range(max(k - 1, 0), min(k + 2, len(piece))):
                if owner[near] == i:
                    other = int(piece[near])
                    row = piece_table[max(int(piece_curve[other]), 0)]
                    gap = min(
                        gap, distance_from(int(piece_kind[other]), row, piece_ends[other], x, y, 0.0, 1.0)
                    )  # fmt: skip
            worst = max(worst, abs(gap - r))
    return worst
