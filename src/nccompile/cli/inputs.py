"""What a command works on: a part program, compiled in memory, or an OutQueue that was compiled before."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import typer

from nccompile.backend import ncq
from nccompile.cli.options import ProgramOptions, Report
from nccompile.cli.queues import STDIN, is_queue, read_queue, refuse_device, require_program
from nccompile.cli.report import report
from nccompile.errors import UsageError
from nccompile.machine.model import Machine, default_machine, load
from nccompile.source import Source, shown_path
from nccompile.toolchain import Compilation
from nccompile.toolpath import Toolpath

__all__ = [
    "Job",
    "compiled",
    "finish",
    "machine_of",
    "open_job",
    "read_program",
    "require_no_options",
]


@dataclass(frozen=True)
class Job:
    """A planned path ready to be run, sampled or drawn.

    name: of its file;  time_law: it was planned for;  chunks: the path from its
    start, each time it is called;  job_time [s];  segments: how many;  machine, machine_sha256: those it was
    planned for.
    """

    name: str
    axes: tuple[str, ...]
    time_law: str
    chunks: Callable[[], Iterator[Toolpath]]
    job_time: float
    segments: int
    machine: str
    machine_sha256: str


def machine_of(file: Path | None) -> Machine:
    """The machine of a file, or the built-in one; raises UsageError, MachineError."""
    if file is None:
        return default_machine()
    refuse_device(file, "a machine file")
    return load(file)


def read_program(path: Path) -> Source:
    """The program at a path, `-` for standard input; raises UsageError."""
    if path == STDIN:
        return Source.from_stream("<stdin>", sys.stdin.buffer)
    require_program(path)
    try:
        return Source.read(path)
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror or error}") from error


def open_job(path: Path, machine: Machine, options: ProgramOptions, form: Report) -> Job:
    """The planned path of an OutQueue or, compiled in memory, of a program.

    Raises: UsageError, QueueError;  typer.Exit(1): the program has errors, which have been reported.
    """
    if is_queue(path):
        require_no_options(path, options)
        queue = read_queue(path)
        totals, origin = queue.total, queue.meta.provenance
        return _job(shown_path(path), queue.axes, queue.chunks, totals.job_time, totals.segments, origin)
    compilation, held = compiled(path, machine, options, form, Compilation.planned)
    axes = held[0].axes if held else ("X", "Y", "Z")
    segments = sum(len(chunk) for chunk in held)
    name, seconds = compilation.source.name, compilation.time.seconds
    return _job(name, axes, lambda: iter(held), seconds, segments, compilation.provenance())


def require_no_options(queue: Path, options: ProgramOptions) -> None:
    """Raises UsageError for options that cannot act on an OutQueue."""
    if options.given:
        raise UsageError(f"{queue} is an OutQueue: {', '.join(options.given)} acts on programs only")


def _job(
    name: str,
    axes: tuple[str, ...],
    chunks: Callable[[], Iterator[Toolpath]],
    job_time: float,
    segments: int,
    origin: ncq.Provenance,
) -> Job:
    return Job(
        name, axes, origin.time_law, chunks, job_time, segments, origin.machine,
        origin.machine_sha256,
    )  # fmt: skip


def compiled(
    path: Path,
    machine: Machine,
    options: ProgramOptions,
    form: Report,
    stage: Callable[[Compilation], Iterator[Toolpath]],
) -> tuple[Compilation, list[Toolpath]]:
    """A program compiled in memory up to a stage; raises as `open_job` does."""
    compilation = Compilation(read_program(path), options.resolve(machine))
    held = list(stage(compilation))
    finish(compilation, form)
    return compilation, held


def finish(compilation: Compilation, form: Report) -> None:
    """Reports what was found; ends the command with exit code 1 if there are errors."""
    report(compilation.diagnostics, compilation.source, form)
    if compilation.diagnostics.errors:
        raise typer.Exit(1)
