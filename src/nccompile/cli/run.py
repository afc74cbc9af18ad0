"""`nccompile run`: an OutQueue or program on virtual drives."""

from __future__ import annotations

import sys
from contextlib import nullcontext
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nccompile.cli.options import CycleTime, DiagnosticsFormat, Input, MachineFile, ProgramOptions, Report
from nccompile.errors import UsageError

if TYPE_CHECKING:
    from nccompile.cli.inputs import Job
    from nccompile.machine.model import Machine
    from nccompile.runtime.task import Options

__all__ = ["run_program"]


class InterpolatorName(StrEnum):
    """Interpolators (docs/runtime.md)."""

    ONE_WAY = "one-way"
    TWO_WAY = "two-way"
    X = "x"


NEVER = "never"
LONGEST_DELAY = 86_400.0


@dataclass(frozen=True)
class RunOptions:
    """Options of the cyclic task, as they came from the command line."""

    realtime: Annotated[
        bool, typer.Option("--realtime", help="Cycles at their deadlines; default: as fast as it can.")
    ] = False
    override: Annotated[
        float,
        typer.Option(
            "--override", metavar="FACTOR", help="Factor on velocities, 0.01 to 10; two-way: from -10."
        ),
    ] = 1.0
    override_profile: Annotated[
        Path | None,
        typer.Option(
            "--override-profile", metavar="FILE", help="Override over time, CSV of seconds and factor."
        ),
    ] = None
    interpolator: Annotated[
        InterpolatorName,
        typer.Option(
            "--interpolator", help="two-way runs back at negative overrides; x follows a workpiece."
        ),
    ] = InterpolatorName.ONE_WAY
    x_velocity: Annotated[
        float | None, typer.Option("--x-velocity", metavar="MM/S", help="x: the workpiece moves so fast.")
    ] = None
    x_profile: Annotated[
        Path | None,
        typer.Option(
            "--x-profile", metavar="FILE", help="x: the workpiece over time, CSV of seconds and mm."
        ),
    ] = None
    x_offset: Annotated[
        float, typer.Option("--x-offset", metavar="MM", help="x: X of the path minus X of the workpiece.")
    ] = 0.0
    cycle_us: CycleTime = None
    m_delay: Annotated[
        str,
        typer.Option("--m-delay", metavar="SECONDS", help="Until an M function is acknowledged, or 'never'."),
    ] = "0"
    at: Annotated[
        list[str] | None,
        typer.Option(
            "--at", metavar="'TIME INPUT=VALUE'", help="An input at a time, '2.5s override=0.5'; repeatable."
        ),
    ] = None

    def follows_workpiece(self) -> bool:
        """Whether the workpiece is the clock; raises UsageError for options that do not go with that, or without."""
        follows = self.interpolator is InterpolatorName.X
        if not follows and (self.x_velocity, self.x_profile, self.x_offset) != (None, None, 0.0):
            raise UsageError("--x-velocity, --x-profile and --x-offset act with --interpolator x only")
        if follows and (
            self.realtime or self.at or self.override_profile is not None or self.override != 1.0
        ):
            raise UsageError(
                "with --interpolator x the workpiece is the clock: no override, --at or --realtime"
            )
        return follows

    def on(self, machine: Machine) -> Machine:
        """The machine with the cycle that is asked for."""
        if self.cycle_us is None:
            return machine
        identity = machine.identity.model_copy(update={"cycle_us": self.cycle_us})
        return machine.model_copy(update={"identity": identity})

    def resolve(self, job: Job) -> Options:
        """The options of the task for a job; raises UsageError."""
        from nccompile.passes.velocity.settings import LAWS
        from nccompile.runtime.interpolator import OVERRIDE_MAX, OVERRIDE_MIN
        from nccompile.runtime.profiles import overrides
        from nccompile.runtime.schedule import parse_command
        from nccompile.runtime.task import Options

        two_way = self.interpolator is InterpolatorName.TWO_WAY
        least = -OVERRIDE_MAX if two_way else OVERRIDE_MIN
        if not least <= self.override <= OVERRIDE_MAX:
            raise UsageError(f"--override {self.override:g}: it goes from {least:g} to {OVERRIDE_MAX:g}")
        commands = [parse_command(text, two_way=two_way) for text in self.at or ()]
        if self.override_profile is not None:
            commands += overrides(self.override_profile, least)
        return Options(
            realtime=self.realtime,
            override=self.override,
            commands=commands,
            m_delay=_delay(self.m_delay),
            vel_mode=LAWS[job.time_law],
            two_way=two_way,
            file=job.name,
        )


def run_program(
    path: Input,
    machine: MachineFile = None,
    *,
    how: RunOptions,
    trace: Annotated[
        Path | None, typer.Option("--trace", metavar="FILE", help="Every cycle as FILE.csv or FILE.npz.")
    ] = None,
    report: Annotated[
        Path | None, typer.Option("--report", metavar="FILE", help="The report as JSON, all events included.")
    ] = None,
    diagnostics: DiagnosticsFormat = Report.TEXT,
    chosen: ProgramOptions,
) -> None:
    """Run an OutQueue or program on virtual drives and print what happened."""
    from nccompile.backend.files import write_file
    from nccompile.cli.inputs import machine_of, open_job
    from nccompile.cli.outputs import keep_apart
    from nccompile.cli.run_report import finish_run, report_lines
    from nccompile.runtime.task import CyclicTask
    from nccompile.runtime.trace import open_trace
    from nccompile.runtime.x_task import XTask
    from nccompile.toolchain import machine_digest

    keep_apart([path, machine], [trace, report])
    axes = machine_of(machine)
    job = open_job(path, axes, chosen, diagnostics)
    if job.machine_sha256 != machine_digest(axes):
        print(f"note: {path} was planned for {job.machine}, it runs on {axes.name}", file=sys.stderr)
    axes, follows, options = how.on(axes), how.follows_workpiece(), how.resolve(job)
    with open_trace(trace) if trace is not None else nullcontext() as sink:
        if follows:
            result = XTask(
                job.chunks(), axes, how.x_velocity, how.x_profile, how.x_offset, sink, job.name
            ).run()
        else:
            result = CyclicTask(job.chunks(), axes, options, trace=sink).run()
    if report is not None:
        write_file(report, result.to_json().encode() + b"\n")
    for line in report_lines(result):
        print(line)
    finish_run(result, diagnostics)


def _delay(text: str) -> float | None:
    if text.strip().lower() == NEVER:
        return None
    try:
        seconds = float(text)
    except ValueError:
        seconds = -1.0
    if not 0 <= seconds <= LONGEST_DELAY:
        raise UsageError(f"--m-delay {text}: write seconds from 0 to {LONGEST_DELAY:g}, or '{NEVER}'")
    return seconds
