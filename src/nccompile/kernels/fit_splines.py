"""A run of small lines becomes a C2 cubic spline: the kernel of the pass `fit-splines`.

    S(tau) = sum c(i) B(i, tau)      cubic B-splines on the knots t(0) < t(1) < ... < t(K), tau: way along the chords

     |   .-●-.       |      ●-.       Least squares for the vertices, weighted with the way they stand for; both
     | ●'     '●-.   |  .-●'          ends exact.  With h the length of a span, its error is about C h⁴, so from
     |/           '●-|-'              the error e(j) measured on each span
     t(j)          t(j+1)                 N = sum (e(j) / tolerance)^(1/4)
                                      spans are needed, at places where they all have the same error: knots
    are spread by that density and the spline is solved again, until the tolerance holds, then with fewer.

The chords of a run lie inside the curve that they stand for, so the vertices are moved inwards by half the sag
before the fit: the spline then runs in the middle of the band.  Errors are measured from the chords as they are:
at every vertex (after one step to the nearest place), at the middle of every chord and with a bound between
them, so they bound the distance of chord and spline both ways.

Source:   C. de Boor, A Practical Guide to Splines, 1978, chapters X, XII (knots by equal error), XIV.
"""

from math import sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = ["fit_spline"]

Floats = npt.NDArray[np.float64]

_ROUNDS = 12
_FLOOR = 1e-3  # part of the tolerance below which an error says nothing of the span it needs
_SMOOTH = 1e-10  # weight of second differences of the coefficients: a span without vertices is still defined


@kernel
def _assemble(points: Floats, tau: Floats, t: Floats, spans: int, band: Floats, right: Floats) -> None:
    """Normal equations of the least squares; t: padded knots, Shape (spans + 7,); band: upper, Shape (N, 4)."""
    n = len(tau) - 1
    count = spans + 3
    for i in range(count):
        for d in range(4):
            band[i, d] = 0.0
        for c in range(3):
            right[i, c] = 0.0
    basis = np.zeros(4)
    span = 0
    for i in range(n + 1):
        x = float(tau[i])
        while span < spans - 1 and x >= t[span + 4]:
            span += 1
        # Cox-de Boor on the four B-splines that live on this span.
        basis[0] = 1.0
        for degree in range(1, 4):
            saved = 0.0
            for r in range(degree):
                high = float(t[span + 4 + r])
                low = float(t[span + 4 + r - degree])
                part = float(basis[r]) / (high - low)
                basis[r] = saved + (high - x) * part
                saved = (x - low) * part
            basis[degree] = saved
        before = float(tau[i - 1]) if i > 0 else x
        after = float(tau[i + 1]) if i < n else x
        weight = after - before
        for a in range(4):
            wa = weight * float(basis[a])
            for b in range(a, 4):
                band[span + a, b - a] += wa * float(basis[b])
            for c in range(3):
                right[span + a, c] += wa * float(points[i, c])
    mean = 0.0
    for i in range(count):
        mean += float(band[i, 0])
    weight = _SMOOTH * mean / count
    for i in range(count - 2):
        band[i, 0] += weight
        band[i, 1] -= 2.0 * weight
        band[i, 2] += weight
        band[i + 1, 0] += 4.0 * weight
        band[i + 1, 1] -= 2.0 * weight
        band[i + 2, 0] += weight


@kernel
def _solve(points: Floats, spans: int, band: Floats, right: Floats) -> bool:
    """Coefficients into `right`; the first and last are the end vertices.  Banded Cholesky, in place."""
    count = spans + 3
    last = len(points) - 1
    for end in range(2):
        at = 0 if end == 0 else count - 1
        for d in range(1, 4):
            other = at + d if end == 0 else at - d
            if 0 <= other < count:
                value = float(band[at, d]) if end == 0 else float(band[other, d])
                for c in range(3):
                    right[other, c] -= value * float(points[0 if end == 0 else last, c])
                if end == 0:
                    band[at, d] = 0.0
                else:
                    band[other, d] = 0.0
        band[at, 0] = 1.0
        for c in range(3):
            right[at, c] = points[0 if end == 0 else last, c]
    for i in range(count):
        pivot = float(band[i, 0])
        for k in range(1, 4):
            if i - k >= 0:
                pivot -= float(band[i - k, k]) * float(band[i - k, k])
        if pivot <= 0.0:
            return False
        root = sqrt(pivot)
        band[i, 0] = root
        for d in range(1, 4):
            if i + d < count:
                value = float(band[i, d])
                for k in range(1, 4 - d):
                    if i - k >= 0:
                        value -= float(band[i - k, k]) * float(band[i - k, k + d])
                band[i, d] = value / root
    for c in range(3):
        for i in range(count):
            value = float(right[i, c])
            for k in range(1, 4):
                if i - k >= 0:
                    value -= float(band[i - k, k]) * float(right[i - k, c])
            right[i, c] = value / float(band[i, 0])
        for i in range(count - 1, -1, -1):
            value = float(right[i, c])
            for k in range(1, 4):
                if i + k < count:
                    value -= float(band[i, k]) * float(right[i + k, c])
            right[i, c] = value / float(band[i, 0])
    return True


