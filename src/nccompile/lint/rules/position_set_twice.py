"""NC162 position-set-twice."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.decoder.tables import AXES
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program

__all__ = ["PositionSetTwice"]


class PositionSetTwice(Rule):
    r"""A position that is set and set again.

    What: G92 followed by G92 for the same axes without a move between them.
    Why: only the last of several counts; to give the first one out, put G1 with the same position between them
    (SoftMotion §3.2).
    NC162: % a\nN10 G92 X5\nN20 G92 X7\nN30 G1 X10 F20
    Okay: % a\nN10 G92 X5\nN15 G1 X5 F20\nN20 G92 X7\nN30 G1 X10
    """

    code = "NC162"
    name = "position-set-twice"

    def check(self, program: Program) -> Iterator[Finding]:
        """Compares each G92 with the next instruction."""
        if not any(program.instructions(92)):
            return
        open_at: int | None = None
        for at, block in enumerate(program.blocks):
            code = program.codes[at]
            if code == 92 and not block.skip:
                axes = {word[0] for word in block.words} & AXES
                if open_at is not None:
                    before = program.blocks[open_at]
                    if {word[0] for word in before.words} & AXES <= axes:
                        yield Finding(
                            before.span, f"G92 has no effect: line {block.line} sets the position again",
                            "remove it, or put G1 with the same position between them",
                        )  # fmt: skip
                open_at = at
            elif block.words or not block.sound or at in program.targets:
                open_at = None
