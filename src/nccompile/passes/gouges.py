"""Gouges: places where the tool's centre path is nearer to the contour than the tool's radius.

contour ──┐   ┌──          The corrected path is sampled, every sample looks for the contour through a tree
          │ o │            of boxes.  depth = r - distance: how far the tool cuts into the contour.
          └───┘            One finding for each source line, at its deepest place.
"""

from __future__ import annotations

from math import ceil

import numpy as np

from nccompile.diagnostics import Severity
from nccompile.geometry.offset import Piece
from nccompile.kernels import curves as curve_kernels
from nccompile.kernels import intersect as kernels
from nccompile.kernels.curves import ARC
from nccompile.passes.base import Context, Flags
from nccompile.passes.correction import Corrected
from nccompile.toolpath.columns import Floats

__all__ = ["check_gouges", "sample_piece"]

_DEEP = 1e-6
"""[mm] A path this much too near is rounding."""

_FREE = 2.5
"""Part of the tolerance by which the offset of an ellipse or spline may be too near."""

_MOST = 128
_LEAST = 8


def check_gouges(contour: Corrected, is_error: bool, loops_cut: Flags, context: Context) -> None:
    """Reports NC302 where the written path of a contour is nearer to it than the tool's radius.

    loops_cut: Shape (n,), rows where loop avoidance is on: there it is a warning.
    """
    rows = contour.rows
    if not contour.written or not rows:
        return
    kinds = np.array([row.kind for row in rows], np.uint8)
    curves = np.array([row.curve for row in rows])
    # Rows with extent in X-Y follow each other, for the others do not move there.
    points = np.array([rows[0].a] + [row.b for row in rows])
    size = 1
    while size < len(kinds):
        size *= 2
    tree = np.empty((2 * size, 4))
    m = kernels.box_tree(kinds, curves, points, tree)
    radius = {row.i: abs(row.d) for row in rows}
    free = any(row.kind > ARC for row in rows)
    allowed = _DEEP + (_FREE * contour.style.tolerance if free else 0.0) + 1e-12 * float(np.abs(points).max())
    worst: dict[int, tuple[float, Floats]] = {}
    for i, piece in contour.written:
        r = radius[i]
        sample = sample_piece(piece, r)
        near = np.empty(len(sample))
        kernels.distance_within(kinds, curves, points, tree, m, sample, r, near)
        at = int(np.argmin(near))
        depth = r - float(near[at])
        line = int(contour.draft.source.line[i])
        if depth > allowed and depth > worst.get(line, (0.0, sample[0]))[0]:
            worst[line] = depth, sample[at]
            if loops_cut[i]:
                context.report.counts["gouges left to avoid-loops"] += 1
    loops = {int(contour.draft.source.line[i]) for i, _ in contour.written if loops_cut[i]}
    for line, (depth, place) in sorted(worst.items()):
        severity = Severity.ERROR if is_error and line not in loops else Severity.WARNING
        context.find(
            "NC302", severity,
            f"the tool would cut {depth:.4g} mm into the contour at X{place[0]:.4g} Y{place[1]:.4g}",
            line, "use a smaller tool, or cut such places out with G61 and avoid-loops",
        )  # fmt: skip


def sample_piece(piece: Piece, r: float) -> Floats:
    """Points along a piece, at most r / 4 apart where that takes no more than 128. Shape (s, 2)."""
    if piece.kind < ARC:
        step = piece.b - piece.a
        count = min(max(ceil(4.0 * float(np.sqrt(step @ step)) / r), _LEAST), _MOST)
        return np.asarray(piece.a + np.linspace(0.0, 1.0, count + 1)[:, None] * step)
    length = curve_kernels.in_plane_length(piece.kind, piece.row)
    count = min(max(ceil(4.0 * length / r), _LEAST), _MOST)
    return np.array([curve_kernels.point(piece.kind, piece.row, u / count) for u in range(count + 1)])
