"""The path length of a segment: the one definition, used by the decoder, the passes and the verifier.

    straight    sqrt(dX² + dY² + dZ²)
    curve       sqrt(L² + dW²): L the curve in its plane, W the third of X, Y, Z, linear in L (a helix)
    in space    a polynomial with the plane SPACE: the length of the curve itself
    otherwise   a segment without length in X, Y, Z is as long as its additional axes move, Euclidean norm

An axis in the S-profile (SoftMotion §6.2.8) follows the others and does not count, unless nothing else
moves.
G92, dwells and M functions have length 0.  See docs/decisions/040.

`path_length` (one segment) and `path_lengths`, `straight_lengths` (columns) give the same bits.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import sqrt

import numpy as np
import numpy.typing as npt

from nccompile.kernels import curves as kernels
from nccompile.toolpath.columns import Floats, Kind, Plane, Toolpath, Words

__all__ = ["PLANE_AXES", "THIRD_AXIS", "path_length", "path_lengths", "straight_lengths"]

PLANE_AXES: dict[int, tuple[int, int]] = {Plane.XY: (0, 1), Plane.ZX: (2, 0), Plane.YZ: (1, 2)}
"""The columns of a plane's two axes (u, v)."""

THIRD_AXIS: dict[int, int] = {Plane.XY: 2, Plane.ZX: 1, Plane.YZ: 0}
"""The column of the axis a plane leaves over."""

_SPATIAL = 3  # X, Y, Z are always the first three columns
_STANDING = (Kind.SET_POSITION, Kind.DWELL, Kind.M_FUNCTION)


def path_length(
    axes: Sequence[str],
    kind: int,
    start: Sequence[float],
    target: Sequence[float],
    plane: int | None = None,
    parameters: Floats | None = None,
    profile: int = 0,
) -> float:
    """The path length of one segment [mm] (degrees if only rotary axes move).

    Args:     start, target: positions, one number for each of `axes`;
              plane, parameters: row of the curve table, f8 (12,), None for a straight segment;
              profile: bit i set: axis i runs in the S-profile.
    """
    if kind in _STANDING:
        return 0.0
    delta = [float(b) - float(a) for a, b in zip(start, target, strict=True)]
    if plane is not None and parameters is not None:
        inside = kernels.in_plane_length(kind, parameters)
        if inside > 0.0:
            third = THIRD_AXIS.get(plane)
            if third is None or profile >> third & 1:
                return inside
            return sqrt(inside * inside + delta[third] * delta[third])
    for columns, bit in _candidates(len(axes)):
        total = 0.0
        for i in columns:
            if profile >> i & 1 == bit:
                total += delta[i] * delta[i]
        if total > 0.0:
            return sqrt(total)
    return 0.0


def straight_lengths(delta: Floats, profile: Words) -> Floats:
    """Path lengths of straight segments.

    Args:     delta: Shape (n, k), target minus start [mm or deg];  profile: Shape (n,), S-profile bits.
    Returns:  Shape (n,) [mm].
    """
    n, k = delta.shape
    plain = not profile.any()
    length = np.zeros(n)
    open_rows = np.arange(n)
    for columns, bit in _candidates(k):
        if not len(open_rows) or (plain and bit):
            break
        total = np.zeros(len(open_rows))
        for i in columns:
            step = delta[open_rows, i]
            if not plain:
                step = np.where((profile[open_rows] >> i & 1) == bit, step, 0.0)
            total += step * step
        found = total > 0.0
        length[open_rows[found]] = np.sqrt(total[found])
        open_rows = open_rows[~found]
    return length


def path_lengths(path: Toolpath, known: Floats | None = None) -> Floats:
    """Path lengths of all segments of a chunk, from its geometry. Shape (n,) [mm].

    known: Shape (n,), lengths of curves in their plane that whoever made them has computed already, 0: not known.
    """
    delta = path.target - path.starts()
    length = straight_lengths(delta, path.profile)
    length[np.isin(path.kind, _STANDING)] = 0.0
    curved = np.flatnonzero(path.curve >= 0)
    if not len(curved):
        return length
    rows = path.curve[curved]
    plane = path.curves.plane[rows]
    inside = np.zeros(len(curved)) if known is None else known[curved]
    rest = np.flatnonzero(inside == 0.0)
    inside[rest] = _in_plane(path.kind[curved[rest]], path.curves.parameters[rows[rest]])
    third = np.array([THIRD_AXIS[Plane.XY], THIRD_AXIS[Plane.ZX], THIRD_AXIS[Plane.YZ], 0])[plane]
    rise = delta[curved, third]
    flat = (plane == Plane.SPACE) | (path.profile[curved] >> third & 1 == 1)
    whole = np.where(flat, inside, np.sqrt(inside * inside + rise * rise))
    length[curved] = np.where(inside > 0.0, whole, length[curved])
    return length


def _in_plane(kinds: npt.NDArray[np.uint8], parameters: Floats) -> Floats:
    """Lengths in the plane: arcs at once, the others by the kernel."""
    inside = parameters[:, 2] * np.abs(parameters[:, 4])
    rest = np.flatnonzero(kinds != Kind.ARC)
    if len(rest):
        found = np.empty(len(rest))
        kernels.in_plane_lengths(kinds[rest], parameters[rest], found)
        inside[rest] = found
    return inside


def _candidates(k: int) -> Iterable[tuple[range, int]]:
    """Which axes make the length: the first of these (columns, S-profile bit) that move."""
    spatial, additional = range(_SPATIAL), range(_SPATIAL, k)
    return (spatial, 0), (additional, 0), (spatial, 1), (additional, 1)
