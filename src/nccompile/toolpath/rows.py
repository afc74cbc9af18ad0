"""Rows of a toolpath as plain dictionaries: what `dump --format jsonl` and `csv` write.

Positions are objects keyed by axis, angles in degrees (counter-clockwise positive), the rest in mm, s.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from nccompile.toolpath.columns import EventKind, Kind, Plane, Toolpath
from nccompile.toolpath.lengths import PLANE_AXES
from nccompile.units import deg_from_rad

__all__ = ["rows"]

_KINDS = {int(kind): kind.name.lower() for kind in Kind}


def rows(chunks: Iterable[Toolpath]) -> Iterator[dict[str, Any]]:
    """One dictionary a segment.

    Always: index, line, kind, start, end, length, feed.  Where they apply:

        plane, center, radius, start_angle, sweep      an arc; center is an object keyed by the plane's axes
        main_axis, sub_axis, direction                 half-axes and direction of an ellipse instead of radius;
                                                       its start_angle and sweep are eccentric
        coefficients                                   a polynomial: per axis c0..c3 over t in 0..1
        accel, decel                                   if programmed, and always when planned
        v_end                                          when planned
        switches                                       list of {number, position}, position 0..1
        m                                              {number, k, l, o}, o the name of the data or null
        seconds                                        a dwell
    """
    for chunk in chunks:
        starts = chunk.starts().tolist()
        targets = chunk.target.tolist()
        curves = chunk.curve.tolist()
        accel, decel = chunk.accel.tolist(), chunk.decel.tolist()
        v_end = None if chunk.v_end is None else chunk.v_end.tolist()
        events = _events(chunk)
        plain = zip(
            chunk.line.tolist(), chunk.kind.tolist(), chunk.length.tolist(), chunk.feed.tolist(), strict=True
        )
        for i, (line, kind, length, feed) in enumerate(plain):
            row: dict[str, Any] = {
                "index": chunk.first + i,
                "line": line,
                "kind": _KINDS[kind],
                "start": dict(zip(chunk.axes, starts[i], strict=True)),
                "end": dict(zip(chunk.axes, targets[i], strict=True)),
                "length": length,
                "feed": feed,
            }
            if curves[i] >= 0:
                row |= _curve(chunk, kind, curves[i])
            if v_end is not None:
                row |= {"v_end": v_end[i], "accel": accel[i], "decel": decel[i]}
            elif accel[i] or decel[i]:
                row |= {"accel": accel[i], "decel": decel[i]}
            row |= events.get(i, {})
            yield row


def _curve(chunk: Toolpath, kind: int, at: int) -> dict[str, Any]:
    """The keys of a curve."""
    plane = Plane(int(chunk.curves.plane[at]))
    p = chunk.curves.parameters[at].tolist()
    named = "XYZ" if plane == Plane.SPACE else "".join("XYZ"[axis] for axis in PLANE_AXES[plane])
    row: dict[str, Any] = {"plane": plane.name}
    if kind == Kind.POLYNOMIAL:
        row["coefficients"] = {axis: p[4 * i : 4 * i + 4] for i, axis in enumerate(named)}
        return row
    row["center"] = dict(zip(named, p[:2], strict=True))
    if kind == Kind.ARC:
        return row | {"radius": p[2], "start_angle": deg_from_rad(p[3]), "sweep": deg_from_rad(p[4])}
    return row | {
        "main_axis": p[2],
        "sub_axis": p[3],
        "direction": deg_from_rad(p[4]),
        "start_angle": deg_from_rad(p[5]),
        "sweep": deg_from_rad(p[6]),
    }


def _events(chunk: Toolpath) -> dict[int, dict[str, Any]]:
    """The keys of the events of every row that has some."""
    found: dict[int, dict[str, Any]] = {}
    e = chunk.events
    columns = (e.segment, e.kind, e.number, e.position, e.k, e.l, e.o)
    for segment, kind, number, position, k, l, o in zip(*(c.tolist() for c in columns), strict=True):  # noqa: E741
        row = found.setdefault(segment, {})
        if kind == EventKind.SWITCH:
            row.setdefault("switches", []).append({"number": number, "position": position})
        elif kind == EventKind.M_FUNCTION:
            row["m"] = {"number": number, "k": k, "l": l, "o": chunk.names[o] if o >= 0 else None}
        else:
            row["seconds"] = k
    return found
