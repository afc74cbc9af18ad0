"""Changing program text: edits by line and column, line ends and encoding kept, and the toolpath as witness."""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterable, Sequence
from dataclasses import fields, is_dataclass, replace
from typing import NamedTuple

import numpy as np

from nccompile.lint.base import Edit
from nccompile.toolpath import Toolpath

__all__ = ["Encoding", "apply_edits", "encoding_of", "same_path", "split_lines"]

_LINE = re.compile(r"([^\r\n]*)(\r\n|\r|\n|\Z)")


class Encoding(NamedTuple):
    """How a program's bytes become text, as `Source.from_bytes` reads them."""

    name: str
    mark: bytes

    def encode(self, text: str) -> bytes:
        """The bytes of a text in this encoding."""
        return self.mark + text.encode(self.name)


def encoding_of(data: bytes) -> Encoding:
    """The encoding of program bytes: UTF-8, with or without byte-order mark, else Latin-1."""
    mark = codecs.BOM_UTF8 if data.startswith(codecs.BOM_UTF8) else b""
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        return Encoding("latin-1", b"")
    return Encoding("utf-8", mark)


def split_lines(text: str) -> list[tuple[str, str]]:
    """The lines of a text with their ends; the last has none."""
    lines = [(found[1], found[2]) for found in _LINE.finditer(text)]
    if len(lines) > 1 and lines[-1] == ("", "") and lines[-2][1] == "":
        lines.pop()  # the empty match behind a last line without end
    return lines


def apply_edits(text: str, edits: Iterable[Edit]) -> str:
    """The text with edits that do not overlap."""
    lines = split_lines(text)
    for edit in sorted(edits, reverse=True):
        line, end = lines[edit.line - 1]
        lines[edit.line - 1] = (line[: edit.column - 1] + edit.text + line[edit.end - 1 :], end)
    return "".join(line + end for line, end in lines)


def same_path(
    before: Sequence[Toolpath], after: Sequence[Toolpath], *, lines: bool = True, shift: int = 0
) -> bool:
    """Whether two toolpaths are the same to the bit, however they are cut into chunks.

    Without `lines` their source lines may differ, with `shift` those of `after` are as much greater.
    """
    if not (before and after):
        return len(before) == len(after)
    one, other = Toolpath.join(list(before)), Toolpath.join(list(after))
    if shift:
        other = replace(other, line=(other.line - shift).astype(other.line.dtype))
    return _same(one, other, () if lines else ("line",))


def _same(before: object, after: object, but: tuple[str, ...]) -> bool:
    if is_dataclass(before):
        names = [field.name for field in fields(before) if field.name not in but]
        return all(_same(getattr(before, name), getattr(after, name), ()) for name in names)
    if isinstance(before, np.ndarray):
        assert isinstance(after, np.ndarray)
        return (
            before.dtype == after.dtype
            and before.shape == after.shape
            and before.tobytes() == after.tobytes()
        )
    return before == after
