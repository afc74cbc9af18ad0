"""Mathematics of arcs, ellipses, parabolas and splines; `tolerance` holds every epsilon.  No CNC words.

Each maker returns a `Curve` (a kind and a row for the kernels) or raises `Impossible` with one sentence.
"""

from nccompile.geometry.arcs import arc_by_center, arc_by_radius
from nccompile.geometry.curve import Curve, Impossible
from nccompile.geometry.ellipses import ellipse_by_center
from nccompile.geometry.parabolas import parabola_by_tangents
from nccompile.geometry.splines import cardinal_spline

__all__ = [
    "Curve",
    "Impossible",
    "arc_by_center",
    "arc_by_radius",
    "cardinal_spline",
    "ellipse_by_center",
    "parabola_by_tangents",
]
