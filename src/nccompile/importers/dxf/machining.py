"""Paths and an operation to moves: sides, order, leads, passes, tabs, switches and M functions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from nccompile.diagnostics import Diagnostic, Diagnostics, Severity
from nccompile.importers.dxf.assemble import Moves
from nccompile.importers.dxf.contour import Contour, cut_contour
from nccompile.importers.dxf.fit import on_grid
from nccompile.importers.dxf.grid import Indices
from nccompile.importers.dxf.job import Job, Operation, Side
from nccompile.importers.dxf.join import Paths
from nccompile.importers.dxf.leads import Obstacles
from nccompile.importers.dxf.nest import Nesting, nest
from nccompile.importers.dxf.offset import offset_path
from nccompile.importers.dxf.order import StartPoint, order_paths, reversed_paths
from nccompile.importers.dxf.pieces import PieceKind, Pieces
from nccompile.source import NOWHERE
from nccompile.toolpath import Kind

__all__ = ["Prepared", "Workshop", "cut", "finish", "prepare"]


@dataclass
class Workshop:
    """What all operations share: the job, findings, tolerances [mm], and all contours as obstacles of leads."""

    job: Job
    found: Diagnostics
    file: str
    tolerance: float
    decimals: int
    seed: int
    obstacles: Obstacles

    def say(self, code: str, message: str, hint: str = "") -> None:
        """A warning about the drawing."""
        self.found.add(Diagnostic(code, Severity.WARNING, message, NOWHERE, self.file, hint))


@dataclass(frozen=True)
class Prepared:
    """The paths of an operation in machining order.

    left: bool (n,), whether the tool (or, on the line, the scrap) is on the left of each;
    corrected: bool (n,), whether G41 or G42 is to move the tool.
    """

    operation: Operation
    paths: Paths
    left: npt.NDArray[np.bool_]
    corrected: npt.NDArray[np.bool_]


def prepare(operation: Operation, paths: Paths, shop: Workshop, origin: complex) -> Prepared:
    """Sides, directions and order of an operation's paths; `origin` is where the tool comes from [mm]."""
    if operation.kind == "drill":
        places = _drill_places(paths)
        if len(places) < len(paths):
            shop.say(
                "NC612", f"{len(paths) - len(places)} paths are no points or circles and are not drilled"
            )
        ordered = _ordered(places, Nesting.flat(len(places)), operation, shop, origin)
        none = np.zeros(len(ordered), bool)
        return Prepared(operation, ordered, none, none)
    paths = _without_points(paths, operation, shop)
    nesting = nest(paths)
    closed = _turned(paths, nesting, operation)
    left = _tool_left(closed, nesting, operation)
    sided = _sided(closed, operation, shop)
    by_geometry = operation.by == "geometry"
    if by_geometry and sided.any():
        closed, left, sided = _offset(closed, left, sided, operation, shop)
        nesting = nest(closed)
    # `left` and `sided` must follow their paths through the ordering: they ride along in the group column
    tagged = Paths(closed.pieces, closed.first, closed.closed, 2 * sided.astype(np.int64) + left)
    ordered = _ordered(tagged, nesting, operation, shop, origin)
    ahead = (ordered.group & 1).astype(bool)
    return Prepared(operation, ordered, ahead, (ordered.group >= 2) & (not by_geometry))


def _ordered(paths: Paths, nesting: Nesting, operation: Operation, shop: Workshop, origin: complex) -> Paths:
    start = operation.start
    rule = StartPoint(start) if isinstance(start, str) else StartPoint("given", complex(*start))
    fixed = np.full(len(paths), operation.side is not Side.ON)
    return order_paths(paths, nesting.parent, fixed, rule, origin, shop.seed) if len(paths) else paths


