"""NC153 axis-word-without-motion."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.decoder.tables import AXES
from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Fix, Rule
from nccompile.lint.flow import without
from nccompile.lint.program import Program

__all__ = ["AxisWordWithoutMotion"]


class AxisWordWithoutMotion(Rule):
    r"""An axis word that repeats the position.

    What: a target that the axis has already, beside another axis word. Off by default, since many
    post-processors write all axes in all blocks.
    Why: the word says nothing new; without it the block shows what moves.
    NC153: % a\nN10 G1 X1 Y5 F20\nN20 G1 X2 Y5
    Okay: % a\nN10 G1 X1 Y5 F20\nN20 G1 X2
    Fix: removes the word, if the program has no jumps.
    """

    code = "NC153"
    name = "axis-word-without-motion"
    severity = Severity.NOTE
    default = False

    def check(self, program: Program) -> Iterator[Finding]:
        """Follows the axes through blocks of G0 and G1 with absolute targets."""
        if program.jumps or any(block.skip for block in program.blocks):
            return
        position: dict[str, float] = {}
        absolute = True
        for block, code, move in zip(program.blocks, program.codes, program.moves, strict=True):
            if code in {90, 91}:
                absolute = code == 90
            if code in {92, 91} or not block.sound:
                position.clear()
            if move is None or not absolute:
                continue
            axes = [word for word in block.words if word[0] in AXES]
            held = [word for word in axes if position.get(word.letter) == word.value]
            if move in {0, 1} and held and len(held) < len(axes) and len({w[0] for w in axes}) == len(axes):
                for word in held:
                    yield Finding(
                        word.span, f"{word.letter} is at {word.number} already", "remove the word",
                        Fix(f"Remove {word.text}", (without(program, word),)),
                    )  # fmt: skip
            for word in reversed(axes):
                if isinstance(word.value, float):
                    position[word.letter] = word.value
                else:
                    position.pop(word.letter, None)
