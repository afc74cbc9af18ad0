"""NC2xx: geometry that cannot be or was replaced."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

PAGES: tuple[Page, ...] = (
    Page(
        "NC201",
        "impossible arc",
        "The centre is not equally far from start and end, the radius is smaller than half their distance, or the\n"
        "block has neither. The arc becomes a line (SoftMotion §3.2.4). Arcs over 180 degrees need I and J.",
        "% a\nN10 G2 X10 Y0 R3 F20",
        "% a\nN10 G2 X10 Y0 R5 F20",
    ),
    Page(
        "NC202",
        "impossible ellipse",
        "Start and end do not lie on one ellipse with this centre (I, J), main axis (K, degrees) and ratio of the\n"
        "axes (R, above 0 and at most 1). The ellipse becomes a line (SoftMotion §3.2.5).",
        "% a\nN10 G8 X10 Y0 I3 J0 K0 R0.5 F20",
        "% a\nN10 G8 X10 Y0 I5 J0 K0 R0.5 F20",
    ),
    Page(
        "NC203",
        "impossible parabola",
        "I and J are the point where the tangents at start and end meet. The block has none, or start and end are\n"
        "one point. The parabola becomes a line.",
        "% a\nN10 G6 X10 Y0 F20",
        "% a\nN10 G6 X10 Y0 I5 J5 F20",
    ),
)
