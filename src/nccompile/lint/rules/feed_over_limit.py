"""NC451 feed-over-limit."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nccompile.lint.base import Finding, Rule
from nccompile.lint.program import Program
from nccompile.machine.limits import limits
from nccompile.toolpath.columns import Kind

__all__ = ["FeedOverLimit"]


class FeedOverLimit(Rule):
    r"""The feed is more than the machine's axes can do.

    What: a programmed feed for which an axis would have to move faster than its `velocity`; one finding a
    program.
    Why: the path runs slower than programmed; often F was meant in mm/min.
    NC451: % a\nN10 G1 X100 F5000
    Okay: % a\nN10 G1 X100 F50
    """

    code = "NC451"
    name = "feed-over-limit"
    needs_path = True

    def check(self, program: Program) -> Iterator[Finding]:
        """Compares the axis velocities of straight moves with the limits."""
        path = program.path
        moving = (path.kind == Kind.LINE) & (path.length > 0.0)
        rows = np.flatnonzero(moving & (path.feed > 0.0))
        if not len(rows):
            return
        most = limits(program.machine, path.axes).velocity
        share = np.abs(path.target[rows] - path.starts()[rows]) / path.length[rows, None]
        with np.errstate(divide="ignore"):
            allowed = np.where(share > 0.0, most / np.where(share > 0.0, share, 1.0), np.inf)
        bound = allowed.min(axis=1)
        excess = path.feed[rows] / bound
        over = np.flatnonzero(excess > 1.0 + 1e-9)
        if not len(over):
            return
        here, worst = int(over[0]), int(np.argmax(excess))
        more = ""
        if len(over) > 1:
            feed, line = path.feed[rows[worst]], path.line[rows[worst]]
            more = f"; {len(over) - 1} more moves are"
            more += f", most of all F{feed:g} in line {line}" if worst != here else ""
        yield Finding(
            program.source.text_span(int(path.line[rows[here]])),
            f"the feed of {path.feed[rows[here]]:g} mm/s is limited to {bound[here]:.4g} mm/s by axis "
            f"{path.axes[allowed[here].argmin()]}{more}",
            "F is in mm/s",
        )
