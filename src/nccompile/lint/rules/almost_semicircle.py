"""NC256 almost-semicircle."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program, first
from nccompile.lint.shapes import ARC_SWEEP, arcs

__all__ = ["AlmostSemicircle"]

LEAST = 178.0
"""Sweep from which R says little about the centre [deg]: 0.01 % of R move it by 2 % of R."""


class AlmostSemicircle(Rule):
    r"""An arc by radius that is almost a semicircle.

    What: an arc with R and a sweep above 178 degrees, short of a semicircle.
    Why: near 180 degrees the last digit of R moves the centre a long way; arcs above 180 degrees cannot be
    programmed with R at all (SoftMotion §3.2.4).
    NC256: % a\nN10 G0 X0 Y0\nN20 G3 X10 Y0 R5.0001 F20
    Okay: % a\nN10 G0 X0 Y0\nN20 G3 X10 Y0 I5 J0 F20
    """

    code = "NC256"
    name = "almost-semicircle"
    severity = Severity.NOTE
    needs_path = True

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the sweep of arcs whose block has R."""
        rows, sweep = arcs(program.path, ARC_SWEEP)
        turn = np.abs(np.degrees(sweep))
        close = (turn > LEAST) & (turn < 180.0 - 1e-6)
        for row, angle in zip(rows[close], turn[close], strict=True):
            block = program.by_line.get(int(program.path.line[row]))
            word = None if block is None else first(block, "R")
            if word is not None and block is not None and first(block, "I") is first(block, "J"):
                yield Finding(
                    word.span, f"R leaves the centre uncertain: the arc turns by {angle:.6g} degrees",
                    "program the centre with I and J",
                )  # fmt: skip
