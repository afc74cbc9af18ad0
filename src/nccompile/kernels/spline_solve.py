"""Least squares for a spline and its knots, by distances across the curve: normal equations and their solution.

                 ● data(i)               A vertex is compared with the spline at its own parameter u(i), the foot of
                 |  e, across            the perpendicular.  Only the part of the error across the curve counts in
        _ . - ~ ~+~ ~ - . _              full, the part along it with the weight `along`: the parameters are free,
      S(u(i))----> tangent               so the spline may run along itself as it likes.

      sum w(i) (e' M e),  M = 1 - (1 - along) T T'        T: unit tangent of the spline before, at u(i)

Unknowns, block by block: the coordinates of control point i, then the move of the knot i - 1.  Each block couples with
three others, so the equations are a band, solved in place by L D L'.

Source:   W. Wang, H. Pottmann, Y. Liu, Fitting B-spline curves by squared distance minimization, 2006 ("tangent
distance"); moving knots: nccompile.kernels.spline_basis.
"""

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = ["assemble", "fix", "hold_knot", "lead", "solve"]

Floats = npt.NDArray[np.float64]

_SMOOTH = 1e-10  # weight of second differences of the coefficients: a span without vertices is still defined
_BOUND = 1e8  # times its own weight: how firmly a control point is bound to a line


@kernel
def assemble(
    data: Floats, u: Floats, weight: Floats, tangent: Floats, t: Floats, spans: int, basis: Floats, along: Floats,
    rows: Floats, stiff: Floats, moving: bool, first: int, step: int, band: Floats, right: Floats,
) -> None:  # fmt: skip
    """Fills band, Shape (>= (spans + 3) b, 4 b), upper, and right, Shape (>= (spans + 3) b,), with b = dims + 1.

    Args:     data, tangent: Shape (n + 1, dims);  u, weight: Shape (n + 1,);  t: padded knots;  basis: of
              `span_basis`;  rows: powers of the spline before, Shape (spans, 4 dims), its knots may move if
              `moving`;  along: Shape (spans,), weights;  stiff: Shape (spans,),
              squared error [mm²] that moving a knot by its span counts as;  first, step: which of the data count.
    """
    dims = data.shape[1]
    block = dims + 1
    width = 4 * block
    size = (spans + 3) * block
    for i in range(size):
        for d in range(width):
            band[i, d] = 0.0
        right[i] = 0.0
    used = 7 if moving else 4
    parts = dims * (dims + 1) // 2
    metric = np.zeros(6)
    gram = np.zeros((6, 28))
    products = np.zeros(28)
    force = np.zeros((7, 3))
    value = np.zeros(7)
    pulled = np.zeros(3)
    jump = np.zeros((3, 3))
    last = len(u) - 1
    i = first
    for j in range(spans):
        for m in range(parts):
            for k in range(28):
                gram[m, k] = 0.0
        for a in range(7):
            for c in range(dims):
                force[a, c] = 0.0
        end = float(t[j + 4])
        begin = float(t[j + 3])
        mass = 0.0
        keep = 1.0 - float(along[j])
        while i <= last and (u[i] < end or j == spans - 1):
            v = float(u[i]) - begin
            for a in range(used):
                value[a] = float(basis[j, a, 0]) + v * (
                    float(basis[j, a, 1]) + v * (float(basis[j, a, 2]) + v * float(basis[j, a, 3]))
                )
            w = float(weight[i])
            mass += w
            k = 0
            less = w * keep
            for c in range(dims):
                pull = less * float(tangent[i, c])
                for e in range(c, dims):
                    metric[k] = -pull * float(tangent[i, e])
                    k += 1
            if dims == 2:
                metric[0] += w
                metric[2] += w
                pulled[0] = metric[0] * float(data[i, 0]) + metric[1] * float(data[i, 1])
                pulled[1] = metric[1] * float(data[i, 0]) + metric[2] * float(data[i, 1])
            else:
                metric[0] += w
                metric[3] += w
                metric[5] += w
                x = float(data[i, 0])
                y = float(data[i, 1])
                z = float(data[i, 2])
                pulled[0] = metric[0] * x + metric[1] * y + metric[2] * z
                pulled[1] = metric[1] * x + metric[3] * y + metric[4] * z
                pulled[2] = metric[2] * x + metric[4] * y + metric[5] * z
            k = 0
            for a in range(used):
                va = float(value[a])
                for c in range(dims):
                    force[a, c] += va * float(pulled[c])
                for b in range(a, used):
                    products[k] = va * float(value[b])
                    k += 1
            pairs = k
            for m in range(parts):
                w = float(metric[m])
                for k in range(pairs):
                    gram[m, k] += w * float(products[k])
            i += step
        if moving:
            for p in range(3):
                knot = j - 1 + p
                for c in range(dims):
                    jump[p, c] = 0.0
                    if 0 < knot < spans:
                        jump[p, c] = 6.0 * float(rows[knot, 4 * c + 3] - rows[knot - 1, 4 * c + 3])
        k = 0
        for a in range(used):
            # The unknowns a = 4.. are single ones, the knots; their direction is the jump there.
            row = (j + a) * block if a < 4 else (j + a - 4) * block + dims
            if a < 4:
                for c in range(dims):
                    right[row + c] += float(force[a, c])
            else:
                for c in range(dims):
                    right[row] += float(jump[a - 4, c]) * float(force[a, c])
            for b in range(a, used):
                other = (j + b) * block if b < 4 else (j + b - 4) * block + dims
                for c in range(dims):
                    for e in range(dims):
                        low = min(c, e)
                        m = low * dims - low * (low - 1) // 2 + max(c, e) - low
                        part = float(gram[m, k])
                        if b < 4:
                            if b > a or e >= c:
                                band[row + c, other + e - row - c] += part
                        elif a < 4:
                            part *= float(jump[b - 4, e])
                            if other >= row + c:
                                band[row + c, other - row - c] += part
                            else:
                                band[other, row + c - other] += part
                        else:
                            band[row, other - row] += part * float(jump[a - 4, c]) * float(jump[b - 4, e])
                k += 1
        if moving:
            hold = float(stiff[j]) * mass / ((end - begin) * (end - begin))
            for p in range(2):
                if 0 < j + p < spans:
                    band[(j + p + 1) * block + dims, 0] += hold
    mean = 0.0
    for i in range(size):
        mean += float(band[i, 0])
    w = _SMOOTH * mean / size
    for i in range(spans + 3):
        scalar = i * block + dims
        if not moving or not 2 <= i <= spans or band[scalar, 0] <= 0.0:
            _clear(band, right, size, scalar, 0.0)
        if i < spans + 1:
            for c in range(dims):
                row = i * block + c
                band[row, 0] += w
                band[row, block] -= 2.0 * w
                band[row, 2 * block] += w
                band[row + block, 0] += 4.0 * w
                band[row + block, block] -= 2.0 * w
                band[row + 2 * block, 0] += w


