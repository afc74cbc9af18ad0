"""tool-radius: the path of the tool's centre for a programmed contour (SoftMotion §6.2.3, SMC_ToolCorr; G41/42, G40).

             .-~~-.          r = D + `radius`;  G41: r to the left, G42: to the right of the direction of motion
    ────────'      `.        convex corner    an arc about it (corner=arc), or the lines extended until they meet
    ======┐    r     |                        (corner=line), if they do within `limit` r
    contour\\         |       concave corner   both neighbours are cut at their common point
            \\        v       tangent joint    they meet; nothing between
                             approach         the positioning before the contour goes to the start of the offset,
                                              or one is put in; the same after it (lead=positioning)
    lead=line, lead=arc      a line or quarter arc of length or radius `length`, tangential to the offset, in
                             front of its start and behind its end

Rows keep their feed, their other axes and their switch points (same share of the way).  A change of D moves the
tool across on a line.  Where the tool comes nearer to the contour than r it would cut into it: a gouge, with its
place and depth.  It is an error (gouge=error) unless G61 is on there, so that avoid-loops cuts it, or gouge=warn.

Example:
    -p tool-radius
    --- in
    % t
    N10 G0 X10
    N20 G42 D1
    N30 G1 X20 F50
    N40 G1 Y10
    N50 G40
    --- out
    positioning 10 -1 0 source 2
    line 20 -1 0 feed 50 tool_radius 1 source 4
    arc 21 0 0 feed 50 tool_radius 1 source 4 xy center 20 0 radius 1 start -1.570796 sweep 1.570796
    line 21 10 0 feed 50 tool_radius 1 source 5
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from nccompile.errors import UsageError
from nccompile.passes.base import Context, Flags, Pass, bounded, gather, region
from nccompile.passes.correction import Corrected, Style
from nccompile.passes.edit import Draft
from nccompile.passes.gouges import check_gouges
from nccompile.toolpath.columns import Floats, Kind, Mark, Toolpath
from nccompile.toolpath.lengths import path_lengths

__all__ = ["ToolRadius"]

_SIDES = int(Mark.TOOL_LEFT | Mark.TOOL_RIGHT)


@dataclass(frozen=True)
class ToolRadius(Pass):
    """The corrected path.

    radius: added to D [mm];  corner: arc or line, limit: greatest |corner| / r of extended lines;  lead:
    positioning, line or arc, length [mm];  tolerance: of offset ellipses and splines [mm];  gouge: error or warn;
    everywhere: every run of feed segments, on this side: left or right.
    """

    name: ClassVar[str] = "tool-radius"
    radius: float = 0.0
    corner: str = "arc"
    limit: float = 2.0
    lead: str = "positioning"
    length: float = 5.0
    tolerance: float = 0.001
    gouge: str = "error"
    everywhere: bool = False
    side: str = "left"

    def __post_init__(self) -> None:
        bounded("radius", self.radius, -1e4, 1e4, "mm")
        bounded("limit", self.limit, 1.0, 100.0, "")
        bounded("length", self.length, 1e-3, 1e4, "mm")
        bounded("tolerance", self.tolerance, 1e-6, 1.0, "mm")
        for name, words in (
            ("corner", ("arc", "line")), ("lead", ("positioning", "line", "arc")), ("gouge", ("error", "warn")),
            ("side", ("left", "right")),
        ):  # fmt: skip
            if getattr(self, name) not in words:
                raise UsageError(f"{name}={getattr(self, name)}: write {' or '.join(words)}")

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module.  A region is held in memory until it ends, with the row before and the one after it."""
        held: Toolpath | None = None
        on, side = False, 0.0
        for chunk in gather(chunks):
            held = chunk if held is None else Toolpath.join([held, chunk])
            sides, _ = self._sides(held, on, side)
            done = _settled(held, sides)
            if done:
                out = self._correct(held, sides, done, context)
                yield out
                _, on = region(held.rows(0, done), _SIDES, int(Mark.TOOL_STOP), on)
                side = _last_side(held.rows(0, done), side)
                # A positioning or set position behind a contour starts where the tool is.
                held = held.rows(done, len(held)).replace(start=out.end)
        if held is not None:
            sides, _ = self._sides(held, on, side)
            yield self._correct(held, sides, len(held), context)

    def _sides(self, path: Toolpath, on: bool, side: float) -> tuple[Floats, bool]:
        """Shape (n,): distance to the left at which the tool runs [mm], 0 where there is no correction."""
        inside, after = region(path, _SIDES, int(Mark.TOOL_STOP), on)
        rows = np.arange(len(path))
        started = np.maximum.accumulate(np.where(path.mark & _SIDES, rows, -1))
        left = path.mark[np.maximum(started, 0)] & int(Mark.TOOL_LEFT)
        sign = np.where(started < 0, side, np.where(left, 1.0, -1.0))
        sign = np.where(inside, sign, 0.0)
        if self.everywhere:
            sign = np.full(len(path), 1.0 if self.side == "left" else -1.0)
        r = np.maximum(path.radius + self.radius, 0.0)
        return np.where(path.kind > Kind.POSITIONING, sign * r, 0.0), after

    def _correct(self, path: Toolpath, d: Floats, count: int, context: Context) -> Toolpath:
        """The first `count` rows; a contour that begins in them also ends in them."""
        cutting = (d != 0.0) & (path.kind != Kind.SET_POSITION)
        clear = _SIDES | int(Mark.TOOL_STOP)
        if not cutting[:count].any():
            plain = path.rows(0, count)
            if count:
                length = plain.length.copy()
                length[:1] = path_lengths(plain.rows(0, 1))
                plain = plain.replace(length=length)
            return plain.replace(mark=plain.mark & np.uint16(0xFFFF & ~clear))
        draft = Draft(path.rows(0, count), clear)
        style = Style(self.corner, self.limit, self.lead, self.length, self.tolerance)
        inside_loop, _ = region(path, int(Mark.LOOP), int(Mark.LOOP_STOP), False)
        i = 0
        while i < count:
            if not cutting[i]:
                draft.copy(i)
                i += 1
                continue
            end = i
            while end < count and cutting[end]:
                end += 1
            contour = Corrected(draft, i, end, d, style, context)
            after = int(path.kind[end]) if end < len(path) else -1
            contour.write(after)
            check_gouges(contour, self.gouge == "error", inside_loop, context)
            i = end
        return draft.build()


def _settled(path: Toolpath, d: Floats) -> int:
    """How many leading rows are complete: the last row stays, and a contour that is open, with the row before it."""
    n = len(path)
    cutting: Flags = (d != 0.0) & (path.kind != Kind.SET_POSITION)
    outside = np.flatnonzero(~cutting[:n])
    if not len(outside):
        return 0
    return int(outside[-1])


def _last_side(path: Toolpath, side: float) -> float:
    """+1 if the last start mark says left, -1 if right, `side` if there is none."""
    at = np.flatnonzero(path.mark & _SIDES)
    if not len(at):
        return side
    return 1.0 if path.mark[at[-1]] & int(Mark.TOOL_LEFT) else -1.0
