"""transform: move, turn, stretch, mirror a path, or put it into a frame (SoftMotion §3.3, §6.4, §8.3).

    P' = scale * Rz(yaw) Ry(pitch) Rx(roll) Rz(rotate) Mirror (M (P - C) + m) + C + t      C: (cx, cy, cz), fixed

             y'                  Lines stay lines and cubics cubics.  An arc or ellipse stays what it is, or an arc
         \\   |   /  x'           becomes an ellipse where M stretches its plane unevenly, while its plane comes to
          \\  |  / rotate        lie in X-Y, Z-X or Y-Z.  Curves in tilted planes, and helices that are stretched
           \\ | /____ x         unevenly, become cubics in space within `tolerance`.

`matrix` is M, rows divided by ";": its columns are the unit vectors of the frame (§8.3); a fourth number in each row
is m.  Additional axes are translated, never turned or stretched.  A mirror swaps left and right of tool radius
correction.  Feeds, D and switch points (a share of their segment) stay.  The deviation in the report is that from
the path moved exactly.

Example:
    -p transform{rotate=90}
    --- in
    % t
    N10 G1 X10 F50
    N20 G3 X20 Y10 R10
    --- out
    line 0 10 0 feed 50 source 2
    arc -10 20 0 feed 50 source 3 xy center -10 10 radius 10 start 0 sweep 1.570796
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from nccompile.errors import UsageError
from nccompile.geometry.frames import Frame, mapped_conics, rotation
from nccompile.kernels import expect_work
from nccompile.kernels.space_cubics import MOST, space_cubics
from nccompile.passes.base import Context, Flags, Pass, bounded, gather
from nccompile.passes.edit import Links, Pieces, Rows, cut_curves, geometry, put_pieces
from nccompile.passes.measure import deviation
from nccompile.toolpath.columns import (
    CURVE_PARAMETERS,
    Bytes,
    Curves,
    Floats,
    Kind,
    Mark,
    Plane,
    Toolpath,
    Words,
)
from nccompile.toolpath.lengths import PLANE_AXES, THIRD_AXIS, path_lengths
from nccompile.units import rad_from_deg

__all__ = ["Transform", "swap_sides"]

_PLANE_OF_NORMAL = {2: Plane.XY, 1: Plane.ZX, 0: Plane.YZ}
_SIDES = int(Mark.TOOL_LEFT | Mark.TOOL_RIGHT)

_WORK = 50
"""What a curve that becomes cubics costs, in the rows by which other passes count."""

_LEAST, _GREATEST = 1e-6, 1e6
"""Factors by which a frame may change lengths."""


@dataclass(frozen=True)
class Transform(Pass):
    """An affine map of space.

    x, y, z, p, q, u, v, w: translation [mm];  rotate: about Z, counter-clockwise [°];  roll, pitch, yaw [°];
    scale > 0;  mirror: letters of the axes that change their sign, as in mirror=x;  matrix: 9 or 12 numbers, as in
    matrix=0 -1 0; 1 0 0; 0 0 1;  cx, cy, cz: the fixed point of all but the translation [mm];  tolerance: of curves
    that become cubics [mm].
    """

    name: ClassVar[str] = "transform"
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    p: float = 0.0
    q: float = 0.0
    u: float = 0.0
    v: float = 0.0
    w: float = 0.0
    rotate: float = 0.0
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0
    scale: float = 1.0
    mirror: str = ""
    matrix: str = ""
    cx: float = 0.0
    cy: float = 0.0
    cz: float = 0.0
    tolerance: float = 0.001

    def __post_init__(self) -> None:
        bounded("scale", self.scale, _LEAST, _GREATEST, "")
        bounded("tolerance", self.tolerance, 1e-6, 1.0, "mm")
        for name in ("x", "y", "z", "p", "q", "u", "v", "w", "cx", "cy", "cz"):
            bounded(name, getattr(self, name), -1e7, 1e7, "mm")
        for name in ("rotate", "roll", "pitch", "yaw"):
            bounded(name, getattr(self, name), -36000.0, 36000.0, "degrees")
        if set(self.mirror.lower()) - set("xyz"):
            raise UsageError(
                f"mirror={self.mirror}: write the letters of the axes that change their sign: x, y, z"
            )
        least, greatest = self.frame.stretch
        if not _LEAST * (1.0 - 1e-9) <= least <= greatest <= _GREATEST * (1.0 + 1e-9):
            raise UsageError(
                f"matrix={self.matrix}: lengths change by {least:g} to {greatest:g}, not by 1e-06 to 1e+06"
            )

    @cached_property
    def frame(self) -> Frame:
        """The map of X, Y, Z."""
        own, offset = _matrix(self.matrix)
        signs = np.array([-1.0 if letter in self.mirror.lower() else 1.0 for letter in "xyz"])
        turn = rotation(*(rad_from_deg(a) for a in (self.roll, self.pitch, self.yaw)))
        outer = self.scale * (turn @ rotation(0.0, 0.0, rad_from_deg(self.rotate)) * signs[None, :])
        m = outer @ own
        fixed = np.array([self.cx, self.cy, self.cz])
        return Frame(m, fixed - m @ fixed + outer @ offset + np.array([self.x, self.y, self.z]))

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module."""
        for chunk in gather(chunks):
            spatial, links = self._spatial(chunk)
            moved = self._moved(spatial)
            if context.measure:
                context.report.deviate(deviation(chunk, moved, links, self.frame))
            yield moved

    def _spatial(self, path: Toolpath) -> tuple[Toolpath, Links]:
        """The path with cubics in space for the curves that no row of the curve table holds behind the map."""
        lost = np.flatnonzero(self._lost(path))
        if not len(lost):
            return path, Links.copies(np.arange(len(path)))
        return put_pieces(path, in_space(path, lost, self.tolerance / self.frame.stretch[1]))

    def _lost(self, path: Toolpath) -> Flags:
        """Shape (n,): which plane curves come to lie in none, or are helices whose plane is stretched unevenly."""
        out = np.zeros(len(path), np.bool_)
        curved = np.flatnonzero(path.curve >= 0)
        plane = path.curves.plane[path.curve[curved]]
        rise = (path.target - path.starts())[curved]
        for at, (u, v) in PLANE_AXES.items():
            own, third = plane == at, THIRD_AXIS[at]
            normal = self.frame.normal_of(u, v)
            if normal is None:
                out[curved[own]] = True
                continue
            straight = all(self.frame.m[i, third] == 0.0 for i in range(3) if i != normal)
            if not (straight and self.frame.is_similar(u, v)):
                out[curved[own & (rise[:, third] != 0.0)]] = True
        return out

    def _moved(self, path: Toolpath) -> Toolpath:
        """The mapped path; every curve has a plane that stays one."""
        n = len(path)
        positions = np.vstack([path.start[None, :], path.target])
        positions[:, :3] = self.frame.points(np.ascontiguousarray(positions[:, :3]))
        for column, letter in enumerate(path.axes[3:], 3):
            positions[:, column] += getattr(self, letter.lower(), 0.0)
        mark = swap_sides(path.mark) if self.frame.mirrors else path.mark
        kind, curves = self._curves(path)
        moved = path.replace(
            start=positions[0], kind=kind, target=positions[1:].reshape(n, -1), mark=mark, curves=curves
        )
        return moved.replace(length=path_lengths(moved))

    def _curves(self, path: Toolpath) -> tuple[Bytes, Curves]:
        """The kinds and the curve table of the mapped path."""
        f = self.frame
        kind, planes, rows = path.kind.copy(), path.curves.plane.copy(), path.curves.parameters.copy()
        curved = np.flatnonzero(path.curve >= 0)
        table = path.curve[curved]
        old = path.curves.plane[table]
        free = table[old == Plane.SPACE]
        rows[free] = _cubics(rows[free], f.m, np.broadcast_to(f.t, (len(free), 3)))
        for plane, (u, v) in PLANE_AXES.items():
            own = np.flatnonzero(old == plane)
            normal = f.normal_of(u, v)
            if normal is None or not len(own):
                continue
            new = int(_PLANE_OF_NORMAL[normal])
            axes, third = list(PLANE_AXES[new]), THIRD_AXIS[plane]
            height = path.target[curved[own], third]
            shift = f.t[axes] + f.m[axes, third] * height[:, None]
            planes[table[own]] = new
            kind[curved[own]], rows[table[own]] = _mapped(
                kind[curved[own]], rows[table[own]], f.m[np.ix_(axes, (u, v))], shift, f.is_similar(u, v)
            )
        return kind, Curves(planes, rows)


