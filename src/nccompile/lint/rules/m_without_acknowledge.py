"""NC172 m-without-acknowledge."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["MWithoutAcknowledge"]


class MWithoutAcknowledge(Rule):
    r"""An M function that nothing acknowledges.

    What: an M function that the setting `acknowledged-m` does not list; without the setting there is no finding.
    Why: the path waits at an M function until the machine acknowledges it (SoftMotion §3.2.2). One that no part of
    the control program answers stops the job for good.
    Settings: acknowledged-m = [3, 5]
    NC172: % a\nN10 G0 X1\nN20 M8
    Okay: % a\nN10 G0 X1\nN20 M3
    """

    code = "NC172"
    name = "m-without-acknowledge"

    def check(self, program: Program) -> Iterator[Finding]:
        """Compares the numbers of M functions with the setting."""
        known = program.config.acknowledged_m
        if known is None:
            return
        for _, word in program.words("M"):
            if isinstance(word.value, float) and word.value not in known:
                yield Finding(
                    word.span, f"nothing acknowledges {word.text.upper()}: the path would wait here for ever",
                    "remove it, or add its number to acknowledged-m in the settings",
                )  # fmt: skip
