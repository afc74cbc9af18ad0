"""One contour of tool radius correction: its rows offset, joined, led in and out (drawing: tool_radius.py).

row i        offset pieces, first one from u0, last one to u1        joints cut u0 and u1, or add connectors
─────────>   |──piece──|──piece──|    connector: arc about the corner, or lines
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import atan2, cos, pi
from typing import NamedTuple

import numpy as np

from nccompile.diagnostics import Severity
from nccompile.geometry.offset import Piece, arc_about, meeting, offset, straight
from nccompile.geometry.tolerance import COINCIDENT
from nccompile.kernels import curves as kernels
from nccompile.kernels.curves import ARC
from nccompile.passes.base import Context
from nccompile.passes.edit import Draft
from nccompile.toolpath.columns import CURVE_PARAMETERS, Floats, Kind, Plane

__all__ = ["Corrected", "Row", "Style"]

_TANGENT = 0.02
"""[rad] Lines that bend less at a convex corner are extended: they meet within 5e-5 r of the arc."""

_MEETINGS = 6
"""Pieces at both sides of a concave corner that are tried for a common point."""


class Style(NamedTuple):
    """Options of `ToolRadius` that shape the path."""

    corner: str
    limit: float
    lead: str
    length: float
    tolerance: float


@dataclass
class Row:
    """A row of the contour with extent in X-Y: source row, ends, unit tangents there, its distance, its offset."""

    i: int
    kind: int
    curve: Floats
    a: Floats
    b: Floats
    t0: Floats
    t1: Floats
    d: float
    pieces: list[Piece]
    after: list[Piece] = field(default_factory=list)


class Corrected:
    """The offset of the source rows first..end - 1; `rows` holds those with extent in X-Y."""

    def __init__(self, draft: Draft, first: int, end: int, d: Floats, style: Style, context: Context) -> None:
        self.draft = draft
        self.first, self.end = first, end
        self.style = style
        self.rows: list[Row] = []
        self.written: list[tuple[int, Piece]] = []
        path = draft.source
        for i in range(first, end):
            row = self._row(path.start if i == 0 else path.target[i - 1], i, float(d[i]), context)
            if row is not None:
                self.rows.append(row)
        for one, two in zip(self.rows, self.rows[1:], strict=False):
            self._join(one, two)
        if len(self.rows) > 1 and float(np.abs(self.rows[0].a - self.rows[-1].b).max()) <= COINCIDENT:
            self._close(self.rows[-1], self.rows[0])

    def _row(self, start: Floats, i: int, d: float, context: Context) -> Row | None:
        path = self.draft.source
        kind, at = int(path.kind[i]), int(path.curve[i])
        if kind > Kind.POLYNOMIAL:
            return None
        a, b = start[:2].copy(), path.target[i][:2].copy()
        curve = np.zeros(CURVE_PARAMETERS)
        if at >= 0:
            curve = path.curves.parameters[at]
            if path.curves.plane[at] != Plane.XY:
                what = "tool radius correction acts in X-Y only, this curve runs in another plane"
                context.find("NC303", Severity.ERROR, what, int(path.line[i]), "end it with G40 before")
                return None
            t0, t1 = (np.array(kernels.tangent(kind, curve, u)) for u in (0.0, 1.0))
        else:
            step = b - a
            size = float(np.sqrt(step @ step))
            if size <= COINCIDENT:
                return None
            t0 = t1 = step / size
        return Row(i, kind, curve, a, b, t0, t1, d, offset(kind, curve, a, b, d, self.style.tolerance))

    def _join(self, one: Row, two: Row) -> None:
        """Makes the offsets of neighbours meet."""
        if not one.pieces or not two.pieces:
            return
        e, s = one.pieces[-1].b, two.pieces[0].a
        if float(np.abs(e - s).max()) <= COINCIDENT:
            return
        turn = atan2(float(one.t1[0] * two.t0[1] - one.t1[1] * two.t0[0]), float(one.t1 @ two.t0))
        if one.d != two.d:
            one.after = [straight(e, s)]
        elif turn * one.d < 0.0 or abs(turn) > pi - 1e-9:
            self._convex(one, two, turn)
        elif not self._concave(one, two):
            one.after = [straight(e, s)]

    def _convex(self, one: Row, two: Row, turn: float) -> None:
        corner, e, s = one.b, one.pieces[-1].b, two.pieces[0].a
        lines = one.pieces[-1].kind < ARC and two.pieces[0].kind < ARC
        reach = 1.0 / max(cos(0.5 * turn), 1e-9)
        tip = corner + ((e - corner) + (s - corner)) / (1.0 + cos(turn)) if reach < 1e6 else corner
        if lines and abs(turn) <= _TANGENT:
            one.pieces[-1] = straight(one.pieces[-1].a, tip)
            two.pieces[0] = straight(tip, two.pieces[0].b)
        elif self.style.corner == "line" and reach <= self.style.limit:
            one.after = [straight(e, tip), straight(tip, s)]
        else:
            one.after = [arc_about(corner, e, s, -abs(turn) if one.d > 0.0 else abs(turn))]

    def _concave(self, one: Row, two: Row) -> bool:
        """Cuts both at their common point; False if they have none."""
        for back in range(min(_MEETINGS, len(one.pieces))):
            for ahead in range(min(_MEETINGS, len(two.pieces))):
                at = len(one.pieces) - 1 - back
                found = meeting(one.pieces[at], two.pieces[ahead])
                if found is not None and found[0] > 0.0 and found[1] < 1.0:
                    one.pieces[at:] = [one.pieces[at].part(0.0, found[0])]
                    rest = two.pieces[ahead].part(found[1], 1.0)
                    two.pieces[: ahead + 1] = [rest._replace(a=one.pieces[-1].b) if rest.kind < ARC else rest]
                    return True
        return False

    def _close(self, last: Row, first: Row) -> None:
        """A closed contour with a concave corner at its start begins and ends at the common point."""
        if not last.pieces or not first.pieces or last.d != first.d:
            return
        turn = atan2(float(last.t1[0] * first.t0[1] - last.t1[1] * first.t0[0]), float(last.t1 @ first.t0))
        if turn * last.d > 0.0 and float(np.abs(last.pieces[-1].b - first.pieces[0].a).max()) > COINCIDENT:
            self._concave(last, first)

    def write(self, after: int) -> None:
        """Writes the contour; after: kind of the row behind it, -1 if there is none."""
        draft, path = self.draft, self.draft.source
        pieces = [p for row in self.rows for p in (*row.pieces, *row.after)]
        if not pieces:
            for i in range(self.first, self.end):
                draft.copy(i)
            return
        lead_in, lead_out = self._leads(pieces[0], pieces[-1])
        self._approach(lead_in.a if lead_in else pieces[0].a)
        if lead_in is not None:
            self._put(lead_in, self._here(), self.rows[0].i)
        by_row = {row.i: row for row in self.rows}
        for i in range(self.first, self.end):
            row = by_row.get(i)
            if row is not None:
                self._write_row(row)
            else:
                target = path.target[i].copy()
                target[:2] = self._here()[:2]
                draft.add(int(path.kind[i]), target, None, i)
        if lead_out is not None:
            self._put(lead_out, self._here(), self.rows[-1].i)
        if after not in (-1, Kind.POSITIONING, Kind.SET_POSITION):
            target = self._here().copy()
            target[:2] = path.target[self.end - 1][:2]
            draft.insert(Kind.POSITIONING, target, None, self.end - 1)

    def _write_row(self, row: Row) -> None:
        path = self.draft.source
        start = path.start if row.i == 0 else path.target[row.i - 1]
        step = path.target[row.i] - start
        for n, piece in enumerate(row.pieces):
            last = n == len(row.pieces) - 1
            target = path.target[row.i].copy() if last else start + piece.p1 * step
            target[:2] = piece.b
            if (
                float(np.abs(piece.b - self._here()[:2]).max()) <= COINCIDENT
                and piece.kind < ARC
                and not last
            ):
                continue
            p0 = 0.0 if n == 0 else piece.p0
            self.written.append((row.i, piece))
            self.draft.add(
                int(max(piece.kind, Kind.LINE)), target, _shape(piece), row.i, p0, 1.0 if last else piece.p1
            )
        if not row.pieces:
            target = path.target[row.i].copy()
            target[:2] = self._here()[:2]
            self.draft.add(Kind.LINE, target, None, row.i)
        for piece in row.after:
            self.written.append((row.i, piece))
            self._put(piece, self._here(), row.i)

    def _put(self, piece: Piece, here: Floats, origin: int) -> None:
        """A segment of its own in X-Y."""
        target = here.copy()
        target[:2] = piece.b
        self.draft.insert(int(max(piece.kind, Kind.LINE)), target, _shape(piece), origin)

    def _here(self) -> Floats:
        return self.draft.target[-1] if self.draft.target else self.draft.source.start

    def _approach(self, to: Floats) -> None:
        """The positioning before the contour goes to `to`; if there is none, one is put in."""
        draft = self.draft
        if draft.kind and draft.kind[-1] == Kind.POSITIONING:
            target = draft.target[-1].copy()
            target[:2] = to
            draft.target[-1] = target
            return
        target = self._here().copy()
        if float(np.abs(target[:2] - to).max()) > 0.0:
            target[:2] = to
            draft.insert(Kind.POSITIONING, target, None, self.first)

    def _leads(self, first: Piece, last: Piece) -> tuple[Piece | None, Piece | None]:
        """Tangential lines or quarter arcs on the tool's side, before and behind the offset."""
        style = self.style
        if style.lead == "positioning":
            return None, None
        side = 1.0 if self.rows[0].d > 0.0 else -1.0
        t0, t1 = self.rows[0].t0, self.rows[-1].t1
        if style.lead == "line":
            return straight(first.a - style.length * t0, first.a), straight(
                last.b, last.b + style.length * t1
            )
        n0, n1 = side * np.array([-t0[1], t0[0]]), side * np.array([-t1[1], t1[0]])
        c0, c1 = first.a + style.length * n0, last.b + style.length * n1
        return (
            arc_about(c0, c0 - style.length * t0, first.a, side * 0.5 * pi),
            arc_about(c1, last.b, c1 + style.length * t1, side * 0.5 * pi),
        )


def _shape(piece: Piece) -> tuple[int, list[float]] | None:
    return None if piece.kind < ARC else (int(Plane.XY), piece.row.tolist())
