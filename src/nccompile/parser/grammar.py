"""The Lark parser of one line, made from `grammars/din66025.lark` when the first program is read."""

from __future__ import annotations

import functools
from typing import Any

from lark import Lark, Token, Transformer
from lark.exceptions import UnexpectedInput, UnexpectedToken

from nccompile.parser.tree import Block, Comment, Header, Value, Variable, Word

__all__ = ["line_parser", "read"]


class _Tree(Transformer[Token, Block | Header]):
    """Makes tree nodes while Lark reduces; lines are filled in by the caller, who knows them."""

    def start(self, children: list[Any]) -> Block | Header:
        node: Block | Header = children[0]
        return node

    def header(self, children: list[Any]) -> Header:
        first, last = children[0], children[-1]
        name = next((str(token).strip() for token in children if token.type == "NAME"), "")
        return Header(name, 1, first.column, last.column + len(last.rstrip()))

    def block(self, tokens: list[Any]) -> Block:
        """Sorts the tokens into number, words and comments."""
        if not tokens:
            return Block(1, 1, 1, None, ())
        number, skip = None, False
        words: list[Word] = []
        comments: list[Comment] = []
        for token in tokens:
            kind = token.type
            text = str(token)
            if kind == "WORD":
                words.append(Word(text[0].upper(), float(text[1:]), text, 1, token.column))
            elif kind == "COMMENT":
                comments.append(Comment(text[1:-1], 1, token.column))
            elif kind == "SKIP":
                skip = True
            else:
                word = Word(text[0].upper(), _value(kind, text), text, 1, token.column)
                if kind == "BLOCK_NUMBER":
                    number = word
                else:
                    words.append(word)
        first, last = tokens[0], tokens[-1]
        end = last.column + len(last)
        return Block(1, first.column, end, number, tuple(words), skip, tuple(comments))


def _value(kind: str, text: str) -> Value:
    if kind == "VARIABLE_WORD":
        return Variable(text[2:-1])
    return None if kind == "EMPTY_WORD" else float(text[1:])


@functools.cache
def line_parser() -> Lark:
    """The parser of one line of text; its result is a `Block` or a `Header` on line 1."""
    return Lark.open_from_package(
        "nccompile.grammars",
        "din66025.lark",
        parser="lalr",
        lexer="contextual",
        transformer=_Tree(),
        maybe_placeholders=False,
    )


def read(text: str) -> Block | Header | int:
    """What the grammar reads in one line, on line 1; the place from 0 where it stops if it cannot."""
    try:
        node: Block | Header = line_parser().parse(text)  # type: ignore[assignment]  # the transformer's result
    except UnexpectedInput as stop:
        at = stop.token.start_pos if isinstance(stop, UnexpectedToken) else stop.pos_in_stream
        ended = isinstance(stop, UnexpectedToken) and stop.token.type == "$END"
        return len(text) if at is None or ended else at
    return node
