"""Cubics to lines and arcs within a tolerance, tangents kept at every joint.

Two arcs that meet with one tangent (a biarc) join the ends of a cubic in its end directions.  With unit tangents
s, e, the chord v and both tangent lengths d equal, the arcs meet at J = (A + B + d (s - e)) / 2 where

    2 (1 - s.e) d² + 2 v.(s + e) d - v.v = 0

A cubic whose biarc is farther off than the tolerance at one of the probes is halved.  All cubics go through
the same steps at once, as arrays; positions are complex numbers x + iy [mm].

Source: Bolton, "Biarc curves" (1975), with equal tangent lengths; own derivation of d.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

__all__ = ["Arcs", "arcs_of_cubics"]

Complexes: TypeAlias = npt.NDArray[np.complex128]
Floats: TypeAlias = npt.NDArray[np.float64]

PROBES = np.linspace(0.0, 1.0, 18)[1:-1]
MARGIN = 0.9
"""The part of the tolerance that the probes may use; the rest is for what lies between two of them."""

STRAIGHT = 0.02
"""An arc whose height over its chord is below this part of the tolerance is written as a line."""

DEEPEST = 40
"""Halvings at most: a piece of 1e-12 of the cubic is a point."""

WIDEST = 0.9 * np.pi
"""Greatest sweep of an arc that is accepted; wider biarcs are halved first."""


class Arcs(NamedTuple):
    """m lines and arcs in running order.

    cubic: i8 (m,) which cubic each stems from;  start, end: c16 (m,) [mm], those of one cubic follow each other;
    sweep: f8 (m,) [rad], + is counter-clockwise, 0 for a line.
    """

    cubic: npt.NDArray[np.int64]
    start: Complexes
    end: Complexes
    sweep: Floats


def arcs_of_cubics(points: Complexes, tolerance: float) -> Arcs:
    """Lines and arcs no farther than `tolerance` from the cubics.

    Args:     points: c16 (n, 4) Bezier control points [mm];  tolerance [mm], > 0.
    Returns:  ends exact: the first start and last end of every cubic are its own.
    """
    todo, cubic = points, np.arange(len(points))
    at, step = np.zeros(len(points)), np.ones(len(points))
    done: list[tuple[npt.NDArray[np.int64], Floats, Complexes, Complexes, Floats]] = []
    for depth in range(DEEPEST + 1):
        if not len(todo):
            break
        joint, first, second = _biarc(todo)
        off = _deviation(todo, joint, first, second)
        wide = np.maximum(np.abs(first), np.abs(second)) > WIDEST
        small = np.abs(todo - todo[:, :1]).max(axis=1) <= 0.5 * tolerance
        line = small | (_control_height(todo) <= STRAIGHT * tolerance)
        good = line | ((off <= MARGIN * tolerance) & ~wide)
        if depth == DEEPEST:
            good[:] = True
        pairs = good & ~line
        done.append((cubic[line & good], at[line & good], todo[line & good, 0], todo[line & good, 3],
                     np.zeros(int((line & good).sum()))))  # fmt: skip
        done.append((cubic[pairs], at[pairs], todo[pairs, 0], joint[pairs], first[pairs]))
        done.append((cubic[pairs], at[pairs] + step[pairs] / 2, joint[pairs], todo[pairs, 3], second[pairs]))
        rest = ~good
        step = np.repeat(step[rest] / 2, 2)
        at = np.repeat(at[rest], 2) + step * np.tile([0.0, 1.0], int(rest.sum()))
        cubic, todo = np.repeat(cubic[rest], 2), _halves(todo[rest])
    cubic, at, start, end, sweep = (np.concatenate(column) for column in zip(*done, strict=True))
    order = np.lexsort((at, cubic))
    sweep = np.where(np.abs((end - start) * np.tan(sweep / 4) / 2) <= STRAIGHT * tolerance, 0.0, sweep)
    keep = order[(start != end)[order]]
    return Arcs(cubic[keep], start[keep], end[keep], sweep[keep])


def _tangents(points: Complexes) -> tuple[Complexes, Complexes]:
    """Unit tangents at both ends; a control point on its end hands over to the next one."""
    a, c1, c2, b = points.T
    size = np.abs(points - a[:, None]).max(axis=1) * 1e-9
    start = np.where(np.abs(c1 - a) > size, c1 - a, np.where(np.abs(c2 - a) > size, c2 - a, b - a))
    end = np.where(np.abs(b - c2) > size, b - c2, np.where(np.abs(b - c1) > size, b - c1, b - a))
    return start / np.maximum(np.abs(start), 1e-300), end / np.maximum(np.abs(end), 1e-300)


def _biarc(points: Complexes) -> tuple[Complexes, Floats, Floats]:
    """The joint and both signed sweeps of every cubic's biarc; sweeps of 2 pi where there is none."""
    a, b = points[:, 0], points[:, 3]
    s, e = _tangents(points)
    chord = b - a
    square = np.abs(chord) ** 2
    bend = 1.0 - (s * e.conj()).real
    along = (chord * (s + e).conj()).real
    root = np.sqrt(np.maximum(along * along + 2.0 * bend * square, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        d = square / (along + root)
    usable = np.isfinite(d) & (d > 0.0)
    d = np.where(usable, d, 0.0)
    joint = 0.5 * (a + b + d * (s - e))
    usable &= (joint != a) & (joint != b)
    first = np.where(usable, 2.0 * np.angle((joint - a) * s.conj()), 2.0 * np.pi)
    second = np.where(usable, 2.0 * np.angle(e * (b - joint).conj()), 2.0 * np.pi)
    return joint, first, second


def _deviation(points: Complexes, joint: Complexes, first: Floats, second: Floats) -> Floats:
    """Shape (n,): the greatest distance of the probes from the nearer of the two arcs."""
    t = PROBES[None, :]
    a, c1, c2, b = (points[:, k : k + 1] for k in range(4))
    probe = (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * c1 + 3 * (1 - t) * t**2 * c2 + t**3 * b
    off = np.minimum(_from_arc(probe, a, joint[:, None], first), _from_arc(probe, joint[:, None], b, second))
    worst: Floats = off.max(axis=1)
    return worst


def _from_arc(probe: Complexes, start: Complexes, end: Complexes, sweep: Floats) -> Floats:
    """Shape (n, m): distances of probes from the arcs start -> end.

    In the frame of the chord (start 0, end 1) the centre is 1/2 + i / (2 tan(sweep / 2)).
    """
    chord = end - start
    size = np.maximum(np.abs(chord), 1e-300)
    z = (probe - start) / np.where(chord == 0, 1e-300, chord)
    half = np.tan(0.5 * sweep)[:, None]
    flat = np.abs(half) < 1e-9
    centre = 0.5 + 0.5j / np.where(flat, 1.0, half)
    turn = np.angle((z - centre) / np.where(centre == 0, 1, -centre))
    turn = np.where(sweep[:, None] < 0, -turn, turn)
    inside = (turn >= -1e-9) & (turn <= np.abs(sweep)[:, None] + 1e-9)
    ends = np.minimum(np.abs(z), np.abs(z - 1.0))
    round_ = np.where(inside, np.abs(np.abs(z - centre) - np.abs(centre)), ends)
    straight = np.where((z.real >= 0) & (z.real <= 1), np.abs(z.imag), ends)
    distance: Floats = np.where(flat, straight, round_) * size
    return distance


def _control_height(points: Complexes) -> Floats:
    """Shape (n,): how far the inner control points are off the chord, or beyond its ends."""
    a, b = points[:, 0], points[:, 3]
    chord = np.where(a == b, 1e-300, b - a)
    inner = (points[:, 1:3] - a[:, None]) / chord[:, None]
    beyond = np.maximum(np.maximum(-inner.real, inner.real - 1.0), 0.0)
    height: Floats = (np.maximum(np.abs(inner.imag), beyond) * np.abs(b - a)[:, None]).max(axis=1)
    return np.where(a == b, np.abs(points - a[:, None]).max(axis=1), height)


def _halves(points: Complexes) -> Complexes:
    """Shape (2 n, 4): both halves of every cubic (de Casteljau at 1/2), left before right."""
    a, c1, c2, b = points.T
    ab, bc, cd = 0.5 * (a + c1), 0.5 * (c1 + c2), 0.5 * (c2 + b)
    abc, bcd = 0.5 * (ab + bc), 0.5 * (bc + cd)
    middle = 0.5 * (abc + bcd)
    left = np.column_stack([a, ab, abc, middle])
    right = np.column_stack([middle, bcd, cd, b])
    return np.stack([left, right], axis=1).reshape(-1, 4)
