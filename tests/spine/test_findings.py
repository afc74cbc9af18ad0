"""Diagnostics: what is kept of many findings of one code."""

from __future__ import annotations

from nccompile.diagnostics import Diagnostics, Severity
from nccompile.source import Source, Span


def test_lines_of_findings_that_are_only_counted_are_not_read() -> None:
    read: list[int] = []

    class Watched(Source):
        def line(self, number: int) -> str:
            read.append(number)
            return super().line(number)

    source = Watched("watched.nc", "% t\n" + "  N1 G1 X1 \n" * 100)
    found = Diagnostics()
    for line in range(2, 102):
        found.report_line("NC302", Severity.ERROR, "it gouges", source, line)
    assert read == list(range(2, 2 + found.limit))
    assert [d.span for d in found] == [Span(line, 3, 11) for line in read]
    assert found.closing == "100 errors (80 more of the same kinds not shown)"
