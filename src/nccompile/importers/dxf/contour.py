"""One contour cut: approach, lead-in, passes with tabs, overcut, lead-out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from nccompile.importers.dxf.assemble import Moves
from nccompile.importers.dxf.job import Operation, Side
from nccompile.importers.dxf.leads import FINE, Obstacles, Room, lead_in, lead_out
from nccompile.importers.dxf.pieces import Pieces, end_tangents, flatten, lengths
from nccompile.importers.dxf.stretches import stretch, tab_stretches
from nccompile.toolpath import Kind, Mark

__all__ = ["Contour", "cut_contour"]

OTHER_STARTS = 12
"""Vertices of a closed contour that are tried for its leads."""

Say = Callable[[str, str, str], None]


@dataclass(frozen=True)
class Contour:
    """A path of the tool: pieces, closed, tool or scrap on its left, moved by G41 or G42."""

    path: Pieces
    closed: bool
    left: bool
    corrected: bool


@dataclass(frozen=True)
class _Way:
    """A contour with its leads; `loop` is the path and the overcut."""

    into: Pieces
    path: Pieces
    over: Pieces
    out: Pieces

    @property
    def begin(self) -> complex:
        return complex((self.into if len(self.into) else self.path).start[0])

    @property
    def stays(self) -> bool:
        """Whether the next pass may begin where this one ended."""
        return not (len(self.into) or len(self.out) or len(self.over)) and bool(
            self.path.end[-1] == self.path.start[0]
        )


def cut_contour(contour: Contour, operation: Operation, moves: Moves, obstacles: Obstacles, say: Say) -> None:
    """Adds the moves of one contour, all passes."""
    way = _way(contour, operation, obstacles, say)
    levels = operation.levels
    lifted = not way.stays or contour.corrected
    for k, level in enumerate(levels):
        if k == 0 or lifted:
            _approach(way.begin, operation.height, moves)
            moves.radius(operation.tool_radius if contour.corrected else 0.0)
        plunge = moves.rows
        moves.line(way.begin, level, operation.plunge_feed or operation.feed)
        plunged = moves.rows > plunge
        if k == 0 or lifted:
            _start(operation, moves)
        first = _pass(way, operation, level, moves)
        last = k == len(levels) - 1
        if (last or lifted) and operation.m_off is not None:
            moves.wait(Kind.M_FUNCTION, operation.m_off, 0.0)
        if contour.corrected:
            _correct(contour, operation, plunge if plunged else first, moves)
        elif last or lifted:
            moves.rapid(complex(moves.at[0], moves.at[1]), operation.height)


def _correct(contour: Contour, operation: Operation, first: int, moves: Moves) -> None:
    """G41 or G42 from the plunge to the retract: the tool goes down and comes up beside the contour.

    The retract is a feed move, since only feed moves are corrected.
    """
    last = moves.rows - 1 - (operation.m_off is not None)
    retract = moves.rows
    moves.line(complex(moves.at[0], moves.at[1]), operation.height, operation.feed)
    moves.mark(first, Mark.TOOL_LEFT if contour.left else Mark.TOOL_RIGHT)
    moves.mark(retract if moves.rows > retract else last, Mark.TOOL_STOP)


def _approach(begin: complex, height: float, moves: Moves) -> None:
    moves.rapid(complex(moves.at[0], moves.at[1]), height)
    moves.rapid(begin, height)


def _start(operation: Operation, moves: Moves) -> None:
    """What turns the tool on, and the time it takes."""
    if operation.m_on is not None:
        moves.wait(Kind.M_FUNCTION, operation.m_on, 0.0)
    if operation.dwell > 0.0:
        moves.wait(Kind.DWELL, 0, operation.dwell)


def _pass(way: _Way, operation: Operation, level: float, moves: Moves) -> int:
    """Lead-in, contour, overcut and lead-out at one level, with switch points at both ends; its first row."""
    first = moves.rows
    plunge = operation.plunge_feed or operation.feed
    moves.follow(way.into, level, operation.feed)
    top = 0.0 if operation.tabs is None else operation.tabs.height - operation.depth
    if operation.tabs is not None and level < top - 1e-9:
        for part, raised in tab_stretches(way.path, operation.tabs, operation.tool_radius):
            moves.line(complex(part.start[0]), top if raised else level, plunge)
            moves.follow(part, top if raised else level, operation.feed)
        moves.line(complex(way.path.end[-1]), level, plunge)
    else:
        moves.follow(way.path, level, operation.feed)
    moves.follow(way.over, level, operation.feed)
    moves.follow(way.out, level, operation.feed)
    if operation.switch is not None:
        moves.switch(first, operation.switch, 0.0)
        moves.switch(moves.rows - 1, -operation.switch, 1.0)
    return first


def _way(contour: Contour, operation: Operation, obstacles: Obstacles, say: Say) -> _Way:
    """The contour with leads that are clear: at its start, or else at another vertex, or without them."""
    path = contour.path
    wanted = (operation.lead_in is not None) + (operation.lead_out is not None)
    best = _with_leads(path, contour, operation, obstacles)
    if wanted and contour.closed and _leads(best) < wanted:
        for row in _other_starts(path):
            turned = Pieces.join([path.take(slice(row, None)), path.take(slice(0, row))])
            other = _with_leads(turned, contour, operation, obstacles)
            if _leads(other) > _leads(best):
                best = other
            if _leads(best) == wanted:
                break
    if _leads(best) < wanted:
        at = complex(best.path.start[0])
        missing = "lead-in" if operation.lead_in is not None and not len(best.into) else "lead-out"
        message = f"no {missing} stays clear at the contour at X{at.real:.4g} Y{at.imag:.4g}; it is left out"
        say("NC613", message, "shorten it, or start elsewhere")
    return best


def _leads(way: _Way) -> int:
    return int(len(way.into) > 0) + int(len(way.out) > 0)


def _other_starts(path: Pieces) -> list[int]:
    """Vertices to try, nearest to the first one along the path, on both sides in turn."""
    n = len(path)
    steps = [step for k in range(1, n // 2 + 1) for step in (k, n - k)]
    return list(dict.fromkeys(steps))[:OTHER_STARTS]


def _with_leads(path: Pieces, contour: Contour, operation: Operation, obstacles: Obstacles) -> _Way:
    """The path with overcut and those leads that stay clear."""
    none = path.take(slice(0, 0))
    over = none
    if contour.closed and operation.overcut > 0.0:
        over = stretch(path, 0.0, min(operation.overcut, float(lengths(path).sum())))
    last = over if len(over) else path
    enter, leave = end_tangents(path.take([0]))[0], end_tangents(last.take([-1]))[1]
    beside = operation.tool_radius if operation.by == "geometry" and operation.side is not Side.ON else 0.0
    room = Room(obstacles, np.concatenate(flatten(path, FINE)), beside, operation.clearance)
    into = out = None
    if operation.lead_in is not None:
        into = lead_in(complex(path.start[0]), complex(enter[0]), contour.left, operation.lead_in, room)
    if operation.lead_out is not None:
        out = lead_out(complex(last.end[-1]), complex(leave[0]), contour.left, operation.lead_out, room)
    return _Way(none if into is None else into, path, over, none if out is None else out)
