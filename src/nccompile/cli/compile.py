"""`nccompile compile`: a part program becomes an OutQueue."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nccompile.cli.options import (
    AngleTolerance,
    Define,
    DiagnosticsFormat,
    JunctionDeviation,
    MachineFile,
    MaxJumps,
    PlannerName,
    PlannerOption,
    Report,
    SkipBlocks,
    Start,
    TimeLawOption,
    Verify,
    Window,
)

if TYPE_CHECKING:
    from nccompile.backend.ncq import Meta
    from nccompile.toolchain import Compilation

__all__ = ["compile_program"]


def compile_program(
    program: Annotated[Path, typer.Argument(help="The part program; - reads standard input.")],
    machine: MachineFile = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="The OutQueue; default: PROGRAM with .ncq."),
    ] = None,
    start: Start = None,
    define: Define = None,
    skip_blocks: SkipBlocks = False,
    max_jumps: MaxJumps = None,
    angle_tolerance: AngleTolerance = None,
    time_law: TimeLawOption = None,
    planner: PlannerOption = PlannerName.LOOK_AHEAD,
    window: Window = None,
    junction_deviation: JunctionDeviation = None,
    verify: Verify = False,
    diagnostics: DiagnosticsFormat = Report.TEXT,
    report: Annotated[
        Path | None, typer.Option("--report", metavar="FILE", help="Totals and diagnostics as JSON.")
    ] = None,
) -> None:
    """Compile a part program to an OutQueue; a program with errors leaves no file."""
    from nccompile.cli.inputs import ProgramOptions, finish, machine_of, output_of, read_program
    from nccompile.cli.progress import progress
    from nccompile.toolchain import Compilation

    source = read_program(program)
    place = output_of(program, output, ".ncq")
    settings = ProgramOptions(
        start, define, skip_blocks, max_jumps, angle_tolerance, time_law, verify,
        planner if planner != PlannerName.LOOK_AHEAD else None, window, junction_deviation,
    )  # fmt: skip
    options = settings.resolve(machine_of(machine))
    compilation = Compilation(source, options)
    with progress(source):
        meta = compilation.write(place)
    if report is not None:
        _write_report(report, compilation, meta, place)
    finish(compilation, diagnostics)
    assert meta is not None
    print(_summary(meta, compilation, place))


def _summary(meta: Meta, compilation: Compilation, place: Path) -> str:
    totals = meta.totals
    warnings = sum(compilation.diagnostics.counts.values())
    segments = f"{totals.segments} segment{'s' * (totals.segments != 1)}"
    said = f", {warnings} warning{'s' * (warnings != 1)}" if warnings else ""
    return f"{place}: {segments}, {totals.length:.3f} mm, job time {totals.job_time:.3f} s{said}"


def _write_report(path: Path, compilation: Compilation, meta: Meta | None, place: Path) -> None:
    from nccompile.backend.files import replacing
    from nccompile.diagnostics import to_json

    content = {
        "program": compilation.source.name,
        "output": None if meta is None else str(place),
        "errors": compilation.diagnostics.errors,
        "diagnostics": json.loads(to_json(compilation.diagnostics)),
        "counts": dict(sorted(compilation.diagnostics.counts.items())),
        "queue": None if meta is None else meta.as_dict(),
    }
    with replacing(path) as (file, commit):
        file.write((json.dumps(content, indent=1, ensure_ascii=False) + "\n").encode())
        commit()
