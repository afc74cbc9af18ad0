"""NC6xx: drawings that become programs."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

PAGES: tuple[Page, ...] = (
    Page(
        "NC601",
        "not a drawing that can be read",
        "The file is empty, is no DXF drawing, or is damaged beyond recovery. DWG files must be saved as DXF "
        "first. Nothing is written.",
    ),
    Page(
        "NC602",
        "damaged drawing recovered",
        "The drawing broke the rules of DXF and was read in recover mode; each repair is listed. What could not "
        "be read is missing from the program, so compare the preview with the drawing.",
    ),
    Page(
        "NC603",
        "drawing without a unit",
        "The header names no unit ($INSUNITS is missing or 0), as in every R12 drawing. On a terminal "
        "import-dxf asks; otherwise the numbers are taken as millimetres. --units says what they are.",
    ),
    Page(
        "NC604",
        "nothing to machine",
        "Nothing is left of the drawing after what is hidden, three-dimensional or of no machinable kind has been "
        "left out. The findings beside this one say what that was. Nothing is written.",
    ),
    Page(
        "NC605",
        "entities left out",
        "Entities that are no flat curves are not machined: solids, dimensions, pictures, curves that leave the "
        "XY plane, and texts and hatches unless --text or --hatch asks for them.",
    ),
    Page(
        "NC606",
        "layer left out",
        "Layers that are off, frozen or not plotted, Defpoints, and the rapids of an exported toolpath are not "
        "machined. --layer names those that are to be, whatever their state.",
    ),
    Page(
        "NC607",
        "gap closed",
        "Two ends that belong to no other path were nearer to each other than the gap tolerance (--gap) and were "
        "made to meet half-way.",
    ),
    Page(
        "NC608",
        "gap left open",
        "Two ends lie near each other, yet farther than the gap tolerance (--gap). The path stays open there: it "
        "has no inside, and the tool lifts.",
    ),
    Page(
        "NC609",
        "drawn twice",
        "A curve lay on another one, along all or a part of its length. The stretch is machined once.",
    ),
    Page(
        "NC610",
        "contours that run along each other",
        "Two polylines share a stretch. Neither can give way without coming apart, so the stretch is machined "
        "twice.",
    ),
    Page(
        "NC611",
        "drawing far from the origin",
        "Coordinates above a kilometre are those of a map, not of a machine. --origin lower-left moves the drawing.",
    ),
    Page(
        "NC612",
        "paths that no operation takes",
        "The job file has no operation for a layer, a colour or a kind of path, so it is left out. An operation of "
        'kind = "ignore" says that this is meant.',
    ),
    Page(
        "NC613",
        "lead left out",
        "No lead-in or lead-out of the wanted shape, down to a sixteenth of its size and at no other vertex, "
        "stays clear of all contours. The contour is entered or left without one.",
    ),
    Page(
        "NC614",
        "open path without a side",
        "Inside and outside are sides of closed contours; the open path is machined on the line.",
    ),
    Page(
        "NC615",
        "tool too large for a contour",
        "No point of the contour's inside is as far from it as the tool's radius. The contour is left out.",
    ),
)
