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

A closed contour that starts at a convex corner is closed there like at any other (close).  Rows keep their feed,
their other axes and their switch points (same share of the way).  Where D changes, the tool goes about the corner
with the D before, then straight to the new one; where the side changes, straight across the contour.

Where the tool comes nearer to the contour than r it would cut into it: a gouge, with its place and depth
(passes/gouges.py).  It is an error (gouge=error) unless G61 is on there, so that avoid-loops cuts it out, or
gouge=loops says that it will; gouge=warn leaves it.

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
from typing import ClassVar, NamedTuple

import numpy as np

from nccompile.errors import UsageError
from nccompile.kernels import expect_work
from nccompile.kernels.offset_check import offset_deviation
from nccompile.kernels.offset_emit import LINKED
from nccompile.passes.base import Context, Flags, Pass, bounded, gather, region
from nccompile.passes.correction import Emitted, Moving, Offsets, Style, build, emit, moving_rows, offset
from nccompile.passes.gouges import Gouges, left_over, report, shorten
from nccompile.toolpath.columns import Floats, Kind, Mark, Toolpath
from nccompile.toolpath.lengths import path_lengths

__all__ = ["ToolRadius"]

_SIDES = int(Mark.TOOL_LEFT | Mark.TOOL_RIGHT)
_CLEAR = _SIDES | int(Mark.TOOL_STOP)

_WORK = 4
"""What correcting a row costs, in the rows by which other passes count."""

_SAMPLES = 9
"""Places of an ellipse's or cubic's offset piece at which its distance is measured, each way."""


class _State(NamedTuple):
    """What is on behind a row: correction, its side (+1 left), loop avoidance."""

    on: bool = False
    side: float = 0.0
    loops: bool = False


@dataclass(frozen=True)
class ToolRadius(Pass):
    """The corrected path.

    radius: added to D [mm];  corner: arc or line, limit: greatest |corner| / r of extended lines;  close: closed
    contours at a convex start corner, too;  lead: positioning, line or arc, length [mm];  tolerance: of offset
    ellipses and splines [mm];  gouge: error, warn or loops;  everywhere: every run of feed segments, on this side:
    left or right.
    """

    name: ClassVar[str] = "tool-radius"
    radius: float = 0.0
    corner: str = "arc"
    limit: float = 2.0
    close: bool = True
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
            ("corner", ("arc", "line")), ("lead", ("positioning", "line", "arc")),
            ("gouge", ("error", "warn", "loops")), ("side", ("left", "right")),
        ):  # fmt: skip
            if getattr(self, name) not in words:
                raise UsageError(f"{name}={getattr(self, name)}: write {' or '.join(words)}")

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module.  A contour is held in memory until it ends, with the row before and the one after it."""
        held: list[tuple[Toolpath, Floats, Flags]] = []
        state = _State()
        for chunk in gather(chunks):
            d, loops, state = self._distances(chunk, state)
            held.append((chunk, d, loops))
            outside = np.flatnonzero(d == 0.0)
            if not len(outside):
                continue
            path, d, loops = _joined(held)
            done = len(path) - len(chunk) + int(outside[-1])
            held = [(path, d, loops)]
            if done:
                out = self._correct(path, d, loops, done, context)
                yield out
                # A positioning or set position behind a contour starts where the tool is.
                rest = path.rows(done, len(path)).replace(start=out.end)
                held = [(rest, d[done:], loops[done:])]
        if held:
            path, d, loops = _joined(held)
            yield self._correct(path, d, loops, len(path), context)

    def _distances(self, path: Toolpath, state: _State) -> tuple[Floats, Flags, _State]:
        """Shape (n,): distance to the left at which the tool runs [mm], 0 where there is no correction; and where
        loops are cut out."""
        inside, on = region(path, _SIDES, int(Mark.TOOL_STOP), state.on)
        loops, is_open = region(path, int(Mark.LOOP), int(Mark.LOOP_STOP), state.loops)
        started = np.maximum.accumulate(np.where(path.mark & _SIDES, np.arange(len(path)), -1))
        left = path.mark[np.maximum(started, 0)] & int(Mark.TOOL_LEFT)
        sign = np.where(started < 0, state.side, np.where(left, 1.0, -1.0))
        last = float(sign[-1]) if len(path) else state.side
        sign = np.where(inside, sign, 0.0)
        if self.everywhere:
            sign = np.full(len(path), 1.0 if self.side == "left" else -1.0)
        r = np.maximum(path.radius + self.radius, 0.0)
        cuts = (path.kind > Kind.POSITIONING) & (path.kind != Kind.SET_POSITION)
        return np.where(cuts, sign * r, 0.0), loops | (self.gouge == "loops"), _State(on, last, is_open)

    def _correct(self, path: Toolpath, d: Floats, loops: Flags, count: int, context: Context) -> Toolpath:
        """The first `count` rows; a contour that begins in them also ends in them."""
        expect_work(_WORK * count)
        moving = moving_rows(path, d, count, context)
        if not len(moving.row):
            plain = path.rows(0, count)
            length = plain.length.copy()
            length[:1] = path_lengths(plain.rows(0, 1))
            return plain.replace(length=length, mark=plain.mark & np.uint16(0xFFFF & ~_CLEAR))
        style = Style(
            self.corner, float(self.limit), self.close, self.lead, float(self.length), float(self.tolerance)
        )
        offsets = offset(moving, style)
        emitted = emit(path, moving, offsets, count, style)
        gouges = Gouges(moving, self.tolerance)
        depth, where = gouges.of_emitted(emitted, offsets)
        if context.measure:
            _measure(moving, offsets, emitted, depth, context)
        cut = loops[emitted.origin]
        bad = np.unique(emitted.contour[cut & (depth > 0.0)])
        findings = [(build(path, count, moving, emitted, offsets, _CLEAR), depth, where, cut)]
        if len(bad):
            if shorten(offsets, moving, emitted, gouges, bad, loops):
                emitted = emit(path, moving, offsets, count, style)
                depth, where = gouges.of_emitted(emitted, offsets)
                cut = loops[emitted.origin]
            out = build(path, count, moving, emitted, offsets, _CLEAR)
            left, where = left_over(out, emitted, offsets, gouges, cut, depth, where)
            findings.append((out, np.where(cut, left, 0.0), where, np.zeros(len(out), np.bool_)))
        said: set[int] = set()
        for out, depth, where, cut in reversed(findings):
            report(out, depth, where, cut, self.gouge != "warn", said, context)
        return findings[-1][0]


def _joined(held: list[tuple[Toolpath, Floats, Flags]]) -> tuple[Toolpath, Floats, Flags]:
    paths, d, loops = zip(*held, strict=True)
    return Toolpath.join(paths), np.concatenate(d), np.concatenate(loops)


def _measure(moving: Moving, offsets: Offsets, emitted: Emitted, depth: Floats, context: Context) -> None:
    """Notes how far offsets are from the radius, where they do not gouge."""
    row = np.flatnonzero((emitted.piece >= 0) & (emitted.flags & LINKED != 0) & (depth == 0.0))
    owner = np.searchsorted(moving.row, emitted.origin[row])
    context.report.deviate(
        offset_deviation(
            owner, *moving[1:6], emitted.piece[row],
            offsets.kinds, offsets.curve, offsets.table, offsets.ends, offsets.part, _SAMPLES,
        )
    )  # fmt: skip
