"""Completion: instructions, words, block numbers of jumps, variables."""

from __future__ import annotations

import re
from heapq import nsmallest

from lsprotocol import types

from nccompile.decoder.tables import INSTRUCTIONS, LETTERS
from nccompile.lint.flow import is_jump
from nccompile.lsp.document import Document
from nccompile.lsp.features.hover import instruction_text
from nccompile.lsp.features.words import number_of
from nccompile.lsp.text import Place
from nccompile.parser import Block, Variable
from nccompile.parser.lines import Unread

__all__ = ["TRIGGERS", "completions"]

TRIGGERS = ["G", "g", "L", "$", " "]

_VARIABLE = re.compile(r"\$[A-Za-z0-9_.]*$")
_INSTRUCTION = re.compile(r"(?:^|[^A-Za-z$])[Gg]([0-9]*)$")
_TARGET = re.compile(r"(?:^|[^A-Za-z$])[Ll]([0-9]*)$")
_JUMP = re.compile(r"[Gg]0*20(?![0-9])")
_MOST = 500


def completions(document: Document, at: Place) -> types.CompletionList:
    """What can stand at a position; an incomplete list is asked for anew with each further character."""
    line, character = at
    if not 0 <= line < len(document.text.lines):
        return types.CompletionList(False, [])
    text = document.text.lines[line][: document.text.index(line, character)]
    is_prose = text.count("(") > text.count(")") or text.lstrip().startswith("%")
    items = [] if is_prose else _after(document, at, text)
    return types.CompletionList(_names_letters(text) or len(items) > _MOST, items[:_MOST])


def _names_letters(text: str) -> bool:
    """Whether a word may begin behind a text: its letter decides what can follow."""
    return not text or text[-1] in " \t/"


def _after(document: Document, at: Place, text: str) -> list[types.CompletionItem]:
    """What can stand behind the text of a block's start."""
    if (found := _VARIABLE.search(text)) and text.count("$") % 2 == 1:
        return _variables(document, at, len(found.group()))
    if found := _TARGET.search(text):
        return _numbers(document, at, found[1]) if _JUMP.search(text) else []
    if found := _INSTRUCTION.search(text):
        return _instructions(document, at, len(found[1]) + 1)
    return _words() if _names_letters(text) else []


def _edit(document: Document, at: Place, length: int, new: str) -> types.TextEdit:
    """Replaces the `length` characters before a position; they are ASCII."""
    start = types.Position(at[0], at[1] - length)
    return types.TextEdit(types.Range(start, types.Position(*at)), new)


def _instructions(document: Document, at: Place, length: int) -> list[types.CompletionItem]:
    return [
        types.CompletionItem(
            label=row.name,
            kind=types.CompletionItemKind.Keyword,
            detail=row.effect,
            documentation=types.MarkupContent(types.MarkupKind.Markdown, instruction_text(row)),
            sort_text=f"{row.code:03}",
            filter_text=row.name,
            text_edit=_edit(document, at, length, row.name),
        )
        for row in INSTRUCTIONS.values()
    ]


def _words() -> list[types.CompletionItem]:
    return [
        types.CompletionItem(
            label=row.letter,
            kind=types.CompletionItemKind.Field,
            detail=row.meaning + (f" [{row.unit}]" if row.unit else ""),
        )
        for row in LETTERS.values()
    ]


def _numbers(document: Document, at: Place, begin: str) -> list[types.CompletionItem]:
    """Block numbers that begin so, those of blocks near the jump first; one more than are shown if there are more."""
    found: list[tuple[int, str]] = []
    for line, node in enumerate(document.nodes):
        block = node.block if isinstance(node, Unread) else node
        if isinstance(block, Block) and block.number is not None and line != at[0]:
            number = number_of(block.number)
            if number is not None and str(number).startswith(begin) and not is_jump(block):
                found.append((abs(line - at[0]), str(number)))
    return [
        types.CompletionItem(
            label=number,
            kind=types.CompletionItemKind.Reference,
            detail=f"block N{number}",
            sort_text=f"{rank:04}",
            text_edit=_edit(document, at, len(begin), number),
        )
        for rank, (_, number) in enumerate(nsmallest(_MOST + 1, found))
    ]


def _variables(document: Document, at: Place, length: int) -> list[types.CompletionItem]:
    names: dict[str, str] = {}
    for line, node in enumerate(document.nodes):
        if isinstance(node, Block) and line != at[0]:
            for word in node.words:
                if isinstance(word.value, Variable):
                    names.setdefault(word.value.name.lower(), word.value.name)
    return [
        types.CompletionItem(
            label=f"${name}$",
            kind=types.CompletionItemKind.Variable,
            filter_text=f"${name}$",
            text_edit=_edit(document, at, length, f"${name}$"),
        )
        for _, name in sorted(names.items())
    ]
