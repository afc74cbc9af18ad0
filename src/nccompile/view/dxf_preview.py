"""A preview of imported drawings: paths blue with their order numbers, rapids green, starts as dots."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from nccompile.toolpath import Toolpath
from nccompile.view.drawing import draw

__all__ = ["save_preview"]

MOST_NUMBERS = 150
"""Paths that are numbered; in a picture of more only every n-th is."""


def save_preview(place: Path, chunks: Sequence[Toolpath], starts: Sequence[complex], title: str) -> None:
    """Draws a toolpath seen from above to a .png, .svg or .pdf file.

    Args: starts: where each path begins, in machining order [mm].
    """
    import matplotlib as mpl  # noqa: PLC0415

    mpl.use("Agg")
    from matplotlib.figure import Figure  # noqa: PLC0415

    drawn = draw(chunks)
    low, high = drawn.box()
    width, height = np.maximum(high[:2] - low[:2], 1e-3)
    scale = 9.0 / max(width, height)
    figure = Figure(figsize=(max(4.0, width * scale) + 1.5, max(3.0, height * scale) + 1.2), dpi=110)
    axes = figure.add_subplot()
    axes.plot(drawn.rapid[:, 0], drawn.rapid[:, 1], color="tab:green", lw=0.8, ls="--", label="rapid")
    axes.plot(drawn.feed[:, 0], drawn.feed[:, 1], color="tab:blue", lw=1.1, label="feed")
    step = max(1, -(-len(starts) // MOST_NUMBERS))
    for number, z in enumerate(starts, 1):
        if (number - 1) % step == 0:
            axes.plot(z.real, z.imag, ".", color="tab:red", ms=4)
            axes.annotate(
                str(number), (z.real, z.imag), xytext=(3, 3), textcoords="offset points", fontsize=7
            )
    axes.set_aspect("equal")
    axes.set_xlabel("X [mm]")
    axes.set_ylabel("Y [mm]")
    axes.set_title(title, fontsize=9)
    axes.legend(loc="upper right", fontsize=7)
    axes.grid(visible=True, lw=0.3)
    figure.tight_layout()
    figure.savefig(place)