@kernel
def _pieces(t: Floats, spans: int, control: Floats, rows: Floats) -> None:
    """Each span as powers of tau - t(j): rows, Shape (spans, 12), four numbers a coordinate."""
    for j in range(spans):
        u = float(t[j + 3])
        h = float(t[j + 4]) - u
        for c in range(3):
            c0 = float(control[j, c])
            c1 = float(control[j + 1, c])
            c2 = float(control[j + 2, c])
            c3 = float(control[j + 3, c])
            e0 = 3.0 * (c1 - c0) / float(t[j + 4] - t[j + 1])
            e1 = 3.0 * (c2 - c1) / float(t[j + 5] - t[j + 2])
            e2 = 3.0 * (c3 - c2) / float(t[j + 6] - t[j + 3])
            f0 = 2.0 * (e1 - e0) / float(t[j + 4] - t[j + 2])
            f1 = 2.0 * (e2 - e1) / float(t[j + 5] - t[j + 3])
            share = float(u - t[j + 2]) / float(t[j + 4] - t[j + 2])
            a = c0 + float(u - t[j + 1]) / float(t[j + 4] - t[j + 1]) * (c1 - c0)
            b = c1 + float(u - t[j + 2]) / float(t[j + 5] - t[j + 2]) * (c2 - c1)
            rows[j, 4 * c] = a + share * (b - a)
            rows[j, 4 * c + 1] = e0 + share * (e1 - e0)
            rows[j, 4 * c + 2] = 0.5 * f0
            rows[j, 4 * c + 3] = (f1 - f0) / (6.0 * h)


@kernel
def _off(points: Floats, i: int, c: int, rows: Floats, j: int, v: float) -> tuple[float, float]:
    """Coordinate c of (middle of the chord that ends in vertex i) - S, and of S', at v behind the start of span j."""
    p1 = float(rows[j, 4 * c + 1])
    p2 = float(rows[j, 4 * c + 2])
    p3 = float(rows[j, 4 * c + 3])
    middle = 0.5 * (float(points[i - 1, c]) + float(points[i, c]))
    place = float(rows[j, 4 * c]) + v * (p1 + v * (p2 + v * p3))
    return middle - place, p1 + v * (2.0 * p2 + 3.0 * v * p3)


