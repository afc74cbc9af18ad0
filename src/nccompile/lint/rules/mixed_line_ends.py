"""NC058 mixed-line-ends."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program
from nccompile.source import Span

__all__ = ["MixedLineEnds"]


class MixedLineEnds(Rule):
    r"""Lines end in different ways.

    What: some lines end with CR LF, others with LF or CR alone.
    Why: it happens when files are joined; line numbers then differ between editors, controls and this compiler.
    NC058: % a\r\nN10 G1 X1 F20\nN20 G1 X2\r\n
    Okay: % a\nN10 G1 X1 F20\nN20 G1 X2\n
    """

    code = "NC058"
    name = "mixed-line-ends"

    def check(self, program: Program) -> Iterator[Finding]:
        """Counts the kinds of line ends."""
        text = program.source.text
        both = text.count("\r\n")
        kinds = {"CR LF": both, "LF": text.count("\n") - both, "CR": text.count("\r") - both}
        found = {kind: count for kind, count in kinds.items() if count}
        if len(found) > 1:
            shown = ", ".join(f"{count} with {kind}" for kind, count in found.items())
            yield Finding(
                Span(1, 1, 2), f"line ends are mixed: {shown}", "`nccompile fmt` makes them all alike"
            )