def _mapped(kind: Bytes, rows: Floats, m: Floats, shift: Floats, similar: bool) -> tuple[Bytes, Floats]:
    """Kinds and rows of plane curves under a map of their plane: m, Shape (2, 2); shift, Shape (n, 2) [mm]."""
    out = np.zeros_like(rows)
    cubic = kind == Kind.POLYNOMIAL
    out[cubic] = _cubics(rows[cubic], m, shift[cubic])
    for i in range(2):
        out[~cubic, i] = (m[i, 0] * rows[:, 0] + m[i, 1] * rows[:, 1] + shift[:, i])[~cubic]
    arc, ellipse = kind == Kind.ARC, kind == Kind.ELLIPSE
    p, e = rows[arc], rows[ellipse]
    if similar:
        size, turn = float(np.sqrt(m[0, 0] ** 2 + m[1, 0] ** 2)), float(np.arctan2(m[1, 0], m[0, 0]))
        side = 1.0 if float(np.linalg.det(m)) > 0.0 else -1.0
        out[arc, 2:5] = np.stack([size * p[:, 2], side * p[:, 3] + turn, side * p[:, 4]], axis=1)
        parts = (size * e[:, 2], size * e[:, 3], side * e[:, 4] + turn, side * e[:, 5], side * e[:, 6])
        out[ellipse, 2:7] = np.stack(parts, axis=1)
        return kind, out
    still = np.zeros(len(p))
    out[arc, 2:7] = np.stack(mapped_conics(p[:, 2], p[:, 2], still, p[:, 3], p[:, 4], m), axis=1)
    out[ellipse, 2:7] = np.stack(mapped_conics(e[:, 2], e[:, 3], e[:, 4], e[:, 5], e[:, 6], m), axis=1)
    return np.where(arc, np.uint8(Kind.ELLIPSE), kind), out