@kernel
def _errors(
    points: Floats, tau: Floats, t: Floats, spans: int, rows: Floats, errors: Floats, needs: Floats
) -> float:  # fmt: skip
    """Fills the error bound of each span [mm] (see the module) and how many spans it should be.

    Between the vertices of a chord, at e0 and e1 off the spline, its middle is (e0 + e1) / 2 + |chord|² / 8 S''
    off; between these three places a quarter of the sag may come on top.  Returns the greatest error.
    """
    last = len(tau) - 1
    for j in range(spans):
        errors[j] = 0.0
        needs[j] = 0.0
    worst = 0.0
    span = 0
    before = 0.0
    bend_before = 0.0
    vx = vy = vz = 0.0
    ex = ey = ez = 0.0
    wx = wy = wz = 0.0
    bx = by = bz = 0.0
    for i in range(last + 1):
        x = float(tau[i])
        while span < spans - 1 and x > t[span + 4]:
            span += 1
        v = x - float(t[span + 3])
        p1 = float(rows[span, 1])
        p2 = float(rows[span, 2])
        p3 = float(rows[span, 3])
        ex = float(points[i, 0]) - (float(rows[span, 0]) + v * (p1 + v * (p2 + v * p3)))
        sx = p1 + v * (2.0 * p2 + 3.0 * v * p3)
        bx = 2.0 * p2 + 6.0 * v * p3
        p1 = float(rows[span, 5])
        p2 = float(rows[span, 6])
        p3 = float(rows[span, 7])
        ey = float(points[i, 1]) - (float(rows[span, 4]) + v * (p1 + v * (p2 + v * p3)))
        sy = p1 + v * (2.0 * p2 + 3.0 * v * p3)
        by = 2.0 * p2 + 6.0 * v * p3
        p1 = float(rows[span, 9])
        p2 = float(rows[span, 10])
        p3 = float(rows[span, 11])
        ez = float(points[i, 2]) - (float(rows[span, 8]) + v * (p1 + v * (p2 + v * p3)))
        sz = p1 + v * (2.0 * p2 + 3.0 * v * p3)
        bz = 2.0 * p2 + 6.0 * v * p3
        ss = sx * sx + sy * sy + sz * sz
        bend = sqrt(bx * bx + by * by + bz * bz)
        step = 0.0
        if ss > 0.25 and 0 < i < last:
            step = (ex * sx + ey * sy + ez * sz) / ss
            ex -= step * sx
            ey -= step * sy
            ez -= step * sz
        off = sqrt(ex * ex + ey * ey + ez * ez) + 0.5 * bend * step * step
        if i > 0:
            size = x - float(tau[i - 1])
            sag = 0.0625 * size * size  # of the mean of both second derivatives
            mx = 0.5 * (ex + vx) + sag * (bx + wx)
            my = 0.5 * (ey + vy) + sag * (by + wy)
            mz = 0.5 * (ez + vz) + sag * (bz + wz)
            most_bend = max(bend, bend_before)
            if t[span + 3] > tau[i - 1]:
                # A joint inside the chord: S'' has a corner there, so the middle is looked up.
                j = span
                while t[j + 3] > tau[i - 1]:
                    kx = float(rows[j, 2])
                    ky = float(rows[j, 6])
                    kz = float(rows[j, 10])
                    most_bend = max(most_bend, 2.0 * sqrt(kx * kx + ky * ky + kz * kz))
                    j -= 1
                v = x - 0.5 * size
                j = span
                while t[j + 3] > v:
                    j -= 1
                v -= float(t[j + 3])
                mx, nx = _off(points, i, 0, rows, j, v)
                my, ny = _off(points, i, 1, rows, j, v)
                mz, nz = _off(points, i, 2, rows, j, v)
                along = (mx * nx + my * ny + mz * nz) / max(nx * nx + ny * ny + nz * nz, 0.25)
                mx -= along * nx
                my -= along * ny
                mz -= along * nz
            middle = sqrt(mx * mx + my * my + mz * mz)
            bump = 0.5 * sag * most_bend  # of each half
            bound = max(off, before, middle)
            for half in range(2):
                ax = ex - mx if half == 0 else vx - mx
                ay = ey - my if half == 0 else vy - my
                az = ez - mz if half == 0 else vz - mz
                apart = sqrt(ax * ax + ay * ay + az * az)
                if 4.0 * bump > apart:
                    most = max(middle, off if half == 0 else before)
                    bound = max(bound, most + bump + apart * apart / (16.0 * bump) - 0.5 * apart)
            worst = max(worst, bound)
            j = span
            while True:
                errors[j] = max(float(errors[j]), bound)
                needs[j] = max(float(needs[j]), sag * most_bend)
                if j == 0 or t[j + 3] <= tau[i - 1]:
                    break
                j -= 1
        before = off
        bend_before = bend
        vx = ex
        vy = ey
        vz = ez
        wx = bx
        wy = by
        wz = bz
    return worst


@kernel
def _axes(points: Floats, tau: Floats, t: Floats, spans: int, errors: Floats) -> float:
    """Raises the errors by what additional axes, linear from knot to knot, miss; returns the greatest of that."""
    k = points.shape[1]
    worst = 0.0
    for c in range(3, k):
        at = 0
        value = float(points[0, c])
        for j in range(spans):
            low = float(t[j + 3])
            high = float(t[j + 4])
            end = at
            while end < len(tau) - 2 and tau[end + 1] < high:
                end += 1
            share = (high - float(tau[end])) / float(tau[end + 1] - tau[end])
            stop = float(points[end, c]) + share * float(points[end + 1, c] - points[end, c])
            for i in range(at, end + 1):
                if low <= tau[i] <= high:
                    linear = value + (float(tau[i]) - low) / (high - low) * (stop - value)
                    off = abs(float(points[i, c]) - linear)
                    errors[j] = max(float(errors[j]), off)
                    worst = max(worst, off)
            at = end
            value = stop
    return worst


