"""NC165 no-radius."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program, first

__all__ = ["NoRadius"]


class NoRadius(Rule):
    r"""Correction, smoothing or rounding without D.

    What: G41, G42, G51 or G52 where no D above 0 is in force.
    Why: the radius is 0, so the function changes nothing (SoftMotion §6.2.3, §6.2.5, §6.2.6).
    NC165: % a\nN10 G41\nN20 G1 X10 F20\nN30 G40
    Okay: % a\nN10 G41 D3\nN20 G1 X10 F20\nN30 G40
    """

    code = "NC165"
    name = "no-radius"

    def check(self, program: Program) -> Iterator[Finding]:
        """Follows D through the blocks in written order."""
        starts = dict(program.instructions(41, 42, 51, 52))
        if program.jumps or not starts:
            return
        radius, known = 0.0, True
        for at, block in enumerate(program.blocks):
            word = first(block, "D")
            if word is not None and program.codes[at] not in {36, 37}:
                known = isinstance(word.value, float) and not block.skip
                radius = word.value if isinstance(word.value, float) else 0.0
            known = known and block.sound
            if at in starts and known and radius == 0.0:
                yield Finding(
                    block.span, f"G{starts[at]} acts with radius 0: no D has been programmed",
                    f"write G{starts[at]} D3 for a radius of 3 mm",
                )  # fmt: skip
