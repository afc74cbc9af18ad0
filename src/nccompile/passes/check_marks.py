"""check-marks: says when the program asks for a path pass that is not turned on, or for two that exclude each other.

NC301   G41, G42, G51, G52 or G61 has no effect; one finding for each of them, where it first acts
NC304   tool radius correction and rounding or smoothing act on the same stretch; one finding for each stretch
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from nccompile.diagnostics import Diagnostics, Severity
from nccompile.passes.base import Diagnose, region
from nccompile.source import Source
from nccompile.toolpath import Kind, Mark, Toolpath

__all__ = ["CORNERS", "CORRECTION", "check_marks", "check_together"]

CORRECTION = (int(Mark.TOOL_LEFT | Mark.TOOL_RIGHT), int(Mark.TOOL_STOP))
"""Start and stop marks of tool radius correction."""

CORNERS = {
    "smooth-corners": (int(Mark.SMOOTH), int(Mark.CORNER_STOP)),
    "round-corners": (int(Mark.ROUND), int(Mark.CORNER_STOP)),
}
"""Start and stop marks of the passes that must not act where tool radius correction does."""

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
            diagnostics.report_line(
                "NC301",
                Severity.WARNING,
                f"{code} has no effect: no pass does {what}, the path runs as programmed",
                source,
                line,
                f"turn it on with -p {_PASSES[code]}",
            )
        yield chunk


def check_together(
    chunks: Iterable[Toolpath], everywhere: bool, corners: dict[str, bool], diagnose: Diagnose
) -> Iterator[Toolpath]:
    """Hands chunks on; reports NC304 where a stretch is corrected by the tool radius and rounded or smoothed.

    D would be a radius and a distance at once, and what is cut off a corner is cut off the offset contour
    (SoftMotion §3.6 allows one of them at a time; the lint rule NC353 says the same of the program alone).

    Args:     everywhere: tool-radius acts on the whole path;  corners: the same of each pass of `CORNERS` that is on.
    """
    tool, inside, before = False, dict.fromkeys(corners, False), dict.fromkeys(corners, False)
    for chunk in chunks:
        corrected, tool = region(chunk, *CORRECTION, tool)
        cuts = np.flatnonzero((chunk.kind >= Kind.LINE) & (chunk.kind <= Kind.POLYNOMIAL))
        for name, whole in corners.items():
            rounded, inside[name] = region(chunk, *CORNERS[name], inside[name])
            both = ((corrected | everywhere) & (rounded | whole))[cuts]
            for at in cuts[both & ~np.concatenate([[before[name]], both])[:-1]]:
                diagnose(
                    "NC304", Severity.ERROR, f"tool-radius and {name} both act from here on",
                    int(chunk.line[at]), "end one with G40 or G50 before the other starts, or leave one pass out",
                )  # fmt: skip
            before[name] = bool(both[-1]) if len(both) else before[name]
        yield chunk
