"""A DXF file as pieces in millimetres, with what was taken and what was left out.

Layers that are off, frozen or not plotted, Defpoints, paper space, invisible entities and everything that is
no flat curve are left out, and said so.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np

from nccompile.diagnostics import Diagnostic, Diagnostics, Severity
from nccompile.importers.dxf.blocks import BY_LAYER, Collector, Names, Options
from nccompile.importers.dxf.document import Document, open_document
from nccompile.importers.dxf.pieces import Pieces, flatten, transform
from nccompile.source import NOWHERE

__all__ = ["UNITS", "Drawing", "ReadOptions", "read_drawing"]

UNITS = {"mm": 4, "cm": 5, "m": 6, "inch": 1, "ft": 2, "um": 13}
"""Values of `--units` and their number in the header ($INSUNITS)."""

MILLIMETRES = 4
FAR = 1e6
"""Coordinates above this [mm] are farther out than machines are large."""


@dataclass(frozen=True)
class ReadOptions:
    """What the user asked for; `units` a key of `UNITS` or empty, `tolerance` [mm], layers as patterns."""

    units: str = ""
    tolerance: float = 0.005
    texts: bool = False
    hatches: bool = False
    layers: tuple[str, ...] = ()
    ask_units: Callable[[float, float], str] | None = None


@dataclass(frozen=True)
class Drawing:
    """What of a drawing can be machined.

    pieces: [mm], colours resolved;  layers: names by number;  units: name of the drawing's unit;
    taken: entities by type;  left: entities by (type, reason);  hidden: layer -> (why, entities).
    """

    name: str
    version: str
    units: str
    pieces: Pieces
    layers: tuple[str, ...]
    taken: Counter[str]
    left: Counter[tuple[str, str]]
    hidden: dict[str, tuple[str, int]]

    @property
    def extents(self) -> tuple[complex, complex]:
        """Lower left and upper right corner [mm]; 0 and 0 for a drawing without pieces."""
        points = np.concatenate(flatten(self.pieces, 0.05)) if len(self.pieces) else np.zeros(1, complex)
        low = complex(points.real.min(), points.imag.min())
        return low, complex(points.real.max(), points.imag.max())


def read_drawing(
    path: Path, options: ReadOptions, found: Diagnostics, progress: Callable[[int], None] | None = None
) -> Drawing | None:
    """Reads a drawing; None if a finding of severity error says why there is none.

    Args: progress: called with the number of entities read so far, about every thousand.
    """
    document = open_document(path, found)
    if document is None:
        return None
    layers = Names()
    scale = _scale(UNITS[options.units]) if options.units else _scale(document.units) or 1.0
    wanted = Options(options.tolerance / scale, options.texts, options.hatches)
    collector = Collector(document.doc, wanted, layers)
    raw = collector.collect(_counted(document.entities(), progress))
    shown, hidden = _visible(raw, layers.names, document.doc, options)
    unit, scale = _unit(document, options, shown, found, path)
    pieces = transform(shown, complex(scale), 1j * scale, 0j)
    drawing = Drawing(
        path.name,
        document.version,
        unit,
        pieces,
        tuple(layers.names),
        collector.taken,
        collector.left,
        hidden,
    )
    _say(drawing, found, path)
    return drawing if found.errors == 0 else None


def _counted(entities: Iterator[Any], progress: Callable[[int], None] | None) -> Iterator[Any]:
    for count, entity in enumerate(entities):
        if progress and count % 1000 == 0:
            progress(count)
        yield entity


def _scale(insunits: int) -> float:
    """Millimetres in one drawing unit of number $INSUNITS; 0 if it has no unit."""
    from ezdxf import units  # noqa: PLC0415
    from ezdxf.enums import InsertUnits  # noqa: PLC0415

    if insunits not in range(1, 25):
        return 0.0
    return float(units.conversion_factor(InsertUnits(insunits), InsertUnits(MILLIMETRES)))


def _unit(
    document: Document, options: ReadOptions, shown: Pieces, found: Diagnostics, path: Path
) -> tuple[str, float]:
    """The drawing's unit and its size [mm]: the option, the header, the user's answer, or mm with a warning."""
    from ezdxf import units  # noqa: PLC0415

    if options.units:
        return options.units, _scale(UNITS[options.units])
    if _scale(document.units):
        return str(units.decode(document.units)), _scale(document.units)
    ends = np.concatenate([shown.start, shown.end]) if len(shown) else np.zeros(1, complex)
    width, height = float(np.ptp(ends.real)), float(np.ptp(ends.imag))
    if options.ask_units is not None and len(shown):
        answer = options.ask_units(width, height)
        return answer, _scale(UNITS[answer])
    if not len(shown):
        return "mm", 1.0
    message = f"the drawing names no unit; its {width:.5g} by {height:.5g} units are taken as mm"
    hint = "say what it was drawn in: --units mm or --units inch"
    found.add(Diagnostic("NC603", Severity.WARNING, message, NOWHERE, str(path), hint))
    return "mm", 1.0


def _visible(
    pieces: Pieces, names: list[str], doc: Any, options: ReadOptions
) -> tuple[Pieces, dict[str, tuple[str, int]]]:
    """The pieces on layers that are shown, their colours resolved, and the layers left out."""
    hidden: dict[str, tuple[str, int]] = {}
    keep = np.ones(len(pieces), bool)
    color = pieces.color.copy()
    for number, name in enumerate(names):
        on = pieces.layer == number
        layer = doc.layers.get(name) if doc.layers.has_entry(name) else None
        color[on & (color == BY_LAYER)] = abs(layer.color) if layer is not None else 7
        why = _why_hidden(name, layer, options.layers)
        if why and on.any():
            keep &= ~on
            hidden[name] = (why, len(np.unique(pieces.entity[on])))
    return pieces.replace(color=color).take(keep), hidden


def _why_hidden(name: str, layer: Any, wanted: tuple[str, ...]) -> str:
    if wanted:
        named = any(fnmatchcase(name.lower(), pattern.lower()) for pattern in wanted)
        return "" if named else "not asked for"
    if name.lower() == "defpoints" or name.lower().startswith("nc_rapid"):
        return "a construction layer"
    if layer is None:
        return ""
    if layer.is_frozen():
        return "frozen"
    if layer.is_off():
        return "off"
    return "" if layer.dxf.get("plot", 1) else "a construction layer (not plotted)"


def _say(drawing: Drawing, found: Diagnostics, path: Path) -> None:
    """Findings about what was left out, and an error if nothing is left."""

    def say(code: str, severity: Severity, message: str, hint: str = "") -> None:
        found.add(Diagnostic(code, severity, message, NOWHERE, str(path), hint))

    for name, (why, count) in drawing.hidden.items():
        say(
            "NC606",
            Severity.NOTE,
            f"layer {name} is left out, {why}: {_entities(count)}",
            "--layer NAME takes it",
        )
    for (kind, reason), count in sorted(drawing.left.items()):
        say("NC605", Severity.WARNING, f"{count} {kind} left out: {reason}")
    if not len(drawing.pieces):
        total = sum(drawing.left.values()) + sum(count for _, count in drawing.hidden.values())
        what = f"none of its {total} entities can be machined" if total else "it is empty"
        hint = "export flat lines, arcs and curves in the XY plane of the model space" if total else ""
        say("NC604", Severity.ERROR, f"the drawing has nothing to machine: {what}", hint)
        return
    low, high = drawing.extents
    if max(abs(low), abs(high)) > FAR:
        message = f"the drawing lies at X{low.real:.6g} Y{low.imag:.6g} mm, far from the origin"
        say("NC611", Severity.WARNING, message, "--origin lower-left moves it to X0 Y0")


def _entities(count: int) -> str:
    return f"{count} entit{'y' if count == 1 else 'ies'}"
