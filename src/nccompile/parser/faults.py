"""Says in a machinist's words why a line is not a block.

The grammar finds the place where reading stops; from there a few plain looks at the text tell what was
meant.
"""

from __future__ import annotations

import re
import string
import unicodedata
from collections.abc import Callable
from typing import NamedTuple

__all__ = ["Fault", "explain"]

_NUMBER_LIKE = re.compile(r"[-+.0-9]+")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)")
_EXPONENT = re.compile(r"[+-]?[0-9.]+[eE][+-]?[0-9]+")
_VARIABLE_LIKE = re.compile(r"\$[^$]*\$?")
_NAME = re.compile(r"[A-Za-z]+")

_LOOKALIKES = {
    ";": "comments stand in parentheses: (text)",
    "[": "the language has no expressions; use a variable: X$name$",
    "=": "values follow their letter directly: X10; variables are set with G36 O$name$ D10",
    "#": "variables are written $name$",
    ",": "the decimal sign is a point: X1.5",
    "\u2212": "use the ordinary minus sign -",
    "\u2013": "use the ordinary minus sign -",
    "\u00a0": "use an ordinary blank",
}


class Fault(NamedTuple):
    """A finding in one line: code, sentence, 0-based begin and end in the line, hint."""

    code: str
    message: str
    begin: int
    end: int
    help: str = ""


def explain(text: str, at: int) -> Fault:
    """The fault at the 0-based place `at` of a line that the grammar refused."""
    if at >= len(text):
        return Fault("NC001", "the line ends too early", max(0, len(text) - 1), len(text))
    return _BY_CHARACTER.get(text[at], _unexpected)(text, at)


def _unexpected(text: str, at: int) -> Fault:
    character = text[at]
    shown = f"'{character}'" if character.isprintable() else f"U+{ord(character):04X}"
    name = "" if character.isascii() else unicodedata.name(character, "").lower()
    message = f"unexpected character {shown}" + (f" ({name})" if name else "")
    return Fault("NC001", message, at, at + 1, _LOOKALIKES.get(character, ""))


def _comment(text: str, at: int) -> Fault:
    if text[at] == ")":
        return Fault(
            "NC004", ") without a comment to close", at, at + 1, "remove it, or put ( before the comment"
        )
    inner, close = text.find("(", at + 1), text.find(")", at + 1)
    if inner >= 0 and (close < 0 or inner < close):
        return Fault("NC004", "comments cannot be nested", inner, inner + 1, "use [ ] inside a comment")
    return Fault("NC004", "the comment is not closed on its line", at, len(text), "close it with )")


def _skip(text: str, at: int) -> Fault:
    return Fault(
        "NC007", "/ stands only at the start of a block", at, at + 1, "move it before the block number"
    )


def _percent(text: str, at: int) -> Fault:
    return Fault("NC008", "% stands only at the start of a program", at, at + 1)


def _bare_variable(text: str, at: int) -> Fault:
    return _variable(text, at, at)


def _variable(text: str, begin: int, at: int) -> Fault:
    """`at` is the place of the $, `begin` that of the word it belongs to."""
    found = _VARIABLE_LIKE.match(text, at)
    end = found.end() if found else at + 1
    shown = text[at:end]
    if len(shown) < 2 or not shown.endswith("$"):
        return Fault("NC005", "the variable's name has no closing $", begin, end, "write $name$")
    if begin == at:
        return Fault(
            "NC006", f"the variable {shown} has no word letter", begin, end, "put one before it: X$name$"
        )
    return Fault(
        "NC005", f"'{shown[1:-1]}' is not a variable name", begin, end,
        "names are letters, digits, _ and . and start with a letter, as in $g_i$",
    )  # fmt: skip


def _block_number(text: str, at: int) -> Fault:
    found = _NUMBER_LIKE.match(text, at + 1)
    if found is None:
        return _missing(text, at)
    if re.fullmatch("[0-9]+", found.group()) is None:
        return Fault("NC007", f"block number {found.group()} is not a whole number", at, found.end())
    return Fault(
        "NC007", "the block number must come first in its block", at, found.end(),
        "put every block on a line of its own",
    )  # fmt: skip


def _word(text: str, at: int) -> Fault:
    letter = text[at]
    if text[at + 1 : at + 2] == "$":
        return _variable(text, at, at + 1)
    exponent = _EXPONENT.match(text, at + 1)
    if exponent is not None:
        value = exponent.group()
        return Fault(
            "NC003", f"the number {value} of {letter} has an exponent", at, exponent.end(),
            "write it out as a decimal; for an E word put a blank before E",
        )  # fmt: skip
    found = _NUMBER_LIKE.match(text, at + 1)
    if found is not None:
        signed = text[found.end() : found.end() + 1] == "$"
        if signed:
            return Fault(
                "NC005", "a variable cannot have a sign", at, found.end() + 1, "negate it where it is set"
            )
        return Fault("NC003", f"'{found.group()}' after {letter} is not a number", at, found.end())
    return _missing(text, at)


def _missing(text: str, at: int) -> Fault:
    """A letter that nothing usable follows."""
    letter = text[at]
    rest = text[at + 1 :]
    bare = rest.lstrip(" \t")
    if bare != rest and _NUMBER.match(bare):
        number = _NUMBER.match(bare)
        end = at + 1 + len(rest) - len(bare) + (number.end() if number else 0)
        shown = number.group() if number else ""
        return Fault(
            "NC002", f"a blank separates {letter} from its number", at, end, f"write {letter}{shown}"
        )
    if rest[:1] in _LOOKALIKES and not rest[:1].isspace():
        return _unexpected(text, at + 1)
    run = _NAME.match(text, at)
    name = run.group() if run else letter
    if len(name) > 1:
        return Fault(
            "NC002", f"'{name}' is not a word", at, at + len(name),
            "a word is a letter and a number, as in X10; comments stand in parentheses",
        )  # fmt: skip
    return Fault(
        "NC002", f"{letter} has no number", at, at + 1, f"write {letter} with a number, or remove it"
    )


def _bare_number(text: str, at: int) -> Fault:
    found = _NUMBER_LIKE.match(text, at)
    end = found.end() if found else at + 1
    return Fault(
        "NC006",
        f"the number {text[at:end]} has no word letter",
        at,
        end,
        "put a letter before it: X" + text[at:end],
    )


_BY_CHARACTER: dict[str, Callable[[str, int], Fault]] = {
    **dict.fromkeys(string.ascii_letters, _word),
    **dict.fromkeys("Nn", _block_number),
    **dict.fromkeys("+-.0123456789", _bare_number),
    **dict.fromkeys("()", _comment),
    "$": _bare_variable,
    "/": _skip,
    "%": _percent,
}
"""Who explains a line that cannot be read on from a character."""
