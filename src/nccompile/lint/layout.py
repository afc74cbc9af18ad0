"""How a block is laid out: upper-case letters, one blank between words, none at the ends.

    n10g01x1  y2(rough)      becomes      N10 G01 X1 Y2 (rough)

Numbers, names of variables and comments stay as they were written.
"""

from __future__ import annotations

from nccompile.parser import Block

__all__ = ["laid_out"]


def laid_out(block: Block, *, keep_case: bool = False) -> str:
    """The text of a sound block; with `keep_case` its letters stay small where they are."""
    words = block.words if block.number is None else (block.number, *block.words)
    parts = [(word.column, word.text if keep_case else word.letter + word.text[1:]) for word in words]
    parts += [(comment.column, f"({comment.text})") for comment in block.comments]
    text = " ".join(part for _, part in sorted(parts))
    return f"/{text}" if block.skip else text
