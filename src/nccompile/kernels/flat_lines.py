"""Lines in place of curves: few of them that keep a length, a bend or a distance from the curve.

share  0 ───┬──┬─┬┬─┬──┬─── 1       the curve is looked at in small steps, each weighs its bend (or, for a
mass   0 ───┬───┬───┬───┬── 1       distance, the root of bend times way), so lines end where the mass is even;
                                    the least number of lines that holds is found by doubling and bisection
"""

from __future__ import annotations

from math import atan2, ceil, sqrt

import numpy as np

from nccompile.kernels import kernel
from nccompile.kernels.curve_points import Floats, point3
from nccompile.kernels.curves import NODES
from nccompile.kernels.legs import STATE, Kinds, Wholes, row_at, tabulate_row
from nccompile.kernels.planes import SPACE, embed

__all__ = ["MOST", "flat_lines"]

MOST = 100_000
"""Lines one curve may become; more is a typing error in a parameter."""

_FINE = 512  # places at which a curve is looked at to find its bend,
_RESOLVED = 8  # and at least for each line
_EVEN = 0.05  # weight of the way beside the bend: flat parts get some lines too
_MARGIN = 0.97  # of the tolerance: with 8 places a line, the farthest one is missed by 1/64 of its distance


@kernel
def _look(kind: int, plane: int, p: Floats, a: Floats, b: Floats, share: Floats, places: Floats) -> None:
    """Fills places X, Y, Z, Shape (m, 3), at equal steps of u, and their share of the way, Shape (m,)."""
    last = len(share) - 1
    way = 0.0
    for k in range(last + 1):
        x, y, z = point3(kind, p, k / last)
        places[k, 0] = x
        places[k, 1] = y
        places[k, 2] = z
        if k > 0:
            square = 0.0
            for c in range(3):
                step = float(places[k, c]) - float(places[k - 1, c])
                square += step * step
            way += sqrt(square)
        share[k] = way
    third = 2 - plane
    for k in range(last + 1):
        share[k] = share[k] / way if way > 0.0 else k / last
        if plane != SPACE:
            w = float(a[third]) + float(share[k]) * (float(b[third]) - float(a[third]))
            places[k, 0], places[k, 1], places[k, 2] = embed(
                plane, float(places[k, 0]), float(places[k, 1]), w
            )


@kernel
def _bend(places: Floats, k: int) -> float:
    """The angle [rad] between the steps to and from place k."""
    x, y, z = (
        places[k, 0] - places[k - 1, 0],
        places[k, 1] - places[k - 1, 1],
        places[k, 2] - places[k - 1, 2],
    )
    x2, y2, z2 = (
        places[k + 1, 0] - places[k, 0],
        places[k + 1, 1] - places[k, 1],
        places[k + 1, 2] - places[k, 2],
    )
    cx, cy, cz = y * z2 - z * y2, z * x2 - x * z2, x * y2 - y * x2
    return atan2(sqrt(cx * cx + cy * cy + cz * cz), x * x2 + y * y2 + z * z2)


@kernel
def _weigh(share: Floats, places: Floats, by_length: bool, by_angle: bool, mass: Floats) -> None:
    """Fills the mass up to each place, Shape (m,), 0..1."""
    last = len(share) - 1
    total = 0.0
    for k in range(last):
        bend = 0.0 if by_length else _bend(places, min(k + 1, last - 1))
        mass[k + 1] = bend if by_angle else sqrt(bend * (share[k + 1] - share[k]))
        total += float(mass[k + 1])
    mass[0] = 0.0
    for k in range(last):
        way = float(share[k + 1]) - float(share[k])
        mass[k + 1] = mass[k] + (way if total == 0.0 else float(mass[k + 1]) / total + _EVEN * way)
    for k in range(last + 1):
        mass[k] /= mass[last]


@kernel
def _spread(share: Floats, mass: Floats, number: int, ends: Floats) -> None:
    """Fills the shares at which `number` lines end, 0 first and 1 last."""
    last = len(share) - 1
    k = 0
    for j in range(number):
        x = j / number
        while k < last - 1 and mass[k + 1] <= x:
            k += 1
        size = float(mass[k + 1]) - float(mass[k])
        part = (x - float(mass[k])) / size if size > 0.0 else 0.0
        ends[j] = share[k] + part * (share[k + 1] - share[k])
    ends[number] = 1.0


