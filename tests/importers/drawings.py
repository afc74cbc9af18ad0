"""Random drawings, and two samplers that share no code with the importer: ezdxf's flattening and a small reader
of the programs.
"""

from __future__ import annotations

import math
import random
import re
from collections.abc import Iterator
from typing import Any

import ezdxf.filemanagement
import numpy as np
import numpy.typing as npt
import shapely
from ezdxf.math import Matrix44

Points = npt.NDArray[np.float64]

WORD = re.compile(r"([A-Z])([-+]?[0-9.]+)")
MILLIMETRES = {1: 25.4, 4: 1.0, 5: 10.0}


def random_drawing(seed: int, entities: int = 12) -> Any:
    """A drawing of all entities that are machined, blocks in blocks, mirrored, scaled and seen from below."""
    r = random.Random(seed)
    doc: Any = ezdxf.filemanagement.new(r.choice(["R12", "R2000", "R2010", "R2018"]))
    if doc.dxfversion > "AC1009":
        doc.header["$INSUNITS"] = r.choice([1, 4, 4, 5])
    scale = 40.0 / _millimetres(doc)
    blocks: list[str] = []
    for depth in range(r.randint(0, 3)):
        block = doc.blocks.new(f"B{depth}", base_point=(_near(r, scale), _near(r, scale)))
        for _ in range(r.randint(1, 3)):
            _add(r, doc, block, scale, blocks)
        blocks.append(block.name)
    for _ in range(r.randint(1, entities)):
        _add(r, doc, doc.modelspace(), scale, blocks)
    return doc


def _millimetres(doc: Any) -> float:
    """Size of the drawing's unit; R12 files have no place for it."""
    return 1.0 if doc.dxfversion <= "AC1009" else MILLIMETRES[int(doc.header["$INSUNITS"])]


def _near(r: random.Random, scale: float) -> float:
    return r.uniform(-1, 1) * scale


def _extrusion(r: random.Random) -> dict[str, Any]:
    return {"extrusion": (0, 0, -1)} if r.random() < 0.3 else {}


def _add(r: random.Random, doc: Any, space: Any, scale: float, blocks: list[str]) -> None:
    """One random entity; sizes stay between a millimetre and some hundred after all scaling."""
    at = (_near(r, scale), _near(r, scale))
    size = r.uniform(0.1, 1) * scale
    old = doc.dxfversion <= "AC1009"
    kinds = ["LINE", "ARC", "CIRCLE", "POLYLINE"] + (
        [] if old else ["ELLIPSE", "SPLINE", "LWPOLYLINE", "LWPOLYLINE"]
    )
    kinds += ["INSERT"] * 3 if blocks else []
    kind = r.choice(kinds)
    look = _extrusion(r)
    if kind == "LINE":
        space.add_line(at, (_near(r, scale), _near(r, scale)))
    elif kind == "ARC":
        space.add_arc(at, size, r.uniform(0, 360), r.uniform(0, 360), dxfattribs=look)
    elif kind == "CIRCLE":
        space.add_circle(at, size, look)
    elif kind == "ELLIPSE":
        angle, ratio = r.uniform(0, math.tau), r.uniform(0.05, 1)
        major = (size * math.cos(angle), size * math.sin(angle))
        start, end = (0.0, math.tau) if r.random() < 0.3 else (r.uniform(0, math.tau), r.uniform(0, math.tau))
        space.add_ellipse(at, major, ratio, start, end, dxfattribs=look)
    elif kind in {"LWPOLYLINE", "POLYLINE"}:
        points = [(_near(r, scale), _near(r, scale), r.choice([0, 0, r.uniform(-1.5, 1.5)]))
                  for _ in range(r.randint(2, 6))]  # fmt: skip
        closed = r.random() < 0.5
        if kind == "LWPOLYLINE":
            space.add_lwpolyline(points, format="xyb", close=closed, dxfattribs=look)
        else:
            space.add_polyline2d(points, format="xyb", close=closed, dxfattribs=look)
    elif kind == "SPLINE":
        degree = r.choice([2, 3, 3, 4, 5])
        points3 = [(_near(r, scale), _near(r, scale), 0) for _ in range(degree + 1 + r.randint(0, 5))]
        if r.random() < 0.4:
            space.add_rational_spline(points3, [r.uniform(0.3, 3) for _ in points3], degree=degree)
        else:
            space.add_open_spline(points3, degree=degree)
    else:
        _insert(r, space, blocks, at, look)


def _insert(
    r: random.Random, space: Any, blocks: list[str], at: tuple[float, float], look: dict[str, Any]
) -> None:
    factor = r.uniform(0.5, 1.5)
    x, y = factor * r.choice([1, 1, -1]), factor * r.choice([1, 1, -1])
    if r.random() < 0.4:
        x *= r.uniform(0.4, 1.6)
    attributes = {"xscale": x, "yscale": y, "zscale": abs(factor), "rotation": r.uniform(0, 360), **look}
    if r.random() < 0.2:
        attributes |= {"column_count": 2, "row_count": 2, "column_spacing": 30.0, "row_spacing": 20.0}
    space.add_blockref(r.choice(blocks), at, dxfattribs=attributes)


