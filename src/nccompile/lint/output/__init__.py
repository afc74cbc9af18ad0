"""Findings as text, JSON, SARIF and GitHub annotations."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from nccompile.lint.engine import Findings
from nccompile.lint.output.github import to_github
from nccompile.lint.output.sarif import to_sarif
from nccompile.lint.output.text import to_text, to_whole_json

__all__ = ["FORMATS"]

FORMATS: dict[str, Callable[[Sequence[Findings]], str]] = {
    "text": to_text,
    "json": to_whole_json,
    "sarif": to_sarif,
    "github": to_github,
}
"""What writes each format, by its name on the command line."""
