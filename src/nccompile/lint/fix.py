"""Applies the safe fixes of a program until none is left.

The fix of a rule never changes the toolpath; this is checked each time: the program is decoded before and
after, and a rule whose fixes would change one bit is left out.
"""

from __future__ import annotations

from collections import defaultdict
from typing import NamedTuple

from nccompile.lint.base import Edit, Fix
from nccompile.lint.config import Config
from nccompile.lint.engine import Report, lint
from nccompile.lint.rewrite import apply_edits, same_path
from nccompile.source import Source
from nccompile.toolchain import Options

__all__ = ["Fixed", "apply_fixes"]

MAX_ROUNDS = 40
"""A fix may open the way for another one; more rounds than this no program needs."""


class Fixed(NamedTuple):
    """The text after fixing, and how many fixes were applied."""

    text: str
    applied: int


def apply_fixes(source: Source, options: Options, config: Config) -> Fixed:
    """Fixes what can be fixed."""
    count = 0
    refused: set[str] = set()
    report = lint(source, options, config, limit=0)
    for _ in range(MAX_ROUNDS):
        by_code: dict[str, list[Fix]] = defaultdict(list)
        for found, fix in report.fixes.items():
            if found.code not in refused:
                by_code[found.code].append(fix)
        if not by_code:
            break
        for code, fixes in by_code.items():
            chosen = _apart(fixes)
            text = apply_edits(source.text, [edit for fix in chosen for edit in fix.edits])
            changed = Source(source.name, text, source.sha256)
            after = lint(changed, options, config, limit=0)
            added = sum(edit.text.count("\n") for fix in chosen for edit in fix.edits)
            if _keeps(report, after, added):
                source, report, count = changed, after, count + len(chosen)
                refused.clear()  # what was not possible may be now
                break
            refused.add(code)
    return Fixed(source.text, count)


def _apart(fixes: list[Fix]) -> list[Fix]:
    """The fixes of one rule whose edits do not overlap."""
    chosen: list[Fix] = []
    taken: dict[int, list[Edit]] = defaultdict(list)
    for fix in fixes:
        if all(e.end <= t.column or t.end <= e.column for e in fix.edits for t in taken[e.line]):
            chosen.append(fix)
            for edit in fix.edits:
                taken[edit.line].append(edit)
    return chosen


def _keeps(before: Report, after: Report, added: int) -> bool:
    """Whether the change kept the toolpath, but for `added` lines before it, and brought nothing to `compile`."""
    old, new = before.program.diagnostics.counts, after.program.diagnostics.counts
    return same_path(before.program.chunks, after.program.chunks, shift=added) and all(
        new[code] <= old[code] for code in new
    )
