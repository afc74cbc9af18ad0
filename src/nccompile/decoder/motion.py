"""Drive instructions to segments: G0 G1 G2 G3 G5 G6 G8 G9 (SoftMotion §3.2, §3.2.4-§3.2.6).

X and Y move on the curve; Z and the additional axes go along in proportion to the path length, or in the
S-profile (§6.2.8).
"""

from __future__ import annotations

from math import hypot, sqrt

from nccompile.decoder.core import LIMIT, Core
from nccompile.decoder.marks import Marks
from nccompile.decoder.splines import SplineRun
from nccompile.decoder.switches import place_switches
from nccompile.decoder.tables import MOTION
from nccompile.decoder.words import Statement
from nccompile.geometry import (
    Curve,
    Impossible,
    arc_by_center,
    arc_by_radius,
    ellipse_by_center,
    parabola_by_tangents,
)
from nccompile.geometry.tolerance import COINCIDENT
from nccompile.source import Span
from nccompile.toolpath.columns import Kind
from nccompile.toolpath.lengths import path_length
from nccompile.units import rad_from_deg

__all__ = ["Motion"]

_CURVE_KIND = {2: Kind.ARC, 3: Kind.ARC, 6: Kind.POLYNOMIAL, 8: Kind.ELLIPSE, 9: Kind.ELLIPSE}
_CURVE_CODE = {2: "NC201", 3: "NC201", 6: "NC203", 8: "NC202", 9: "NC202"}


