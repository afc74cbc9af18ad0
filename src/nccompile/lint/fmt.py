"""The formatter: one layout for every block, and new block numbers if asked.

    n10g1x5  y2           N10 G1 X5 Y2
    g20 L10 k$n$          N20 G20 L10 K$n$        (--renumber; L follows its block)

The toolpath stays the same.  Lines that cannot be read, and those behind a second %, stay as they are.
"""

from __future__ import annotations

import re

from nccompile.diagnostics import Diagnostics
from nccompile.lint.layout import laid_out
from nccompile.lint.numbering import numbering
from nccompile.lint.rewrite import apply_edits, split_lines
from nccompile.parser import parse, read_header
from nccompile.source import Source

__all__ = ["format_text", "is_text", "renumbered"]

_END_MARK = re.compile(r"[\x00\x1a \r\n]*\x1a\Z")


def format_text(source: Source) -> str:
    """The program laid out; empty lines at the end go, the last line gets an end, line ends become alike.

    What is not text stays as it is, and so does an end-of-file mark (Ctrl-Z).
    """
    if not is_text(source):
        return source.text
    mark = _END_MARK.search(source.text)
    if mark is not None:
        source = Source(source.name, source.text[: mark.start()], source.sha256)
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
    return "".join(text + end for text in texts) + ("" if mark is None else "\x1a")


def is_text(source: Source) -> bool:
    """Whether a file can be a program at all; others must not be changed."""
    diagnostics = Diagnostics()
    next(parse(source, diagnostics), None)
    return not diagnostics.counts["NC010"]


def renumbered(source: Source, step: int) -> Source:
    """The program with the block numbers `step`, 2 `step`, ...; raises as `numbering` does."""
    return Source(source.name, apply_edits(source.text, numbering(source, step)), source.sha256)
