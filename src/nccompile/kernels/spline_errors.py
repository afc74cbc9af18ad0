"""How far a spline is from the chords it stands for: feet of the vertices and a bound along every chord.

     P(i-1) ●---------------●---------------● P(i)       D(s) = chord(s) - S(u(i-1) + s (u(i) - u(i-1)))
            |D0             |Dm             |D1
            '~ - . _ _ . - ~'~ - . _ _ . - ~'

D pairs each point of the chord with a point of the spline, both running forward, so the greatest |D| bounds the
distance of both ways.  D0, Dm, D1 are computed.  The parabola through them is above its chords by at most
b = |D0 - 2 Dm + D1| / 8 on each half, and from it D differs by at most max |D'''| max |s (s - 1/2) (s - 1)| / 6,
D''' = - S''' (u(i) - u(i-1))³; so, with e the greater and f the smaller end of a half,

     |D| <= (e + f) / 2 + b + (e - f)² / (16 b)   if e - f < 4 b, else e;     + 0.0081 max |D'''|

This holds with knots inside the chord too, as S'' is continuous.  Own derivation.
"""

from math import sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = ["axes_errors", "chord_errors"]

Floats = npt.NDArray[np.float64]

_REST = 0.0081  # a little more than max |s (s - 1/2) (s - 1)| / 6 = 0.008019
_SLOW = 0.05  # squared speed below which a step to the foot is cut short


@kernel
def _span_of(t: Floats, spans: int, span: int, x: float) -> int:
    """The span that holds the parameter x, looked for from one near it on."""
    while span < spans - 1 and x >= t[span + 4]:
        span += 1
    while span > 0 and x < t[span + 3]:
        span -= 1
    return span


@kernel
def _step(data: Floats, i: int, rows: Floats, span: int, v: float) -> float:
    """By how much v grows to the foot of data[i] on the cubic of a span, by one step of Newton's method."""
    step = 0.0
    square = 0.0
    for c in range(data.shape[1]):
        p1 = float(rows[span, 4 * c + 1])
        p2 = float(rows[span, 4 * c + 2])
        p3 = float(rows[span, 4 * c + 3])
        d = p1 + v * (2.0 * p2 + 3.0 * v * p3)
        step += d * (float(data[i, c]) - (float(rows[span, 4 * c]) + v * (p1 + v * (p2 + v * p3))))
        square += d * d
    return step / max(square, _SLOW)


@kernel
def _inside(
    off: Floats, off_before: Floats, bend: Floats, bend_before: Floats, h: float, dims: int
) -> tuple[float, float, float]:  # fmt: skip
    """(|Dm|, |D0 - 2 Dm + D1|, max |D'''|) of a chord of h in one span, from D and S'' at its ends."""
    middle = second = third = 0.0
    for c in range(dims):
        # of a cubic: D(1/2) = (D0 + D1) / 2 - (D''0 + D''1) / 16, D'' = - S'' h²
        sum_ = float(off[c]) + float(off_before[c])
        m = 0.5 * sum_ + 0.0625 * h * h * (float(bend[c]) + float(bend_before[c]))
        k = sum_ - 2.0 * m
        r = float(bend[c]) - float(bend_before[c])
        middle += m * m
        second += k * k
        third += r * r
    return sqrt(middle), sqrt(second), h * h * sqrt(third)


@kernel
def _across(
    points: Floats, i: int, off: Floats, off_before: Floats, t: Floats, rows: Floats, first: int, last: int,
    x_before: float, h: float,
) -> tuple[float, float, float]:  # fmt: skip
    """The same of the chord that ends at vertex i and runs over the knots between the spans first..last."""
    dims = points.shape[1]
    half = x_before + 0.5 * h
    j = first
    while j < last and half >= t[j + 4]:
        j += 1
    v = half - float(t[j + 3])
    middle = second = third = 0.0
    for c in range(dims):
        place = float(rows[j, 4 * c]) + v * (
            float(rows[j, 4 * c + 1]) + v * (float(rows[j, 4 * c + 2]) + v * float(rows[j, 4 * c + 3]))
        )
        m = 0.5 * (float(points[i, c]) + float(points[i - 1, c])) - place
        k = float(off[c]) + float(off_before[c]) - 2.0 * m
        middle += m * m
        second += k * k
    for j in range(first, last + 1):
        r = 0.0
        for c in range(dims):
            r += float(rows[j, 4 * c + 3]) * float(rows[j, 4 * c + 3])
        third = max(third, 6.0 * h * h * h * sqrt(r))
    return sqrt(middle), sqrt(second), third


@kernel
def _bound(far: float, far_before: float, middle: float, second: float, third: float) -> float:
    """The bound of |D| along a chord (see the module)."""
    bump = 0.125 * second
    bound = max(middle, far, far_before)
    for side in range(2):
        ends = far if side == 0 else far_before
        apart = abs(ends - middle)
        if 4.0 * bump > apart:
            bound = max(bound, 0.5 * (ends + middle) + bump + apart * apart / (16.0 * bump))
    return bound + _REST * third


