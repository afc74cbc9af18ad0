"""NC251 zero-length-move."""

from __future__ import annotations

from collections.abc import Iterator

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program
from nccompile.lint.shapes import lines_of
from nccompile.toolpath.columns import Kind

__all__ = ["ZeroLengthMove"]


class ZeroLengthMove(Rule):
    r"""A feed move of no length.

    What: G1 or G5 that ends where it starts; not after G92, where it gives the position out (SoftMotion §3.2).
    Why: it moves nothing. A point that stands twice comes from rounding in the CAM system, or one of its
    coordinates was meant to differ.
    NC251: % a\nN10 G1 X5 F20\nN20 G1 X5
    Okay: % a\nN10 G1 X5 F20\nN20 G1 X6
    Okay: % a\nN10 G1 X5 F20\nN20 G2 X5 R3
    """

    code = "NC251"
    name = "zero-length-move"
    severity = Severity.NOTE
    needs_path = True

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks for lines of length 0 without events."""
        path = program.path
        flags = (path.kind == Kind.LINE) & (path.length == 0.0)
        flags[1:] &= path.kind[:-1] != Kind.SET_POSITION
        flags[path.events.segment] = False
        if len(flags):
            flags[0] = False  # gives the start position out
        if not flags.any():
            return
        moves = {block.line: move for block, move in zip(program.blocks, program.moves, strict=True)}
        for line in lines_of(path, flags):
            if moves[line] in {1, 5}:  # a curve that became a line has its own finding, which says why
                yield Finding(
                    program.source.text_span(line), "this move ends where it starts", "remove the block"
                )
