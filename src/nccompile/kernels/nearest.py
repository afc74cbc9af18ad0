"""What is near: the nearest stops of every stop, and tours that always take the nearest one, on a grid of cells.

Stops and their ends are those of `nccompile.kernels.tour`.
"""

from __future__ import annotations

from math import floor, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = ["near_stops", "nearest_first"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@kernel
def _cell(value: float, low: float, size: float, count: int) -> int:
    at = floor((value - low) / size)
    return min(max(at, 0), count - 1)


@kernel
def near_stops(
    px: Floats, py: Floats, owner: Ints, stops: int, k: int, side: int, near: Ints, reach: Floats
) -> None:
    """Fills near (stops, k) with the k stops nearest to each stop's ends, -1 where there are fewer.

    reach (stops, k) [mm] becomes their distances, endless where there is none.

    Args: px, py, owner: (m,) end points and their stops;  side: cells of the grid along each axis.
    """
    m = len(px)
    x0, y0 = px.min(), py.min()
    size = max(px.max() - x0, py.max() - y0) / side + 1e-9
    head = np.full(side * side, -1, np.int64)
    link = np.full(m, -1, np.int64)
    for i in range(m):
        c = _cell(px[i], x0, size, side) * side + _cell(py[i], y0, size, side)
        link[i] = head[c]
        head[c] = i
    best = np.empty(k)
    best_stop = np.empty(k, np.int64)
    for s in range(stops):
        for j in range(k):
            near[s, j] = -1
            reach[s, j] = np.inf
    for i in range(m):
        s = owner[i]
        for j in range(k):
            best[j] = reach[s, j]
            best_stop[j] = near[s, j]
        cx, cy = _cell(px[i], x0, size, side), _cell(py[i], y0, size, side)
        ring = 0
        while ring <= side:
            if ring > 0 and best[k - 1] <= (ring - 1) * size:
                break
            for gx in range(cx - ring, cx + ring + 1):
                if gx < 0 or gx >= side:
                    continue
                step = 1 if gx == cx - ring or gx == cx + ring else max(1, 2 * ring)
                for gy in range(cy - ring, cy + ring + 1, step):
                    if gy < 0 or gy >= side:
                        continue
                    j = head[gx * side + gy]
                    while j >= 0:
                        if owner[j] != s:
                            d = sqrt((px[j] - px[i]) * (px[j] - px[i]) + (py[j] - py[i]) * (py[j] - py[i]))
                            if d < best[k - 1]:
                                _insert(best, best_stop, d, owner[j])
                        j = link[j]
            ring += 1
        for j in range(k):
            reach[s, j] = best[j]
            near[s, j] = best_stop[j]


@kernel
def _insert(best: Floats, stop: Ints, d: float, s: int) -> None:
    """Puts a stop into the sorted list of the nearest, once."""
    k = len(best)
    old = k - 1
    for j in range(k):
        if stop[j] == s:
            if best[j] <= d:
                return
            old = j
            break
    while old > 0 and best[old - 1] > d:
        best[old] = best[old - 1]
        stop[old] = stop[old - 1]
        old -= 1
    best[old] = d
    stop[old] = s


@kernel
def nearest_first(
    ax: Floats, ay: Floats, bx: Floats, by: Floats, fixed: npt.NDArray[np.bool_], parent: Ints,
    x0: float, y0: float, side: int, tour: Ints, flip: npt.NDArray[np.bool_],
) -> None:  # fmt: skip
    """Fills tour and flip: always the nearest stop next whose inner ones are done."""
    n = len(ax)
    lx, ly = min(ax.min(), bx.min()), min(ay.min(), by.min())
    size = max(max(ax.max(), bx.max()) - lx, max(ay.max(), by.max()) - ly) / side + 1e-9
    head = np.full(side * side, -1, np.int64)
    link = np.full(2 * n, -1, np.int64)
    waiting = np.zeros(n, np.int64)
    done = np.zeros(n, np.bool_)
    for i in range(n):
        if parent[i] >= 0:
            waiting[parent[i]] += 1
    for i in range(n):
        if waiting[i] == 0:
            _place(i, ax, ay, bx, by, fixed, lx, ly, size, side, head, link)
    x, y = x0, y0
    for at in range(n):
        best, best_d, best_flip = -1, np.inf, False
        cx, cy = _cell(x, lx, size, side), _cell(y, ly, size, side)
        # how far the point lies outside of the grid: rings are farther away by that
        away = max(0.0, lx - x, x - lx - size * side, ly - y, y - ly - size * side)
        ring = 0
        while ring <= side:
            if best >= 0 and best_d <= away + (ring - 1) * size:
                break
            for gx in range(cx - ring, cx + ring + 1):
                if gx < 0 or gx >= side:
                    continue
                step = 1 if gx == cx - ring or gx == cx + ring else max(1, 2 * ring)
                for gy in range(cy - ring, cy + ring + 1, step):
                    if gy < 0 or gy >= side:
                        continue
                    cell = gx * side + gy
                    last = -1
                    j = head[cell]
                    while j >= 0:
                        stop = j // 2
                        following = link[j]
                        if done[stop]:
                            if last < 0:
                                head[cell] = following
                            else:
                                link[last] = following
                        else:
                            turned = j % 2 == 1
                            ex = bx[stop] if turned else ax[stop]
                            ey = by[stop] if turned else ay[stop]
                            d = sqrt((ex - x) * (ex - x) + (ey - y) * (ey - y))
                            if d < best_d or (d == best_d and stop < best):
                                best, best_d, best_flip = stop, d, turned
                            last = j
                        j = following
            ring += 1
        tour[at] = best
        flip[at] = best_flip
        done[best] = True
        x = ax[best] if best_flip else bx[best]
        y = ay[best] if best_flip else by[best]
        up = parent[best]
        if up >= 0:
            waiting[up] -= 1
            if waiting[up] == 0:
                _place(up, ax, ay, bx, by, fixed, lx, ly, size, side, head, link)


@kernel
def _place(
    i: int, ax: Floats, ay: Floats, bx: Floats, by: Floats, fixed: npt.NDArray[np.bool_],
    lx: float, ly: float, size: float, side: int, head: Ints, link: Ints,
) -> None:  # fmt: skip
    """Puts the ends at which a stop may be entered into the grid."""
    c = _cell(ax[i], lx, size, side) * side + _cell(ay[i], ly, size, side)
    link[2 * i] = head[c]
    head[c] = 2 * i
    if not fixed[i] and (ax[i] != bx[i] or ay[i] != by[i]):
        c = _cell(bx[i], lx, size, side) * side + _cell(by[i], ly, size, side)
        link[2 * i + 1] = head[c]
        head[c] = 2 * i + 1