def _drill_places(paths: Paths) -> Paths:
    """Points, and full circles by their centres, as points."""
    single = np.diff(paths.first) == 1
    rows = paths.first[:-1]
    kind = paths.pieces.kind[rows]
    circle = single & paths.pieces.is_full[rows] & (kind == PieceKind.ARC)
    point = single & (kind == PieceKind.POINT)
    centre = paths.pieces.p[rows, 0] + 1j * paths.pieces.p[rows, 1]
    picked = np.flatnonzero(circle | point)
    at = np.where(circle, centre, paths.pieces.start[rows])[picked]
    pieces = paths.pieces.take(rows[picked])
    kinds = np.full(len(picked), PieceKind.POINT, np.uint8)
    points = pieces.replace(start=at, end=at, kind=kinds, p=np.zeros_like(pieces.p))
    return Paths(points, np.arange(len(picked) + 1), np.zeros(len(picked), bool), paths.group[picked])


def _without_points(paths: Paths, operation: Operation, shop: Workshop) -> Paths:
    """Points are places to go to in a flat path and nothing to cut in a deep one."""
    point = paths.pieces.kind[paths.first[:-1]] == PieceKind.POINT
    if operation.depth == 0.0 or not point.any():
        return paths
    shop.say(
        "NC612", f"{int(point.sum())} points are left out", 'an operation with kind = "drill" takes them'
    )
    return paths.select(np.flatnonzero(~point))


def _turned(paths: Paths, nesting: Nesting, operation: Operation) -> Paths:
    """Closed paths run so that the tool cuts climb (tool on the left) or conventional (on the right)."""
    if operation.direction == "drawn" or operation.side in {Side.LEFT, Side.RIGHT}:
        return paths
    climb = operation.direction == "climb"
    wanted_ccw = _tool_inside(nesting, operation) == climb
    wrong = paths.closed & ((nesting.area > 0) != wanted_ccw)
    nesting.area[wrong] *= -1.0
    return reversed_paths(paths, wrong)


def _tool_inside(nesting: Nesting, operation: Operation) -> npt.NDArray[np.bool_]:
    """Shape (n,): whether tool or scrap are inside; on the line scrap is outside parts and inside their holes."""
    if operation.side is Side.ON:
        holes: npt.NDArray[np.bool_] = nesting.depth % 2 == 1
        return holes
    return np.full(len(nesting.depth), operation.side is Side.INSIDE)


def _tool_left(paths: Paths, nesting: Nesting, operation: Operation) -> npt.NDArray[np.bool_]:
    """Shape (n,): whether the tool (or the scrap) is on the left in the direction of each path."""
    if operation.side in {Side.LEFT, Side.RIGHT}:
        return np.full(len(paths), operation.side is Side.LEFT)
    left: npt.NDArray[np.bool_] = _tool_inside(nesting, operation) == (nesting.area > 0)
    return left


def _sided(paths: Paths, operation: Operation, shop: Workshop) -> npt.NDArray[np.bool_]:
    """Shape (n,): whether the tool runs beside the path; open paths have no inside."""
    if operation.side is Side.ON:
        return np.zeros(len(paths), bool)
    if operation.side in {Side.LEFT, Side.RIGHT}:
        return np.ones(len(paths), bool)
    for i in np.flatnonzero(~paths.closed).tolist():
        z = paths.pieces.start[paths.first[i]]
        shop.say(
            "NC614",
            f"the path at X{z.real:.4g} Y{z.imag:.4g} is open and has no {operation.side}; it is cut on the line",
            "close it in the drawing, raise --gap, or give it an operation of its own",
        )  # fmt: skip
    return paths.closed.copy()


