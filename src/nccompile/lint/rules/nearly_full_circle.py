"""NC253 nearly-full-circle."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program
from nccompile.lint.shapes import ARC_SWEEP, arcs

__all__ = ["NearlyFullCircle"]

NEAR = 0.1
"""Difference to a full turn that is suspicious [deg]."""


class NearlyFullCircle(Rule):
    r"""An arc of nearly 0 or nearly 360 degrees.

    What: a sweep that differs from a full turn by less than 0.1 degrees without being one, or is as small on a
    circle that large.
    Why: a rounded coordinate decides whether it is a full circle or nothing at all.
    NC253: % a\nN10 G0 X0 Y0\nN20 G3 X0 Y-0.001 I-10 J0 F20
    Okay: % a\nN10 G0 X0 Y0\nN20 G3 X0 Y0 I-10 J0 F20
    """

    code = "NC253"
    name = "nearly-full-circle"
    needs_path = True

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the sweep of arcs."""
        rows, sweep = arcs(program.path, ARC_SWEEP)
        turn = np.abs(np.degrees(sweep))
        risky = (turn > 360.0 - NEAR) & (turn < 360.0 - 1e-9)
        for row, angle in zip(rows[risky], turn[risky], strict=True):
            span = program.source.text_span(int(program.path.line[row]))
            yield Finding(
                span, f"this arc turns by {angle:.5g} degrees, almost a full circle",
                "for a full circle end exactly at the start",
            )  # fmt: skip