@kernel
def chord_errors(
    points: Floats, data: Floats, t: Floats, spans: int, rows: Floats, u: Floats, tangent: Floats, errors: Floats,
    chords: bool,
) -> float:  # fmt: skip
    """Moves u to the feet of the data; fills tangents there and the error bound of each span; returns the greatest.

    Args:     points, data: Shape (n + 1, dims), the vertices and what the spline is fitted to;  t: padded knots;
              rows: Shape (spans, 4 dims);  u: Shape (n + 1,), in and out, ascending, within the knots; the first and
              the last stay;  tangent: Shape (n + 1, dims), out;  errors: Shape (>= spans,) [mm], out;  chords:
              whether the chords are looked at, or the vertices only (a guess, for some of the vertices of a run).
    """
    dims = points.shape[1]
    last = len(u) - 1
    for j in range(spans):
        errors[j] = 0.0
    speed = np.zeros(3)
    bend = np.zeros(3)
    off = np.zeros(3)
    bend_before = np.zeros(3)
    off_before = np.zeros(3)
    worst = 0.0
    span = 0
    x_before = float(u[0])
    end = float(u[last])
    span_before = 0
    far_before = 0.0
    for i in range(last + 1):
        x = float(u[i])
        if 0 < i < last:
            span = _span_of(t, spans, span, x)
            step = _step(data, i, rows, span, x - float(t[span + 3]))
            most = 0.5 * abs(float(u[i + 1]) - x_before)
            x = min(max(x + min(max(step, -most), most), x_before), end)
        span = _span_of(t, spans, span, x)
        u[i] = x
        v = x - float(t[span + 3])
        square = 0.0
        far = 0.0
        for c in range(dims):
            p1 = float(rows[span, 4 * c + 1])
            p2 = float(rows[span, 4 * c + 2])
            p3 = float(rows[span, 4 * c + 3])
            off[c] = float(points[i, c]) - (float(rows[span, 4 * c]) + v * (p1 + v * (p2 + v * p3)))
            speed[c] = p1 + v * (2.0 * p2 + 3.0 * v * p3)
            bend[c] = 2.0 * p2 + 6.0 * v * p3
            square += float(speed[c]) * float(speed[c])
            far += float(off[c]) * float(off[c])
        far = sqrt(far)
        square = sqrt(square)
        for c in range(dims):
            tangent[i, c] = float(speed[c]) / square if square > 0.0 else 0.0
        h = x - x_before
        quiet = i == 0
        if chords and i > 0 and span == span_before:
            # |D| is at most that of its ends and h² max |S''| / 8: most chords need no closer look.
            curved = 0.0
            curved_before = 0.0
            for c in range(dims):
                curved += float(bend[c]) * float(bend[c])
                curved_before += float(bend_before[c]) * float(bend_before[c])
            quiet = max(far, far_before) + 0.125 * h * h * sqrt(max(curved, curved_before)) <= errors[span]
        if not chords:
            # The data are half a sag off the vertices, so this is what chords between them would show.
            apart = 0.0
            near = 0.0
            for c in range(dims):
                moved = float(data[i, c]) - float(points[i, c])
                apart += moved * moved
                near += (float(off[c]) + moved) * (float(off[c]) + moved)
            bound = sqrt(near) + sqrt(apart)
            worst = max(worst, bound)
            errors[span] = max(float(errors[span]), bound)
        elif not quiet:
            if span == span_before:
                middle, second, third = _inside(off, off_before, bend, bend_before, h, dims)
            else:
                middle, second, third = _across(
                    points, i, off, off_before, t, rows, span_before, span, x_before, h
                )  # fmt: skip
            bound = _bound(far, far_before, middle, second, third)
            worst = max(worst, bound)
            for j in range(span_before, span + 1):
                errors[j] = max(float(errors[j]), bound)
        x_before = x
        span_before = span
        far_before = far
        for c in range(dims):
            off_before[c] = off[c]
            bend_before[c] = bend[c]
    return worst


@kernel
def axes_errors(extra: Floats, way: Floats, ends: Floats, spans: int, errors: Floats) -> float:
    """Raises the errors by what additional axes, linear in the way from knot to knot, miss; returns the greatest.

    Args:     extra: Shape (n + 1, m), additional axes;  way: Shape (n + 1,), along the chords;  ends: Shape
              (spans + 1,), the way at which the knots are.
    """
    worst = 0.0
    last = len(way) - 1
    for c in range(extra.shape[1]):
        at = 0
        value = float(extra[0, c])
        for j in range(spans):
            low = float(ends[j])
            high = float(ends[j + 1])
            if high <= low:
                continue
            end = at
            while end < last - 1 and way[end + 1] < high:
                end += 1
            share = (high - float(way[end])) / float(way[end + 1] - way[end])
            stop = float(extra[end, c]) + share * float(extra[end + 1, c] - extra[end, c])
            for i in range(at, end + 1):
                if low <= way[i] <= high:
                    linear = value + (float(way[i]) - low) / (high - low) * (stop - value)
                    off = abs(float(extra[i, c]) - linear)
                    errors[j] = max(float(errors[j]), off)
                    worst = max(worst, off)
            at = end
            value = stop
    return worst
