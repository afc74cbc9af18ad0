"""NC4xx: machine limits and travel."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

PAGES: tuple[Page, ...] = (
    Page(
        "NC401",
        "an axis that the machine does not have",
        "The program moves an axis for which the machine file has no section [axes.<letter>], so there is no "
        "drive that could follow and no limit that could be planned for. Choose the file of the machine that "
        "has the axis, add the section, or leave the axis out of the program. An axis that is only named and "
        "never leaves its start position is accepted.",
    ),
    Page(
        "NC402",
        "an axis leaves its travel",
        "Axis position (path coordinate plus the offset of [kinematics]) goes below `min` or above `max` of "
        "the axis. The whole course of arcs, ellipses and splines counts, not only their ends: an arc can "
        "bulge out of the travel between two allowed points. Move the workpiece by [kinematics] offset, or "
        "correct the block. Each time an axis leaves its travel one finding is given, where it leaves.",
    ),
)
