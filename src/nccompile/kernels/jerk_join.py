r"""The third-order plan between a march forward and a march backward (`kernels.jerk_march`).

    v  |   forward .     . backward        Both marches keep the caps.  Where the forward one gets above the
       |          / `---' \                backward one, an arc with -J joins them below their crossing: the
       |         /  level  \               forward march eases to a level, the backward one (seen from its end)
       |        /           \              eases to the same level.  The greatest level at which both eases do
       |_______/             \_______      not overlap is the fastest; what is left between them is cruised.
            cut               cut

The plan follows the forward march, the arc, the backward march down to a cut that both have, and so on: at such
a node, and where both cruise, it is at the cap with a = 0, and nothing behind it matters before it.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.jerk_march import PIECES, ease_length, place_time

__all__ = ["JOINED", "join"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

JOINED = 2 * PIECES + 4
"""Greatest number of parts of a row."""

_TINY = 1e-11  # of a row's length, as in `kernels.jerk_march`
_SAME = 1e-12  # relative: velocities that differ by less are one
_STEPS = 60


@kernel
def _start(first: Ints, pieces: Floats, entry: Floats, i: int, q: int) -> tuple[float, float, float]:
    """(place in the row, v, a) at the start of piece q of row i."""
    if q == first[i]:
        return 0.0, float(entry[i, 0]), float(entry[i, 1])
    return float(pieces[q - 1, 0]), float(pieces[q - 1, 1]), float(pieces[q - 1, 2])


@kernel
def _before(first: Ints, pieces: Floats, entry: Floats, i: int, q: int) -> tuple[int, int]:
    """The piece before piece q of row i, on the same ramps; (-1, -1) if the march starts with q."""
    if q > first[i]:
        return i, q - 1
    if i == 0:
        return -1, -1
    v, a = pieces[q - 1, 1], pieces[q - 1, 2]
    if a != entry[i, 1] or abs(v - entry[i, 0]) > _SAME * v:
        return -1, -1
    return i - 1, q - 1


@kernel
def _at_level(
    level: float, x: float, v: float, a: float, v_end: float, a_end: float, j: float, jerk: float
) -> tuple[float, float, float]:
    """(place, v, a) on a piece from (v, a) at x where an ease would reach `level`, the first one of them."""
    if j > 0.0:
        rise = sqrt(min(max(jerk * (level - v) + 0.5 * a * a, a * a), a_end * a_end))
        t = max(rise - a, 0.0) / jerk
        return x + t * (v + t * (0.5 * a + t * jerk / 6.0)), v + t * (a + 0.5 * jerk * t), max(rise, a)
    if j < 0.0 or a <= 0.0:
        return x, v, a
    v_at = min(max(level - 0.5 * a * a / jerk, v), v_end)
    return x + (v_at - v) * (v_at + v) / (2.0 * a), v_at, a


@kernel
def _is_common(f_entry: Floats, i: int, b_entry: Floats, k: int) -> bool:
    """Whether both marches start at the node before row i with the same velocity and no acceleration."""
    v = f_entry[i, 0]
    return f_entry[i, 1] == 0.0 and b_entry[k, 1] == 0.0 and abs(b_entry[k, 0] - v) <= _SAME * v  # type: ignore[no-any-return]


@kernel
def _put(
    run: float, row: int, x: float, v: float, a: float, begin: int, count: int, out_row: Ints, out: Floats
) -> int:
    """Adds the part of a row that ends at x with (v, a); `begin`: first part of the row.  Returns their number.

    Parts without length are left out; the last part of a row always ends with it.
    """
    last = out[count - 1, 0] if count > begin else 0.0
    if x >= (1.0 - _TINY) * run:
        x = run
    if x - last <= _TINY * run:
        if x < run:
            return count
        count -= 1
    out_row[count] = row
    out[count, 0] = x
    out[count, 1] = v
    out[count, 2] = a
    return count + 1


@kernel
def join(
    length: Floats, f_first: Ints, f_pieces: Floats, f_entry: Floats, f_ramp: Floats, b_first: Ints,
    b_pieces: Floats, b_entry: Floats, b_ramp: Floats, out_first: Ints, out_row: Ints, out: Floats,
) -> tuple[int, int]:  # fmt: skip
    """Fills the parts of all rows with a constant jerk each.

    length (n,); f_*: the march forward, b_*: that on the mirrored rows.  out_row (m,), out (m, 3): the row, and
    (place in the row, v, a) at the end of a part; out_first (n + 1,) as in `march`; room for JOINED a row.
    Returns the number of parts and the last row before which the plan is final: 0 if none is, -1 if the marches
    do not meet.
    """
    n = len(length)
    i = 0
    count = 0
    settled = 0
    forward = True
    low_row = 0  # where the plan took to the forward march
    if b_pieces[b_first[n] - 1, 1] < f_entry[0, 0] * (1.0 - 1e-9):
        return 0, -1
    while i < n:
        k = n - 1 - i
        run = float(length[i])
        out_first[i] = count
        if forward:
            if i > 0 and _is_common(f_entry, i, b_entry, k + 1):
                settled = i
            if f_pieces[f_first[i + 1] - 1, 1] <= b_entry[k, 0] * (1.0 + _SAME):
                for q in range(f_first[i], f_first[i + 1]):
                    count = _put(
                        run,
                        i,
                        f_pieces[q, 0],
                        f_pieces[q, 1],
                        f_pieces[q, 2],
                        int(out_first[i]),
                        count,
                        out_row,
                        out,
                    )
                i += 1
                continue
            # The arc.  Places are distances from the start of row i.
            rf, qf, yf = i, int(f_first[i + 1]) - 1, 0.0
            rb, qb, yb = k, int(b_first[k + 1]) - 1, run
            over = min(
                f_pieces[qf, 1] + 0.5 * f_pieces[qf, 2] * f_pieces[qf, 2] / f_ramp[rf],
                b_pieces[qb, 1] + 0.5 * b_pieces[qb, 2] * b_pieces[qb, 2] / b_ramp[rb],
            )
            while True:
                jf, jb = float(f_ramp[rf]), float(b_ramp[rb])
                xf, vf, af = _start(f_first, f_pieces, f_entry, rf, qf)
                xb, vb, ab = _start(b_first, b_pieces, b_entry, rb, qb)
                lf = vf + 0.5 * af * af / jf
                lb = vb + 0.5 * ab * ab / jb
                level = max(lf, lb)
                x, v, a = _at_level(level, xf, vf, af, f_pieces[qf, 1], f_pieces[qf, 2], f_pieces[qf, 3], jf)
                w, u, c = _at_level(level, xb, vb, ab, b_pieces[qb, 1], b_pieces[qb, 2], b_pieces[qb, 3], jb)
                gap = yb - w - ease_length(u, c, jb) - (yf + x + ease_length(v, a, jf))
                if gap >= -_TINY * run:
                    break
                over = level
                if lf >= lb:
                    rf, qf = _before(f_first, f_pieces, f_entry, rf, qf)
                    if rf < low_row:
                        return 0, -1
                    if qf == f_first[rf + 1] - 1:
                        yf -= length[rf]
                else:
                    rb, qb = _before(b_first, b_pieces, b_entry, rb, qb)
                    if rb < 0:
                        return 0, -1
                    if qb == b_first[rb + 1] - 1:
                        yb += length[n - 1 - rb]
            if over > level:
                low, high = level, over
                g_low, g_high = gap, -1.0
                side = 0
                first_step = True
                for _ in range(_STEPS):
                    level = over if first_step else (low * g_high - high * g_low) / (g_high - g_low)
                    if not first_step and not low < level < high:
                        level = 0.5 * (low + high)
                    x, v, a = _at_level(
                        level, xf, vf, af, f_pieces[qf, 1], f_pieces[qf, 2], f_pieces[qf, 3], jf
                    )
                    w, u, c = _at_level(
                        level, xb, vb, ab, b_pieces[qb, 1], b_pieces[qb, 2], b_pieces[qb, 3], jb
                    )
                    gap = yb - w - ease_length(u, c, jb) - (yf + x + ease_length(v, a, jf))
                    if gap >= 0.0:
                        low, g_low = level, gap
                        if side == 1:
                            g_high *= 0.5
                        side = 1
                    else:
                        high, g_high = level, gap
                        if side == -1:
                            g_low *= 0.5
                        side = -1
                    first_step = False
                    if abs(gap) <= _TINY * run or high - low <= 1e-15 * high:
                        break
                if gap < -_TINY * run:
                    level = low
                    x, v, a = _at_level(
                        level, xf, vf, af, f_pieces[qf, 1], f_pieces[qf, 2], f_pieces[qf, 3], jf
                    )
                    w, u, c = _at_level(
                        level, xb, vb, ab, b_pieces[qb, 1], b_pieces[qb, 2], b_pieces[qb, 3], jb
                    )
            count = int(out_first[rf])
            for q in range(f_first[rf], qf):
                count = _put(
                    length[rf],
                    rf,
                    f_pieces[q, 0],
                    f_pieces[q, 1],
                    f_pieces[q, 2],
                    int(out_first[rf]),
                    count,
                    out_row,
                    out,
                )
            count = _put(length[rf], rf, x, v, a, int(out_first[rf]), count, out_row, out)
            leave, arrive = yf + x, yb - w
            top_a = leave + ease_length(v, a, jf)
            top_b = max(arrive - ease_length(u, c, jb), top_a)
            r, y = rf, yf
            last = n - 1 - rb
            while True:
                if r > rf:
                    out_first[r] = count
                size = float(length[r])
                if y < top_a < y + size:
                    count = _put(size, r, top_a - y, level, 0.0, int(out_first[r]), count, out_row, out)
                if y < top_b < y + size:
                    count = _put(size, r, top_b - y, level, 0.0, int(out_first[r]), count, out_row, out)
                if r == last:
                    break
                end = y + size
                if end <= top_a:
                    t = place_time(end - leave, v, a, -jf)
                    v_node, a_node = v + t * (a - 0.5 * jf * t), max(a - jf * t, 0.0)
                elif end <= top_b:
                    v_node, a_node = level, 0.0
                else:
                    t = place_time(arrive - end, u, c, -jb)
                    v_node, a_node = u + t * (c - 0.5 * jb * t), -max(c - jb * t, 0.0)
                count = _put(size, r, size, v_node, a_node, int(out_first[r]), count, out_row, out)
                y = end
                r += 1
            size = float(length[last])
            count = _put(size, last, size - w, u, -c, int(out_first[last]), count, out_row, out)
            i, k = last, rb
            q = qb
            forward = False
        else:
            q = int(b_first[k + 1]) - 1
        run = float(length[i])
        while q >= b_first[k]:
            x, v, a = _start(b_first, b_pieces, b_entry, k, q)
            count = _put(run, i, run - x, v, -a, int(out_first[i]), count, out_row, out)
            q -= 1
        i += 1
        if i < n and _is_common(f_entry, i, b_entry, k):
            forward = True
            low_row = i
        if not forward and k > 0:
            q = int(b_first[k]) - 1
            if (
                b_entry[k, 1] != b_pieces[q, 2]
                or abs(b_pieces[q, 1] - b_entry[k, 0]) > _SAME * b_pieces[q, 1]
            ):
                return 0, -1
    out_first[n] = count
    return count, settled