def _cubics(rows: Floats, m: Floats, shift: Floats) -> Floats:
    """Rows of mapped cubics: m, Shape (k, k), k = 2 or 3;  shift, Shape (n, k): added to the constants [mm]."""
    out = np.zeros_like(rows)
    k = len(m)
    for i in range(k):
        for j in range(k):
            out[:, 4 * i : 4 * i + 4] += m[i, j] * rows[:, 4 * j : 4 * j + 4]
        out[:, 4 * i] += shift[:, i]
    return out


def _matrix(text: str) -> tuple[Floats, Floats]:
    """The matrix, Shape (3, 3), and the translation, Shape (3,) [mm], of the parameter; UsageError if it is none."""
    if not text:
        return np.eye(3), np.zeros(3)
    try:
        rows = [[float(number) for number in row.split()] for row in text.split(";")]
    except ValueError:
        rows = []
    if [len(row) for row in rows] not in ([3, 3, 3], [4, 4, 4]) or not np.isfinite(rows).all():
        raise UsageError(f"matrix={text}: write three rows of 3 or 4 numbers, as in 0 -1 0; 1 0 0; 0 0 1")
    full = np.array([[*row, 0.0][:4] for row in rows])
    return full[:, :3], full[:, 3]


def swap_sides(mark: Words) -> Words:
    """Marks with left and right of tool radius correction exchanged."""
    left, right = mark & int(Mark.TOOL_LEFT), mark & int(Mark.TOOL_RIGHT)
    swapped = mark & ~np.uint16(_SIDES)
    swapped |= np.where(left, np.uint16(Mark.TOOL_RIGHT), np.uint16(0))
    swapped |= np.where(right, np.uint16(Mark.TOOL_LEFT), np.uint16(0))
    return swapped.astype(np.uint16)


def in_space(path: Toolpath, picked: Rows, tolerance: float) -> Pieces:
    """The plane curves of rows as cubics in space within `tolerance` [mm]; picked: Shape (p,), ascending."""
    shape = geometry(path)

    def fill(begin: int, owner: Rows, share: Floats, ends: Floats, rows: Floats) -> int:
        return space_cubics(*shape, path.length, picked, begin, tolerance, owner, share, ends, rows)

    expect_work(_WORK * len(picked))
    owner, share, (ends, rows) = cut_curves(picked, MOST, (3, CURVE_PARAMETERS), fill)
    begin, end = path.starts()[owner], path.target[owner]
    target = np.where(share[:, None] < 1.0, begin + share[:, None] * (end - begin), end)
    target[:, :3] = ends
    kind, planes = np.full(len(owner), Kind.POLYNOMIAL, np.uint8), np.full(len(owner), Plane.SPACE, np.uint8)
    return Pieces(owner, share, kind, target, Curves(planes, rows))
