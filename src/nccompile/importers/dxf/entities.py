"""One function an entity: its geometry as rows of pieces, in the plane of the block it stands in.

Entities with an extrusion (OCS) direction of -Z are drawn seen from below: x counts to the left.  They are
turned into world coordinates here, so arcs bend the right way and nobody after this has to think of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from math import pi, radians, tau
from typing import TYPE_CHECKING, Any

from nccompile.importers.dxf.pieces import PieceKind, Row, arc_row, bulge_row, ellipse_row, line_row
from nccompile.importers.dxf.splines import spline_rows

if TYPE_CHECKING:
    from ezdxf.entities.dxfentity import DXFEntity

__all__ = ["NotTaken", "hatch_rows", "mirrored", "rows_of"]

FLAT = 1e-6
"""Z values that differ by less than this [drawing units] lie in one plane parallel to XY; so do directions."""


class NotTaken(Exception):
    """An entity that is left out; the text says why."""


def rows_of(entity: DXFEntity, tolerance: float) -> list[Row]:
    """The entity's pieces.

    Args:     tolerance: of splines that are no cubics [drawing units].
    Raises:   NotTaken: no flat curve, not a supported type, or numbers that make no curve.
    """
    take = TAKEN.get(entity.dxftype())
    if take is None:
        raise NotTaken("not a curve")
    try:
        rows = take(entity, tolerance)
    except (ValueError, ZeroDivisionError, IndexError, OverflowError) as error:
        raise NotTaken(f"bad numbers: {error}") from error
    if not all(abs(value) < 1e300 for row in rows for value in row):
        raise NotTaken("bad numbers: not finite")
    rows = [row for row in rows if row[0] != PieceKind.LINE or row[1:3] != row[3:5]]
    if not rows:
        raise NotTaken("no length")
    return rows


def _is_flat_direction(entity: Any) -> bool:
    """Whether the entity's extrusion is +Z or -Z."""
    ex = entity.dxf.get("extrusion")
    return ex is None or (abs(ex.x) <= FLAT and abs(ex.y) <= FLAT and ex.z != 0.0)


def mirrored(entity: Any) -> bool:
    """Whether the entity's own x axis points to -X; raises NotTaken if its plane is not parallel to XY."""
    if not _is_flat_direction(entity):
        raise NotTaken("not parallel to the XY plane")
    ex = entity.dxf.get("extrusion")
    return ex is not None and bool(ex.z < 0.0)


def _flip(z: complex, mirror: bool) -> complex:
    return complex(-z.real, z.imag) if mirror else z


def _same_height(heights: Iterable[float]) -> None:
    values = list(heights)
    if values and max(values) - min(values) > FLAT * (1.0 + max(abs(v) for v in values)):
        raise NotTaken("not parallel to the XY plane")


def _line(e: Any, tolerance: float) -> list[Row]:
    a, b = e.dxf.start, e.dxf.end
    _same_height((a.z, b.z))
    return [line_row(complex(a.x, a.y), complex(b.x, b.y))]


def _point(e: Any, tolerance: float) -> list[Row]:
    at = e.dxf.location
    return [(PieceKind.POINT, at.x, at.y, at.x, at.y, 0, 0, 0, 0, 0, 0, 0)]


def _circle(e: Any, tolerance: float) -> list[Row]:
    return [_round(e, 0.0, tau)]


def _arc(e: Any, tolerance: float) -> list[Row]:
    start = radians(e.dxf.start_angle)
    sweep = (radians(e.dxf.end_angle) - start) % tau
    return [_round(e, start, sweep or tau)]


def _round(e: Any, start: float, sweep: float) -> Row:
    if not e.dxf.radius > 0.0:
        raise NotTaken("no length")
    mirror = mirrored(e)
    centre = _flip(complex(e.dxf.center.x, e.dxf.center.y), mirror)
    if mirror:
        start, sweep = pi - start, -sweep
    return arc_row(centre, e.dxf.radius, start, sweep)


