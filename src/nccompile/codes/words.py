"""NC1xx: modal state, words, variables and jumps."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

PAGES: tuple[Page, ...] = (
    Page(
        "NC101",
        "feed move before any feed rate",
        "The move has no programmed velocity; the machine's default feed holds.",
        "% a\nN10 G1 X10",
        "% a\nN10 G1 X10 F20",
    ),
    Page(
        "NC102",
        "unknown instruction",
        "The language has G0 G1 G2 G3 G4 G5 G6 G8 G9, G20, G36 G37, G40-G42, G50-G52, G60 G61, G90-G92, G98 G99\n"
        "(SoftMotion §3.2; G4 is an addition). G21 and others of RS-274 do not exist.",
        "% a\nN10 G21\nN20 G1 X10 F20",
        "% a\nN20 G1 X10 F20",
    ),
    Page(
        "NC103",
        "two instructions in one block",
        "A block has one instruction (SoftMotion §3.2): G90 and G1 stand in two blocks.",
        "% a\nN10 G90 G1 X10 F20",
        "% a\nN10 G90\nN20 G1 X10 F20",
    ),
    Page(
        "NC104",
        "word repeated",
        "Words are evaluated from right to left, so of a repeated word the leftmost holds (SoftMotion §3.2).\n"
        "E may come twice (acceleration and deceleration), as may S, and O and L beside several H.",
        "% a\nN10 G1 X10 X20 F20",
        "% a\nN10 G1 X10 F20 E100 E-200",
    ),
    Page(
        "NC105",
        "word without effect",
        "The instruction of this block does not use the word; it is left out.",
        "% a\nN10 G1 X10 K5 F20",
        "% a\nN10 G1 X10 F20",
    ),
    Page(
        "NC106",
        "no instruction yet",
        "A block without an instruction repeats the last one (SoftMotion §3.2). Before the first it runs as G0.",
        "% a\nN10 X10 Y5",
        "% a\nN10 G0 X10 Y5",
    ),
    Page(
        "NC107",
        "whole number needed",
        "G and M take whole numbers (SoftMotion §3.2).",
        "% a\nN10 G0.5 X10",
        "% a\nN10 G0 X10",
    ),
    Page(
        "NC108",
        "feed not above 0",
        "F is the path velocity in mm/s; at 0 the path would never end.",
        "% a\nN10 G1 X10 F0",
        "% a\nN10 G1 X10 F20",
    ),
    Page(
        "NC109",
        "acceleration too low",
        "An acceleration or deceleration below 1 mm/s2 is refused (SoftMotion §6.2.1, ERR_DEC_ACC_TOO_LITTLE and\n"
        "ERR_DEC_RET_TOO_LITTLE). E > 0 is the acceleration, E < 0 the deceleration.",
        "% a\nN10 G1 X10 F20 E0.5",
        "% a\nN10 G1 X10 F20 E500 E-500",
    ),
    Page(
        "NC110",
        "variable not defined",
        "G36 sets a variable in the program, --define NAME=VALUE before it (SoftMotion §3.2.3). Names have no case.",
        "% a\nN10 G1 X$width$ F20",
        "% a\nN10 G36 O$width$ D40\nN20 G1 X$width$ F20",
    ),
    Page(
        "NC111",
        "G36 or G37 without value or variable",
        "D is the value, O$name$ the variable; without O the implicit variable is meant (SoftMotion §3.2.8).",
        "% a\nN10 G36 O5 D1\nN20 G1 X1 F20",
        "% a\nN10 G36 O$count$ D1\nN20 G1 X1 F20",
    ),
    Page(
        "NC112",
        "value does not fit the implicit variable",
        "The implicit variable is an IEC INT: a whole number from -32768 to 32767 (SoftMotion §3.2.8).",
        "% a\nN10 G36 D0.5\nN20 G1 X1 F20",
        "% a\nN10 G36 O$step$ D0.5\nN20 G1 X1 F20",
    ),
    Page(
        "NC113",
        "jump to a block that is not there",
        "L of G20 is the N number of a block of the same program (SoftMotion §3.2.7).",
        "% a\nN10 G1 X1 F20\nN20 G20 L15 K0",
        "% a\nN10 G1 X1 F20\nN20 G20 L10 K0",
    ),
    Page(
        "NC114",
        "jump to a number that two blocks have",
        "It cannot be known which of them is meant.",
        "% a\nN10 G1 X1 F20\nN10 G1 X2\nN20 G20 L10 K0",
        "% a\nN10 G1 X1 F20\nN15 G1 X2\nN20 G20 L10 K0",
    ),
    Page(
        "NC115",
        "endless loop",
        "The program jumps back without changing a variable, or exceeds the limit of jumps or executed blocks. A\n"
        "loop ends when its condition is exactly 0: steps such as 0.1 may never meet it.",
        "% a\nN10 G36 D3\nN20 G1 X1 F20\nN30 G20 L20",
        "% a\nN10 G36 D3\nN20 G1 X1 F20\nN25 G37 D-1\nN30 G20 L20",
    ),
    Page(
        "NC116",
        "jump without a target",
        "G20 jumps to the block whose number is in L (SoftMotion §3.2.7).",
        "% a\nN10 G1 X1 F20\nN20 G20 K0",
        "% a\nN10 G1 X1 F20\nN20 G20 L10 K0",
    ),
    Page(
        "NC117",
        "switch position outside its path object",
        "O is a part of the path object, 0..1; L a length in mm from its start (> 0) or its end (< 0), at most the\n"
        "length of the path object (SoftMotion §3.2.1).",
        "% a\nN10 G1 X10 F20 H1 L12",
        "% a\nN10 G1 X10 F20 H1 L8",
    ),
    Page(
        "NC118",
        "too many switch points",
        "A path object has a limited number of switch points (SoftMotion §3.2.1, MAX_SWITCHES); the machine file\n"
        "sets it.",
        "% a\nN10 G1 X10 F20 H1 H2 H3 H4 H5 H6 H7 H8 H9",
        "% a\nN10 G1 X5 F20 H1 H2 H3 H4\nN20 G1 X10 H5 H6 H7 H8 H9",
    ),
    Page(
        "NC119",
        "switch position without its switch",
        "Each O or L places the H before it: H1 O0.25 H-1 O0.75.",
        "% a\nN10 G1 X10 F20 H1 O0.25 O0.75",
        "% a\nN10 G1 X10 F20 H1 O0.25 H-1 O0.75",
    ),
    Page(
        "NC120",
        "value out of range",
        "Values and coordinates above 1e9 are typing errors.",
        "% a\nN10 G1 X12345678901 F20",
        "% a\nN10 G1 X123.45678901 F20",
    ),
    Page(
        "NC121",
        "no such switch or M function",
        "H takes a number from 1 to 32767, negative to switch off; M one from 0 to 65535.",
        "% a\nN10 G1 X10 F20 H0",
        "% a\nN10 G1 X10 F20 H1",
    ),
    Page(
        "NC122",
        "no axis with an S-profile",
        "S takes 3 for Z, 4 5 6 for A B C, 7 8 for P Q, 9 10 11 for U V W; negative to switch off.",
        "% a\nN10 G1 X10 F20 S1",
        "% a\nN10 G1 X10 F20 S3",
    ),
    Page(
        "NC123",
        "function already on",
        "The same start instruction is programmed twice without its end between them; the second has no effect.",
        "% a\nN10 G61\nN20 G61\nN30 G1 X10 F20\nN40 G60",
        "% a\nN10 G61\nN30 G1 X10 F20\nN40 G60",
    ),
    Page(
        "NC124",
        "change of side without an end",
        "Tool radius correction to the other side, and rounding instead of smoothing, start only after the running\n"
        "one was ended (SoftMotion §6.2.3).",
        "% a\nN10 G41 D3\nN20 G1 X10 F20\nN30 G42\nN40 G1 X20\nN50 G40",
        "% a\nN10 G41 D3\nN20 G1 X10 F20\nN25 G40\nN30 G42\nN40 G1 X20\nN50 G40",
    ),
    Page(
        "NC125",
        "function not ended",
        "Tool radius correction, rounding or loop avoidance is on at the end of the program; it ends with the last\n"
        "path object.",
        "% a\nN10 G41 D3\nN20 G1 X10 F20",
        "% a\nN10 G41 D3\nN20 G1 X10 F20\nN30 G40",
    ),
    Page(
        "NC126",
        "negative radius",
        "D is the tool radius or the rounding distance in mm. For the other side use G42 instead of G41.",
        "% a\nN10 G41 D-3\nN20 G1 X10 F20\nN30 G40",
        "% a\nN10 G42 D3\nN20 G1 X10 F20\nN30 G40",
    ),
    Page(
        "NC127",
        "G92 without an axis",
        "G92 sets the position of the axes it names.",
        "% a\nN10 G92\nN20 G1 X10 F20",
        "% a\nN10 G92 X5\nN20 G1 X10 F20",
    ),
    Page(
        "NC128",
        "instruction not first",
        "The instruction stands directly after the block number (SoftMotion §3.2).",
        "% a\nN10 X10 G1 F20",
        "% a\nN10 G1 X10 F20",
    ),
    Page(
        "NC129",
        "G92 under G91",
        "G92 names positions, not distances, also while targets are relative.",
        "% a\nN10 G91\nN20 G92 X5\nN30 G1 X10 F20",
        "% a\nN20 G92 X5\nN25 G91\nN30 G1 X10 F20",
    ),
    Page(
        "NC130",
        "dwell without time",
        "G4 waits T seconds (or F seconds).",
        "% a\nN10 G1 X10 F20\nN20 G4",
        "% a\nN10 G1 X10 F20\nN20 G4 T0.5",
    ),
)
