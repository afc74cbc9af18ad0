"""One line of text to its node: plain blocks at once, every other line by the grammar.

    N10 G1 X1.5 Y-2 F20      plain: numbers behind letters, one blank between words
    N10 G1 X1.5 (rough)      plain, with a comment at its end or nothing else
    N10 (rough) G1X$w$       by the grammar

Plain lines are nearly all of a large program.  They are a part of what the grammar reads, and their nodes are
the same; a property test holds that.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, TypeAlias

from nccompile.parser.faults import Fault, explain
from nccompile.parser.tree import Block, Comment, Header, Word
from nccompile.source import Source

__all__ = [
    "MAX_LINE",
    "Node",
    "ReadSource",
    "Unread",
    "commented_block",
    "placed",
    "placed_block",
    "plain_block",
    "plain_header",
    "read_by_grammar",
    "read_line",
]

MAX_LINE = 65_536
"""Longest line that is read, in characters; no program that a person or a post-processor wrote has one."""

_WORD = r"[A-MO-Za-mo-z][+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)"
_PLAIN_HEADER = re.compile(r"% ?([A-Za-z0-9_.-]*)")
_PLAIN = re.compile(rf"(?:[Nn][0-9]+|{_WORD})(?: {_WORD})*")
_COMMENTED = re.compile(rf"((?:{_PLAIN.pattern})?) *\(([^()]*)\)")
_NUMBER_FIRST = re.compile(r"[ \t/]*([Nn])([0-9]+)(?![0-9.])")


class Unread(NamedTuple):
    """A line that could not be read: why, and the block that stands for it."""

    fault: Fault
    block: Block


Node: TypeAlias = Block | Header | Unread | None
"""What a line is; None: it is empty."""


@dataclass(frozen=True)
class ReadSource(Source):
    """A source whose lines were read before; `nodes[i]` is `read_line(i + 1, lines[i])`."""

    nodes: Sequence[Node] = field(default=(), repr=False, compare=False)


def read_line(line: int, text: str) -> Node:
    """The node of one line."""
    if text[:1] == "%":
        return plain_header(line, text) or read_by_grammar(line, text)
    return plain_block(line, text) or commented_block(line, text) or read_by_grammar(line, text)


def plain_header(line: int, text: str) -> Header | None:
    """The header of a line such as `% bracket`; None for every other line."""
    found = _PLAIN_HEADER.fullmatch(text) if len(text) <= MAX_LINE else None
    return None if found is None else Header(found[1], line, 1, len(text.rstrip()) + 1)


def plain_block(line: int, text: str) -> Block | None:
    """The block of a plain line; None for every other line."""
    if len(text) > MAX_LINE or _PLAIN.fullmatch(text) is None:
        return None
    column = 1
    words: list[Word] = []
    upper = text.upper()  # once a line: a call a word costs a tenth more
    new = tuple.__new__  # a third of the time of the named constructor, and this is most of the work
    for part in text.split(" "):
        words.append(new(Word, (upper[column - 1], float(part[1:]), part, line, column)))
        column += len(part) + 1
    number = words.pop(0) if words[0][0] == "N" else None
    return Block(line, 1, column - 1, number, tuple(words))


def commented_block(line: int, text: str) -> Block | None:
    """The block of a plain line that ends with a comment, or of a comment alone; None for every other line."""
    found = _COMMENTED.fullmatch(text) if text[-1:] == ")" and len(text) <= MAX_LINE else None
    if found is None:
        return None
    comments = (Comment(found[2], line, found.start(2)),)
    end = len(text) + 1
    if not found[1]:
        return Block(line, found.start(2), end, None, (), comments=comments)
    block = plain_block(line, found[1])
    return None if block is None else block._replace(end=end, comments=comments)


def read_by_grammar(line: int, text: str) -> Node:
    """The node of one line as the grammar reads it; the reference for `plain_block`."""
    if len(text) > MAX_LINE:
        fault = Fault(
            "NC011", f"the line has {len(text):,} characters, more than {MAX_LINE:,}", 0, MAX_LINE,
            "put every block on a line of its own",
        )  # fmt: skip
        return Unread(fault, Block(line, 1, MAX_LINE, None, (), sound=False))
    text = text.removesuffix("\x1a")  # the end-of-file mark of old systems
    if not text or text.isspace():
        return None
    from nccompile.parser.grammar import read  # noqa: PLC0415 - plain programs start without Lark

    node = read(text)
    if isinstance(node, int):
        return Unread(explain(text, node), _unsound(line, text))
    return placed(node, line)


def placed(node: Block | Header, line: int) -> Block | Header:
    """The node on another line."""
    if line == node.line or isinstance(node, Header):
        return node._replace(line=line)
    return placed_block(node, line)


def placed_block(block: Block, line: int) -> Block:
    """The block with another line number in every part."""
    number, comments, new = block.number, block.comments, tuple.__new__  # as in `plain_block`
    return Block(
        line,
        block.column,
        block.end,
        None if number is None else new(Word, (number[0], number[1], number[2], line, number[4])),
        tuple([new(Word, (w[0], w[1], w[2], line, w[4])) for w in block.words]),
        block.skip,
        tuple([c._replace(line=line) for c in comments]) if comments else (),
        block.sound,
    )


def _unsound(line: int, text: str) -> Block:
    """The block of a line that could not be read, with its number so that jumps to it are not blamed too."""
    first = len(text) - len(text.lstrip())
    found = _NUMBER_FIRST.match(text)
    number = None
    if found is not None:
        number = Word("N", float(found[2]), found[1] + found[2], line, found.start(1) + 1)
    return Block(
        line, first + 1, len(text.rstrip()) + 1, number, (), text.lstrip().startswith("/"), sound=False
    )
