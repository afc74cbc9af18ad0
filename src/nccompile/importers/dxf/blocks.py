"""A drawing's entities as pieces, INSERTs placed: block by block, never piece by piece.

A block is read once; every INSERT of it is one affine map of its columns.  Layer 0 and colours ByBlock inside a
block stand for what the INSERT has: they are kept open (layer -1, colour 0) until the block is placed.
"""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from math import radians
from typing import Any

import numpy as np

from nccompile.importers.dxf.entities import NotTaken, hatch_rows, mirrored, rows_of
from nccompile.importers.dxf.pieces import Pieces, transform
from nccompile.importers.dxf.texts import text_rows

__all__ = ["BY_BLOCK", "BY_LAYER", "Collector", "Names", "Options"]

BY_BLOCK, BY_LAYER, OPEN_LAYER = 0, 256, -1
NESTING = 64
"""Blocks in blocks in blocks at most; what is deeper refers to itself."""
BATCH = 50_000


@dataclass(frozen=True)
class Options:
    """What is read: `tolerance` of rational and high-degree splines [drawing units], texts, hatch boundaries."""

    tolerance: float
    texts: bool = False
    hatches: bool = False


class Names:
    """Layer names and their numbers, in the order of their first use."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self._index: dict[str, int] = {}

    def number(self, name: str) -> int:
        """The number of a layer; names are equal whatever their case."""
        key = name.lower()
        if key not in self._index:
            self._index[key] = len(self.names)
            self.names.append(name)
        return self._index[key]


@dataclass
class Collector:
    """Turns entities into pieces; counts what was taken (by type) and left out (by type and reason)."""

    doc: Any
    options: Options
    layers: Names
    taken: Counter[str] = field(default_factory=Counter)
    left: Counter[tuple[str, str]] = field(default_factory=Counter)
    _blocks: dict[str, Pieces] = field(default_factory=dict)
    _open: set[str] = field(default_factory=set)
    _frozen: dict[str, bool] = field(default_factory=dict)

    def collect(self, entities: Iterable[Any], *, inside: bool = False) -> Pieces:
        """The pieces of the entities; `inside` a block, layer 0 stays open."""
        parts: list[Pieces] = []
        table, tags = array("d"), array("i")
        count = 0
        for entity in entities:
            kind = entity.dxftype()
            try:
                layer, color = self._tags(entity, inside)
                if kind == "INSERT":
                    placed = self._insert(entity, layer, color)
                    parts += [_flush(table, tags), placed.replace(entity=placed.entity + count)]
                    count += int(placed.entity.max(initial=0)) + 1
                    table, tags = array("d"), array("i")
                    self.taken["INSERT"] += 1
                    continue
                rows = self._rows(entity, kind)
            except NotTaken as reason:
                self.left[kind, str(reason)] += 1
                continue
            for row in rows:
                table.extend(row)
                tags.extend((layer, color, count))
            count += 1
            self.taken[kind] += 1
            if len(tags) > 3 * BATCH:
                parts.append(_flush(table, tags))
                table, tags = array("d"), array("i")
        parts.append(_flush(table, tags))
        return Pieces.join(parts)

    def _rows(self, entity: Any, kind: str) -> Any:
        if kind in {"TEXT", "MTEXT", "ATTRIB"}:
            if not self.options.texts:
                raise NotTaken("text (engraved with --text)")
            mirrored(entity)
            return text_rows(entity)
        if kind in {"HATCH", "MPOLYGON"}:
            if not self.options.hatches:
                raise NotTaken("hatch (boundary cut with --hatch)")
            return hatch_rows(entity, self.options.tolerance)
        return rows_of(entity, self.options.tolerance)

    def _tags(self, entity: Any, inside: bool) -> tuple[int, int]:
        dxf = entity.dxf
        if dxf.get("invisible", 0):
            raise NotTaken("invisible")
        if not inside and dxf.get("paperspace", 0):
            raise NotTaken("paper space")
        name = dxf.get("layer", "0")
        layer = OPEN_LAYER if inside and name == "0" else self.layers.number(name)
        return layer, int(dxf.get("color", BY_LAYER))

    def _insert(self, insert: Any, layer: int, color: int) -> Pieces:
        """The placed block, once for every row and column of the INSERT."""
        name = insert.dxf.get("name", "")
        if self._is_frozen(insert.dxf.get("layer", "0")):
            raise NotTaken("on a frozen layer")
        block = self._block(name)
        mirror = mirrored(insert)
        u, v = complex(insert.dxf.xscale, 0.0), complex(0.0, insert.dxf.yscale)
        if u == 0 or v == 0:
            raise NotTaken("scale 0")
        angle = radians(insert.dxf.rotation)
        turn = complex(np.cos(angle), np.sin(angle))
        at = complex(insert.dxf.insert.x, insert.dxf.insert.y)
        base = self.doc.blocks.get(name).block.dxf.base_point
        columns, rows = max(1, insert.dxf.column_count), max(1, insert.dxf.row_count)
        step = complex(insert.dxf.column_spacing, insert.dxf.row_spacing)
        own = block.replace(
            layer=np.where(block.layer == OPEN_LAYER, layer, block.layer).astype(np.int32),
            color=np.where(block.color == BY_BLOCK, color, block.color).astype(np.int32),
        )
        parts: list[Pieces] = []
        entities = int(block.entity.max(initial=0)) + 1
        for row in range(rows):
            for column in range(columns):
                cell = at + turn * complex(step.real * column, step.imag * row)
                shift = cell - turn * (u * base.x + v * base.y)
                maps = [turn * u, turn * v, shift]
                if mirror:
                    maps = [complex(-z.real, z.imag) for z in maps]
                placed = transform(own, *maps)
                parts.append(placed.replace(entity=placed.entity + entities * len(parts)))
        return Pieces.join(parts)

    def _block(self, name: str) -> Pieces:
        if name not in self._blocks:
            layout = self.doc.blocks.get(name)
            if layout is None:
                raise NotTaken("its block is missing")
            if layout.block is not None and layout.block.is_xref:
                raise NotTaken("an external reference")
            if name in self._open or len(self._open) >= NESTING:
                raise NotTaken("a block that contains itself")
            self._open.add(name)
            self._blocks[name] = self.collect(layout, inside=True)
            self._open.discard(name)
        return self._blocks[name]

    def _is_frozen(self, name: str) -> bool:
        if name not in self._frozen:
            layer = self.doc.layers.get(name) if self.doc.layers.has_entry(name) else None
            self._frozen[name] = layer is not None and layer.is_frozen()
        return self._frozen[name]


def _flush(table: array[float], tags: array[int]) -> Pieces:
    columns = np.frombuffer(tags, np.int32).reshape(-1, 3) if len(tags) else np.zeros((0, 3), np.int32)
    rows = np.frombuffer(table, float).reshape(len(columns), -1) if len(tags) else np.zeros((0, 12))
    return Pieces.from_rows(rows, columns[:, 0], columns[:, 1], columns[:, 2])
