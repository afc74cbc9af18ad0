"""`nccompile plot`: a picture of the path and of its course over time."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from nccompile.cli.options import (
    AngleTolerance,
    Define,
    DiagnosticsFormat,
    Input,
    MachineFile,
    MaxJumps,
    Report,
    SkipBlocks,
    Start,
    TimeLawOption,
)
from nccompile.errors import UsageError

__all__ = ["plot"]

SUFFIXES = (".png", ".svg", ".pdf")


def plot(
    path: Input,
    machine: MachineFile = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help=".png, .svg or .pdf; default: INPUT.png."),
    ] = None,
    start: Start = None,
    define: Define = None,
    skip_blocks: SkipBlocks = False,
    max_jumps: MaxJumps = None,
    angle_tolerance: AngleTolerance = None,
    time_law: TimeLawOption = None,
    diagnostics: DiagnosticsFormat = Report.TEXT,
) -> None:
    """Draw the path, and velocity and acceleration over time."""
    raise UsageError("plot is not wired yet")
