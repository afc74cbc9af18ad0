"""An open document: its lines, what was read in each, and its newest analysis.

An edit reads the changed lines only.  All others keep their nodes; nodes behind inserted or removed lines are
moved when the next analysis needs them.
"""

from __future__ import annotations

from copy import copy
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple
from urllib.parse import unquote, urlsplit

from nccompile.diagnostics import Diagnostic, Severity
from nccompile.lsp.analysis import Analysis
from nccompile.lsp.text import Change, Place, Text, joined
from nccompile.parser import Block, Header, ReadSource, read_line
from nccompile.parser.lines import Node, Unread, placed, placed_block
from nccompile.source import Span

__all__ = ["Document", "Snapshot", "forget", "path_of"]

_AT_ONCE = 500
"""Nodes that are freed before other threads may go on: a third of a millisecond."""


def path_of(uri: str) -> Path | None:
    """The file of a `file:` URI; None for documents that are not saved."""
    parts = urlsplit(uri)
    if parts.scheme != "file":
        return None
    path = unquote(parts.path)
    return Path(path[1:] if len(path) > 2 and path[2] == ":" else path)  # /C:/part.nc


class Document:
    """One open document.

    version: of the client;  analysis: the newest one, maybe of an older version, and the seconds it took;
    shown: what was published.
    """

    def __init__(self, uri: str, version: int, text: str, encoding: str) -> None:
        self.uri = uri
        self.version = version
        self.path = path_of(uri)
        self.name = uri if self.path is None else str(self.path)
        self.text = Text(text, encoding)
        self.nodes: list[Node] = [read_line(at, line) for at, line in enumerate(self.text.lines, 1)]
        self.analysis: Analysis | None = None
        self.seconds = 0.0
        self.shown: list[Diagnostic] = []

    def edit(self, start: Place, end: Place, new: str) -> None:
        """One incremental change."""
        self._changed(self.text.edit(start, end, new))

    def replace(self, text: str) -> None:
        """A whole new text."""
        self._changed(self.text.replace_all(text))

    def _changed(self, change: Change) -> None:
        first, before, after = change
        lines = self.text.lines
        self.nodes[first : first + before] = [
            read_line(at + 1, lines[at]) for at in range(first, first + after)
        ]
        self.shown = self._moved(first, before, after)

    def _moved(self, first: int, before: int, after: int) -> list[Diagnostic]:
        """The published findings after a change: those of changed lines go, those below move along."""
        moved = []
        for found in self.shown:
            span = found.span
            if span.line - 1 < first:
                moved.append(found)
            elif span.line - 1 >= first + before:
                line = span.line + after - before
                moved.append(replace(found, span=Span(line, span.column, span.end)))
        changed = self.nodes[first : first + after]
        return moved + [self._fault(node) for node in changed if isinstance(node, Unread)]

    def _fault(self, node: Unread) -> Diagnostic:
        fault = node.fault
        span = Span(node.block.line, fault.begin + 1, fault.end + 1)
        return Diagnostic(fault.code, Severity.ERROR, fault.message, span, self.name, fault.help)

    def copy(self) -> Document:
        """The document as it is, for a thread to read: edits do not reach the copy."""
        twin = copy(self)
        twin.text, twin.nodes, twin.shown = self.text.copy(), list(self.nodes), list(self.shown)
        return twin

    def in_line(self, line: int) -> Block | Header | None:
        """What stands in a line, from 0; its line number may be one from before an edit."""
        node = self.nodes[line]
        return None if isinstance(node, Unread) else node

    def node(self, line: int) -> Block | Header | None:
        """What stands in a line, from 0, with its number; None if it is empty or cannot be read."""
        if not 0 <= line < len(self.nodes):
            return None
        node = self.nodes[line]
        if node is None or isinstance(node, Unread):
            return None
        if node.line != line + 1:
            node = self.nodes[line] = placed(node, line + 1)
        return node

    def snapshot(self) -> Snapshot:
        """The lines and nodes as they are; copies, so that edits do not reach them."""
        return Snapshot(self.name, list(self.text.lines), list(self.text.ends), list(self.nodes))

    def source(self) -> ReadSource:
        """The text with its nodes, all in their places."""
        return self.snapshot().source()


class Snapshot(NamedTuple):
    """A document at one moment."""

    name: str
    lines: list[str]
    ends: list[str]
    nodes: list[Node]

    def source(self) -> ReadSource:
        """The text with its nodes; those behind inserted or removed lines are put in their places, which takes a
        while in a long document: a thread may do it."""
        nodes = self.nodes
        for at, node in enumerate(nodes, 1):
            if node is None:
                continue
            if isinstance(node, Unread):
                if node.block.line != at:
                    nodes[at - 1] = Unread(node.fault, placed_block(node.block, at))
            elif node.line != at:
                nodes[at - 1] = placed(node, at)
        return ReadSource(self.name, joined(self.lines, self.ends), nodes=nodes)


def forget(nodes: list[Node]) -> None:
    """Empties a list of nodes that nobody reads any more.

    To free all nodes of a long document takes a hundredth of a second, in which no edit would be answered.
    """
    while nodes:
        del nodes[-_AT_ONCE:]
