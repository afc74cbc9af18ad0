"""What every rule is: a code, a page in its docstring, and a check that yields findings.

    class EmptyName(Rule):
        '''The header has no name.

        What: ...                        one or more lines
        Why: ...
        NC063: %\\nN10 G1 X1 F20         a program that gives the code
        Okay: % a\\nN10 G1 X1 F20        one that does not
        Fix: ...                         only if there is one
        '''

The docstring is the page of the code: `nccompile explain` and docs/rules print it, and the tests run its
programs.  A rule adds what `compile` does not report.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import TYPE_CHECKING, ClassVar, NamedTuple

from nccompile.diagnostics import Severity
from nccompile.source import Span

if TYPE_CHECKING:
    from nccompile.lint.program import Program

__all__ = ["Edit", "Finding", "Fix", "Rule"]


class Edit(NamedTuple):
    """Replaces the columns `column` to `end` - 1 of a line by `text`; equal columns insert."""

    line: int
    column: int
    end: int
    text: str

    @classmethod
    def of(cls, span: Span, text: str) -> Edit:
        """Replaces the text of a span."""
        return cls(span.line, span.column, span.end, text)


class Fix(NamedTuple):
    """A safe change: the toolpath stays the same to the bit.  `title` says what is done, as an order.

    Lines may be added only before the first one.
    """

    title: str
    edits: tuple[Edit, ...]


class Finding(NamedTuple):
    """What a rule found: where, in one sentence, what to do, and the fix if there is a safe one."""

    span: Span
    message: str
    help: str = ""
    fix: Fix | None = None


class Rule(ABC):
    """A check of a program.

    code, name: never change once published;  default: whether it runs without being selected;
    needs_path: whether it reads `program.path`, which only a program without errors has.
    """

    code: ClassVar[str]
    name: ClassVar[str]
    severity: ClassVar[Severity] = Severity.WARNING
    default: ClassVar[bool] = True
    needs_path: ClassVar[bool] = False

    @abstractmethod
    def check(self, program: Program) -> Iterator[Finding]:
        """The findings in a program, in any order."""

    def fix_all(self, program: Program) -> Fix | None:
        """One fix for all findings together; the first of them carries it."""
        return None