def _offset(
    paths: Paths,
    left: npt.NDArray[np.bool_],
    sided: npt.NDArray[np.bool_],
    operation: Operation,
    shop: Workshop,
) -> tuple[Paths, npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """The paths of the tool's centre."""
    parts: list[Pieces] = []
    first, closed, origin = [0], [], []
    for i in range(len(paths)):
        path = paths.path(i)
        if not sided[i]:
            made = paths.select(np.array([i]))
        else:
            side = operation.tool_radius if left[i] else -operation.tool_radius
            made = on_grid(offset_path(path, bool(paths.closed[i]), side, shop.tolerance), shop.decimals)
        if not len(made):
            z = path.start[0]
            shop.say(
                "NC615", f"the tool of radius {operation.tool_radius:g} does not fit into the contour at "
                f"X{z.real:.4g} Y{z.imag:.4g}; it is left out", "take a smaller tool",
            )  # fmt: skip
        parts.append(made.pieces)
        first += (first[-1] + made.first[1:]).tolist()
        closed += made.closed.tolist()
        origin += [i] * len(made)
    rows: Indices = np.array(origin, np.int64)
    joined = Paths(Pieces.join(parts), np.array(first), np.array(closed, bool), paths.group[rows])
    return joined, left[rows], sided[rows]


def cut(prepared: Prepared, rows: Indices, moves: Moves, shop: Workshop) -> None:
    """Adds the moves of some of the operation's paths, in their order."""
    operation = prepared.operation
    title = [f"tool {operation.tool}"] * (operation.tool is not None) + [operation.name] * bool(
        operation.name
    )
    if title and len(rows):
        moves.note(", ".join(title))
    if operation.tool not in {None, moves.tool} and len(rows):
        moves.tool = operation.tool
        moves.wait(Kind.M_FUNCTION, shop.job.program.tool_change_m, float(operation.tool or 0))
    moves.accel, moves.decel = operation.accel or 0.0, operation.decel or 0.0
    if operation.kind == "drill":
        for i in rows.tolist():
            _drill(complex(prepared.paths.path(i).start[0]), operation, moves)
    elif _is_plain(operation):
        _bulk(prepared.paths.select(rows), operation, moves)
    else:
        for i in rows.tolist():
            contour = Contour(
                prepared.paths.path(i), bool(prepared.paths.closed[i]), bool(prepared.left[i]),
                bool(prepared.corrected[i]),
            )  # fmt: skip
            cut_contour(contour, operation, moves, shop.obstacles, shop.say)


def _is_plain(operation: Operation) -> bool:
    """Whether an operation is nothing but paths at Z0."""
    extras = (
        operation.lead_in, operation.lead_out, operation.tabs, operation.switch, operation.m_on, operation.m_off,
        operation.overcut, operation.dwell, operation.depth, operation.height,
    )  # fmt: skip
    return not any(extra for extra in extras) and operation.by == "geometry"


def _bulk(paths: Paths, operation: Operation, moves: Moves) -> None:
    """All paths at once, a rapid before each unless it starts where the one before it ended."""
    if not len(paths):
        return
    pieces, first = paths.pieces, paths.first
    begin = pieces.take(first[:-1])
    before = np.concatenate([[complex(moves.at[0], moves.at[1])], pieces.end[first[1:-1] - 1]])
    away = begin.start != before
    blank = begin.replace(
        end=begin.start, start=before, kind=np.zeros(len(begin), np.uint8), p=np.zeros_like(begin.p)
    ).take(away)
    order = np.argsort(np.concatenate([2 * np.arange(len(pieces)) + 1, 2 * first[:-1][away]]), kind="stable")
    everything = Pieces.join([pieces, blank]).take(order)
    rapids = order >= len(pieces)
    place = everything.kind == PieceKind.POINT
    keep = ~place
    moves.bulk(everything.take(keep), 0.0, operation.feed, rapids[keep])


def _drill(at: complex, operation: Operation, moves: Moves) -> None:
    """One hole, in pecks of `pass_depth`; the tool comes out of the hole after every peck."""
    height, plunge = operation.height, operation.plunge_feed or operation.feed
    moves.rapid(complex(moves.at[0], moves.at[1]), height)
    moves.rapid(at, height)
    if operation.m_on is not None:
        moves.wait(Kind.M_FUNCTION, operation.m_on, 0.0)
    for level in operation.levels:
        moves.line(at, level, plunge)
        if level == operation.levels[-1] and operation.dwell > 0.0:
            moves.wait(Kind.DWELL, 0, operation.dwell)
        moves.rapid(at, height)
    if operation.m_off is not None:
        moves.wait(Kind.M_FUNCTION, operation.m_off, 0.0)


def finish(moves: Moves, job: Job) -> None:
    """The place and M functions at the program's end."""
    place = job.program.park
    if place is None and moves.ends_in_contact:
        place = job.program.origin
    if place is not None:
        moves.rapid(complex(*place), moves.at[2])
    for number in job.program.end_m:
        moves.wait(Kind.M_FUNCTION, number, 0.0)
