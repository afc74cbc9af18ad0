"""Toolpaths as DIN 66025 part programs, in numbers of a stated resolution (SoftMotion §3.2).

Every end is rounded to the last decimal; what then has no length is left out.  The centre of an arc is computed
anew from the rounded ends and the sweep, and I and J carry two more decimals, so that the arc stays an arc:
both radii agree far below the resolution.  Arcs above a half turn are written as two.  What the language has
no word for - cubics, and curves in other planes than XY - becomes arcs and lines within a tolerance.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import accumulate
from math import pi, tan

import numpy as np

from nccompile.backend.din66025_curves import Step, steps_of
from nccompile.toolpath import EventKind, Kind, Mark, Plane, Toolpath

__all__ = ["ProgramFormat", "program_text"]

CENTRE_DECIMALS = 2
"""I and J have this many decimals more than the coordinates."""

_STARTS = {
    int(Mark.TOOL_LEFT): "G41",
    int(Mark.TOOL_RIGHT): "G42",
    int(Mark.SMOOTH): "G51",
    int(Mark.ROUND): "G52",
    int(Mark.LOOP): "G61",
}
_STOPS = {int(Mark.TOOL_STOP): "G40", int(Mark.CORNER_STOP): "G50", int(Mark.LOOP_STOP): "G60"}
_WAITS = frozenset({Kind.DWELL, Kind.M_FUNCTION})


@dataclass(frozen=True)
class ProgramFormat:
    """How a program is written.

    decimals: of coordinates [mm];  tolerance: of curves that have no word [mm];  step: between block numbers;
    head: comment lines at the top;  notes: comments before the segments of these numbers.
    """

    name: str = "PROGRAM"
    decimals: int = 4
    tolerance: float = 0.005
    step: int = 10
    head: Sequence[str] = ()
    notes: Mapping[int, Sequence[str]] = field(default_factory=dict)


def program_text(chunks: Iterable[Toolpath], form: ProgramFormat) -> Iterator[str]:
    """The program's lines, each with its line end."""
    yield f"% {_comment(form.name)}\n"
    for line in form.head:
        yield f"({_comment(line)})\n"
    writer = _Writer(form)
    for chunk in chunks:
        yield from writer.chunk(chunk)


def _comment(text: str) -> str:
    """Text that fits between parentheses: comments do not nest."""
    shown = "".join(c if c.isprintable() else " " for c in text)
    return shown.replace("(", "[").replace(")", "]").replace("$", "S")


