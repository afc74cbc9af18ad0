"""Diagnostics: what is wrong with the user's program, where, and what to do about it.

One object feeds the command line, JSON and later SARIF and the editor:

    error[NC201]: the centre is 0.5 mm nearer to the start than to the end
     --> bracket.nc:3:14
      |
    3 | N30 G2 X10 Y0 I5 J0.25
      |               ^^^^^^^^
      = help: correct I and J, or program the radius with R

Codes are listed with their pages in `nccompile.codes`; they are never reused.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from enum import StrEnum

from nccompile.source import Source, Span

__all__ = ["Diagnostic", "Diagnostics", "Severity", "render", "to_json"]

_SHOWN_WIDTH = 120


class Severity(StrEnum):
    """How bad it is: an error makes the exit code 1, a warning and a note do not."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding in the user's program: one plain sentence, a span, and a hint with the fix."""

    code: str
    severity: Severity
    message: str
    span: Span
    file: str
    help: str = ""


@dataclass
class Diagnostics:
    """Collects the findings of one compilation, at most `limit` of each code.

    A million equal warnings help nobody: past the limit findings of a code are only counted, and `closing`
    says how many were left out.
    """

    limit: int = 20
    found: list[Diagnostic] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)
    errors: int = 0

    def add(self, diagnostic: Diagnostic) -> None:
        """Records one finding."""
        self.counts[diagnostic.code] += 1
        if diagnostic.severity is Severity.ERROR:
            self.errors += 1
        if self.counts[diagnostic.code] <= self.limit:
            self.found.append(diagnostic)

    def report(
        self, code: str, severity: Severity, message: str, source: Source, span: Span, help: str = ""
    ) -> None:
        """Records a finding at a span of `source`."""
        self.add(Diagnostic(code, severity, message, span, source.name, help))

    def report_line(
        self, code: str, severity: Severity, message: str, source: Source, line: int, help: str = ""
    ) -> None:
        """Records a finding at the text of a line of `source`; past the limit the line is not even read."""
        span = source.text_span(line) if self.counts[code] < self.limit else Span(line, 1, 2)
        self.report(code, severity, message, source, span, help)

    @property
    def closing(self) -> str:
        """One line that totals the findings; empty if there are none."""
        if not self.counts:
            return ""
        total = sum(self.counts.values())
        parts = [f"{self.errors} error{'s' * (self.errors != 1)}"]
        others = total - self.errors
        if others:
            parts.append(f"{others} warning{'s' * (others != 1)}")
        hidden = total - len(self.found)
        return ", ".join(parts) + (f" ({hidden} more of the same kinds not shown)" if hidden else "")

    def __iter__(self) -> Iterator[Diagnostic]:
        return iter(sorted(self.found, key=lambda d: (d.span, d.code)))


def render(diagnostic: Diagnostic, source: Source | None = None) -> str:
    """The finding as text with the line of the program and a caret under the span.

    Long lines are cut to a window around the span; tabs and control characters are shown as blanks, so the
    caret stands where the reader looks.
    """
    span = diagnostic.span
    lines = [f"{diagnostic.severity}[{diagnostic.code}]: {diagnostic.message}"]
    if span.line == 0 or source is None:
        lines.append(f" --> {diagnostic.file}" + (f":{span.line}:{span.column}" if span.line else ""))
    else:
        gutter = " " * len(str(span.line))
        lines.append(f"{gutter}--> {diagnostic.file}:{span.line}:{span.column}")
        text, column = _window(source.line(span.line), span)
        width = max(1, min(span.end - span.column, _SHOWN_WIDTH, max(1, len(text) - column)))
        lines += [f"{gutter} |", f"{span.line} | {text}".rstrip(), f"{gutter} | {' ' * column}{'^' * width}"]
    if diagnostic.help:
        indent = " " * len(str(span.line)) if span.line else ""
        lines.append(f"{indent} = help: {diagnostic.help}")
    return "\n".join(lines)


def _window(text: str, span: Span) -> tuple[str, int]:
    """The shown part of a line and the 0-based place of the caret in it."""
    first = max(0, span.column - 1 - _SHOWN_WIDTH // 2) if len(text) > _SHOWN_WIDTH else 0
    cut = text[first : first + _SHOWN_WIDTH]
    shown = "".join(c if c.isprintable() else " " for c in cut)
    head = "..." if first else ""
    tail = "..." if first + _SHOWN_WIDTH < len(text) else ""
    return head + shown + tail, span.column - 1 - first + len(head)


def to_json(diagnostics: Iterable[Diagnostic]) -> str:
    """The findings as a JSON array of objects with `code, severity, message, file, line, column, end, help`."""
    rows = [
        {
            "code": d.code,
            "severity": str(d.severity),
            "message": d.message,
            "file": d.file,
            "line": d.span.line,
            "column": d.span.column,
            "end": d.span.end,
            "help": d.help,
        }
        for d in diagnostics
    ]
    return json.dumps(rows, indent=1, ensure_ascii=False)
