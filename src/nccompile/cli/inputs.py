"""What a command works on: a part program, compiled in memory, or an OutQueue that was compiled before."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import typer

from nccompile.backend import ncq
from nccompile.cli.options import Report, parse_defines, parse_start
from nccompile.cli.queues import STDIN, is_queue, read_queue
from nccompile.cli.report import report
from nccompile.decoder import DecodeOptions
from nccompile.errors import UsageError
from nccompile.machine.model import Machine, default_machine, load
from nccompile.passes.pipeline import parse as parse_passes
from nccompile.passes.velocity import LOOK_AHEAD, WINDOW
from nccompile.source import Source
from nccompile.toolchain import Compilation, Options
from nccompile.toolpath import Toolpath

__all__ = [
    "Job",
    "ProgramOptions",
    "compiled",
    "finish",
    "machine_of",
    "open_job",
    "output_of",
    "read_program",
]


@dataclass(frozen=True)
class ProgramOptions:
    """Options that act on a program while it is compiled, as they came from the command line."""

    start: str | None = None
    define: list[str] | None = None
    skip_blocks: bool = False
    max_jumps: int | None = None
    angle_tolerance: float | None = None
    time_law: str | None = None
    verify: bool = False
    planner: str | None = None
    window: int | None = None
    junction_deviation: float | None = None
    passes: str | None = None

    def resolve(self, machine: Machine) -> Options:
        """The options of a compilation; raises UsageError."""
        decoder = DecodeOptions(
            start=parse_start(self.start),
            defines=parse_defines(self.define),
            skip_blocks=self.skip_blocks,
            max_switches=machine.path.max_switches,
            max_jumps=DecodeOptions.max_jumps if self.max_jumps is None else self.max_jumps,
        )
        return Options(
            machine, decoder, self.angle_tolerance, self.time_law, self.verify, self.planner or LOOK_AHEAD,
            WINDOW if self.window is None else self.window or None, self.junction_deviation,
            passes=parse_passes(self.passes or ""),
        )  # fmt: skip

    @property
    def given(self) -> list[str]:
        """The options in use, as they are spelt."""
        return ["--" + name.replace("_", "-") for name, value in vars(self).items() if value]


@dataclass(frozen=True)
class Job:
    """A planned path ready to be run, sampled or drawn.

    name: of its file;  time_law and smoothing [s]: it was planned for;  chunks: the path from its
    start, each time it is called;  job_time [s];  segments: how many;  machine, machine_sha256: those it was
    planned for.
    """

    name: str
    axes: tuple[str, ...]
    time_law: str
    smoothing: float
    chunks: Callable[[], Iterator[Toolpath]]
    job_time: float
    segments: int
    machine: str
    machine_sha256: str


def machine_of(file: Path | None) -> Machine:
    """The machine of a file, or the built-in one; raises MachineError."""
    return default_machine() if file is None else load(file)


def read_program(path: Path) -> Source:
    """The program at a path, `-` for standard input; raises UsageError."""
    if path == STDIN:
        return Source.from_stream("<stdin>", sys.stdin.buffer)
    if is_queue(path):
        raise UsageError(f"{path} is an OutQueue, not a part program: it was compiled already")
    if path.is_char_device() or path.is_block_device():
        raise UsageError(f"{path} is a device, not a part program; - reads standard input")
    try:
        return Source.read(path)
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror or error}") from error


def open_job(path: Path, machine: Machine, options: ProgramOptions, form: Report) -> Job:
    """The planned path of an OutQueue or, compiled in memory, of a program.

    Raises: UsageError, QueueError;  typer.Exit(1): the program has errors, which have been reported.
    """
    if path != STDIN and is_queue(path):
        if options.given:
            raise UsageError(f"{path} is an OutQueue: {', '.join(options.given)} acts on programs only")
        queue = read_queue(path)
        totals, origin = queue.total, queue.meta.provenance
        return _job(str(path), queue.axes, queue.chunks, totals.job_time, totals.segments, origin)
    compilation, held = compiled(path, machine, options, form, Compilation.planned)
    axes = held[0].axes if held else ("X", "Y", "Z")
    segments = sum(len(chunk) for chunk in held)
    name, seconds = compilation.source.name, compilation.time.seconds
    return _job(name, axes, lambda: iter(held), seconds, segments, compilation.provenance())


def _job(
    name: str,
    axes: tuple[str, ...],
    chunks: Callable[[], Iterator[Toolpath]],
    job_time: float,
    segments: int,
    origin: ncq.Provenance,
) -> Job:
    return Job(
        name, axes, origin.time_law, origin.smoothing, chunks, job_time, segments, origin.machine,
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


def output_of(path: Path, output: Path | None, suffix: str) -> Path:
    """The output file: as given, or named after the input; raises UsageError where that cannot be."""
    if output is None and path == STDIN:
        raise UsageError("name the output with -o when the program comes from standard input")
    if output is None and not path.name:
        raise UsageError(f"{path} cannot be read: Is a directory")
    place = path.with_suffix(suffix) if output is None else output
    if place.exists() and path.exists() and place.samefile(path):
        raise UsageError(f"{place} is the input: name another output with -o")
    return place


def finish(compilation: Compilation, form: Report) -> None:
    """Reports what was found; ends the command with exit code 1 if there are errors."""
    report(compilation.diagnostics, compilation.source, form)
    if compilation.diagnostics.errors:
        raise typer.Exit(1)
