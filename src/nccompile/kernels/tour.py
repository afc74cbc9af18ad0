"""Short tours by 2-opt and Or-opt moves.

A stop has two ends: it is entered at one and left at the other (a closed path has both in one place).  A stop
that is flipped is entered at its exit.  `parent[i]` must come after i (-1: no such stop); a stop that is `fixed`
keeps its direction.  The tour begins at (x0, y0) and ends with its last stop.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = ["improve", "tour_length"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

LONGEST_TURN = 25_000
SHORT_TURN = 1_000
"""Stops that a 2-opt move turns round at most, in tours of up to and above `LONGEST_TURN` stops: long turns cost
more than they save in a large tour."""

GAIN = 1e-9
"""[mm] A move must save this much: rounding must not keep the search going round."""


@kernel
def _gap(
    p: int, q: int, p_turned: bool, q_turned: bool, tour: Ints, flip: npt.NDArray[np.bool_],
    ax: Floats, ay: Floats, bx: Floats, by: Floats, x0: float, y0: float,
) -> float:  # fmt: skip
    """Way from the stop at place p to the one at place q; `turned` ones are taken flipped once more.

    Place -1 is the start of the tour; a place behind the last costs nothing.
    """
    if q >= len(tour):
        return 0.0
    t = tour[q]
    entry_flipped = flip[q] != q_turned
    qx = bx[t] if entry_flipped else ax[t]
    qy = by[t] if entry_flipped else ay[t]
    x, y = x0, y0
    if p >= 0:
        s = tour[p]
        left_flipped = flip[p] != p_turned
        x = ax[s] if left_flipped else bx[s]
        y = ay[s] if left_flipped else by[s]
    return sqrt((qx - x) * (qx - x) + (qy - y) * (qy - y))


@kernel
def tour_length(
    tour: Ints,
    flip: npt.NDArray[np.bool_],
    ax: Floats,
    ay: Floats,
    bx: Floats,
    by: Floats,
    x0: float,
    y0: float,
) -> float:
    """Length of all ways between the stops [mm]."""
    total = 0.0
    for q in range(len(tour)):
        total += _gap(q - 1, q, False, False, tour, flip, ax, ay, bx, by, x0, y0)
    return total


@kernel
def _may_turn(p: int, q: int, tour: Ints, place: Ints, fixed: npt.NDArray[np.bool_], parent: Ints) -> bool:
    """Whether the stops at places p..q may be run backwards."""
    for k in range(p, q + 1):
        s = tour[k]
        if fixed[s]:
            return False
        up = parent[s]
        if up >= 0 and place[up] <= q:
            return False
    return True


@kernel
def _may_move(
    p: int, q: int, to: int, tour: Ints, place: Ints, parent: Ints, inner: npt.NDArray[np.bool_]
) -> bool:
    """Whether the stops at places p..q may go between the places `to` and `to + 1` outside p-1..q."""
    if to > q:
        for k in range(p, q + 1):
            up = parent[tour[k]]
            if up >= 0 and q < place[up] <= to:
                return False
        return True
    has_inner = False
    for k in range(p, q + 1):
        has_inner = has_inner or inner[tour[k]]
    if has_inner:
        for k in range(to + 1, p):
            up = parent[tour[k]]
            if up >= 0 and p <= place[up] <= q:
                return False
    return True


@kernel
def _turn(p: int, q: int, tour: Ints, flip: npt.NDArray[np.bool_], place: Ints) -> None:
    """Runs the stops at places p..q backwards."""
    while p < q:
        tour[p], tour[q] = tour[q], tour[p]
        flip[p], flip[q] = not flip[q], not flip[p]
        place[tour[p]] = p
        place[tour[q]] = q
        p += 1
        q -= 1
    if p == q:
        flip[p] = not flip[p]
        place[tour[p]] = p


@kernel
def _shift(
    p: int, q: int, to: int, turned: bool, tour: Ints, flip: npt.NDArray[np.bool_], place: Ints
) -> None:
    """Moves the stops at places p..q between `to` and `to + 1`, backwards if `turned`."""
    n = q - p + 1
    held = tour[p : q + 1].copy()
    held_flip = flip[p : q + 1].copy()
    if to > q:
        for k in range(p, to - n + 1):
            tour[k] = tour[k + n]
            flip[k] = flip[k + n]
            place[tour[k]] = k
        begin = to - n + 1
    else:
        for k in range(q, to + n, -1):
            tour[k] = tour[k - n]
            flip[k] = flip[k - n]
            place[tour[k]] = k
        begin = to + 1
    for k in range(n):
        from_k = n - 1 - k if turned else k
        tour[begin + k] = held[from_k]
        flip[begin + k] = (not held_flip[from_k]) if turned else held_flip[from_k]
        place[tour[begin + k]] = begin + k


@kernel
def improve(
    tour: Ints, flip: npt.NDArray[np.bool_], ax: Floats, ay: Floats, bx: Floats, by: Floats,
    fixed: npt.NDArray[np.bool_], parent: Ints, near: Ints, reach: Floats, quiet: npt.NDArray[np.bool_],
    x0: float, y0: float, rounds: int,
) -> None:  # fmt: skip
    """Shortens a tour in place by 2-opt and Or-opt moves between near stops until none saves way.

    Args: near, reach: (n, k) from `near_stops`;  quiet: (n,) stops that need not be looked at, all True
          afterwards;  rounds: passes over all stops at most.
    """
    n = len(tour)
    place = np.empty(n, np.int64)
    inner = np.zeros(n, np.bool_)
    for k in range(n):
        place[tour[k]] = k
        if parent[k] >= 0:
            inner[parent[k]] = True
    for _ in range(rounds):
        changed = False
        for s in range(n):
            if quiet[s]:
                continue
            quiet[s] = True
            while _better(
                s, tour, flip, ax, ay, bx, by, fixed, parent, inner, near, reach, place, quiet, x0, y0
            ):
                changed = True
        if not changed:
            return


@kernel
def _wake(k: int, tour: Ints, quiet: npt.NDArray[np.bool_]) -> None:
    """Lets the stop at a place, if there is one, be looked at again."""
    if 0 <= k < len(tour):
        quiet[tour[k]] = False


@kernel
def _better(
    s: int, tour: Ints, flip: npt.NDArray[np.bool_], ax: Floats, ay: Floats, bx: Floats, by: Floats,
    fixed: npt.NDArray[np.bool_], parent: Ints, inner: npt.NDArray[np.bool_], near: Ints, reach: Floats, place: Ints,
    quiet: npt.NDArray[np.bool_], x0: float, y0: float,
) -> bool:  # fmt: skip
    """Does the first move at stop s that saves way; False if there is none."""
    i = place[s]
    n = len(tour)
    # the stop itself turned round
    if _try_turn(i, i, tour, flip, ax, ay, bx, by, fixed, parent, place, quiet, x0, y0):
        return True
    # a move only saves way if one of its new ways is shorter than one that it takes away at s
    longest = max(
        _gap(i - 1, i, False, False, tour, flip, ax, ay, bx, by, x0, y0),
        _gap(i, i + 1, False, False, tour, flip, ax, ay, bx, by, x0, y0),
    )
    for m in range(near.shape[1]):
        if reach[s, m] >= longest:
            break
        j = place[near[s, m]]
        for kind in range(2):
            if j > i:
                p, q = (i + 1, j) if kind == 0 else (i, j - 1)
            else:
                p, q = (j + 1, i) if kind == 0 else (j, i - 1)
            if p <= q and _try_turn(p, q, tour, flip, ax, ay, bx, by, fixed, parent, place, quiet, x0, y0):
                return True
        for long in range(1, 4):
            for back in range(2):
                p = i if back == 0 else i - long + 1
                q = p + long - 1
                if p < 0 or q >= n or (p <= j <= q):
                    continue
                cut = (
                    _gap(p - 1, p, False, False, tour, flip, ax, ay, bx, by, x0, y0)
                    + _gap(q, q + 1, False, False, tour, flip, ax, ay, bx, by, x0, y0)
                    - _gap(p - 1, q + 1, False, False, tour, flip, ax, ay, bx, by, x0, y0)
                )
                if cut <= GAIN:
                    continue
                for side in range(2):
                    to = j if side == 0 else j - 1
                    if p - 1 <= to <= q:
                        continue
                    open_way = _gap(to, to + 1, False, False, tour, flip, ax, ay, bx, by, x0, y0)
                    for turned in range(2):
                        if turned == 0:
                            added = _gap(to, p, False, False, tour, flip, ax, ay, bx, by, x0, y0)
                            if to + 1 < n:
                                added += _gap(q, to + 1, False, False, tour, flip, ax, ay, bx, by, x0, y0)
                        else:
                            added = _gap(to, q, False, True, tour, flip, ax, ay, bx, by, x0, y0)
                            if to + 1 < n:
                                added += _gap(p, to + 1, True, False, tour, flip, ax, ay, bx, by, x0, y0)
                        if cut - (added - open_way) > GAIN:
                            if not _may_move(p, q, to, tour, place, parent, inner):
                                continue
                            if turned == 1 and not _may_turn(p, q, tour, place, fixed, parent):
                                continue
                            for k in (p - 1, p, q, q + 1, to, to + 1):
                                _wake(k, tour, quiet)
                            _shift(p, q, to, turned == 1, tour, flip, place)
                            return True
    return False


@kernel
def _try_turn(
    p: int, q: int, tour: Ints, flip: npt.NDArray[np.bool_], ax: Floats, ay: Floats, bx: Floats, by: Floats,
    fixed: npt.NDArray[np.bool_], parent: Ints, place: Ints, quiet: npt.NDArray[np.bool_], x0: float, y0: float,
) -> bool:  # fmt: skip
    """Turns the stops at places p..q round if that saves way and is allowed."""
    if q - p > (LONGEST_TURN if len(tour) <= LONGEST_TURN else SHORT_TURN):
        return False
    old = _gap(p - 1, p, False, False, tour, flip, ax, ay, bx, by, x0, y0)
    old += _gap(q, q + 1, False, False, tour, flip, ax, ay, bx, by, x0, y0)
    new = _gap(p - 1, q, False, True, tour, flip, ax, ay, bx, by, x0, y0)
    new += _gap(p, q + 1, True, False, tour, flip, ax, ay, bx, by, x0, y0)
    if old - new <= GAIN or not _may_turn(p, q, tour, place, fixed, parent):
        return False
    for k in (p - 1, p, q, q + 1):
        _wake(k, tour, quiet)
    _turn(p, q, tour, flip, place)
    return True
