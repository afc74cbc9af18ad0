"""Every word letter and instruction of the dialect: what it means and what it goes with (SoftMotion §3.2).

The decoder reads its rules here; messages, hovers and rules of the linter take their texts from here.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from nccompile.toolpath.columns import AXIS_LETTERS

__all__ = [
    "AXES", "DWELL", "INSTRUCTIONS", "LETTERS", "MODAL", "MOTION", "M_FUNCTION", "PROFILE_AXES", "Group",
    "Instruction", "Letter",
]  # fmt: skip

AXES = frozenset(AXIS_LETTERS)

MODAL = frozenset("DEFS")
"""Words that set something and may stand in any block."""

MOTION = AXES | frozenset("IJRH")
"""Words that repeat the last drive instruction in a block without instruction."""

PROFILE_AXES = {3: "Z", 4: "A", 5: "B", 6: "C", 7: "P", 8: "Q", 9: "U", 10: "V", 11: "W"}
"""Axes of the S word (SoftMotion §3.2; 4 to 6 by the order of POSINFO §6.6, docs/decisions/016)."""


class Group(StrEnum):
    """Instructions of one group replace each other (drive, distance, ...) or stand alone (flow, ...)."""

    DRIVE = "drive"
    DISTANCE = "distance"
    CENTRE = "centre"
    TOOL = "tool radius correction"
    CORNER = "corner rounding"
    LOOP = "loop avoidance"
    POSITION = "position"
    VARIABLE = "variable"
    FLOW = "flow"
    WAIT = "wait"


@dataclass(frozen=True, slots=True)
class Letter:
    """A word letter: meaning, and unit if it has one; `counts`: its value must be a whole number."""

    letter: str
    meaning: str
    unit: str = ""
    counts: bool = False


LETTERS: dict[str, Letter] = {
    row.letter: row
    for row in (
        Letter("A", "target of the rotary axis A", "deg"),
        Letter("B", "target of the rotary axis B", "deg"),
        Letter("C", "target of the rotary axis C", "deg"),
        Letter("D", "tool radius or rounding radius; value for G36 and G37", "mm"),
        Letter("E", "path acceleration (> 0) or deceleration (< 0)", "mm/s2"),
        Letter("F", "path velocity; seconds with G4", "mm/s"),
        Letter("G", "instruction", "", True),
        Letter("H", "switch on (> 0) or off (< 0)", "", True),
        Letter("I", "centre or tangent intersection in X", "mm"),
        Letter("J", "centre or tangent intersection in Y", "mm"),
        Letter("K", "direction of the ellipse's main axis [deg]; jump condition; M parameter"),
        Letter("L", "switch position from the start (> 0) or end (< 0) [mm]; jump target; M parameter"),
        Letter("M", "M function: waits for the acknowledge", "", True),
        Letter("N", "block number", "", True),
        Letter("O", "switch position 0..1; variable of G36 and G37; M parameter"),
        Letter("P", "target of the additional axis P", "mm"),
        Letter("Q", "target of the additional axis Q", "mm"),
        Letter("R", "arc radius [mm]; sub axis / main axis of an ellipse"),
        Letter("S", "S-profile of an axis on (> 0) or off (< 0)", "", True),
        Letter("T", "dwell time of G4", "s"),
        Letter("U", "target of the additional axis U", "mm"),
        Letter("V", "target of the additional axis V", "mm"),
        Letter("W", "target of the additional axis W", "mm"),
        Letter("X", "target in X", "mm"),
        Letter("Y", "target in Y", "mm"),
        Letter("Z", "target in Z", "mm"),
    )
}
"""The letters of the language; A B C, T and G4 are additions of this compiler (docs/decisions/017)."""


@dataclass(frozen=True, slots=True)
class Instruction:
    """A G code (or M, which has none): group, effect, and the letters it goes with.

    operands: words it uses;  accepts: these and the modal ones; all others have no effect beside it.
    """

    code: int
    group: Group
    effect: str
    operands: frozenset[str] = frozenset()

    @property
    def name(self) -> str:
        """As a program writes it."""
        return f"G{self.code}" if self.code >= 0 else "M"

    @property
    def accepts(self) -> frozenset[str]:
        """The letters that may stand beside it."""
        return self.operands | MODAL


_ARC = AXES | frozenset("IJR")

INSTRUCTIONS: dict[int, Instruction] = {
    row.code: row
    for row in (
        Instruction(0, Group.DRIVE, "positioning without tool contact; stops at both ends", AXES),
        Instruction(1, Group.DRIVE, "line", AXES),
        Instruction(2, Group.DRIVE, "circular arc, clockwise", _ARC),
        Instruction(3, Group.DRIVE, "circular arc, counter-clockwise", _ARC),
        Instruction(4, Group.WAIT, "dwell", frozenset("FT")),
        Instruction(5, Group.DRIVE, "point of a cardinal spline", AXES),
        Instruction(
            6, Group.DRIVE, "parabola by the intersection of its end tangents", AXES | frozenset("IJ")
        ),
        Instruction(8, Group.DRIVE, "ellipse arc, clockwise", _ARC | {"K"}),
        Instruction(9, Group.DRIVE, "ellipse arc, counter-clockwise", _ARC | {"K"}),
        Instruction(20, Group.FLOW, "jump to block L if K is not 0", frozenset("KL")),
        Instruction(36, Group.VARIABLE, "set variable O to D", frozenset("DO")),
        Instruction(37, Group.VARIABLE, "add D to variable O", frozenset("DO")),
        Instruction(40, Group.TOOL, "end of tool radius correction"),
        Instruction(41, Group.TOOL, "start of tool radius correction, left"),
        Instruction(42, Group.TOOL, "start of tool radius correction, right"),
        Instruction(50, Group.CORNER, "end of corner rounding and smoothing"),
        Instruction(51, Group.CORNER, "start of corner smoothing by splines"),
        Instruction(52, Group.CORNER, "start of corner rounding by arcs"),
        Instruction(60, Group.LOOP, "end of loop avoidance"),
        Instruction(61, Group.LOOP, "start of loop avoidance"),
        Instruction(90, Group.DISTANCE, "targets are absolute"),
        Instruction(91, Group.DISTANCE, "targets are relative to the position before"),
        Instruction(92, Group.POSITION, "set the position without moving", AXES),
        Instruction(98, Group.CENTRE, "I and J are absolute"),
        Instruction(99, Group.CENTRE, "I and J are relative to the start of the arc"),
    )
}

M_FUNCTION = Instruction(-1, Group.WAIT, "M function: waits for the acknowledge", frozenset("KLO"))

DWELL = INSTRUCTIONS[4]
