"""NC170 acceleration-without-deceleration."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["AccelerationWithoutDeceleration"]


class AccelerationWithoutDeceleration(Rule):
    r"""Only one of acceleration and deceleration is programmed.

    What: E above 0 and none below 0 in the whole program, or the other way round.
    Why: E with a positive value sets the acceleration only (SoftMotion §3.2); the deceleration stays that of the
    machine.
    NC170: % a\nN10 G1 X10 F20 E500
    Okay: % a\nN10 G1 X10 F20 E500 E-500
    """

    code = "NC170"
    name = "acceleration-without-deceleration"
    severity = Severity.NOTE

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at the signs of all E words."""
        words = [word for _, word in program.words("E")]
        values = [word.value for word in words if isinstance(word.value, float)]
        if not values or len(values) < len(words):
            return
        if all(value > 0 for value in values) or all(value < 0 for value in values):
            missing, set_ = (
                ("deceleration", "acceleration") if values[0] > 0 else ("acceleration", "deceleration")
            )
            sign = "-" if values[0] > 0 else ""
            yield Finding(
                words[0].span, f"E sets the {set_} only; the {missing} is that of the machine",
                f"add E{sign}{abs(values[0]):g}",
            )  # fmt: skip
