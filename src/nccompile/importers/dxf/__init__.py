"""DXF drawings become toolpaths (SoftMotion §3.3, "Import DXF file").

The stages, each a module, in running order:

    read       file -> entities of the model space, units, layers that are shown
    entities   one entity -> pieces (lines, arcs, ellipses, cubics, points); `blocks` places INSERTs
    clean      doubles and overlapping lines removed
    join       pieces -> paths whose pieces follow each other; gaps closed and left open are reported
    arcs       cubics -> lines and arcs within the tolerance, where the output has no cubics
    nest       which contour lies inside which
    order      inner before outer, short rapids, start points
    machining  the job's operations (sides, leads, depths, tabs) -> toolpath

Positions are complex numbers x + iy [mm] all through this package: turning, scaling and mirroring are then
one multiplication.
"""