@kernel
def _holds(
    share: Floats, places: Floats, ends: Floats, number: int, angle: float, tolerance: float, joints: Floats
) -> bool:  # fmt: skip
    """Whether bend and distance hold for lines that end at these shares;  joints: Shape (> number, 3), scratch."""
    last = len(share) - 1
    k = 0
    for j in range(number + 1):
        while k < last - 1 and share[k + 1] <= ends[j]:
            k += 1
        size = float(share[k + 1]) - float(share[k])
        part = (float(ends[j]) - float(share[k])) / size if size > 0.0 else 0.0
        for c in range(3):
            joints[j, c] = places[k, c] + part * (places[k + 1, c] - places[k, c])
    if angle > 0.0:
        if number < 2:
            return False
        for j in range(1, number):
            if _bend(joints, j) >= angle:
                return False
    if tolerance > 0.0:
        least = tolerance * _MARGIN * tolerance * _MARGIN
        j = 0
        for k in range(last + 1):
            while j < number - 1 and ends[j + 1] <= share[k]:
                j += 1
            along = size = 0.0
            for c in range(3):
                way = float(joints[j + 1, c]) - float(joints[j, c])
                along += (float(places[k, c]) - float(joints[j, c])) * way
                size += way * way
            along = min(max(along / size, 0.0), 1.0) if size > 0.0 else 0.0
            square = 0.0
            for c in range(3):
                way = float(joints[j + 1, c]) - float(joints[j, c])
                off = float(places[k, c]) - float(joints[j, c]) - along * way
                square += off * off
            if square > least:
                return False
    return True


@kernel
def _least(
    share: Floats, places: Floats, mass: Floats, least: int, angle: float, tolerance: float, ends: Floats,
    joints: Floats,
) -> int:  # fmt: skip
    """The least number of lines, from `least` to MOST, that holds; fills where they end."""
    few = least - 1
    number = least
    while number < MOST:
        _spread(share, mass, number, ends)
        if _holds(share, places, ends, number, angle, tolerance, joints):
            break
        few = number
        number = min(2 * number, MOST)
    while number - few > 1:
        middle = (few + number) // 2
        _spread(share, mass, middle, ends)
        if _holds(share, places, ends, middle, angle, tolerance, joints):
            number = middle
        else:
            few = middle
    _spread(share, mass, number, ends)
    return number


@kernel
def flat_lines(
    kinds: Kinds, planes: Wholes, rows: Floats, points: Floats, length: Floats, picked: Wholes, begin: int,
    longest: float, angle: float, tolerance: float, owner: Wholes, share: Floats, ends: Floats,
) -> int:  # fmt: skip
    """Lines for the curves `picked`, Shape (p,), from the one at place `begin` on.

    Args:     columns of the path as in `kernels.distance`;  longest: length of a line [mm], angle: bend [rad] below
              which neighbouring lines stay, tolerance [mm]; 0: not asked for;  owner, share: Shape (k,), out: the row
              and the part 0..1 of its way at which each line ends;  ends: Shape (k, 3), out, X, Y, Z.
    Returns:  the number of lines; of those curves only for which there is room, at least MOST rows.
    """
    nodes = np.empty((2, NODES))
    state = np.empty(STATE)
    stops, joints = np.empty(MOST + 1), np.empty((MOST + 1, 3))
    count = 0
    for j in range(begin, len(picked)):
        i = int(picked[j])
        table = tabulate_row(kinds, rows, i, nodes, 0)
        least = 1
        if longest > 0.0:
            least = min(max(1, ceil(float(nodes[1, table - 1]) / longest * (1.0 - 1e-12))), MOST)
        fine = _FINE
        number = 0
        while number == 0 or ((number + 1) * _RESOLVED > fine and number < MOST):
            if number:
                fine = (number + 1) * _RESOLVED * 2
            way, places, mass = np.empty(fine + 1), np.empty((fine + 1, 3)), np.empty(fine + 1)
            _look(int(kinds[i]), int(planes[i]), rows[i], points[i], points[i + 1], way, places)
            _weigh(way, places, longest > 0.0, angle > 0.0, mass)
            number = _least(way, places, mass, least, angle, tolerance, stops, joints)
        if count + number > len(owner):
            break
        for k in range(number):
            part = float(stops[k + 1])
            row_at(kinds, planes, rows, points, length, i, nodes, 0, table, part * float(length[i]), state)
            owner[count] = i
            share[count] = part
            for c in range(3):
                ends[count, c] = points[i + 1, c] if k == number - 1 else state[c]
            count += 1
    return count
