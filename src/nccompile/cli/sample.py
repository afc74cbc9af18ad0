"""`nccompile sample`: set positions cycle by cycle, without a drive."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from nccompile.cli.options import (
    AngleTolerance,
    Define,
    DiagnosticsFormat,
    Input,
    JunctionDeviation,
    MachineFile,
    MaxJumps,
    Passes,
    PlannerName,
    PlannerOption,
    Report,
    SkipBlocks,
    Start,
    TimeLawOption,
    Window,
)

__all__ = ["sample"]


def sample(
    path: Input,
    machine: MachineFile = None,
    cycle_us: Annotated[
        int | None,
        typer.Option("--cycle-us", metavar="US", min=100, max=100_000, help="Default: the machine's cycle."),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="FILE.csv or FILE.npz; default: CSV on stdout."),
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
    passes: Passes = None,
    diagnostics: DiagnosticsFormat = Report.TEXT,
) -> None:
    """Write the set positions of every cycle: t, axes, path velocity, source line, status, switch word."""
    from nccompile.backend.samples import sample as sample_chunks
    from nccompile.backend.tables import write_samples, write_samples_csv
    from nccompile.cli.inputs import ProgramOptions, machine_of, open_job
    from nccompile.errors import UsageError
    from nccompile.kernels import expect_work
    from nccompile.passes.velocity.settings import LAWS
    from nccompile.units import seconds_from_us

    if output is not None and output.suffix.lower() not in (".csv", ".npz"):
        raise UsageError(f"{output}: samples are written as .csv or .npz")
    axes_of = machine_of(machine)
    options = ProgramOptions(
        start, define, skip_blocks, max_jumps, angle_tolerance, time_law, False,
        planner if planner != PlannerName.LOOK_AHEAD else None, window, junction_deviation, passes,
    )  # fmt: skip
    job = open_job(path, axes_of, options, diagnostics)
    cycle = seconds_from_us(cycle_us or axes_of.cycle_us)
    expect_work(int(job.job_time / cycle))
    blocks = sample_chunks(job.chunks(), cycle, LAWS[job.time_law])
    if output is None:
        write_samples_csv(sys.stdout, job.axes, blocks)
        return
    rows = write_samples(output, job.axes, blocks)
    print(f"{output}: {rows} cycles of {cycle * 1e6:.0f} us, {rows * cycle:.3f} s", file=sys.stderr)
