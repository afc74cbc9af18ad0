"""Safe fixes for findings that `compile` gives; like those of rules they are applied only if the path stays.

(cut)                    NC009    % part
N10 G1 X10 F20                    (cut)
                                  N10 G1 X10 F20
N20 G4 T1 F5             NC105    N20 G4 T1
N10 GNone X0             NC013    N10 X0
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import PurePath
from typing import NamedTuple

from nccompile.diagnostics import Diagnostic
from nccompile.lint.base import Edit, Fix
from nccompile.lint.flow import without
from nccompile.lint.program import Program
from nccompile.lint.rewrite import split_lines

__all__ = ["REMEDIES", "Remedy", "remedy"]

_NOT_IN_NAMES = re.compile(r"[^A-Za-z0-9_.-]+")


class Remedy(NamedTuple):
    """says: what the fix does, for the page of the code;  make: the fix of a finding, None if it has none."""

    says: str
    make: Callable[[Program, Diagnostic], Fix | None]


def remedy(program: Program, found: Diagnostic) -> Fix | None:
    """The safe fix of a finding of `compile`, if there is one."""
    known = REMEDIES.get(found.code)
    return None if known is None else known.make(program, found)


def _put_header(program: Program, found: Diagnostic) -> Fix:
    """The header goes before everything else, named like the file."""
    name = _NOT_IN_NAMES.sub("_", PurePath(program.source.name).stem).strip("_") or "program"
    end = split_lines(program.source.text)[0][1] or "\n"
    return Fix(f"Put % {name} before the program", (Edit(1, 1, 1, f"% {name}{end}"),))


def _drop_word(program: Program, found: Diagnostic) -> Fix | None:
    block = program.by_line.get(found.span.line)
    for word in () if block is None else block.words:
        if word.span == found.span:
            return Fix(f"Remove {word.text}", (without(program, word),))
    return None


REMEDIES = {
    "NC009": Remedy("puts a header with the name of the file before the program.", _put_header),
    "NC013": Remedy("removes the word.", _drop_word),
    "NC105": Remedy("removes the word.", _drop_word),
}
"""The fixes by the code of the finding."""