@kernel
def _density(errors: Floats, needs: Floats, spans: int, tolerance: float) -> float:
    """Turns `needs` (the sag between data, which no knot lowers) into spans needed for each; returns their sum."""
    for j in range(spans):
        sag = min(float(needs[j]), 0.7 * tolerance)
        part = max(float(errors[j]) - sag, 0.0) / (tolerance - sag)
        needs[j] = sqrt(sqrt(max(part, _FLOOR)))
    # An error is an oscillation through several spans: neighbours share their needs.
    total = 0.0
    before = float(needs[0])
    for j in range(spans):
        here = float(needs[j])
        after = float(needs[j + 1]) if j + 1 < spans else here
        needs[j] = 0.25 * before + 0.5 * here + 0.25 * after
        before = here
        total += float(needs[j])
    return total


@kernel
def _pad(knots: Floats, spans: int, t: Floats) -> None:
    """The knots with the end ones repeated: Shape (spans + 7,)."""
    for i in range(3):
        t[i] = knots[0]
        t[spans + 4 + i] = knots[spans]
    for i in range(spans + 1):
        t[3 + i] = knots[i]


@kernel
def _spread(knots: Floats, spans: int, needs: Floats, total: float, wanted: int, out: Floats) -> None:
    """Knots at equal shares of the spans needed."""
    out[0] = knots[0]
    j = 0
    done = 0.0
    for i in range(1, wanted):
        goal = total * i / wanted
        while j < spans - 1 and done + needs[j] < goal:
            done += float(needs[j])
            j += 1
        out[i] = float(knots[j]) + (goal - done) / float(needs[j]) * float(knots[j + 1] - knots[j])
    out[wanted] = knots[spans]


@kernel
def fit_spline(
    points: Floats, data: Floats, tau: Floats, tolerance: float, knots: Floats, rows: Floats, most: int
) -> int:  # fmt: skip
    """The number of cubics, with few of them, that keep the tolerance along a run; 0 if none was found.

    Args:     points: Shape (n + 1, >= 3), vertices and additional axes;  data: Shape (n + 1, 3), what the
              spline is fitted to: the vertices, moved half the sag of their chords;  tau: Shape (n + 1,), way
              along the chords, ascending from 0;  most: greatest number of pieces;
              knots: Shape (most + 1,), out;  rows: Shape (most, 12), out: coefficients over the share 0..1 of
              each span, four a coordinate.
    """
    cap = most + 8
    last = len(tau) - 1
    t = np.zeros(cap)
    band = np.zeros((cap, 4))
    right = np.zeros((cap, 3))
    errors = np.zeros(cap)
    needs = np.zeros(cap)
    trial = np.zeros((cap, 12))
    now = np.zeros(cap)
    fresh = np.zeros(cap)
    spans = min(max(last // 24, 1), most)
    for i in range(spans + 1):
        now[i] = float(tau[last]) * i / spans
    found = 0
    failed = 0
    for _ in range(_ROUNDS):
        _pad(now, spans, t)
        _assemble(data, tau, t, spans, band, right)
        if not _solve(data, spans, band, right):
            break
        _pieces(t, spans, right, trial)
        worst = _errors(points, tau, t, spans, trial, errors, needs)
        worst = max(worst, _axes(points, tau, t, spans, errors))
        total = _density(errors, needs, spans, tolerance)
        if worst <= tolerance:
            failed = 0
            found = spans
            for i in range(spans + 1):
                knots[i] = now[i]
            for j in range(spans):
                for c in range(12):
                    rows[j, c] = trial[j, c]
            wanted = min(int(total) + 1, spans - 1 - spans // 64)
        else:
            failed += 1
            if found > 0:
                wanted = spans if failed < 3 else (spans + found) // 2
                if wanted == spans and failed > 3:
                    break
            else:
                wanted = max(int(total * (1.0 + 0.02 * failed)) + 1, spans + (0 if failed < 4 else 1))
        if wanted > most or wanted < 1:
            break
        _spread(now, spans, needs, total, wanted, fresh)
        spans = wanted
        for i in range(spans + 1):
            now[i] = fresh[i]
    for j in range(found):
        h = float(knots[j + 1] - knots[j])
        for c in range(3):
            rows[j, 4 * c + 1] *= h
            rows[j, 4 * c + 2] *= h * h
            rows[j, 4 * c + 3] *= h * h * h
    return found
