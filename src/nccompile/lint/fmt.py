"""The formatter: one layout for every block, and new block numbers if asked.

    n10g1x5  y2           N10 G1 X5 Y2
    g20 L10 k$n$          N20 G20 L10 K$n$        (--renumber; L follows its block)

The toolpath stays the same.  Lines that cannot be read, and those behind a second %, stay as they are.
"""

from __future__ import annotations

from collections import defaultdict

from nccompile.diagnostics import Diagnostics
from nccompile.errors import UsageError
from nccompile.lint.layout import laid_out
from nccompile.lint.rewrite import split_lines
from nccompile.parser import Block, Word, parse, read_header
from nccompile.source import Source

__all__ = ["format_text", "renumbered"]


def format_text(source: Source) -> str:
    """The program laid out; empty lines at the end go, the last line gets an end, line ends become alike."""
    lines = split_lines(source.text)
    ends = [end for _, end in lines]
    end = max(("\n", "\r\n", "\r"), key=ends.count)
    texts = [text for text, _ in lines]
    for block in parse(source, Diagnostics()):
        if block.sound:
            texts[block.line - 1] = laid_out(block)
    header = read_header(source)
    if header is not None:
        texts[header.line - 1] = texts[header.line - 1].strip()
    texts = ["" if not text.strip(" \t\v\f") else text for text in texts]
    while texts and texts[-1] == "":
        texts.pop()
    return "".join(text + end for text in texts)


def renumbered(source: Source, step: int) -> Source:
    """The program with the block numbers `step`, 2 `step`, ...; jumps lead to the same blocks.

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
    lines = split_lines(source.text)
    for at, block in enumerate(blocks):
        text, end = lines[block.line - 1]
        target = _target(block)
        if target is not None:
            number = f"L{_new_number(source, block, target, places, step)}"
            text = _replaced(text, target, number)
        new = f"N{(at + 1) * step}"
        lines[block.line - 1] = (_numbered(text, block, new), end)
    return Source(source.name, "".join(text + end for text, end in lines), source.sha256)


def _target(block: Block) -> Word | None:
    """The word with the target of a jump; None if the block is no jump."""
    if not any(word.letter == "G" and word.value == 20.0 for word in block.words):
        return None
    return next((word for word in block.words if word.letter == "L"), None)


def _new_number(source: Source, block: Block, target: Word, places: dict[int, list[int]], step: int) -> int:
    found = places.get(int(target.value), []) if isinstance(target.value, float) else []
    if len(found) != 1:
        why = "is a variable" if not isinstance(target.value, float) else "is missing or there twice"
        raise UsageError(
            f"{source.name}:{block.line}: the target {target.text} of this jump {why}, so the blocks cannot be numbered"
        )
    return (found[0] + 1) * step


def _replaced(text: str, word: Word, new: str) -> str:
    return text[: word.column - 1] + new + text[word.column - 1 + len(word.text) :]


def _numbered(text: str, block: Block, new: str) -> str:
    """The line with a new block number."""
    if block.number is not None:
        return _replaced(text, block.number, new)
    at = block.words[0].column - 1
    comments = [c for c in block.comments if c.column - 1 < at]
    if comments:
        at = comments[0].column - 1
    return f"{text[:at]}{new} {text[at:]}"
