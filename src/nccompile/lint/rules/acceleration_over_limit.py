"""NC452 acceleration-over-limit."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["AccelerationOverLimit"]


class AccelerationOverLimit(Rule):
    r"""The acceleration is more than the machine's axes can do.

    What: E above the greatest acceleration of all axes together.
    Why: no move of the program can reach it; the machine's values hold.
    NC452: % a\nN10 G1 X100 F50 E90000 E-500
    Okay: % a\nN10 G1 X100 F50 E900 E-500
    """

    code = "NC452"
    name = "acceleration-over-limit"

    def check(self, program: Program) -> Iterator[Finding]:
        """Compares E with the norm of the axis limits."""
        known = [axis.acceleration for axis in program.machine.axes.values() if axis.kind == "linear"]
        most = sum(a * a for a in known) ** 0.5
        for _, word in program.words("E"):
            if isinstance(word.value, float) and known and abs(word.value) > most:
                yield Finding(
                    word.span, f"{word.text} is more than all axes of {program.machine.name} reach together",
                    f"their greatest common acceleration is {most:.4g} mm/s2",
                )  # fmt: skip
