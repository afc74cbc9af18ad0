"""A run of small lines becomes a C2 cubic spline with few pieces: the kernel of the pass `fit-splines`.

     |   .-●-.       |      ●-.       Least squares by distances across the curve (kernels/spline_solve), in turns
     | ●'     '●-.   |  .-●'          with the knots free to move and with the knots held; the vertices look for their
     |/           '●-|-'              feet on the spline in between, so neither knots nor parameters are given.
     t(j)          t(j+1)

Where a span is too far off (kernels/spline_errors), a knot is put into its middle and the spans around it are
solved again, while the rest of the spline stands still (kernels/spline_windows).

Source:   W. Wang, H. Pottmann, Y. Liu, Fitting B-spline curves by squared distance minimization, 2006;
          C. de Boor, A Practical Guide to Splines, 1978, chapters X, XIV; windows and moving knots: own derivation.
"""

from math import ceil, inf

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel
from nccompile.kernels.spline_basis import pad_knots
from nccompile.kernels.spline_errors import axes_errors, chord_errors
from nccompile.kernels.spline_samples import count_samples, fill_samples
from nccompile.kernels.spline_windows import HELD, damp_window, measure_window, solve_window

__all__ = ["fit_spline"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_FIRST = 0.65  # part of the spans that a first guess asks for
_ORDER = 0.2  # errors fall with the fifth power of the span
_TURNS = 6  # of knots moving and knots held, for one window
_IDLE = 0.97  # of the error before: a turn that leaves more was the last one
_CYCLES = 30  # of inserting knots
_ROUGH = 200.0  # times the tolerance: a spline so far off tells nothing of where its knots should be
_FRESH = 0.1  # weight of errors along the curve when knots are new,
_ALONG = 0.01  # once they are not, knots held,
_ALONG_MOVING = 0.001  # and knots moving
_AROUND = 4  # spans around a new knot that are solved again
_NEAR = 3  # spans around a new knot that get no other one, 1 where the error is
_FAR = 10.0  # times the tolerance
_ENOUGH = 12.0  # samples a span of the first guess that the least squares look at
_SAMPLES = 25.0  # samples a span of the first guess, at least; four times as many if that fails


@kernel
def _insert(
    t: Floats,
    spans: int,
    rows: Floats,
    errors: Floats,
    tolerance: float,
    most: int,
    fresh: npt.NDArray[np.bool_],
) -> int:
    """Puts knots into the middle of the worst spans, each some spans from the next; returns the new number of spans.

    fresh: which spans are new, out.  Powers and errors of cut spans follow; 0 if there would be more than `most`.
    """
    cut = np.zeros(spans, np.bool_)
    taken = np.zeros(spans, np.bool_)
    count = 0
    while True:
        j = -1
        worst = tolerance
        for i in range(spans):
            if errors[i] > worst and not taken[i]:
                worst = float(errors[i])
                j = i
        if j < 0:
            break
        near = 1 if errors[j] > _FAR * tolerance else _NEAR
        cut[j] = True
        count += 1
        for i in range(max(j - near, 0), min(j + near + 1, spans)):
            taken[i] = True
    if spans + count > most:
        return 0
    to = spans + count
    for i in range(3):
        t[to + 4 + i] = t[spans + 3]
    t[to + 3] = t[spans + 3]
    for j in range(spans - 1, -1, -1):
        start = float(t[j + 3])
        if cut[j]:
            half = 0.5 * float(t[to + 3] - start)
            for i in range(2):
                at = to - 1 - i
                fresh[at] = True
                errors[at] = errors[j]
            for c in range(rows.shape[1] // 4):
                p0 = float(rows[j, 4 * c])
                p1 = float(rows[j, 4 * c + 1])
                p2 = float(rows[j, 4 * c + 2])
                p3 = float(rows[j, 4 * c + 3])
                rows[to - 1, 4 * c] = p0 + half * (p1 + half * (p2 + half * p3))
                rows[to - 1, 4 * c + 1] = p1 + half * (2.0 * p2 + 3.0 * half * p3)
                rows[to - 1, 4 * c + 2] = p2 + 3.0 * half * p3
                rows[to - 1, 4 * c + 3] = p3
                rows[to - 2, 4 * c] = p0
                rows[to - 2, 4 * c + 1] = p1
                rows[to - 2, 4 * c + 2] = p2
                rows[to - 2, 4 * c + 3] = p3
            t[to + 2] = start + half
            t[to + 1] = start
            to -= 2
        else:
            fresh[to - 1] = False
            errors[to - 1] = errors[j]
            for c in range(rows.shape[1]):
                rows[to - 1, c] = rows[j, c]
            t[to + 2] = start
            to -= 1
    return spans + count


@kernel
def _guess(points: Floats, way: Floats, tolerance: float, states: Floats) -> int:
    """Roughly how many spans a run needs, or some fewer: from fits to a few of its vertices, knots evenly spaced."""
    kinds = np.zeros(2, np.int64)
    n = len(way) - 1
    dims = points.shape[1]
    spans = min(n, 1)
    for _ in range(12):
        stride = max(1, n // (8 * spans))
        count = (n + stride - 1) // stride + 1
        few = np.zeros((count, dims))
        short = np.zeros(count)
        for i in range(count):
            at = min(i * stride, n)
            short[i] = way[at]
            for c in range(dims):
                few[i, c] = points[at, c]
        places, data, tangent = np.zeros((count, dims)), np.zeros((count, dims)), np.zeros((count, dims))
        u, weight = np.zeros(count), np.zeros(count)
        fill_samples(few, short, inf, tolerance, places, data, u, weight, tangent)
        t, rows, errors = np.zeros(spans + 7), np.zeros((spans, 4 * dims)), np.zeros(spans)
        _even_knots(float(way[n]), spans, t)
        along = np.full(spans, _FRESH)
        for _turn in range(2):
            window = np.array([0, spans - 1, 1, 0])
            if not solve_window(
                places, u, weight, tangent, t, spans, rows, window, along, along, kinds, states
            ):
                return spans
            chord_errors(places, places, t, spans, rows, u, tangent, errors, window[3] > 0)
        total = 0.0
        for j in range(spans):
            total += float(np.exp(_ORDER * np.log(max(float(errors[j]) / tolerance, 1e-3))))
        wanted = ceil(_FIRST * total)
        if wanted <= 1.15 * spans:
            break
        spans = min(wanted, max(1, n // 2), 4 * spans)
    return spans


@kernel
def _even_knots(extent: float, spans: int, t: Floats) -> None:
    knots = np.zeros(spans + 1)
    for i in range(spans + 1):
        knots[i] = extent * i / spans
    pad_knots(knots, spans, t)


@kernel
def _ways(samples: Floats, u: Floats, t: Floats, spans: int, ends: Floats) -> None:
    """Fills the way along the chords at each knot: samples, Shape (m,), at parameters u."""
    i = 1
    last = len(u) - 1
    for j in range(spans + 1):
        x = float(t[j + 3])
        while i < last and u[i] < x:
            i += 1
        size = float(u[i] - u[i - 1])
        part = min(max((x - float(u[i - 1])) / size, 0.0), 1.0) if size > 0.0 else 0.0
        ends[j] = float(samples[i - 1]) + part * float(samples[i] - samples[i - 1])
    ends[0] = samples[0]
    ends[spans] = samples[last]


@kernel
def _next_window(fresh: npt.NDArray[np.bool_], spans: int, a: int, window: Ints) -> bool:
    """Finds the first and last span of the next window that has fresh ones from span a on; false if none has."""
    while a < spans and not fresh[a]:
        a += 1
    b = a
    j = a
    while j < min(b + 2 * _AROUND + 2, spans):
        if fresh[j]:
            b = j
        j += 1
    window[0] = max(a - _AROUND, 0)
    window[1] = min(b + _AROUND, spans - 1)
    return a < spans


@kernel
def fit_spline(
    points: Floats, extra: Floats, way: Floats, tolerance: float, kinds: Ints, states: Floats, ends: Floats,
    rows: Floats, most: int,
) -> int:  # fmt: skip
    """The number of cubics, with few of them, that keep the tolerance along a run; 0 if none was found.

    Args:     points: Shape (n + 1, dims), vertices, dims 2 or 3;  extra: Shape (n + 1, m), additional axes;  way:
              Shape (n + 1,), along the chords, ascending from 0;  kinds: Shape (2,), FREE, LED or HELD at the
              start and the end;  states: Shape (2, 4 dims), position, direction (unit), half the second derivative
              by the way and 0 there, by coordinates;  most: greatest number of cubics;
              ends: Shape (most + 1,), out, the way at which they end;  rows: Shape (most, 4 dims), out: powers of
              the share 0..1 of each.

    Up to three attempts: as described above, with more points in between, and carefully: knots stay in the middle
    of the spans that they cut, errors count the same in all directions.
    """
    dims = points.shape[1]
    extent = float(way[len(way) - 1])
    first = _guess(points, way, tolerance, states)
    # Three control points are held at a HELD end, and at least the two at the end otherwise bound.
    for side in range(2):
        if kinds[side] == HELD:
            first = max(first, 2 if kinds[1 - side] != HELD else 3)
    if first > most:
        return 0
    t, errors, fresh = np.zeros(most + 7), np.zeros(most), np.ones(most, np.bool_)
    along, stiff, window = np.zeros(most), np.zeros(most), np.zeros(4, np.int64)
    for attempt in range(3):
        careful = attempt == 2
        spacing = extent / (first * _SAMPLES * (1.0 if attempt == 0 else 4.0))
        m = count_samples(way, spacing)
        places, data, tangent = np.zeros((m, dims)), np.zeros((m, dims)), np.zeros((m, dims))
        u, weight = np.zeros(m), np.zeros(m)
        fill_samples(points, way, spacing, tolerance, places, data, u, weight, tangent)
        samples = u.copy()
        window[2] = max(1, m // int(first * _ENOUGH))
        spans = first
        _even_knots(extent, spans, t)
        for j in range(spans):
            errors[j] = inf
            fresh[j] = True
        solved = True
        for _cycle in range(_CYCLES):
            after = 0
            while solved and _next_window(fresh, spans, after, window):
                a = int(window[0])
                b = int(window[1])
                after = b - _AROUND + 1 if b < spans - 1 else spans
                for j in range(a, b + 1):
                    along[j] = 1.0 if careful else _FRESH
                worst = inf
                for turn in range(2 * _TURNS + 1):
                    # Even turns hold the knots and look at the errors, odd ones move them.
                    rough = careful or worst > _ROUGH * tolerance
                    window[3] = turn % 2
                    if turn % 2 == 1 and rough:
                        continue
                    if turn > 0 and not careful:
                        least = _ALONG if turn % 2 == 0 else _ALONG_MOVING
                        damp_window(t, spans, errors, a, b, tolerance, least, along, stiff)
                    solved = solve_window(
                        data, u, weight, tangent, t, spans, rows, window, along, stiff, kinds, states
                    )
                    if not solved:
                        break
                    if turn % 2 == 0:
                        before = worst
                        worst = measure_window(places, data, u, tangent, t, spans, rows, errors, a, b)
                        idle = turn >= 4 and (rough or worst > _IDLE * before)
                        if worst <= tolerance or idle:
                            break
            if not solved:
                break
            worst = 0.0
            for j in range(spans):
                worst = max(worst, float(errors[j]))
            _ways(samples, u, t, spans, ends)
            if worst <= tolerance and extra.shape[1] > 0:
                worst = axes_errors(extra, way, ends, spans, errors)
            if worst <= tolerance:
                _share_powers(t, spans, dims, rows)
                return spans
            spans = _insert(t, spans, rows, errors, tolerance, most, fresh)
            if spans == 0:
                break
    return 0


@kernel
def _share_powers(t: Floats, spans: int, dims: int, rows: Floats) -> None:
    """Turns powers of u - t(j) into powers of the share 0..1 of each span."""
    for j in range(spans):
        h = float(t[j + 4] - t[j + 3])
        for c in range(dims):
            rows[j, 4 * c + 1] *= h
            rows[j, 4 * c + 2] *= h * h
            rows[j, 4 * c + 3] *= h * h * h