def drawn_lines(doc: Any, fine: float = 0.001) -> list[Points]:
    """The model space as polylines [mm], by ezdxf."""
    scale = _millimetres(doc)
    lines = []
    for part, matrix in _leaves(doc.modelspace(), Matrix44()):
        points = matrix.transform_vertices(_flattened(part, fine / scale / 4))
        lines.append(np.array([(p.x, p.y) for p in points]) * scale)
    return [line for line in lines if np.abs(np.diff(line, axis=0)).sum() > 1e-4]


def _leaves(space: Any, matrix: Matrix44) -> Iterator[tuple[Any, Matrix44]]:
    """Every curve with the matrix that places it.

    Points are placed, not entities: ezdxf 1.4 moves an INSERT inside an INSERT wrongly where turning it and
    scaling it unevenly make its axes oblique, which no INSERT can express.
    """
    for entity in space:
        if entity.dxftype() == "INSERT":
            for one in entity.multi_insert() if entity.mcount > 1 else [entity]:
                yield from _leaves(one.block(), one.matrix44() @ matrix)
        elif entity.dxftype() in {"LWPOLYLINE", "POLYLINE"}:
            yield from ((part, matrix) for part in entity.virtual_entities())
        else:
            yield entity, matrix


def _flattened(entity: Any, fine: float) -> list[Any]:
    """Points of a LINE, ARC, CIRCLE, ELLIPSE or SPLINE in world coordinates."""
    if entity.dxftype() == "LINE":
        return [entity.dxf.start, entity.dxf.end]
    if (
        entity.dxftype() == "SPLINE"
    ):  # its flattening looks at the middle of a stretch only and misses S-bends
        return list(entity.construction_tool().approximate(1500))
    return list(entity.flattening(fine))


def machined_lines(program: str, fine: float = 0.001) -> list[Points]:
    """The feed moves of a program as polylines, by a reader of G0 G1 G2 G3 G8 G9 with relative I and J."""
    lines, x, y = [], 0.0, 0.0
    for block in program.splitlines():
        words = dict(WORD.findall(block)) if block.startswith("N") else {}
        if "G" not in words:
            continue
        tx, ty = float(words.get("X", x)), float(words.get("Y", y))
        code = int(words["G"])
        if code == 1:
            lines.append(np.array([(x, y), (tx, ty)]))
        elif code in {2, 3}:
            lines.append(_round(words, x, y, tx, ty, 0.0, 1.0, code == 3, fine))
        elif code in {8, 9}:
            direction, ratio = math.radians(float(words["K"])), float(words["R"])
            lines.append(_round(words, x, y, tx, ty, direction, ratio, code == 9, fine))
        x, y = tx, ty
    return lines


def _round(
    words: dict[str, str], x: float, y: float, tx: float, ty: float, direction: float, ratio: float, ccw: bool,
    fine: float,
) -> Points:  # fmt: skip
    """An arc or ellipse arc as a polyline: turned and stretched it is a circle."""
    axis = complex(math.cos(direction), math.sin(direction))
    centre = complex(x + float(words["I"]), y + float(words["J"]))

    def stretched(px: float, py: float) -> complex:
        z = (complex(px, py) - centre) / axis
        return complex(z.real, z.imag / ratio)

    a, b = stretched(x, y), stretched(tx, ty)
    sweep = float(np.angle(b / a)) % math.tau
    sweep = sweep if ccw else sweep - math.tau
    if (x, y) == (tx, ty):
        sweep = math.tau if ccw else -math.tau
    count = max(4, math.ceil(abs(sweep) / math.sqrt(8 * fine / max(abs(a), 8 * fine))))
    turned = a * np.exp(1j * sweep * np.linspace(0, 1, count + 1))
    z = centre + axis * (turned.real + 1j * ratio * turned.imag)
    return np.column_stack([z.real, z.imag])


def distance(a: list[Points], b: list[Points], step: float = 0.25) -> float:
    """The farthest that a point of `a` (vertices and points every `step` mm) is from `b`."""
    pairs = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in b])
    tree = shapely.STRtree(shapely.linestrings(pairs))
    points = np.vstack(list(_dense(a, step)))
    _, found = tree.query_nearest(shapely.points(points), return_distance=True, all_matches=False)
    return float(found.max())


def _dense(lines: list[Points], step: float) -> Iterator[Points]:
    for line in lines:
        length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
        at = np.unique(np.concatenate([length, np.arange(0.0, length[-1], step)]))
        yield np.column_stack([np.interp(at, length, line[:, k]) for k in (0, 1)])
