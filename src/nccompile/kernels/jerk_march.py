"""Third-order ramps along rows: the fastest rise of the path velocity below caps, at a constant jerk J a ramp.

A march goes along rows of one stretch, forward (accelerating) or, on mirrored rows, backward (braking seen from
its end).  Its acceleration lies in 0..A of the row and changes with +J, 0 or -J.  From every state (v, a) it can
*ease*: run with -J until a = 0.

      v                          level  v + a² / 2J       at the distance  v a / J + a³ / 3J²
      |            .-----  level
      |       ..-''              Along a march both only grow, whatever the march does, so "the first state whose
      |     /   easing           ease would break a limit" is found by bisection.
      |   /
      |--' march

A march rises as fast as it can as long as its ease stays below the caps of the rows and of the nodes between
them and below the accelerations of the rows that it meets.  Otherwise it eases until the place of the limit.

A node whose cap is below the level that an ease from here reaches *before* the node is a cut: the march goes on
to it as if the cap was not there, and starts again behind it at the cap with a = 0.  Forward and backward march
meet between two common cuts (`kernels.jerk_join`).  A ramp starts and ends at a = 0; its J is the least of the
rows that it and its ease touch.  Own derivation.
"""

from __future__ import annotations

from math import exp, log, sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = ["PIECES", "ease_length", "march", "place_time"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

PIECES = 4
"""Greatest number of pieces of a row: rise, hold, ease, cruise."""

_SAFE, _CUT, _TOO_FAST, _TOO_STEEP, _LESS_JERK = 0, 1, 2, 3, 4

_TINY = 1e-11  # of a row's length: places that are nearer to each other are one
_SAME = 1e-12  # relative: velocities that differ by less are one
_ROUNDED = 1e-9  # relative: by how much an ease may miss the velocity of its end
_NEAR = 1e-9  # relative: an ease that ends so near before a limit uses it
_STEPS = 60
_JERK_STEP = (
    0.8  # a ramp is started anew with at most this share of its jerk, so that there are few such starts
)


@kernel
def place_time(d: float, v: float, a: float, j: float) -> float:
    """The time t > 0 after which v t + a t² / 2 + j t³ / 6 = d, for a motion that does not turn back on its way.

    j >= 0: a >= 0;  j < 0: the motion is asked before its acceleration is 0.  Newton's method from the right,
    where the distance is convex, falls to the root without leaving the interval.
    """
    if j < 0.0:
        t = -a / j
        if v > 0.0:
            t = min(t, d / v)
    else:
        t = 1e300
        if v > 0.0:
            t = d / v
        if a > 0.0 and a * t * t > 2.0 * d:
            t = sqrt(2.0 * d / a)
        if j > 0.0 and j * t * t * t > 48.0 * d:
            t = exp(log(6.0 * d / j) / 3.0) * (1.0 + 1e-12)
    for _ in range(64):
        slope = v + t * (a + 0.5 * j * t)
        if slope <= 0.0:
            return t
        step = (t * (v + t * (0.5 * a + t * j / 6.0)) - d) / slope
        t -= step
        if step <= 1e-11 * t:
            return t
    return t


@kernel
def ease_length(v: float, a: float, jerk: float) -> float:
    """Distance of an ease from (v, a)."""
    return a / jerk * (v + a * a / (3.0 * jerk))


@kernel
def _check(
    length: Floats, top: Floats, node: Floats, accel: Floats, jerk_row: Floats, i: int, x: float, v: float,
    a: float, jerk: float, cut: int,
) -> tuple[int, int, float]:  # fmt: skip
    """What an ease from (v, a) at the place x of row i meets first, in which row, and how far its end is from i."""
    level = v + a * a / (2.0 * jerk)
    way = x + ease_length(v, a, jerk)
    end = length[i]
    r = i
    while True:
        if way <= end:
            if r != cut and level > node[r] * (1.0 + _SAME):
                return _CUT, r, end
            return (_TOO_FAST if level > top[r] * (1.0 + _SAME) else _SAFE), r, end
        cap = top[r] if r == cut else node[r]
        if level > cap * (1.0 + _SAME):
            if v >= cap:
                return _TOO_FAST, r, end
            t = (a - sqrt(max(a * a - 2.0 * jerk * (cap - v), 0.0))) / jerk
            if x + t * (v + t * (0.5 * a - t * jerk / 6.0)) < end * (1.0 - _SAME):
                return _TOO_FAST, r, end
        if r == cut:
            return _SAFE, r, end
        if accel[r + 1] < a:
            t = (a - accel[r + 1]) / jerk
            if x + t * (v + t * (0.5 * a - t * jerk / 6.0)) > end * (1.0 + _SAME):
                return _TOO_STEEP, r, end
        if jerk_row[r + 1] < jerk:
            return _LESS_JERK, r + 1, end
        r += 1
        end += length[r]


@kernel
def _level_time(level: float, t_rise: float, v: float, a: float, a_top: float, jerk: float) -> float:
    """The time of a rise after which an ease reaches `level`, 0 if it does already."""
    peak = sqrt(max(jerk * (level - v) + 0.5 * a * a, 0.0))
    if peak <= a_top:
        return max(peak - a, 0.0) / jerk
    v_rise = v + t_rise * (a + 0.5 * jerk * t_rise)
    return t_rise + max(level - 0.5 * a_top * a_top / jerk - v_rise, 0.0) / a_top


@kernel
def _eased(
    steep: bool, z: float, value: float, t_rise: float, v: float, a: float, a_top: float, jerk: float
) -> tuple[float, float]:
    """(time of a rise, place): where its ease has the velocity `value` with the acceleration z.

    steep: z is the time, and the place is where the ease has the acceleration `value`.
    """
    t = z if steep else _level_time(value + 0.5 * z * z / jerk, t_rise, v, a, a_top, jerk)
    _, _, a1, way, v1 = _rise(t, t_rise, v, a, a_top, jerk)
    u = (a1 - (value if steep else z)) / jerk
    return t, way + u * (v1 + u * (0.5 * a1 - u * jerk / 6.0))


@kernel
def _last_time(
    steep: bool, low: float, high: float, value: float, end: float, t_rise: float, v: float, a: float, a_top: float,
    jerk: float,
) -> float:  # fmt: skip
    """The longest rise whose ease has `value` no later (steep) or no earlier than at `end`: regula falsi (Illinois).

    low, high: what is known to be short and long enough, times if steep, otherwise accelerations at the end.
    """
    sign = 1.0 if steep else -1.0
    t_low, at = _eased(steep, low, value, t_rise, v, a, a_top, jerk)
    f_low = sign * (at - end)
    _, at = _eased(steep, high, value, t_rise, v, a, a_top, jerk)
    f_high = sign * (at - end)
    side = 0
    for _ in range(_STEPS):
        if f_low >= -_NEAR * end or f_high <= f_low:
            break
        z = (low * f_high - high * f_low) / (f_high - f_low)
        if not low < z < high:
            z = 0.5 * (low + high)
            if not low < z < high:
                break
        t, at = _eased(steep, z, value, t_rise, v, a, a_top, jerk)
        f = sign * (at - end)
        if f <= 0.0:
            low, f_low, t_low = z, f, t
            if side == 1:
                f_high *= 0.5
            side = 1
        else:
            high, f_high = z, f
            if side == -1:
                f_low *= 0.5
            side = -1
    return t_low


@kernel
def _put(pieces: Floats, q: int, x: float, v: float, a: float, j: float) -> None:
    """Writes a piece."""
    pieces[q, 0] = x
    pieces[q, 1] = v
    pieces[q, 2] = a
    pieces[q, 3] = j


@kernel
def _rise(
    t: float, t_rise: float, v: float, a: float, a_top: float, jerk: float
) -> tuple[float, float, float, float, float]:
    """A rise of t seconds, t_rise of them with +J, then at a_top.

    Returns (way of the first part, v after it, a after it, way of both, v after both).
    """
    t1 = min(t, t_rise)
    a1 = a_top if t >= t_rise else a + jerk * t1
    d1 = t1 * (v + t1 * (0.5 * a + t1 * jerk / 6.0))
    v1 = v + t1 * (a + 0.5 * jerk * t1)
    t2 = t - t1
    return d1, v1, a1, d1 + t2 * (v1 + 0.5 * a1 * t2), v1 + a1 * t2


@kernel
def march(
    length: Floats, top: Floats, node: Floats, accel: Floats, jerk_row: Floats, v_start: float, first: Ints,
    pieces: Floats, entry: Floats, ramp: Floats,
) -> None:  # fmt: skip
    """Fills the pieces of all rows.

    length, top, accel, jerk_row (n,): of the rows, all > 0; node (n,): cap of the node behind each row, at most the
    top of both rows, the last one 0.  The march starts at (v_start, 0) and ends at the end of the last row.
    first (n + 1,): pieces first[i] .. first[i + 1] are those of row i; pieces (m, 4): their ends (place in the row,
    velocity, acceleration) and their jerk; room for PIECES a row.  entry (n, 2): (v, a) at the start of each row;
    ramp (n,): jerk J of the ramp that enters it.
    """
    n = len(length)
    i = 0
    count = 0
    v = v_start
    a = 0.0
    jerk = 0.0
    begin = -1  # row where the ramp began
    begin_v = v_start
    cut = -1
    ease_to = -1  # the march eases until the end of this row
    while i < n:
        if a == 0.0 and ease_to < i and (begin != i or begin_v != v):
            begin, begin_v = i, v
            jerk = float(jerk_row[i])
        less = float(jerk_row[i])
        run = float(length[i])
        cap = float(top[i])
        first[i] = count
        entry[i, 0] = v
        entry[i, 1] = a
        ramp[i] = jerk
        x = 0.0
        if less >= jerk and ease_to < i and a == 0.0 and cap - v <= _SAME * cap:
            ease_to = i
            if node[i] < v:
                cut = i
        elif less >= jerk and ease_to < i:
            a_top = max(float(accel[i]), a)
            t_rise = (a_top - a) / jerk
            # The rise that an ease follows up to the row's cap, if both end in the row.
            v_rise = v + t_rise * (a + 0.5 * jerk * t_rise)
            t = _level_time(cap, t_rise, v, a, a_top, jerk)
            d1, v1, a1, d2, v2 = _rise(t, t_rise, v, a, a_top, jerk)
            if d2 + ease_length(v2, a1, jerk) <= run:
                ease_to = i
                if node[i] < cap:
                    cut = i
            else:
                d_rise, _, _, _, _ = _rise(t_rise, t_rise, v, a, a_top, jerk)
                if d_rise >= run:
                    whole = min(place_time(run, v, a, jerk), t_rise)
                else:
                    whole = t_rise + 2.0 * (run - d_rise) / (
                        v_rise + sqrt(v_rise * v_rise + 2.0 * a_top * (run - d_rise))
                    )
                t = whole
                for _ in range(_STEPS):
                    d1, v1, a1, d2, v2 = _rise(t, t_rise, v, a, a_top, jerk)
                    what, where, end = _check(length, top, node, accel, jerk_row, i, d2, v2, a1, jerk, cut)
                    if what == _LESS_JERK:
                        less = float(jerk_row[where])
                    elif what == _CUT:
                        cut = where
                        t, ease_to = whole, -1
                        continue
                    elif what == _TOO_STEEP:
                        value = float(accel[where + 1])
                        low = min(max(value - a, 0.0) / jerk, t)
                        t = _last_time(True, low, t, value, end, t_rise, v, a, a_top, jerk)
                        ease_to = where
                        continue
                    elif what == _TOO_FAST:
                        value = float(top[where] if where == cut else node[where])
                        low = min(_level_time(value, t_rise, v, a, a_top, jerk), t)
                        _, _, a1, d2, v2 = _rise(low, t_rise, v, a, a_top, jerk)
                        inside = d2 + ease_length(v2, a1, jerk) <= end
                        if inside and where != cut:
                            cut = where
                            t, ease_to = whole, -1
                            continue
                        if inside:
                            t = low
                        else:
                            _, _, a1, _, v2 = _rise(t, t_rise, v, a, a_top, jerk)
                            high = sqrt(max(a1 * a1 - 2.0 * jerk * (value - v2), 0.0))
                            t = _last_time(False, 0.0, high, value, end, t_rise, v, a, a_top, jerk)
                        ease_to = where
                        continue
                    break
                if t == whole:
                    d2 = run
            if less >= jerk:
                if d1 > _TINY * run:
                    x = min(d1, run)
                    _put(pieces, count, x, v1, a1, jerk)
                    count += 1
                    v, a = v1, a1
                if d2 - x > _TINY * run:
                    x = min(d2, run)
                    _put(pieces, count, x, v2, a, 0.0)
                    count += 1
                    v = v2
        if less < jerk:
            jerk = min(less, _JERK_STEP * jerk)
            i, v, a, cut, ease_to = begin, begin_v, 0.0, -1, -1
            count = int(first[i])
            continue
        if ease_to >= i and run - x > _TINY * run:
            way = ease_length(v, a, jerk)
            if way > (1.0 - _TINY) * (run - x):
                t = place_time(run - x, v, a, -jerk)
                v += t * (a - 0.5 * jerk * t)
                a = max(a - jerk * t, 0.0)
                _put(pieces, count, run, v, a, -jerk)
                count += 1
            else:
                if way > _TINY * run:
                    x += way
                    v += a * a / (2.0 * jerk)
                    if abs(v - cap) <= _SAME * cap:
                        v = cap
                    _put(pieces, count, x, v, 0.0, -jerk)
                    count += 1
                a = 0.0
                _put(pieces, count, run, v, 0.0, 0.0)
                count += 1
        pieces[count - 1, 0] = run
        if cut == i or v > node[i] * (1.0 + _ROUNDED):
            cut = -1
            ease_to = -1
            v, a = float(node[i]), 0.0
        elif v > node[i]:
            v = float(node[i])
            pieces[count - 1, 1] = v
        i += 1
    first[n] = count
