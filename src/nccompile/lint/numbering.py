"""New block numbers for a whole program, as edits: `step`, 2 `step`, ...; jumps follow their targets."""

from __future__ import annotations

from collections import defaultdict

from nccompile.diagnostics import Diagnostics
from nccompile.errors import UsageError
from nccompile.lint.base import Edit, Fix
from nccompile.lint.flow import is_jump
from nccompile.lint.program import Program, first
from nccompile.parser import Block, Word, parse
from nccompile.source import Source

__all__ = ["numbering", "numbering_fix"]


def numbering(source: Source, step: int) -> list[Edit]:
    """The edits that number the blocks anew; none where a number is right already.

    Raises:   UsageError: lines that cannot be read, or a jump whose target is a variable, missing or double.
    """
    diagnostics = Diagnostics()
    blocks = [block for block in parse(source, diagnostics) if block.words or block.number]
    if diagnostics.errors:
        line = next(d.span.line for d in diagnostics if d.severity == "error")
        raise UsageError(f"{source.name}:{line}: cannot be read, so the blocks cannot be numbered")
    places: dict[int, list[int]] = defaultdict(list)
    for at, block in enumerate(blocks):
        if block.number is not None and isinstance(block.number.value, float):
            places[int(block.number.value)].append(at)
    edits = []
    for at, block in enumerate(blocks):
        target = _target(block)
        if target is not None:
            new = f"L{_new_number(source, block, target, places, step)}"
            edits += [Edit.of(target.span, new)] * (target.text != new)
        edits += _numbered(block, f"N{(at + 1) * step}")
    return edits


def numbering_fix(program: Program) -> Fix | None:
    """The fix that numbers the blocks of a program anew; None if that cannot be done."""
    try:
        edits = numbering(program.source, program.config.step)
    except UsageError:
        return None
    return Fix("Number the blocks anew", tuple(edits))


def _target(block: Block) -> Word | None:
    """The word with the target of a jump; None if the block is no jump."""
    return first(block, "L") if is_jump(block) else None


def _new_number(source: Source, block: Block, target: Word, places: dict[int, list[int]], step: int) -> int:
    found = places.get(int(target.value), []) if isinstance(target.value, float) else []
    if len(found) != 1:
        why = "is a variable" if not isinstance(target.value, float) else "is missing or there twice"
        raise UsageError(
            f"{source.name}:{block.line}: the target {target.text} of this jump {why}, so the blocks cannot be numbered"
        )
    return (found[0] + 1) * step


def _numbered(block: Block, new: str) -> list[Edit]:
    """Gives a block its number; the new one stands before the first word or comment."""
    if block.number is not None:
        return [Edit.of(block.number.span, new)] * (block.number.text != new)
    column = min([block.words[0].column, *(comment.column for comment in block.comments)])
    return [Edit(block.line, column, column, f"{new} ")]
