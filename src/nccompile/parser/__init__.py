"""Part-program text to syntax tree; no meaning.

`parse` reads block by block: a line that is no block gives one diagnostic, and the rest is still read.  The
text is never read as a whole by Lark: `lines.read_line` takes the lines it knows in front of it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from nccompile.diagnostics import Diagnostics, Severity
from nccompile.parser.faults import Fault
from nccompile.parser.lines import MAX_LINE, ReadSource, Unread, read_line
from nccompile.parser.tree import Block, Comment, Header, Value, Variable, Word
from nccompile.source import LargeSource, Source, Span

__all__ = [
    "MAX_LINE",
    "Block",
    "Comment",
    "Header",
    "ReadSource",
    "Reader",
    "Value",
    "Variable",
    "Word",
    "parse",
    "read_header",
    "read_line",
    "report_control",
]

MAX_UNREADABLE = 1000
"""Lines without sense after which reading stops: this is no part program."""

_COMMENTS = re.compile(r"\([^()]*\)")
_WIDE = ("\xff\xfe", "\xfe\xff")  # UTF-16, read as Latin-1
_CONTROL = re.compile(r"[\x00-\x08\x0e-\x1f\x7f]")
_CONTROL_BYTES = bytes([*range(0x09), *range(0x0E, 0x20), 0x7F])


def parse(source: Source, diagnostics: Diagnostics) -> Iterator[Block]:
    """The blocks of a program in order; blank lines are left out.

    Every line that is no block adds one error and comes as a block that is not `sound`.  The header is not a
    block (see `read_header`).  Time is linear in the text, memory that of one block.
    """
    if _is_binary(source, diagnostics):
        return
    reader = Reader(source, diagnostics)
    for line, text in enumerate(source.each_line(), 1):
        block = reader.take(line, text)
        if block is not None:
            yield block
        if reader.stopped:
            return
    reader.finish()


def read_header(source: Source) -> Header | None:
    """The header line of a program; None if a block or anything else comes first."""
    for line, text in enumerate(source.each_line(), 1):
        bare = text.strip()
        if not bare or (bare.startswith("(") and bare.endswith(")")):
            continue
        if not bare.startswith("%") or len(text) > MAX_LINE:
            return None
        node = read_line(line, text)
        return node if isinstance(node, Header) else None
    return None


class Reader:
    """Reads the lines of a program in order and reports what is wrong with them.

    any_block: a block was read, so header and start are dealt with;  stopped: the rest is not to be read.
    """

    def __init__(self, source: Source, diagnostics: Diagnostics) -> None:
        self.source = source
        self.diagnostics = diagnostics
        self.nodes = source.nodes if isinstance(source, ReadSource) else ()
        self.any_block = False
        self.stopped = False
        self.seen_header = False
        self.unreadable = 0

    def take(self, line: int, text: str) -> Block | None:
        """The block of the next line; None if it is none."""
        node = self.read(line, text)
        if node is None:
            return None
        if isinstance(node, Header):
            self.stopped = not self.header(node, self.any_block)
            return None
        if node.is_empty:
            return node if node.comments or node.skip else None
        if not self.any_block and (node.words or node.number):
            self.started(node)
        self.any_block = True
        if self.unreadable >= MAX_UNREADABLE:
            self.give_up(node)
            self.stopped = True
        return node

    def finish(self) -> None:
        """Called after the last line."""
        if not self.any_block:
            self.diagnostics.report(
                "NC012", Severity.ERROR, "there is no program in this file: it has no block", self.source,
                Span(1, 1, 1), "a program is a line with % and its name, then blocks such as N10 G1 X10 F20",
            )  # fmt: skip

    def read(self, line: int, text: str) -> Block | Header | None:
        """The node of one line; None for an empty one."""
        node = self.nodes[line - 1] if self.nodes else read_line(line, text)
        if isinstance(node, Unread):
            self.report(line, node.fault)
            return node.block
        return node

    def report(self, line: int, fault: Fault) -> None:
        """Adds an error."""
        self.unreadable += 1
        span = Span(line, fault.begin + 1, fault.end + 1)
        self.diagnostics.report(fault.code, Severity.ERROR, fault.message, self.source, span, fault.help)

    def give_up(self, block: Block) -> None:
        """Called when so many lines could not be read that the rest would not help either."""
        self.report(block.line, Fault(
            "NC014", f"reading stops here: {self.unreadable:,} lines are no blocks", block.column - 1, block.end - 1,
            "is this a part program?",
        ))  # fmt: skip

    def started(self, block: Block) -> None:
        """Called at the first block: warns if the header is missing."""
        if not self.seen_header:
            self.diagnostics.report(
                "NC009", Severity.WARNING, "the program does not start with %", self.source, block.span,
                "put a line with % and the program's name before the first block",
            )  # fmt: skip
            self.seen_header = True

    def header(self, header: Header, after_blocks: bool) -> bool:
        """Whether reading goes on after a header line."""
        if not self.seen_header and not after_blocks:
            self.seen_header = True
            return True
        rest = self.source.each_line(header.line)
        if any(_COMMENTS.sub("", line).strip("\x1a \t\f\v") for line in rest):
            self.report(header.line, Fault(
                "NC008", "a second program starts here", header.column - 1, header.end - 1,
                "keep one program a file; what follows is not read",
            ))  # fmt: skip
        else:
            self.diagnostics.report(
                "NC008", Severity.WARNING, "% has no meaning at the end of a program", self.source, header.span,
                "remove the line",
            )  # fmt: skip
            self.finish()
        return False


def _is_binary(source: Source, diagnostics: Diagnostics) -> bool:
    """Whether the text holds control characters no program has; reports the first."""
    text = source.text.rstrip("\x1a\x00 \r\n") if source.text.endswith("\x1a") else source.text
    data = text.encode("utf-8", "surrogatepass")
    if len(data.translate(None, _CONTROL_BYTES)) == len(data):  # a tenth of the time of the search
        return False
    found = _CONTROL.search(text)
    assert found is not None
    before = source.text[: found.start()].replace("\r\n", "\n").replace("\r", "\n")
    wide = source.text[:2] in _WIDE
    _refuse(
        source,
        diagnostics,
        before.count("\n") + 1,
        len(before) - before.rfind("\n"),
        ord(found.group()),
        wide,
    )
    return True


def report_control(source: LargeSource, diagnostics: Diagnostics, place: int) -> None:
    """Reports the control character at byte `place` of a file."""
    line = source.line_at(place)
    column = len(source.decode(source.line_start(place))) + 1
    wide = source.encoding == "latin-1" and source.decode(source.read_at(0, 2)) in _WIDE
    _refuse(source, diagnostics, line, column, source.read_at(place, 1)[0], wide)


def _refuse(
    source: Source, diagnostics: Diagnostics, line: int, column: int, character: int, wide: bool
) -> None:  # fmt: skip
    diagnostics.report(
        "NC010", Severity.ERROR,
        f"this is not a text file: it holds the control character U+{character:04X}",
        source, Span(line, column, column + 1),
        "save the program as UTF-8" if wide else "",
    )  # fmt: skip
