"""Toolpaths as DXF drawings, to be looked at in a CAD program or imported again.

Lines and arcs at one height become polylines, a contour one of them, so that it stays in one piece; other
segments become the entity that is exactly them: LINE (in three dimensions where Z moves), CIRCLE, ELLIPSE,
SPLINE.  Layers say what a segment is; a suffix says which stage it is from.

    NC_FEED      feed moves                    NC_RAPID     positionings (import-dxf leaves them out)
    NC_SWITCH    switch points, M functions and dwells as points (not plotted)

A helix, and a curve in another plane than XY, is drawn as a polyline within the tolerance: DXF has no arc that
climbs.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import ceil, degrees, pi, tan
from typing import Any, TextIO

import numpy as np
import numpy.typing as npt

from nccompile.geometry.sampling import sample_curves
from nccompile.toolpath import Kind, Plane, Toolpath
from nccompile.toolpath.lengths import PLANE_AXES

__all__ = ["COLORS", "DxfExport"]

Floats = npt.NDArray[np.float64]

COLORS = {"NC_FEED": 5, "NC_RAPID": 3, "NC_SWITCH": 1}
"""AutoCAD colours of the layers, those of `nccompile plot`."""

FULL = 2 * pi - 1e-12
MILLIMETRES = 4


class DxfExport:
    """A drawing that toolpaths are added to and that is written at the end."""

    def __init__(self, tolerance: float = 0.001) -> None:
        """tolerance: of curves that are drawn as polylines [mm]."""
        import ezdxf.filemanagement  # noqa: PLC0415

        self._doc: Any = ezdxf.filemanagement.new("R2010")
        self._doc.header["$INSUNITS"] = MILLIMETRES
        self._doc.header["$MEASUREMENT"] = 1
        self._tolerance = tolerance

    def add(self, chunks: Iterable[Toolpath], suffix: str = "") -> int:
        """Draws a toolpath; returns the number of entities.

        Args: suffix: of its layers' names, to keep several stages apart.
        """
        for name, color in COLORS.items():
            layer = self._doc.layers.add(name + suffix, color=color)
            layer.dxf.plot = int(name == "NC_FEED")
        space = self._doc.modelspace()
        before = len(space)
        run = _Run(space)
        for chunk in chunks:
            starts = chunk.starts()
            marked = set(chunk.events.segment.tolist())
            for i, kind in enumerate(chunk.kind.tolist()):
                layer_name = ("NC_RAPID" if kind == Kind.POSITIONING else "NC_FEED") + suffix
                if kind <= Kind.POLYNOMIAL and not run.takes(chunk, i, kind, starts[i], layer_name):
                    run.end()
                    self._segment(space, chunk, i, kind, starts[i], {"layer": layer_name})
                if i in marked:
                    self._events(space, chunk, i, starts[i], {"layer": "NC_SWITCH" + suffix})
        run.end()
        return len(space) - before

    def write(self, file: TextIO) -> None:
        """Writes the drawing as text."""
        self._doc.write(file)

    def _segment(
        self, space: Any, chunk: Toolpath, i: int, kind: int, start: Floats, attributes: dict[str, Any]
    ) -> None:
        """A segment that no polyline holds."""
        a, b = start[:3], chunk.target[i][:3]
        if chunk.curve[i] < 0:
            if not np.array_equal(a, b):
                space.add_line(tuple(a), tuple(b), attributes)
            return
        row = chunk.curves.parameters[chunk.curve[i]]
        plane = Plane(int(chunk.curves.plane[chunk.curve[i]]))
        if plane is not Plane.XY or a[2] != b[2]:
            space.add_polyline3d(
                [tuple(p) for p in self._points(kind, plane, row, a, b)], dxfattribs=attributes
            )
        elif kind == Kind.ARC:
            _arc(space, row, float(a[2]), attributes)
        elif kind == Kind.ELLIPSE:
            _ellipse(space, row, float(a[2]), attributes)
        else:
            _cubic(space, row, float(a[2]), attributes)

    def _points(self, kind: int, plane: Plane, row: Floats, a: Floats, b: Floats) -> Floats:
        """Shape (n, 3): a curve as a polyline; the axis its plane leaves over goes along evenly."""
        kinds, rows = np.array([kind], np.uint8), row[None, :]
        probe = sample_curves(kinds, rows, np.linspace(0.0, 1.0, 65))[0]
        bend = float(np.abs(np.diff(probe, 2, axis=0)).max(initial=0.0))
        count = max(2, ceil(64 * (bend / (2 * self._tolerance)) ** 0.5))
        u = np.linspace(0.0, 1.0, count + 1)
        curve = sample_curves(kinds, rows, u)[0]
        if plane is Plane.SPACE:
            return np.asarray(curve, np.float64)
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))])
        points: Floats = a + (b - a) * (along / along[-1])[:, None]
        first, second = PLANE_AXES[plane]
        points[:, first], points[:, second] = curve[:, 0], curve[:, 1]
        return points

    def _events(self, space: Any, chunk: Toolpath, i: int, start: Floats, attributes: dict[str, Any]) -> None:
        rows = np.flatnonzero(chunk.events.segment == i)
        for e in rows.tolist():
            share = float(chunk.events.position[e])
            place = start[:3] + (chunk.target[i][:3] - start[:3]) * share
            if chunk.curve[i] >= 0:
                row, plane = chunk.curve[i], int(chunk.curves.plane[chunk.curve[i]])
                curve = self._points(int(chunk.kind[i]), Plane(plane), chunk.curves.parameters[row],
                                     start[:3], chunk.target[i][:3])  # fmt: skip
                place = curve[round(share * (len(curve) - 1))]
            space.add_point(tuple(place), attributes)


class _Run:
    """Feed moves in lines and arcs at one height that follow each other: one polyline."""

    def __init__(self, space: Any) -> None:
        self._space = space
        self._points: list[tuple[float, float, float]] = []
        self._layer = ""
        self._height = 0.0
        self._last = (0.0, 0.0)

    def takes(self, chunk: Toolpath, i: int, kind: int, start: Floats, layer: str) -> bool:
        """Adds a segment if it is a line or an arc, not a full circle, at the height of the run."""
        target = chunk.target[i]
        row = None if chunk.curve[i] < 0 else chunk.curves.parameters[chunk.curve[i]]
        sweep = 0.0 if row is None else float(row[4])
        flat = kind in {Kind.LINE, Kind.ARC} and start[2] == target[2] and abs(sweep) < FULL
        if row is not None:
            flat = flat and chunk.curves.plane[chunk.curve[i]] == Plane.XY
        if not flat or np.array_equal(start[:2], target[:2]):
            return False
        if self._points and (layer, float(start[2])) != (self._layer, self._height):
            self.end()
        self._layer, self._height = layer, float(start[2])
        self._points.append((float(start[0]), float(start[1]), tan(sweep / 4)))
        self._last = (float(target[0]), float(target[1]))
        return True

    def end(self) -> None:
        """Draws what was gathered: a LINE if it is one, else a polyline, closed if it ends where it began."""
        points, self._points = self._points, []
        if not points:
            return
        attributes = {"layer": self._layer, "elevation": self._height}
        if len(points) == 1 and points[0][2] == 0.0:
            ends = [(x, y, self._height) for x, y in (points[0][:2], self._last)]
            self._space.add_line(*ends, {"layer": self._layer})
            return
        closed = points[0][:2] == self._last
        everything = points if closed else [*points, (*self._last, 0.0)]
        self._space.add_lwpolyline(everything, format="xyb", close=closed, dxfattribs=attributes)


def _arc(space: Any, row: Floats, z: float, attributes: dict[str, Any]) -> None:
    """DXF arcs are counter-clockwise; a clockwise one is drawn seen from below, so that it keeps its direction."""
    cx, cy, radius, start, sweep = (float(v) for v in row[:5])
    if sweep > 0:
        centre, begin = (cx, cy, z), start
    else:
        centre, begin = (-cx, cy, -z), pi - start
        attributes = attributes | {"extrusion": (0, 0, -1)}
    if abs(sweep) >= FULL:
        space.add_circle(centre, radius, attributes)
    else:
        space.add_arc(centre, radius, degrees(begin), degrees(begin + abs(sweep)), dxfattribs=attributes)


def _ellipse(space: Any, row: Floats, z: float, attributes: dict[str, Any]) -> None:
    """An ellipse lies in world coordinates; the extrusion turns the direction of its parameter."""
    cx, cy, main, sub, direction, start, sweep = (float(v) for v in row[:7])
    axis = (main * np.cos(direction), main * np.sin(direction), 0.0)
    if sweep < 0:
        attributes = attributes | {"extrusion": (0, 0, -1)}
        start = -start
    ellipse = space.add_ellipse((cx, cy, z), axis, sub / main, dxfattribs=attributes)
    ellipse.dxf.start_param, ellipse.dxf.end_param = start, start + abs(sweep)


def _cubic(space: Any, row: Floats, z: float, attributes: dict[str, Any]) -> None:
    """The cubic as a Bezier curve: a clamped spline of degree three."""
    c = [complex(row[k], row[4 + k]) for k in range(4)]
    points = [c[0], c[0] + c[1] / 3, c[0] + (2 * c[1] + c[2]) / 3, sum(c)]
    space.add_open_spline([(p.real, p.imag, z) for p in points], degree=3, dxfattribs=attributes)
