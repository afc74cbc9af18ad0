"""NC5xx: feeds, accelerations and velocity planning."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

PAGES: tuple[Page, ...] = (
    Page(
        "NC501",
        "planned beyond the machine's limits",
        "The planner `softmotion` follows the manual's rules exactly: the program's F and E, the angle tolerance "
        "and the lower of both feeds at a junction. It does not know what the axes can do, so a segment can ask "
        "for more velocity or acceleration, or a bend for a greater velocity step, than the machine file allows; "
        "a drive would fault there. Lower F or E, make the angle tolerance smaller, or use the planner "
        "`look-ahead`, which keeps every limit of the machine file.",
    ),
)
