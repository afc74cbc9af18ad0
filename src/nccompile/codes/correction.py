"""NC3xx: tool radius correction, rounding, smoothing and loop avoidance."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

PAGES: tuple[Page, ...] = (
    Page(
        "NC301",
        "no pass acts on a mark",
        "G41 and G42 (tool radius), G51 and G52 (smoothing, rounding) and G61 (loop avoidance) are read, checked "
        "and kept as marks of the toolpath, but this version has no pass that carries them out: the path runs as "
        "programmed. With G41 or G42 this is the contour itself, not the path of the tool's centre. Program the "
        "centre path, or have the CAM system correct it.",
        "% a\nN10 G41 D3\nN20 G1 X10 F20\nN30 G40",
        "% a\nN20 G1 X10 Y3 F20",
    ),
)