class _Writer:
    """The modal state of the program as written so far."""

    def __init__(self, form: ProgramFormat) -> None:
        self.form = form
        self.number = 0
        self.at: list[float] = []
        self.feed = self.accel = self.decel = 0.0

    def block(self, words: str) -> str:
        """A numbered block."""
        self.number += self.form.step
        return f"N{self.number} {words}\n"

    def chunk(self, path: Toolpath) -> Iterator[str]:
        """The blocks of a chunk."""
        if not self.at:
            self.at = [round(float(v), self.form.decimals) for v in path.start]
            if any(self.at):
                yield self.block(
                    "G92 "
                    + " ".join(
                        _word(a, v, self.form.decimals) for a, v in zip(path.axes, self.at, strict=True)
                    )
                )
        events: dict[int, list[int]] = {}
        for e, segment in enumerate(path.events.segment.tolist()):
            events.setdefault(segment, []).append(e)
        starts = path.starts()
        for i, (kind, mark) in enumerate(zip(path.kind.tolist(), path.mark.tolist(), strict=True)):
            for text in self.form.notes.get(path.first + i, ()):
                yield f"({_comment(text)})\n"
            if kind in _WAITS:
                yield self._wait(path, events.get(i, ()))
                continue
            if kind == Kind.SET_POSITION:
                yield self._jump(path, i)
                continue
            for bit, code in _STARTS.items():
                if mark & bit:
                    yield self.block(f"{code} {_word('D', float(path.radius[i]), self.form.decimals)}")
            yield from self._segment(path, i, kind, starts[i], events.get(i, ()))
            for bit, code in _STOPS.items():
                if mark & bit:
                    yield self.block(code)

    def _wait(self, path: Toolpath, events: Sequence[int]) -> str:
        e, table = events[0], path.events
        if table.kind[e] == EventKind.DWELL:
            return self.block(f"G4 {_word('T', float(table.k[e]), 6)}")
        words = [f"M{int(table.number[e])}"]
        words += [_word(a, float(v), 6) for a, v in (("K", table.k[e]), ("L", table.l[e])) if v]
        if table.o[e] >= 0:
            words.append(f"O${path.names[table.o[e]]}$")
        return self.block(" ".join(words))

    def _jump(self, path: Toolpath, i: int) -> str:
        self.at = [round(float(v), self.form.decimals) for v in path.target[i]]
        words = (_word(a, v, self.form.decimals) for a, v in zip(path.axes, self.at, strict=True))
        return self.block("G92 " + " ".join(words))

    def _segment(
        self, path: Toolpath, i: int, kind: int, start: np.typing.NDArray[np.float64], events: Sequence[int]
    ) -> Iterator[str]:
        """A drive segment as one block or, for curves the language has no word for, several."""
        target = path.target[i]
        row = None if path.curve[i] < 0 else path.curves.parameters[path.curve[i]]
        plane = Plane.XY if path.curve[i] < 0 else Plane(int(path.curves.plane[path.curve[i]]))
        steps = steps_of(kind, plane, row, start, target, self.form.tolerance)
        shares = list(accumulate(step.share for step in steps))
        for at, step in enumerate(steps):
            switches = self._switches(path, events, shares, at)
            words = self._step(path, i, step, bool(switches))
            if words:
                yield self.block(" ".join([*words, *switches]))

    def _switches(self, path: Toolpath, events: Sequence[int], shares: Sequence[float], at: int) -> list[str]:
        """H and O words of the switch points that lie on step `at` of a segment."""
        low, high = (shares[at - 1] if at else 0.0), shares[at]
        words = []
        for e in events:
            position = float(path.events.position[e]) * shares[-1]
            last = at == len(shares) - 1
            if low <= position < high or (last and position >= low):
                place = (position - low) / (high - low) if high > low else 0.0
                words.append(f"H{int(path.events.number[e])} {_word('O', min(max(place, 0.0), 1.0), 9)}")
        return words

    def _step(self, path: Toolpath, i: int, step: Step, needed: bool) -> list[str]:
        """The words of one step; none if rounding leaves nothing of it."""
        d = self.form.decimals
        new = [round(float(v), d) for v in step.target]
        moved = [k for k, (a, b) in enumerate(zip(self.at, new, strict=True)) if a != b]
        full = abs(step.sweep) >= 2 * pi - 1e-12
        if not moved and not full and not needed:
            return []
        flat = full or any(k < 2 for k in moved)
        code = step.code if flat or step.code in {"G0", "G1"} else "G1"
        words = [code]
        shown = moved or [0, 1]
        words += [_word(path.axes[k], new[k], d) for k in shown]
        if code not in {"G0", "G1"}:
            words += self._centre(step, complex(self.at[0], self.at[1]), complex(new[0], new[1]), full)
        words += self._limits(path, i, code)
        self.at = new
        return words

    def _centre(self, step: Step, a: complex, b: complex, full: bool) -> list[str]:
        """I and J from the start, for an ellipse K and R too.

        In the frame in which the curve is a circle (turned by -direction, the sub axis stretched by 1 / ratio)
        the centre stands over the middle of the chord, i chord / (2 tan(sweep / 2)) aside.
        """
        d = self.form.decimals + CENTRE_DECIMALS
        if full:
            centre = step.centre - step.start
        else:
            axis = complex(np.cos(step.direction), np.sin(step.direction))
            chord = (b - a) / axis
            round_chord = complex(chord.real, chord.imag / step.ratio)
            offset = 0.5 * round_chord + 0.5j * round_chord / tan(0.5 * step.sweep)
            centre = axis * complex(offset.real, offset.imag * step.ratio)
        words = [_word("I", centre.real, d), _word("J", centre.imag, d)]
        if step.code in {"G8", "G9"}:
            words += [_word("K", float(np.degrees(step.direction)), 9), _word("R", step.ratio, 12)]
        return words

    def _limits(self, path: Toolpath, i: int, code: str) -> list[str]:
        """F and E words where they change; a rapid needs no F."""
        words = []
        feed, accel, decel = float(path.feed[i]), float(path.accel[i]), float(path.decel[i])
        if code != "G0" and feed > 0 and feed != self.feed:
            self.feed = feed
            words.append(_word("F", feed, 6))
        if accel > 0 and accel != self.accel:
            self.accel = accel
            words.append(_word("E", accel, 6))
        if decel > 0 and decel != self.decel:
            self.decel = decel
            words.append(_word("E", -decel, 6))
        return words


def _word(letter: str, value: float, decimals: int) -> str:
    """A word; the number without exponent, trailing zeros and negative zero."""
    text = f"{value:.{decimals}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return letter + ("0" if text in {"-0", ""} else text)
