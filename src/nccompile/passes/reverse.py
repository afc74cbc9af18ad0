"""reverse: the path run from its end to its start (SoftMotion §3.3, invert direction).

    in    A ──1──> B ──2──> C       out   C ──2──> B ──1──> A
             sw at 0.2                            sw at 0.8: the place on the path stays

Start marks become stop marks and the other way round; left and right change places, for the tool stays on its
side of the material.  The whole path is held in memory.

Example:
    -p reverse
    --- in
    % t
    N10 H3 O0.2 G1 X10 F50
    N20 G1 Y10
    --- out
    start 10 10 0
    line 10 0 0 feed 50 source 3
    line 0 0 0 feed 50 source 2
      switch 3 at 0.8
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from nccompile.kernels.curve_parts import turn_round
from nccompile.passes.base import Context, Pass
from nccompile.passes.edit import Links
from nccompile.passes.measure import deviation
from nccompile.passes.transform import swap_sides
from nccompile.toolpath.columns import Curves, Events, Kind, Mark, Toolpath
from nccompile.toolpath.lengths import path_lengths

__all__ = ["Reverse"]

_PAIRS = (
    ((Mark.TOOL_LEFT, Mark.TOOL_RIGHT), Mark.TOOL_STOP),
    ((Mark.SMOOTH, Mark.ROUND), Mark.CORNER_STOP),
    ((Mark.LOOP,), Mark.LOOP_STOP),
)

_COLUMNS = ("length", "feed", "accel", "decel", "radius", "profile", "line")


@dataclass(frozen=True)
class Reverse(Pass):
    """The reversed path; twice is the path itself."""

    name: ClassVar[str] = "reverse"

    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """See the module."""
        path = Toolpath.join(list(chunks))
        turned = reversed_path(path)
        if context.measure:
            context.report.deviate(deviation(path, turned, Links.moved(np.arange(len(path))[::-1])))
        yield turned


def reversed_path(path: Toolpath) -> Toolpath:
    """The whole path turned round."""
    n = len(path)
    back = np.arange(n)[::-1]
    kinds = path.kind[back]
    curved = np.flatnonzero(path.curve[back] >= 0)
    rows = path.curve[back][curved]
    curve = np.full(n, -1, np.int32)
    curve[curved] = np.arange(len(curved), dtype=np.int32)
    parameters = path.curves.parameters[rows]
    turn_round(kinds[curved], parameters)
    e = path.events
    moved = [
        (n - 1 - int(e.segment[j]), int(e.kind[j]), int(e.number[j]),
         1.0 - float(e.position[j]) if path.kind[e.segment[j]] <= Kind.POLYNOMIAL else float(e.position[j]),
         float(e.k[j]), float(e.l[j]), int(e.o[j]))
        for j in range(len(e))
    ]  # fmt: skip
    picked = {name: getattr(path, name)[back] for name in _COLUMNS}
    turned = path.replace(
        start=path.end, kind=kinds, target=path.starts()[back], curve=curve, mark=_marks(path)[back],
        curves=Curves(path.curves.plane[rows], parameters), events=Events.from_rows(moved), **picked,
    )  # fmt: skip
    return turned.replace(length=path_lengths(turned))


def _marks(path: Toolpath) -> npt.NDArray[np.uint16]:
    """Marks of the path run backwards, still in the old order.

    The region start..stop of a function stays; where it was opened it is now closed.
    """
    out = np.zeros(len(path), np.uint16)
    for starts, stop in _PAIRS:
        kind = 0
        for i in np.flatnonzero(path.mark & (int(sum(starts)) | int(stop))):
            opened = int(path.mark[i]) & int(sum(starts))
            if opened:
                kind = opened
                out[i] |= np.uint16(stop)
            if int(path.mark[i]) & int(stop) and kind:
                out[i] |= np.uint16(kind)
    return swap_sides(out)
