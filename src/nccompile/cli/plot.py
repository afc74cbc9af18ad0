"""`nccompile plot`: a picture of the path and of its course over time."""

from __future__ import annotations

from math import ceil
from pathlib import Path
from typing import Annotated

import typer

from nccompile.cli.options import DiagnosticsFormat, Input, MachineFile, ProgramOptions, Report

__all__ = ["plot"]

MOST_SAMPLES = 200_000
"""Cycles that are drawn; a longer job is sampled more coarsely, as the picture has fewer columns anyway."""


def plot(
    path: Input,
    machine: MachineFile = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help=".png, .svg or .pdf; default: INPUT.png."),
    ] = None,
    diagnostics: DiagnosticsFormat = Report.TEXT,
    *,
    chosen: ProgramOptions,
) -> None:
    """Draw the path, and velocity, acceleration and jerk over time."""
    from nccompile.backend.samples import sample
    from nccompile.cli.inputs import machine_of, open_job, read_program
    from nccompile.cli.outputs import keep_apart, output_of, require_picture
    from nccompile.kernels import expect_work
    from nccompile.machine.limits import limits
    from nccompile.passes.velocity.planner import row_times
    from nccompile.passes.velocity.settings import LAWS
    from nccompile.toolchain import Compilation
    from nccompile.view.motion import caps, gather
    from nccompile.view.plot import save

    place = output_of(path, output, ".png")
    keep_apart([path, machine], [place])
    require_picture(place)
    axes_of = machine_of(machine)
    job = open_job(path, axes_of, chosen, diagnostics)
    cycle = axes_of.cycle * max(1, ceil(job.job_time / axes_of.cycle / MOST_SAMPLES))
    expect_work(int(job.job_time / cycle))
    motion = gather(job.axes, sample(job.chunks(), cycle, LAWS[job.time_law]))
    title = f"{job.name}: {job.segments} segments, {job.job_time:.3f} s"
    before = None
    if chosen.passes and path.is_file():  # a pipe cannot be read again
        before = Compilation(read_program(path), chosen.resolve(axes_of)).decoded()
    bounds = caps(job.chunks(), row_times)
    save(place, job.chunks(), motion, limits(axes_of, job.axes), bounds, title=title, before=before)
    print(f"{place}: path, and velocity, acceleration and jerk over {job.job_time:.3f} s")