def _ellipse(e: Any, tolerance: float) -> list[Row]:
    mirror = mirrored(e)
    main = complex(e.dxf.major_axis.x, e.dxf.major_axis.y)
    if abs(e.dxf.major_axis.z) > FLAT * abs(main):
        raise NotTaken("not parallel to the XY plane")
    sub = (-1j if mirror else 1j) * main * e.dxf.ratio
    start = e.dxf.start_param
    sweep = (e.dxf.end_param - start) % tau
    if sweep < 1e-9 or tau - sweep < 1e-9:
        sweep = tau
    centre = complex(e.dxf.center.x, e.dxf.center.y)
    return [ellipse_row(centre, main, sub, start, sweep)]


def _bulges(points: list[tuple[complex, float]], closed: bool) -> list[Row]:
    pairs = list(zip(points, points[1:] + points[:1] if closed else points[1:], strict=False))
    return [bulge_row(a, b, bulge) for (a, bulge), (b, _) in pairs if a != b]


def _lwpolyline(e: Any, tolerance: float) -> list[Row]:
    mirror = mirrored(e)
    sign = -1.0 if mirror else 1.0
    points = [(_flip(complex(x, y), mirror), sign * b) for x, y, b in e.get_points("xyb")]
    return _bulges(points, e.closed)


def _polyline(e: Any, tolerance: float) -> list[Row]:
    if not (e.is_2d_polyline or e.is_3d_polyline):
        raise NotTaken("a 3D mesh")
    mirror = e.is_2d_polyline and mirrored(e)
    sign = -1.0 if mirror else 1.0
    spline_frame = 16
    vertices = [v.dxf for v in e.vertices if not v.dxf.flags & spline_frame]
    _same_height(v.location.z for v in vertices)
    points = [
        (_flip(complex(v.location.x, v.location.y), mirror), sign * v.get("bulge", 0.0)) for v in vertices
    ]
    return _bulges(points, e.is_closed)


def _spline(e: Any, tolerance: float) -> list[Row]:
    tool = e.construction_tool()
    control = list(tool.control_points)
    _same_height(p.z for p in control)
    points = [complex(p.x, p.y) for p in control]
    return spline_rows(tool.degree, list(tool.knots()), points, list(tool.weights()), tolerance)


def hatch_rows(e: Any, tolerance: float) -> list[Row]:
    """The boundary paths of a HATCH or MPOLYGON."""
    mirror = mirrored(e)
    rows: list[Row] = []
    for path in e.paths:
        if hasattr(path, "vertices"):
            sign = -1.0 if mirror else 1.0
            points = [(_flip(complex(x, y), mirror), sign * bulge) for x, y, bulge in path.vertices]
            rows += _bulges(points, path.is_closed)
        else:
            for edge in path.edges:
                rows += _hatch_edge(edge, mirror, tolerance)
    return rows


def _hatch_edge(edge: Any, mirror: bool, tolerance: float) -> list[Row]:
    def at(p: Any) -> complex:
        return _flip(complex(p.x, p.y), mirror)

    kind = type(edge).__name__
    if kind == "LineEdge":
        return [line_row(at(edge.start), at(edge.end))]
    if kind == "SplineEdge":
        points = [at(p) for p in edge.control_points]
        return spline_rows(edge.degree, list(edge.knot_values), points, list(edge.weights), tolerance)
    if kind == "ArcEdge":
        start, end, main, ratio = (
            radians(edge.start_angle),
            radians(edge.end_angle),
            complex(edge.radius),
            1.0,
        )
    else:
        start, end, ratio = edge.start_param, edge.end_param, edge.ratio
        main = complex(edge.major_axis.x, edge.major_axis.y)
    sweep = (end - start) % tau
    if sweep < FLAT or tau - sweep < FLAT:
        sweep = tau
    return [ellipse_row(at(edge.center), _flip(main, mirror), _flip(1j * main * ratio, mirror), start, sweep)]


TAKEN: dict[str, Callable[[Any, float], list[Row]]] = {
    "LINE": _line,
    "ARC": _arc,
    "CIRCLE": _circle,
    "ELLIPSE": _ellipse,
    "LWPOLYLINE": _lwpolyline,
    "POLYLINE": _polyline,
    "SPLINE": _spline,
    "POINT": _point,
}
"""What every entity type gives; INSERT, HATCH and texts are treated by `blocks`."""
