"""`nccompile export-dxf`: a toolpath as a drawing, to be checked in a CAD program."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Annotated

import typer

from nccompile.cli.options import (
    DiagnosticsFormat,
    Input,
    MachineFile,
    Passes,
    ProgramOptions,
    ReadOptions,
    Report,
)

__all__ = ["export_dxf"]


def export_dxf(
    path: Input,
    machine: MachineFile = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE.dxf", help="The drawing; default: INPUT.dxf."),
    ] = None,
    passes: Passes = None,
    diagnostics: DiagnosticsFormat = Report.TEXT,
    *,
    chosen: ReadOptions,
) -> None:
    """Draw a program or an OutQueue as DXF: rapids, feed moves and switch points on layers of their own.

    Of a program both stages are drawn: as programmed, and with --passes on layers with the suffix _PASSES as
    the passes changed it.
    """
    from nccompile.backend.dxf import DxfExport
    from nccompile.backend.files import write_file
    from nccompile.cli.dxf_stages import stages
    from nccompile.cli.outputs import keep_apart, output_of

    place = output_of(path, output, ".dxf")
    keep_apart([path, machine], [place])
    drawing = DxfExport()
    program = ProgramOptions(**vars(chosen), passes=passes)
    count = sum(drawing.add(chunks, suffix) for suffix, chunks in stages(path, machine, program, diagnostics))
    text = io.StringIO()
    drawing.write(text)
    write_file(place, text.getvalue().encode("utf-8", "surrogateescape"))
    print(f"{place}: {count} entities")
