"""`nccompile sample`: set positions cycle by cycle, without a drive."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from nccompile.cli.options import CycleTime, DiagnosticsFormat, Input, MachineFile, ProgramOptions, Report

__all__ = ["sample"]


def sample(
    path: Input,
    machine: MachineFile = None,
    cycle_us: CycleTime = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="FILE.csv or FILE.npz; default: CSV on stdout."),
    ] = None,
    diagnostics: DiagnosticsFormat = Report.TEXT,
    *,
    chosen: ProgramOptions,
) -> None:
    """Write the set positions of every cycle: t, axes, path velocity, source line, status, switch word."""
    from nccompile.backend.samples import sample as sample_chunks
    from nccompile.backend.tables import write_samples, write_samples_csv
    from nccompile.cli.inputs import machine_of, open_job
    from nccompile.cli.outputs import keep_apart
    from nccompile.errors import UsageError
    from nccompile.kernels import expect_work
    from nccompile.passes.velocity.settings import LAWS
    from nccompile.units import seconds_from_us

    if output is not None and output.suffix.lower() not in (".csv", ".npz"):
        raise UsageError(f"{output}: samples are written as .csv or .npz")
    keep_apart([path, machine], [output])
    axes_of = machine_of(machine)
    job = open_job(path, axes_of, chosen, diagnostics)
    cycle = seconds_from_us(cycle_us or axes_of.cycle_us)
    expect_work(int(job.job_time / cycle))
    blocks = sample_chunks(job.chunks(), cycle, LAWS[job.time_law])
    if output is None:
        write_samples_csv(sys.stdout, job.axes, blocks)
        return
    rows = write_samples(output, job.axes, blocks)
    print(f"{output}: {rows} cycles of {cycle * 1e6:.0f} us, {rows * cycle:.3f} s", file=sys.stderr)
