"""Switch points on a path object: H with O or L (SoftMotion §3.2.1)."""

from __future__ import annotations

from nccompile.decoder.core import Core
from nccompile.decoder.words import Statement
from nccompile.parser import Word
from nccompile.toolpath.columns import EventKind

__all__ = ["place_switches"]

_MOST = 32767
"""Greatest switch number, an IEC INT."""


def place_switches(core: Core, statement: Statement, row: int, length: float) -> None:
    """Adds the block's switch points to its segment, which is `length` mm long.

    Each H goes with the O or L after it and before the next H; without one it switches at the start.
    """
    pairs: list[tuple[Word, float, Word | None, float]] = []
    for word, value in statement.switches:
        if word.letter == "H":
            pairs.append((word, value, None, 0.0))
        elif not pairs or pairs[-1][2] is not None:
            core.error(
                "NC119", f"{word.text} stands after no H of its own", word.span, "write H1 O0.5 H-1 O0.75"
            )
            return
        else:
            pairs[-1] = (*pairs[-1][:2], word, value)
    if len(pairs) > core.options.max_switches:
        extra = pairs[core.options.max_switches][0]
        core.error(
            "NC118", f"{len(pairs)} switch points on one path object; at most {core.options.max_switches} fit",
            extra.span, "divide the path object",
        )  # fmt: skip
        return
    for switch, number, place, value in pairs:
        position = _position(core, place, value, length) if place is not None else 0.0
        if not number.is_integer() or number == 0 or abs(number) > _MOST:
            core.error(
                "NC121", f"{switch.text} names no switch", switch.span,
                f"H takes a whole number from 1 to {_MOST}, negative to switch off",
            )  # fmt: skip
        elif position is not None:
            core.path.event(row, EventKind.SWITCH, int(number), position)


def _position(core: Core, word: Word, value: float, length: float) -> float | None:
    """The place on the segment, 0..1; None (reported) if it is not on it."""
    if word.letter == "O":
        if 0.0 <= value <= 1.0:
            return value
        core.error("NC117", f"the switch position {word.text} is not between 0 and 1", word.span)
        return None
    if abs(value) > length:
        core.error(
            "NC117", f"the switch position {word.text} lies outside its path object, which is {length:.6g} mm long",
            word.span, "use O0 for its start, O1 for its end",
        )  # fmt: skip
        return None
    if value >= 0.0:
        return value / length if length > 0.0 else 0.0
    return (length + value) / length
