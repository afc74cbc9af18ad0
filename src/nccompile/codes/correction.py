"""NC3xx: tool radius correction, rounding, smoothing and loop avoidance."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

PAGES: tuple[Page, ...] = (
    Page(
        "NC301",
        "no pass acts on a mark",
        "G41 and G42 (tool radius), G51 and G52 (smoothing, rounding) and G61 (loop avoidance) are read, checked "
        "and kept as marks of the toolpath, but the pass that carries them out is not turned on: the path runs as "
        "programmed. With G41 or G42 this is the contour itself, not the path of the tool's centre. Turn the pass on "
        "with -p tool-radius, smooth-corners, round-corners or avoid-loops.",
        "% a\nN10 G41 D3\nN20 G1 X10 F20\nN30 G40",
        "% a\nN20 G1 X10 Y3 F20",
    ),
    Page(
        "NC302",
        "gouge",
        "The path of the tool's centre comes nearer to the contour than the tool's radius, so the tool would cut into "
        "it: a narrow slot, a concave arc or a step smaller than the tool. The message has the deepest place of the "
        "block and the depth. With G61 on, loop avoidance cuts such places out of the path, and the finding is a "
        "warning (SoftMotion §6.2.3, 6.2.4).",
        "% a\nN10 G41 D6\nN20 G1 X10 F20\nN30 G1 Y10\nN40 G1 X0\nN50 G40",
        "% a\nN10 G41 D2\nN20 G1 X10 F20\nN30 G1 Y10\nN40 G1 X0\nN50 G40",
    ),
    Page(
        "NC303",
        "correction in another plane",
        "Tool radius correction acts in X-Y. A curve in Z-X, Y-Z or in space has no offset there.",
    ),
    Page(
        "NC304",
        "correction together with rounding or smoothing",
        "The passes tool-radius and round-corners or smooth-corners are both turned on, and both would act on this "
        "stretch. D would be the tool's radius and the rounding at once, and the corners of the offset path would be "
        "cut, not those of the contour: SoftMotion allows one of them at a time (§3.6). Let one end with G40 or G50 "
        "before the other starts, or leave one pass out.",
        "% a\nN10 G41 D1\nN20 G51\nN30 G1 X10 F20\nN40 G1 Y10\nN50 G50\nN60 G40",
        "% a\nN10 G41 D1\nN20 G1 X10 F20\nN30 G1 Y10\nN40 G40\nN50 G51\nN60 G1 X20\nN70 G1 Y20\nN80 G50",
    ),
)
