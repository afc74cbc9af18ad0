"""From a drawing to programs: groups, cleaning, joining, operations, and how the result is split."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from nccompile.diagnostics import Diagnostic, Diagnostics, Severity
from nccompile.importers.dxf.assemble import Moves
from nccompile.importers.dxf.clean import Place, remove_doubles
from nccompile.importers.dxf.fit import arcs_for_cubics, on_grid
from nccompile.importers.dxf.grid import Indices
from nccompile.importers.dxf.job import Job
from nccompile.importers.dxf.join import Paths, join_pieces
from nccompile.importers.dxf.leads import Obstacles
from nccompile.importers.dxf.machining import Prepared, Workshop, cut, finish, prepare
from nccompile.importers.dxf.order import rapid_length
from nccompile.importers.dxf.pieces import Pieces, lengths, transform
from nccompile.importers.dxf.read import Drawing
from nccompile.source import NOWHERE
from nccompile.toolpath import Kind

__all__ = ["ConvertOptions", "NamedProgram", "Result", "convert"]

Split = Literal["whole", "layers", "segments"]

DOUBLE = 1e-3
"""[mm] Curves that stay this close to each other are drawn twice."""


@dataclass(frozen=True)
class ConvertOptions:
    """How a drawing becomes programs.

    split: one program, one a layer or one a path;  gap, tolerance [mm];  origin: `drawing`, `lower-left` or X,Y
    of the drawing that become 0, 0;  cubics: keep them (queues can, programs cannot);  seed: of the search.
    """

    split: Split = "whole"
    gap: float = 0.01
    tolerance: float = 0.005
    decimals: int = 4
    origin: str | tuple[float, float] = "drawing"
    cubics: bool = False
    seed: int = 0


@dataclass(frozen=True)
class NamedProgram:
    """One program: what its name adds to the base name, its moves, and comment lines for its head."""

    suffix: str
    moves: Moves
    head: tuple[str, ...]


@dataclass
class Result:
    """All programs of a drawing, every place that was mended or left open, and the paths in machining order."""

    programs: list[NamedProgram] = field(default_factory=list)
    places: list[Place] = field(default_factory=list)
    paths: list[Paths] = field(default_factory=list)
    rapids: float = 0.0
    layers: dict[str, tuple[int, float]] = field(default_factory=dict)


def convert(drawing: Drawing, job: Job, options: ConvertOptions, found: Diagnostics, file: str) -> Result:
    """The programs of a drawing."""
    result = Result()
    pieces = _at_origin(drawing, options.origin)
    group = _groups(pieces, drawing, job, options, found, file)
    pieces, group = pieces.take(group >= 0), group[group >= 0]
    pieces, group, doubles = remove_doubles(pieces, group, DOUBLE)
    paths, gaps = join_pieces(pieces, group, options.gap)
    result.places = doubles + gaps
    _report_places(result.places, drawing.layers, found, file)
    if not options.cubics:
        paths = arcs_for_cubics(paths, options.tolerance)
    paths = on_grid(paths, options.decimals)
    result.layers = _layer_statistics(paths, drawing.layers)
    obstacles = Obstacles(paths)
    shop = Workshop(job, found, file, options.tolerance, options.decimals, options.seed, obstacles)
    if options.split == "layers":
        for number in np.unique(paths.pieces.layer[paths.first[:-1]]).tolist():
            rows = np.flatnonzero(paths.pieces.layer[paths.first[:-1]] == number)
            name = _file_part(drawing.layers[number])
            _machine(paths.select(rows), "_" + name, drawing, shop, options, result)
    else:
        _machine(paths, "", drawing, shop, options, result)
    result.programs = [program for program in result.programs if program.moves.rows]
    if not result.programs:
        message = "the drawing has nothing to machine: nothing of it is left"
        found.add(Diagnostic("NC604", Severity.ERROR, message, NOWHERE, file, "see the other findings"))
    return result


def _at_origin(drawing: Drawing, origin: str | tuple[float, float]) -> Pieces:
    if origin == "drawing":
        return drawing.pieces
    low = drawing.extents[0] if isinstance(origin, str) else complex(*origin)
    return transform(drawing.pieces, 1 + 0j, 1j, -low)


def _groups(
    pieces: Pieces, drawing: Drawing, job: Job, options: ConvertOptions, found: Diagnostics, file: str
) -> Indices:
    """Shape (n,): operation and layer as one number; -1 for what no operation takes.

    Paths join inside an operation, across layers only if the operation names layers or colours itself.
    """
    pairs, inverse = np.unique(np.column_stack([pieces.layer, pieces.color]), axis=0, return_inverse=True)
    count = len(drawing.layers) + 1
    numbers, left = [], []
    for layer, color in pairs.tolist():
        name = drawing.layers[layer]
        taking = [k for k, op in enumerate(job.operation) if op.takes(name, color)]
        ignored = bool(taking) and job.operation[taking[0]].kind == "ignore"
        if not taking:
            left.append(f"{name} (colour {color})")
        if not taking or ignored:
            numbers.append(-1)
            continue
        operation = job.operation[taking[0]]
        across = bool(operation.layers or operation.colors) and options.split != "layers"
        numbers.append(taking[0] * count + (0 if across else layer + 1))
    if left:
        message = f"no operation takes {', '.join(left)}"
        found.add(
            Diagnostic("NC612", Severity.WARNING, message, NOWHERE, file, "name the layer in the job file")
        )
    groups: Indices = np.array(numbers, np.int64)[inverse.ravel()]
    return groups


_PLACE_TEXTS = {
    "NC607": (Severity.NOTE, "a gap of {size:.4g} mm is closed", ""),
    "NC608": (Severity.WARNING, "a gap of {size:.4g} mm is left open", "--gap closes larger ones"),
    "NC609": (Severity.NOTE, "{size:.5g} mm drawn twice are machined once", ""),
    "NC610": (Severity.WARNING, "two contours run along each other; both are machined", ""),
}


def _report_places(places: Sequence[Place], layers: Sequence[str], found: Diagnostics, file: str) -> None:
    for place in places:
        severity, text, hint = _PLACE_TEXTS[place.code]
        where = f" at X{place.at.real:.6g} Y{place.at.imag:.6g}, layer {layers[place.layer]}"
        found.add(Diagnostic(place.code, severity, text.format(size=place.size) + where, NOWHERE, file, hint))


def _layer_statistics(paths: Paths, layers: Sequence[str]) -> dict[str, tuple[int, float]]:
    """Paths and length [mm] by layer."""
    if not len(paths):
        return {}
    length = np.add.reduceat(lengths(paths.pieces), paths.first[:-1])
    layer = paths.pieces.layer[paths.first[:-1]]
    return {
        layers[number]: (int((layer == number).sum()), float(length[layer == number].sum()))
        for number in sorted(np.unique(layer).tolist(), key=lambda number: layers[number])
    }


def _machine(
    paths: Paths, suffix: str, drawing: Drawing, shop: Workshop, options: ConvertOptions, result: Result
) -> None:
    """The operations on some paths, in the job's order, as one program or one a path."""
    count = len(drawing.layers) + 1
    at = complex(*shop.job.program.origin)
    plans: list[Prepared] = []
    for number, operation in enumerate(shop.job.operation):
        rows = np.flatnonzero(paths.group // count == number)
        if len(rows):
            plan = prepare(operation, paths.select(rows), shop, at)
            result.rapids += rapid_length(plan.paths, at) if len(plan.paths) else 0.0
            at = complex(plan.paths.pieces.end[-1]) if len(plan.paths) else at
            plans.append(plan)
            result.paths.append(plan.paths)
    head = _head(drawing, options, result)
    if options.split == "segments":
        every = [(plan, i) for plan in plans for i in range(len(plan.paths))]
        digits = max(4, len(str(len(every))))
        for number, (plan, i) in enumerate(every, 1):
            moves = _begin(shop.job)
            cut(plan, np.array([i]), moves, shop)
            finish(moves, shop.job)
            result.programs.append(NamedProgram(f"{suffix}_{number:0{digits}d}", moves, head))
        return
    moves = _begin(shop.job)
    for plan in plans:
        cut(plan, np.arange(len(plan.paths)), moves, shop)
    finish(moves, shop.job)
    result.programs.append(NamedProgram(suffix, moves, head))


def _begin(job: Job) -> Moves:
    x, y = job.program.origin
    moves = Moves(start=(x, y, 0.0), at=(x, y, 0.0))
    for number in job.program.begin_m:
        moves.wait(Kind.M_FUNCTION, number, 0.0)
    return moves


def _head(drawing: Drawing, options: ConvertOptions, result: Result) -> tuple[str, ...]:
    """Comment lines: source, units, extents, resolution, layers."""
    low, high = drawing.extents
    lines = [
        f"from {drawing.name}, DXF {drawing.version}, drawn in {drawing.units}; written in mm, mm/s",
        f"drawing X{low.real:.4f} to {high.real:.4f}, Y{low.imag:.4f} to {high.imag:.4f} mm",
        f"resolution {10.0**-options.decimals:.{options.decimals}f} mm, curves within {options.tolerance:g} mm",
    ]
    lines += [
        f"layer {name}: {count} path{'s' * (count != 1)}, {length:.3f} mm"
        for name, (count, length) in result.layers.items()
    ]
    return tuple(lines)


def _file_part(name: str) -> str:
    """A layer's name as a part of a file name."""
    return re.sub(r"[^\w.+-]+", "_", name).strip("._") or "layer"
