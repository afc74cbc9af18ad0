"""NC254 tiny-segment."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nccompile.diagnostics import Severity
from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program
from nccompile.toolpath.columns import Kind

__all__ = ["TinySegment"]


class TinySegment(Rule):
    r"""Tiny segments.

    What: runs of feed moves shorter than `min-segment` (0.001 mm); one finding a run.
    Why: a path of them is limited by cycle time and look-ahead, not by the feed; they are noise of the CAM
    system.
    NC254: % a\nN10 G1 X1 F20\nN20 G1 X1.0002\nN30 G1 X1.0004\nN40 G1 X9
    Okay: % a\nN10 G1 X1 F20\nN20 G1 X2\nN40 G1 X9
    """

    code = "NC254"
    name = "tiny-segment"
    severity = Severity.NOTE
    needs_path = True

    def check(self, program: Program) -> Iterator[Finding]:
        """Looks for runs of short segments."""
        path = program.path
        contour = (path.kind >= Kind.LINE) & (path.kind <= Kind.POLYNOMIAL)
        tiny = contour & (path.length > 0.0) & (path.length < program.config.min_segment)
        begins = np.flatnonzero(tiny & ~np.concatenate([[False], tiny[:-1]]))
        ends = np.flatnonzero(tiny & ~np.concatenate([tiny[1:], [False]]))
        for begin, end in zip(begins, ends, strict=True):
            span = program.source.text_span(int(path.line[begin]))
            count = int(end - begin) + 1
            what = f"{count} segments are" if count > 1 else "this segment is"
            yield Finding(
                span,
                f"{what} shorter than {program.config.min_segment:g} mm",
                "let the CAM system thin the path",
            )
