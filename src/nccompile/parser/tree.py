"""The syntax tree of a part program: header, blocks, words.

Tuples rather than dataclasses: a large program makes millions of them, and a tuple costs a third.  Columns
count from 1; spans are made on demand.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

from nccompile.source import Span

__all__ = ["Block", "Comment", "Header", "Value", "Variable", "Word"]


class Variable(NamedTuple):
    """A value that is known only when its block is decoded: `$name$` (SoftMotion §3.2.3)."""

    name: str


Value: TypeAlias = float | Variable | None
"""What follows a word's letter; None if the program prints `None` where it has no value."""


class Word(NamedTuple):
    """A letter and its value.

    letter: upper case;  value: exactly float(text after the letter);  text: the word as written;
    line, column: of its letter.
    """

    letter: str
    value: Value
    text: str
    line: int
    column: int

    @property
    def number(self) -> str:
        """The value as written."""
        return self.text[1:]

    @property
    def span(self) -> Span:
        """The place of the whole word."""
        return Span(self.line, self.column, self.column + len(self.text))


class Comment(NamedTuple):
    """Text in parentheses, without them; `column` is that of the opening one."""

    text: str
    line: int
    column: int

    @property
    def span(self) -> Span:
        """The place of the comment with its parentheses."""
        return Span(self.line, self.column, self.column + len(self.text) + 2)


class Block(NamedTuple):
    """One line of the program.

    number: the N word;  words: all others, in written order;  skip: whether it starts with `/`;
    sound: False if the line could not be read (a diagnostic says why): then it has no words, and its number
    only if that stands first as it should.
    """

    line: int
    column: int
    end: int
    number: Word | None
    words: tuple[Word, ...]
    skip: bool = False
    comments: tuple[Comment, ...] = ()
    sound: bool = True

    @property
    def span(self) -> Span:
        """The place of the line's text without the blanks around it."""
        return Span(self.line, self.column, self.end)

    @property
    def is_empty(self) -> bool:
        """Whether it has neither number nor words; a line that could not be read may have both."""
        return self.sound and self.number is None and not self.words


class Header(NamedTuple):
    """The line that starts a program: `%` and its name, which may be empty."""

    name: str
    line: int
    column: int
    end: int

    @property
    def span(self) -> Span:
        """The place of the line's text."""
        return Span(self.line, self.column, self.end)
