"""Findings as `compile` shows them: rendered with the line and a caret, or as its JSON objects."""

from __future__ import annotations

from collections.abc import Sequence

from nccompile.diagnostics import render, to_json
from nccompile.lint.engine import Findings

__all__ = ["to_text", "to_whole_json"]


def to_text(reports: Sequence[Findings]) -> str:
    """All findings with their lines, file by file."""
    return "".join(render(found, report.source) + "\n" for report in reports for found in report.ordered())


def to_whole_json(reports: Sequence[Findings]) -> str:
    """One JSON array of all findings, with the keys of `nccompile.diagnostics.to_json`."""
    return to_json([found for report in reports for found in report.ordered()]) + "\n"
