"""transform: move, turn, stretch, mirror a path, or put it into a frame (SoftMotion §3.3, §6.4, §8.3).

    P' = scale * Rz(yaw) Ry(pitch) Rx(roll) Rz(rotate) Mirror (P - C) + C + t      C: the fixed point (cx, cy, cz)

             y'                  Lines stay lines.  A curve stays what it is while its plane comes to lie in
         \\   |   /  x'           one of X-Y, Z-X, Y-Z; in a tilted plane it becomes cubics in space within
          \\  |  / rotate        `tolerance`.  Additional axes are translated, never turned or stretched.
           \\ | /____ x

A mirror swaps left and right of tool radius correction.  Feeds, D and switch points (a share of their segment)
stay.

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
from nccompile.geometry.frames import Frame, rotation
from nccompile.geometry.parts import Way, tangent_at
from nccompile.geometry.spatial import cubics
from nccompile.kernels.distance import place_on
from nccompile.passes.base import Context, Pass, bounded, gather
from nccompile.passes.edit import Draft
from nccompile.toolpath.columns import Curves, Floats, Kind, Mark, Plane, Toolpath
from nccompile.toolpath.lengths import PLANE_AXES, THIRD_AXIS, path_lengths
from nccompile.units import rad_from_deg

__all__ = ["Transform", "swap_sides"]

_PLANE_OF_NORMAL = {2: Plane.XY, 1: Plane.ZX, 0: Plane.YZ}
_SIDES = int(Mark.TOOL_LEFT | Mark.TOOL_RIGHT)


@dataclass(frozen=True)
class Transform(Pass):
    """A similarity of space.

    x, y, z, p, q, u, v, w: translation [mm];  rotate: about Z, counter-clockwise [°];  roll, pitch, yaw [°];
    scale > 0;  mirror: letters of the axes that change their sign, as in mirror=x;  cx, cy, cz: the fixed point
    of all but the translation [mm];  tolerance: of curves in tilted planes [mm].
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
    cx: float = 0.0
    cy: float = 0.0
    cz: float = 0.0
    tolerance: float = 0.001

    def __post_init__(self) -> None:
        bounded("scale", self.scale, 1e-6, 1e6, "")
        bounded("tolerance", self.tolerance, 1e-6, 1.0, "mm")
        for name in ("x", "y", "z", "p", "q", "u", "v", "w", "cx", "cy", "cz"):
            bounded(name, getattr(self, name), -1e7, 1e7, "mm")
        for name in ("rotate", "roll", "pitch", "yaw"):
            bounded(name, getattr(self, name), -36000.0, 36000.0, "degrees")
        if set(self.mirror.lower()) - set("xyz"):
            raise UsageError(
                f"mirror={self.mirror}: write the letters of the axes that change their sign: x, y, z"
            )

    @cached_property
    def frame(self) -> Frame:
        """The map of X, Y, Z."""
        signs = np.array([-1.0 if letter in self.mirror.lower() else 1.0 for letter in "xyz"])
        turn = rotation(*(rad_from_deg(a) for a in (self.roll, self.pitch, self.yaw)))
        q = turn @ rotation(0.0, 0.0, rad_from_deg(self.rotate)) * signs[None, :]
        fixed = np.array([self.cx, self.cy, self.cz])
        return Frame(self.scale, q, fixed - self.scale * (q @ fixed) + np.array([self.x, self.y, self.z]))

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module."""
        for chunk in gather(chunks):
            yield self._moved(self._spatial(chunk))

    def _spatial(self, path: Toolpath) -> Toolpath:
        """The path with cubics in space for the curves whose plane will be tilted."""
        tilted = np.zeros(len(path), np.bool_)
        for i in np.flatnonzero(path.curve >= 0).tolist():
            plane = int(path.curves.plane[path.curve[i]])
            tilted[i] = plane != Plane.SPACE and self.frame.plane_to(THIRD_AXIS[plane]) is None
        if not tilted.any():
            return path
        draft = Draft(path)
        starts = path.starts()
        for i in range(len(path)):
            if tilted[i]:
                in_space(draft, i, starts[i], self.tolerance / self.scale)
            else:
                draft.copy(i)
        return draft.build()

    def _moved(self, path: Toolpath) -> Toolpath:
        """The mapped path; every curve has a plane that stays one."""
        n = len(path)
        positions = np.vstack([path.start[None, :], path.target])
        positions[:, :3] = self.frame.points(np.ascontiguousarray(positions[:, :3]))
        for column, letter in enumerate(path.axes[3:], 3):
            positions[:, column] += getattr(self, letter.lower(), 0.0)
        mark = swap_sides(path.mark) if self.frame.mirrors else path.mark
        curves = Curves(path.curves.plane.copy(), path.curves.parameters.copy())
        for row, kind in zip(path.curve[path.curve >= 0], path.kind[path.curve >= 0], strict=True):
            plane, p = self._curve(int(kind), int(curves.plane[row]), curves.parameters[row])
            curves.plane[row] = plane
            curves.parameters[row] = p
        moved = path.replace(
            start=positions[0], target=positions[1:].reshape(n, -1), mark=mark, curves=curves
        )
        return moved.replace(length=path_lengths(moved))

    def _curve(self, kind: int, plane: int, p: Floats) -> tuple[int, Floats]:
        """The mapped curve row and its plane."""
        f = self.frame
        out = np.zeros(12)
        if plane == Plane.SPACE:
            out[:] = _linear(f.scale * f.q, p.reshape(3, 4), f.t).ravel()
            return plane, out
        normal = f.plane_to(THIRD_AXIS[plane])
        assert normal is not None
        new = int(_PLANE_OF_NORMAL[normal])
        rows, columns = PLANE_AXES[new], PLANE_AXES[plane]
        q2 = f.q[np.ix_(rows, columns)]
        t2 = f.t[list(rows)]
        if kind == Kind.POLYNOMIAL:
            out[:8] = _linear(f.scale * q2, p[:8].reshape(2, 4), t2).ravel()
            return new, out
        side = 1.0 if float(np.linalg.det(q2)) > 0.0 else -1.0
        turn = float(np.arctan2(q2[1, 0], q2[0, 0]))
        out[:] = p
        out[:2] = f.scale * (q2 @ p[:2]) + t2
        out[2] = f.scale * p[2]
        if kind == Kind.ARC:
            out[3], out[4] = side * p[3] + turn, side * p[4]
        else:
            out[3], out[4] = f.scale * p[3], side * p[4] + turn
            out[5], out[6] = side * p[5], side * p[6]
        return new, out


def _linear(m: Floats, c: Floats, t: Floats) -> Floats:
    """Coefficients of mapped polynomials, Shape (k, 4): the constants also move by t."""
    out: Floats = m @ c
    out[:, 0] += t
    return out


def swap_sides(
    mark: np.ndarray[tuple[int], np.dtype[np.uint16]],
) -> np.ndarray[tuple[int], np.dtype[np.uint16]]:
    """Marks with left and right of tool radius correction exchanged."""
    left, right = mark & int(Mark.TOOL_LEFT), mark & int(Mark.TOOL_RIGHT)
    swapped = mark & ~np.uint16(_SIDES)
    swapped |= np.where(left, np.uint16(Mark.TOOL_RIGHT), np.uint16(0))
    swapped |= np.where(right, np.uint16(Mark.TOOL_LEFT), np.uint16(0))
    return swapped.astype(np.uint16)


def in_space(draft: Draft, i: int, start: Floats, tolerance: float) -> None:
    """Adds the plane curve of row i as cubics in space within `tolerance` [mm]."""
    s = draft.source
    row = int(s.curve[i])
    plane, p, kind, end = int(s.curves.plane[row]), s.curves.parameters[row], int(s.kind[i]), s.target[i]
    way = Way(kind, p.tolist())
    rise = (end[THIRD_AXIS[plane]] - start[THIRD_AXIS[plane]]) / way.length if way.length > 0.0 else 0.0

    def at(share: float) -> tuple[Floats, Floats]:
        u = way.parameter(share)
        return (
            np.array(place_on(kind, plane, p, start, end, u)),
            np.array(tangent_at(kind, plane, p, u, float(rise))),
        )

    before = 0.0
    for share, c in cubics(at, float(s.length[i]), tolerance):
        target = start + share * (end - start)
        target[:3] = at(share)[0] if share < 1.0 else end[:3]
        draft.add(Kind.POLYNOMIAL, target, (int(Plane.SPACE), c.ravel().tolist()), i, before, share)
        before = share