@kernel
def _clear(band: Floats, right: Floats, size: int, at: int, value: float) -> None:
    """Takes the unknown `at` out of the equations: it is `value`."""
    width = band.shape[1]
    for d in range(1, width):
        if at + d < size:
            right[at + d] -= float(band[at, d]) * value
            band[at, d] = 0.0
        if at - d >= 0:
            right[at - d] -= float(band[at - d, d]) * value
            band[at - d, d] = 0.0
    band[at, 0] = 1.0
    right[at] = value


@kernel
def fix(band: Floats, right: Floats, spans: int, point: int, place: Floats) -> None:
    """Takes a control point out of the equations: it is at `place`, Shape (dims,)."""
    dims = len(place)
    for c in range(dims):
        _clear(band, right, (spans + 3) * (dims + 1), point * (dims + 1) + c, float(place[c]))


@kernel
def hold_knot(band: Floats, right: Floats, spans: int, dims: int, knot: int) -> None:
    """Takes the move of a knot, 1..spans - 1, out of the equations: it stays."""
    _clear(band, right, (spans + 3) * (dims + 1), (knot + 1) * (dims + 1) + dims, 0.0)


@kernel
def lead(band: Floats, right: Floats, point: int, place: Floats, direction: Floats) -> None:
    """Binds a control point to the line through `place` along the unit `direction`, by a weight of 1e8."""
    dims = len(place)
    row = point * (dims + 1)
    most = 0.0
    for c in range(dims):
        most = max(most, float(band[row + c, 0]))
    weight = _BOUND * most
    for c in range(dims):
        for e in range(dims):
            part = -weight * float(direction[c]) * float(direction[e])
            if c == e:
                part += weight
            if e >= c:
                band[row + c, e - c] += part
            right[row + c] += part * float(place[e])


@kernel
def solve(band: Floats, right: Floats, size: int) -> bool:
    """The unknowns into `right`; false if the equations have no single solution."""
    width = band.shape[1]
    for i in range(size):
        pivot = float(band[i, 0])
        if not pivot > 0.0:
            return False
        top = min(width, size - i)
        for d in range(1, top):
            factor = float(band[i, d]) / pivot
            if factor != 0.0:
                for e in range(d, top):
                    band[i + d, e - d] -= factor * float(band[i, e])
                right[i + d] -= factor * float(right[i])
    for i in range(size - 1, -1, -1):
        value = float(right[i])
        top = min(width, size - i)
        for d in range(1, top):
            value -= float(band[i, d]) * float(right[i + d])
        right[i] = value / float(band[i, 0])
    return True
