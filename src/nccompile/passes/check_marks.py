"""check-marks: says when the program asks for a path pass that is not turned on.

NC301   G41, G42, G51, G52 or G61 has no effect; one finding for each of them, where it first acts
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from nccompile.diagnostics import Diagnostics, Severity
from nccompile.source import Source
from nccompile.toolpath import Mark, Toolpath

__all__ = ["check_marks"]

_ASKED = {
    Mark.TOOL_LEFT: ("G41", "tool radius correction"),
    Mark.TOOL_RIGHT: ("G42", "tool radius correction"),
    Mark.SMOOTH: ("G51", "corner smoothing"),
    Mark.ROUND: ("G52", "corner rounding"),
    Mark.LOOP: ("G61", "loop avoidance"),
}
_PASSES = {
    "G41": "tool-radius", "G42": "tool-radius", "G51": "smooth-corners", "G52": "round-corners", "G61": "avoid-loops",
}  # fmt: skip


def check_marks(chunks: Iterable[Toolpath], source: Source, diagnostics: Diagnostics) -> Iterator[Toolpath]:
    """Hands chunks on; reports NC301 at the first segment that each start mark stands on."""
    unseen = dict(_ASKED)
    for chunk in chunks:
        present = int(np.bitwise_or.reduce(chunk.mark)) if len(chunk) else 0
        for mark in [m for m in unseen if present & m]:
            code, what = unseen.pop(mark)
            line = int(chunk.line[np.flatnonzero(chunk.mark & mark)[0]])
            diagnostics.report(
                "NC301",
                Severity.WARNING,
                f"{code} has no effect: no pass does {what}, the path runs as programmed",
                source,
                source.text_span(line),
                f"turn it on with -p {_PASSES[code]}",
            )
        yield chunk
