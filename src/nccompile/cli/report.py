"""Diagnostics on standard error: as text that fits on a screen, or as JSON."""

from __future__ import annotations

import sys

from nccompile.cli.options import Report
from nccompile.diagnostics import Diagnostic, Diagnostics, Severity, render, to_json
from nccompile.source import Source

__all__ = ["report"]

SCREEN = 18
"""Lines of findings shown as text; the rest is counted.  With the closing lines it is one screen."""


def report(diagnostics: Diagnostics, source: Source, form: Report) -> None:
    """Writes the findings: all of those kept as JSON, or as text as many as fit, errors first."""
    if form is Report.JSON:
        print(to_json(diagnostics), file=sys.stderr)
        return
    shown = 0
    lines = 0
    ranked = sorted(diagnostics, key=lambda d: d.severity is not Severity.ERROR)
    for diagnostic in ranked:
        text = _text(diagnostic, source)
        height = text.count("\n") + 1
        if shown and lines + height > SCREEN:
            break
        print(text, file=sys.stderr)
        shown, lines = shown + 1, lines + height
    total = sum(diagnostics.counts.values())
    if not total:
        return
    hidden = total - shown
    closing = diagnostics.closing.partition(" (")[0]
    more = f"; {hidden} not shown, --diagnostics json lists them" if hidden else ""
    print(f"{source.name}: {closing}{more}", file=sys.stderr)


def _text(diagnostic: Diagnostic, source: Source) -> str:
    return render(diagnostic, source if diagnostic.file == source.name else None)
