"""NC052 block-number-twice."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.lint.base import Finding, Fix, Rule
from nccompile.lint.numbering import numbering_fix
from nccompile.lint.program import Program

__all__ = ["BlockNumberTwice"]


class BlockNumberTwice(Rule):
    r"""Two blocks have the same block number.

    What: a block number that stood before.
    Why: a jump to it cannot be executed, and messages that name the block mean two places.
    NC052: % a\nN10 G1 X1 F20\nN10 G1 X2
    Okay: % a\nN10 G1 X1 F20\nN20 G1 X2
    Fix: numbers all blocks anew, if no jump leads to the number; other jumps follow their targets.
    """

    code = "NC052"
    name = "block-number-twice"

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks at numbers with more than one block."""
        values = [block.number.value for block in program.blocks if block.number is not None]
        if len(set(values)) == len(values):
            return
        for number, places in program.numbers.items():
            line = program.blocks[places[0]].line
            for at in places[1:]:
                word = program.blocks[at].number
                if word is not None:
                    yield Finding(
                        word.span, f"N{number} is also the number of line {line}",
                        "`nccompile fmt --renumber` gives every block its own",
                    )  # fmt: skip

    def fix_all(self, program: Program) -> Fix | None:
        """New numbers."""
        return numbering_fix(program)
