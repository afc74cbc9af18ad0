"""Pages of the lint rules.  Made from their docstrings by tools/rule_pages.py: do not edit."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

# fmt: off
PAGES: tuple[Page, ...] = (
    Page(
        "NC051", "A block has no block number",
        "A block with words and without N in a program whose other blocks have one; one finding for the whole\n"
        "program if none has.\n"
        "The number is expected of every block (SoftMotion §3.2); drives, operators and jumps name blocks by it.",
        "% a\nN10 G1 X1 F20\nG1 X2",
        "% a\nN10 G1 X1 F20\nN20 G1 X2",
    ),
    Page(
        "NC052", "Two blocks have the same block number",
        "A block number that stood before.\n"
        "A jump to it cannot be executed, and messages that name the block mean two places.",
        "% a\nN10 G1 X1 F20\nN10 G1 X2",
        "% a\nN10 G1 X1 F20\nN20 G1 X2",
    ),
    Page(
        "NC053", "Block numbers do not rise",
        "A block number below that of the block before.\n"
        "Operators look for a block by its number; falling numbers are usually left over from copied blocks.",
        "% a\nN20 G1 X1 F20\nN10 G1 X2",
        "% a\nN10 G1 X1 F20\nN20 G1 X2",
    ),
    Page(
        "NC054", "Words are written with small letters",
        "A block with a word letter in lower case.\n"
        "Case has no meaning (SoftMotion §3.2), but a program is easier to read and to search in one spelling.",
        "% a\nn10 g1 x1 f20",
        "% a\nN10 G1 X1 F20",
    ),
    Page(
        "NC055", "Words are not separated by one blank",
        "Words that are glued together, tabs, several blanks, blanks at the start or end of a line.\n"
        "Words are separated by blanks (SoftMotion §3.2); other controls and editors may read glued words\n"
        "differently.",
        "% a\nN10G1X1  F20",
        "% a\nN10 G1 X1 F20",
    ),
    Page(
        "NC056", "Characters that a control may not show",
        "A comment or name with characters beyond ASCII.\n"
        "Controls read programs in different encodings; letters with accents come out as other ones, and some\n"
        "controls refuse the file.",
        "% a\nN10 G1 X1 F20 (größer)",
        "% a\nN10 G1 X1 F20 (groesser)",
    ),
    Page(
        "NC057", "Control characters between words",
        "A form feed or vertical tab, left over from printing.\n"
        "They count as blanks here, but not on every control.",
        "% a\nN10 G1\x0cX1 F20",
        "% a\nN10 G1 X1 F20",
    ),
    Page(
        "NC058", "Lines end in different ways",
        "Some lines end with CR LF, others with LF or CR alone.\n"
        "It happens when files are joined; line numbers then differ between editors, controls and this compiler.",
        "% a\r\nN10 G1 X1 F20\nN20 G1 X2\r\n",
        "% a\nN10 G1 X1 F20\nN20 G1 X2\n",
    ),
    Page(
        "NC059", "A skip mark on a block that does nothing",
        "/ before a block without words, or alone in a line.\n"
        "There is nothing to skip; usually the / was meant for the next block.",
        "% a\n/N10 (rough)\nN20 G1 X1 F20",
        "% a\n/N10 G1 X1 F20\nN20 G1 X2",
    ),
    Page(
        "NC060", "A comment holds a block",
        "A comment whose text is made of words, as a block that was taken out.\n"
        "Nobody knows whether it may come back. The skip mark / takes a block out for good reason and visibly.",
        "% a\n(N10 G1 X5)\nN20 G1 X1 F20",
        "% a\n(first cut)\nN20 G1 X1 F20",
    ),
    Page(
        "NC061", "The header has no name",
        "% without a program name after it.\n"
        "The name is what queue files, reports and operators call the program by.",
        "%\nN10 G1 X1 F20",
        "% bracket\nN10 G1 X1 F20",
    ),
    Page(
        "NC062", "A comment that silences nothing known",
        "(nc: ...) that is not one of the forms of ignore comments, or names a code that does not exist.\n"
        "The finding that it should silence is still shown, or will never come.",
        "% a\nN10 G1 X1 F20 (nc: ignore[NC9])",
        "% a\nN10 G1 X1 F20 (nc: ignore[NC151])",
    ),
    Page(
        "NC151", "A feed that holds already",
        "F with the value that is in force.\n"
        "The word says nothing new; post-processors write it in every block, and a change of feed is hard to\n"
        "find among them.",
        "% a\nN10 G1 X1 F20\nN20 G1 X2 F20",
        "% a\nN10 G1 X1 F20\nN20 G1 X2",
    ),
    Page(
        "NC153", "An axis word that repeats the position",
        "A target that the axis has already, beside another axis word. Off by default, since many\n"
        "post-processors write all axes in all blocks.\n"
        "The word says nothing new; without it the block shows what moves.",
        "% a\nN10 G1 X1 Y5 F20\nN20 G1 X2 Y5",
        "% a\nN10 G1 X1 Y5 F20\nN20 G1 X2",
    ),
    Page(
        "NC154", "A variable that is written and never read",
        "G36 or G37 on a variable that no word uses.\n"
        "Either its use was forgotten or its name is misspelt somewhere.",
        "% a\nN10 G36 O$depth$ D5\nN20 G1 X1 F20",
        "% a\nN10 G36 O$depth$ D5\nN20 G1 X1 Z$depth$ F20",
    ),
    Page(
        "NC155", "The implicit variable is set and never used",
        "G36 or G37 without O in a program whose jumps all have a condition of their own, or that has none.\n"
        "The implicit variable acts only as the condition of a jump without K (SoftMotion §3.2.8).",
        "% a\nN10 G36 D5\nN20 G1 X1 F20",
        "% a\nN10 G36 D2\nN20 G1 X1 F20\nN30 G37 D-1\nN40 G20 L20",
    ),
    Page(
        "NC156", "A loop whose condition never changes",
        "A jump back over blocks that do not write the variable of its condition.\n"
        "Once taken it is taken for ever; `compile` sees it only if the loop is entered.",
        "% a\nN10 G36 O$n$ D0\nN20 G1 X1 F20\nN30 G20 L20 K$n$",
        "% a\nN10 G36 O$n$ D2\nN20 G1 X1 F20\nN25 G37 O$n$ D-1\nN30 G20 L20 K$n$",
    ),
    Page(
        "NC157", "A loop step that may never meet 0",
        "G37 with a fraction, such as 0.1, on the variable of a loop's condition.\n"
        "A jump is taken until its condition is exactly 0; sums of fractions are not exact, so the loop may run\n"
        "past 0 and never end.",
        "% a\nN10 G36 O$n$ D0.2\nN20 G1 X1 F20\nN25 G37 O$n$ D-0.1\nN30 G20 L20 K$n$",
        "% a\nN10 G36 O$n$ D10\nN20 G1 X1 F20\nN25 G37 O$n$ D-1\nN30 G20 L20 K$n$",
    ),
    Page(
        "NC158", "A block that is never reached",
        "Blocks after a jump that is always taken, up to the next block that a jump leads to.\n"
        "They look as if they ran.",
        "% a\nN10 G1 X1 F20\nN20 G20 L40 K1\nN30 G1 X2\nN40 G1 X3",
        "% a\nN10 G36 O$n$ D1\nN20 G20 L40 K$n$\nN30 G1 X2 F20\nN40 G1 X3 F20",
    ),
    Page(
        "NC159", "A jump that is never taken, or leads nowhere else",
        "G20 with the constant condition 0, or to the block that follows anyway.\n"
        "It has no effect; usually the condition or the number is wrong.",
        "% a\nN10 G1 X1 F20\nN20 G20 L10 K0",
        "% a\nN10 G36 O$n$ D1\nN15 G1 X1 F20\nN20 G37 O$n$ D-1\nN30 G20 L15 K$n$",
    ),
    Page(
        "NC160", "A mode that holds already",
        "G90, G91, G98 or G99 while it is in force, other than as the first of its kind.\n"
        "It has no effect; where it was meant to change something, the other one is missing.",
        "% a\nN10 G91\nN20 G1 X1 F20\nN30 G91\nN40 G1 X1",
        "% a\nN10 G91\nN20 G1 X1 F20\nN30 G90\nN40 G1 X1",
    ),
    Page(
        "NC161", "The program ends with relative targets",
        "G91 without G90 after it.\n"
        "The control may keep the mode; the next program then starts with relative targets.",
        "% a\nN10 G91\nN20 G1 X1 F20",
        "% a\nN10 G91\nN20 G1 X1 F20\nN30 G90",
    ),
    Page(
        "NC162", "A position that is set and set again",
        "G92 followed by G92 for the same axes without a move between them.\n"
        "Only the last of several counts; to give the first one out, put G1 with the same position between them\n"
        "(SoftMotion §3.2).",
        "% a\nN10 G92 X5\nN20 G92 X7\nN30 G1 X10 F20",
        "% a\nN10 G92 X5\nN15 G1 X5 F20\nN20 G92 X7\nN30 G1 X10",
    ),
    Page(
        "NC163", "M2 or M30 is no end",
        "M2 or M30, which end a program in ISO 6983.\n"
        "Here every M function waits until it is acknowledged (SoftMotion §3.2.2); the program ends with its last\n"
        "block. Without an acknowledge the run never ends.",
        "% a\nN10 G1 X1 F20\nN20 M30",
        "% a\nN10 G1 X1 F20",
    ),
    Page(
        "NC164", "An M function stops a contour",
        "An M function between two feed moves.\n"
        "The path stands until it is acknowledged (SoftMotion §3.2.2), with the tool in contact. A switch point\n"
        "(H) acts without a stop (§3.2.1).",
        "% a\nN10 G1 X5 F20\nN20 M8\nN30 G1 X10",
        "% a\nN10 G1 X5 F20\nN30 G1 X10 H8 O0",
    ),
    Page(
        "NC165", "Correction, smoothing or rounding without D",
        "G41, G42, G51 or G52 where no D above 0 is in force.\n"
        "The radius is 0, so the function changes nothing (SoftMotion §6.2.3, §6.2.5, §6.2.6).",
        "% a\nN10 G41\nN20 G1 X10 F20\nN30 G40",
        "% a\nN10 G41 D3\nN20 G1 X10 F20\nN30 G40",
    ),
    Page(
        "NC166", "The end of a function that is not on",
        "G40, G50 or G60 without its start before it, other than at the head of the program, where it is a\n"
        "customary reset.\n"
        "It has no effect; often its start was deleted or never written.",
        "% a\nN10 G1 X10 F20\nN20 G50\nN30 G1 X20",
        "% a\nN10 G51 D1\nN20 G1 X10 F20\nN30 G1 X20\nN40 G50",
    ),
    Page(
        "NC167", "A function is ended before anything moves",
        "G41, G42, G51, G52 or G61 and its end with no move between them.\nIt acts on nothing.",
        "% a\nN10 G1 X5 F20\nN20 G41 D3\nN30 G40\nN40 G1 X10",
        "% a\nN10 G1 X5 F20\nN20 G41 D3\nN40 G1 X10\nN50 G40",
    ),
    Page(
        "NC168", "The program ends on a feed move",
        "No positioning (G0) after the last feed move, which does not lead back to where the program began.\n"
        "The tool stays where it cut last; the next program, or the operator, has to move it away.",
        "% a\nN10 G0 X5\nN20 G1 X10 F20",
        "% a\nN10 G0 X5\nN20 G1 X10 F20\nN30 G0 Z50",
    ),
    Page(
        "NC169", "The first move is a curve",
        "An arc, ellipse, parabola or spline before any G0, G1 or G92.\n"
        "Its start is wherever the machine stands, by default 0; its shape depends on it.",
        "% a\nN10 G2 X10 Y0 I5 J0 F20",
        "% a\nN10 G0 X0 Y0\nN20 G2 X10 Y0 I5 J0 F20",
    ),
    Page(
        "NC170", "Only one of acceleration and deceleration is programmed",
        "E above 0 and none below 0 in the whole program, or the other way round.\n"
        "E with a positive value sets the acceleration only (SoftMotion §3.2); the deceleration stays that of the\n"
        "machine.",
        "% a\nN10 G1 X10 F20 E500",
        "% a\nN10 G1 X10 F20 E500 E-500",
    ),
    Page(
        "NC171", "F beside G0 on a machine with rapids",
        "F in a block with G0, if the machine file gives its axes a rapid velocity.\n"
        "The positioning runs at the rapid velocity, and F holds from the next feed move on; a reader thinks the\n"
        "positioning is meant.",
        "% a\nN10 G0 X10 F20\nN20 G1 X20",
        "% a\nN10 G0 X10\nN20 G1 X20 F20",
    ),
    Page(
        "NC172", "An M function that nothing acknowledges",
        "An M function that the setting `acknowledged-m` does not list; without the setting there is no finding.\n"
        "The path waits at an M function until the machine acknowledges it (SoftMotion §3.2.2). One that no part of\n"
        "the control program answers stops the job for good.\n"
        "The example below gives it with this in the settings, below [lint]: acknowledged-m = [3, 5]",
        "% a\nN10 G0 X1\nN20 M8",
        "% a\nN10 G0 X1\nN20 M3",
    ),
    Page(
        "NC251", "A feed move of no length",
        "G1 or G5 that ends where it starts; not after G92, where it gives the position out (SoftMotion §3.2).\n"
        "It moves nothing. A point that stands twice comes from rounding in the CAM system, or one of its\n"
        "coordinates was meant to differ.",
        "% a\nN10 G1 X5 F20\nN20 G1 X5",
        "% a\nN10 G1 X5 F20\nN20 G1 X6",
    ),
    Page(
        "NC252", "An arc with a tiny radius",
        "A radius below `min-radius` (0.005 mm).\n"
        "It is rounding of the CAM system, not a contour; on it the feed falls to almost 0.",
        "% a\nN10 G0 X0 Y0\nN20 G3 X0.002 Y0 R0.001 F20",
        "% a\nN10 G0 X0 Y0\nN20 G3 X2 Y0 R1 F20",
    ),
    Page(
        "NC253", "An arc of nearly 0 or nearly 360 degrees",
        "A sweep that differs from a full turn by less than 0.1 degrees without being one, or is as small on a\n"
        "circle that large.\n"
        "A rounded coordinate decides whether it is a full circle or nothing at all.",
        "% a\nN10 G0 X0 Y0\nN20 G3 X0 Y-0.001 I-10 J0 F20",
        "% a\nN10 G0 X0 Y0\nN20 G3 X0 Y0 I-10 J0 F20",
    ),
    Page(
        "NC254", "Tiny segments",
        "Runs of feed moves shorter than `min-segment` (0.001 mm); one finding a run.\n"
        "A path of them is limited by cycle time and look-ahead, not by the feed; they are noise of the CAM\n"
        "system.",
        "% a\nN10 G1 X1 F20\nN20 G1 X1.0002\nN30 G1 X1.0004\nN40 G1 X9",
        "% a\nN10 G1 X1 F20\nN20 G1 X2\nN40 G1 X9",
    ),
    Page(
        "NC255", "A spline of a single point",
        "One G5 between positionings or at the ends of the path.\n"
        "A cardinal spline takes its tangents from its neighbours (SoftMotion §3.2.6); without any it is a line.",
        "% a\nN10 G0 X0 Y0\nN20 G5 X10 Y5 F20\nN30 G0 Z5",
        "% a\nN10 G0 X0 Y0\nN20 G5 X10 Y5 F20\nN25 G5 X20 Y0\nN30 G0 Z5",
    ),
    Page(
        "NC256", "An arc by radius that is almost a semicircle",
        "An arc with R and a sweep above 178 degrees, short of a semicircle.\n"
        "Near 180 degrees the last digit of R moves the centre a long way; arcs above 180 degrees cannot be\n"
        "programmed with R at all (SoftMotion §3.2.4).",
        "% a\nN10 G0 X0 Y0\nN20 G3 X10 Y0 R5.0001 F20",
        "% a\nN10 G0 X0 Y0\nN20 G3 X10 Y0 I5 J0 F20",
    ),
    Page(
        "NC351", "Tool radius correction starts or ends on a curve",
        "G41, G42 or G40 next to an arc, ellipse, parabola or spline.\n"
        "The correction is built up on the first path object and taken back on the last (SoftMotion §6.2.3); that\n"
        "needs a line, on a curve the tool cuts into the contour.",
        "% a\nN10 G0 X0 Y0\nN20 G41 D1\nN30 G3 X10 Y0 R5 F20\nN40 G1 X20\nN50 G40",
        "% a\nN10 G0 X0 Y0\nN20 G41 D1\nN30 G1 X5 Y0 F20\nN40 G3 X15 Y0 R5\nN45 G1 X25\nN50 G40",
    ),
    Page(
        "NC352", "Positioning while a correction is on",
        "G0 between G41 or G42 and G40.\n"
        "The corrected path then holds a positioning through the contour; the correction is to be ended first.",
        "% a\nN10 G41 D1\nN20 G1 X10 F20\nN30 G0 X20\nN40 G1 X30\nN50 G40",
        "% a\nN10 G41 D1\nN20 G1 X10 F20\nN30 G40\nN40 G0 X20",
    ),
    Page(
        "NC353", "Tool radius correction together with rounding or smoothing",
        "A path object for which G41 or G42 is on together with G51 or G52.\n"
        "SoftMotion's preprocessing does not allow both at once (§3.6); D would be tool radius and rounding\n"
        "distance at the same time.",
        "% a\nN10 G41 D1\nN20 G51\nN30 G1 X10 F20\nN40 G1 Y10\nN50 G50\nN60 G40",
        "% a\nN20 G51 D1\nN30 G1 X10 F20\nN40 G1 Y10\nN50 G50",
    ),
    Page(
        "NC354", "D changes while a correction is on",
        "Another D between the start and the end of tool radius correction.\n"
        "The distance to the contour jumps in the middle of the contour.",
        "% a\nN10 G41 D3\nN20 G1 X10 F20\nN30 G1 X20 D2\nN40 G40",
        "% a\nN10 G41 D3\nN20 G1 X10 F20\nN30 G1 X20\nN40 G40 D2",
    ),
    Page(
        "NC355", "Loop avoidance around a positioning",
        "G0 between G61 and G60.\n"
        "The path is cut where it crosses itself (SoftMotion §6.2.4); moves in the air may be cut together with\n"
        "the contour.",
        "% a\nN10 G61\nN20 G1 X10 F20\nN30 G0 X20\nN40 G1 X30\nN50 G60",
        "% a\nN10 G61\nN20 G1 X10 F20\nN30 G1 X20\nN50 G60",
    ),
    Page(
        "NC451", "The feed is more than the machine's axes can do",
        "A programmed feed for which an axis would have to move faster than its `velocity`; one finding a\n"
        "program.\n"
        "The path runs slower than programmed; often F was meant in mm/min.",
        "% a\nN10 G1 X100 F5000",
        "% a\nN10 G1 X100 F50",
    ),
    Page(
        "NC452", "The acceleration is more than the machine's axes can do",
        "E above the greatest acceleration of all axes together.\n"
        "No move of the program can reach it; the machine's values hold.",
        "% a\nN10 G1 X100 F50 E90000 E-500",
        "% a\nN10 G1 X100 F50 E900 E-500",
    ),
    Page(
        "NC551", "A single kink in a smooth contour",
        "A bend above the machine's angle tolerance, at most 60 degrees, between two bends on each side of less\n"
        "than 5 degrees.\n"
        "The path stops there (SoftMotion §3.2), which leaves a mark in a contour that is smooth otherwise. It may\n"
        "be an edge of the workpiece, the joint of two curves in the drawing, or a misplaced point.",
        "% a\nN10 G1 X1 F20\nN20 G1 X2\nN30 G1 X3\nN40 G1 X4 Y0.5\nN50 G1 X5 Y1\nN60 G1 X6 Y1.5",
        "% a\nN10 G1 X1 F20\nN20 G1 X2\nN30 G1 X3 Y0.1\nN40 G1 X4 Y0.3\nN50 G1 X5 Y0.6\nN60 G1 X6 Y1",
    ),
)