class Motion:
    """Makes the segments of drive instructions."""

    def __init__(self, core: Core) -> None:
        self._core = core
        self._warned_feed = False
        self.spline = SplineRun(core)
        self.marks = Marks(core)

    @property
    def warns_of_feed(self) -> bool:
        """Whether a feed move before any feed rate is still to be reported."""
        return not self._warned_feed and not self._core.incomplete

    def drive(self, statement: Statement) -> None:
        """Executes a block whose instruction is G0 to G9."""
        core, instruction = self._core, statement.instruction
        assert instruction is not None
        code = core.modal.drive = instruction.code
        values = statement.values
        if MOTION.isdisjoint(values) and not statement.switches:
            return
        if core.modal.feed == 0.0 and code != 0 and self.warns_of_feed:
            self._warned_feed = True
            core.warn(
                "NC101", f"feed move G{code} before any feed rate; the machine's default holds",
                statement.span, "program F in this block or in an earlier one",
            )  # fmt: skip
        target = self.target(statement)
        if target is None:
            return
        if code <= 1:
            self._straight(statement, target, Kind.POSITIONING if code == 0 else Kind.LINE)
        elif code == 5:
            self._spline(statement, target)
        else:
            self._curve(statement, target, code)

    def target(self, statement: Statement) -> list[float] | None:
        """The target on all axes; None (reported) if it is out of range."""
        core = self._core
        index = core.index
        target = core.modal.position.copy()
        if core.modal.absolute:
            for letter, value in statement.values.items():
                at = index.get(letter)
                if at is not None:
                    target[at] = value
            return target
        for letter, value in statement.values.items():
            at = index.get(letter)
            if at is not None:
                target[at] += value
                if not -LIMIT <= target[at] <= LIMIT:
                    core.error(
                        "NC120", f"{letter} leaves the range of +-{LIMIT:.0e}", statement.place(letter)
                    )
                    return None
        return target

    def _straight(self, statement: Statement, target: list[float], kind: Kind) -> None:
        modal = self._core.modal
        position = modal.position
        dx, dy, dz = target[0] - position[0], target[1] - position[1], target[2] - position[2]
        length = sqrt(dx * dx + dy * dy + dz * dz)
        if length == 0.0 or modal.profile:
            length = path_length(self._core.axes, kind, position, target, profile=modal.profile)
        contour = kind is Kind.LINE and (dx != 0.0 or dy != 0.0)
        leaving: Curve | tuple[float, float] | None = (dx, dy) if contour else None
        if length > 0.0 or kind is Kind.POSITIONING:
            self.spline.close((dx, dy) if contour else None)
        else:
            leaving = modal.leaving  # a line without length keeps its neighbours' tangents together
        self._finish(statement, self._core.add(kind, target, length, statement.line), length)
        modal.leaving = leaving

    def _spline(self, statement: Statement, target: list[float]) -> None:
        position = self._core.modal.position
        if hypot(target[0] - position[0], target[1] - position[1]) <= COINCIDENT:
            self._straight(statement, target, Kind.LINE)
            return
        row = self.spline.point(statement, target, self._rise(target))
        self._core.path.last_drive = row
        self.marks.drive(row)

    def _curve(self, statement: Statement, target: list[float], code: int) -> None:
        core = self._core
        x0, y0 = core.modal.position[0], core.modal.position[1]
        try:
            curve = _CURVES[code](self, statement, x0, y0, target[0], target[1])
        except Impossible as reason:
            shape = {2: "arc", 3: "arc", 6: "parabola"}.get(code, "ellipse")
            core.warn(_CURVE_CODE[code], f"no {shape}, a line instead: {reason}", _shape_span(statement))
            self._straight(statement, target, Kind.LINE)
            return
        length, rise = curve.length, self._rise(target)
        if rise != 0.0:
            length = sqrt(length * length + rise * rise)
        self.spline.close(curve.start_tangent)
        row = core.add(_CURVE_KIND[code], target, length, statement.line, curve)
        self._finish(statement, row, length)
        core.modal.leaving = curve

    def _finish(self, statement: Statement, row: int, length: float) -> None:
        self._core.path.last_drive = row
        self.marks.drive(row)
        if statement.switches:
            place_switches(self._core, statement, row, length)

    def _rise(self, target: list[float]) -> float:
        """Travel of Z that counts as path length: none if Z runs in the S-profile [mm]."""
        modal = self._core.modal
        return 0.0 if modal.profile & 4 else target[2] - modal.position[2]

    def _centre(self, statement: Statement, x0: float, y0: float) -> tuple[float, float]:
        """The point of I and J; one that is missing keeps the start's coordinate."""
        values = statement.values
        if self._core.modal.centre_absolute:
            return values.get("I", x0), values.get("J", y0)
        return x0 + values.get("I", 0.0), y0 + values.get("J", 0.0)

    def _arc(self, statement: Statement, x0: float, y0: float, x1: float, y1: float) -> Curve:
        values = statement.values
        ccw = self._core.modal.drive == 3
        if "I" in values or "J" in values:
            if "R" in values:
                self._core.warn("NC105", "R has no effect beside I and J", statement.place("R"))
            cx, cy = self._centre(statement, x0, y0)
            return arc_by_center(x0, y0, x1, y1, cx, cy, ccw)
        if "R" not in values:
            raise Impossible("the block has neither a radius R nor a centre I J")
        return arc_by_radius(x0, y0, x1, y1, values["R"], ccw)

    def _ellipse(self, statement: Statement, x0: float, y0: float, x1: float, y1: float) -> Curve:
        values = statement.values
        missing = "R" if "R" not in values else "I J" if "I" not in values and "J" not in values else ""
        if missing:
            raise Impossible(f"the block has no {missing}")
        ratio = values["R"]
        if not 0.0 < ratio <= 1.0:
            raise Impossible(f"the ratio R must be above 0 and at most 1, not {ratio:g}")
        cx, cy = self._centre(statement, x0, y0)
        direction = rad_from_deg(values.get("K", 0.0))
        return ellipse_by_center(x0, y0, x1, y1, cx, cy, direction, ratio, self._core.modal.drive == 9)

    def _parabola(self, statement: Statement, x0: float, y0: float, x1: float, y1: float) -> Curve:
        if "I" not in statement.values and "J" not in statement.values:
            raise Impossible("the block has no tangent intersection I J")
        if hypot(x1 - x0, y1 - y0) <= COINCIDENT:
            raise Impossible("start and end are the same point")
        ix, iy = self._centre(statement, x0, y0)
        return parabola_by_tangents(x0, y0, x1, y1, ix, iy)


def _shape_span(statement: Statement) -> Span:
    """The words that shape a curve, or the whole block."""
    spans = [word.span for word in statement.block.words if word.letter in {"I", "J", "K", "R"}]
    return spans[0].to(spans[-1]) if spans else statement.block.span


_CURVES = {2: Motion._arc, 3: Motion._arc, 6: Motion._parabola, 8: Motion._ellipse, 9: Motion._ellipse}
