"""NC551 single-kink."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program
from nccompile.lint.shapes import bends

__all__ = ["SingleKink"]

SMOOTH = 5.0
"""Bend of a smooth contour [deg]."""
MOST = 60.0
"""Bend from which it is a corner that is meant [deg]."""


class SingleKink(Rule):
    r"""A single kink in a smooth contour.

    What: a bend above the machine's angle tolerance, at most 60 degrees, between two bends on each side of less
    than 5 degrees.
    Why: the path stops there (SoftMotion §3.2), which leaves a mark in a contour that is smooth otherwise. It may
    be an edge of the workpiece, the joint of two curves in the drawing, or a misplaced point.
    NC551: % a\nN10 G1 X1 F20\nN20 G1 X2\nN30 G1 X3\nN40 G1 X4 Y0.5\nN50 G1 X5 Y1\nN60 G1 X6 Y1.5
    Okay: % a\nN10 G1 X1 F20\nN20 G1 X2\nN30 G1 X3 Y0.1\nN40 G1 X4 Y0.3\nN50 G1 X5 Y0.6\nN60 G1 X6 Y1
    """

    code = "NC551"
    name = "single-kink"
    severity = Severity.NOTE
    needs_path = True

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks for one large bend among small ones."""
        bend, straight = bends(program.path)
        if len(bend) < 5:
            return
        tolerance = program.machine.path.angle_tolerance
        smooth = straight & (bend < SMOOTH)
        around = smooth[:-4] & smooth[1:-3] & smooth[3:-1] & smooth[4:]
        here = bend[2:-2]
        kink = around & straight[2:-2] & (here > tolerance) & (here <= MOST)
        for at in np.flatnonzero(kink):
            row = int(at) + 3  # bend i lies at the start of segment i + 1
            yield Finding(
                program.source.text_span(int(program.path.line[row])),
                f"the path stops here: a single bend of {here[at]:.3g} degrees in a smooth contour",
                "check the point; G51, or a larger angle tolerance, keeps the path moving",
            )  # fmt: skip
