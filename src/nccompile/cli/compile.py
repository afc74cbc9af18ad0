"""`nccompile compile`: a part program becomes an OutQueue."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nccompile.cli.options import DiagnosticsFormat, MachineFile, Report, StageOptions
from nccompile.errors import UsageError

if TYPE_CHECKING:
    from nccompile.backend.ncq import Meta
    from nccompile.toolchain import Compilation, Options
    from nccompile.toolpath import Toolpath

__all__ = ["compile_program"]


def compile_program(
    program: Annotated[Path, typer.Argument(help="The part program; - reads standard input.")],
    machine: MachineFile = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="The OutQueue; default: PROGRAM with .ncq."),
    ] = None,
    print_after: Annotated[
        str | None, typer.Option("--print-after", metavar="PASS", help="Print the path behind a pass.")
    ] = None,
    time_passes: Annotated[bool, typer.Option("--time-passes", help="Print the time of each pass.")] = False,
    diagnostics: DiagnosticsFormat = Report.TEXT,
    report: Annotated[
        Path | None, typer.Option("--report", metavar="FILE", help="Totals and diagnostics as JSON.")
    ] = None,
    *,
    chosen: StageOptions,
) -> None:
    """Compile a part program to an OutQueue; a program with errors leaves no file."""
    from nccompile.cli.inputs import finish, machine_of, read_program
    from nccompile.cli.outputs import keep_apart, output_of
    from nccompile.cli.progress import progress
    from nccompile.toolchain import Compilation

    source = read_program(program)
    place = output_of(program, output, ".ncq")
    keep_apart([program, machine], [place, report])
    options = replace(
        chosen.resolve(machine_of(machine)),
        losses=report is not None,
        measure=report is not None or time_passes,
    )
    if print_after is not None:
        options = replace(options, print_after=(_known(print_after, options), _print_chunk))
    compilation = Compilation(source, options)
    with progress(source):
        meta = compilation.write(place)
    if report is not None:
        _write_report(report, compilation, meta, place)
    if time_passes:
        _print_times(compilation)
    finish(compilation, diagnostics)
    assert meta is not None
    print(_summary(meta, compilation, place))


def _known(name: str, options: Options) -> str:
    """The name of a pass that runs; raises UsageError."""
    names = [p.name for p in options.passes.passes]
    if name not in names:
        raise UsageError(f"--print-after {name}: -p names no such pass, but {', '.join(names) or 'none'}")
    return name


def _print_chunk(chunk: Toolpath) -> None:
    from nccompile.toolpath.text import format_toolpath

    sys.stderr.write(format_toolpath(chunk))


def _print_times(compilation: Compilation) -> None:
    """One line a pass: time, segments in and out, largest deviation."""
    for report in compilation.options.passes.reports:
        off = "" if report.deviation is None else f", deviation {report.deviation:.3g} mm"
        print(
            f"{report.name:16} {report.seconds:8.3f} s  {report.segments_in} -> {report.segments_out} segments{off}",
            file=sys.stderr,
        )


def _summary(meta: Meta, compilation: Compilation, place: Path) -> str:
    totals = meta.totals
    warnings = sum(compilation.diagnostics.counts.values())
    segments = f"{totals.segments} segment{'s' * (totals.segments != 1)}"
    said = f", {warnings} warning{'s' * (warnings != 1)}" if warnings else ""
    return f"{place}: {segments}, {totals.length:.3f} mm, job time {totals.job_time:.3f} s{said}"


def _write_report(path: Path, compilation: Compilation, meta: Meta | None, place: Path) -> None:
    from nccompile.cli.outputs import write_json
    from nccompile.diagnostics import to_json
    from nccompile.source import shown_path

    content = {
        "program": compilation.source.name,
        "output": None if meta is None else shown_path(place),
        "errors": compilation.diagnostics.errors,
        "diagnostics": json.loads(to_json(compilation.diagnostics)),
        "counts": dict(sorted(compilation.diagnostics.counts.items())),
        "passes": [r.as_dict() for r in compilation.options.passes.reports],
        "queue": None if meta is None else meta.as_dict(),
        "velocity": None if compilation.time.losses is None else compilation.time.losses.as_dict(),
    }
    write_json(path, content)
