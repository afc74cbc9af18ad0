"""Findings as workflow commands of GitHub Actions, which shows them at the lines of a pull request.

::warning file=part.nc,line=3,col=5,endColumn=8,title=NC151::the feed is 20 since line 2
"""

from __future__ import annotations

from collections.abc import Sequence

from nccompile.diagnostics import Diagnostic, Severity
from nccompile.lint.engine import Findings

__all__ = ["to_github"]

_KINDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "notice"}


def to_github(reports: Sequence[Findings]) -> str:
    """One command a finding."""
    return "".join(_command(found) + "\n" for report in reports for found in report.ordered())


def _command(found: Diagnostic) -> str:
    place = [f"file={_property(found.file)}"]
    if found.span.line:
        span = found.span
        place += [f"line={span.line}", f"col={span.column}", f"endColumn={max(span.column, span.end - 1)}"]
    place.append(f"title={found.code}")
    message = found.message + (f" ({found.help})" if found.help else "")
    return f"::{_KINDS[found.severity]} {','.join(place)}::{_data(message)}"


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
