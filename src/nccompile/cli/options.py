"""Options that several subcommands share, and the parsing of their values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nccompile.errors import UsageError

if TYPE_CHECKING:
    from nccompile.decoder import DecodeOptions
    from nccompile.machine.model import Machine
    from nccompile.toolchain import Options

__all__ = [
    "AngleTolerance",
    "CycleTime",
    "Define",
    "DiagnosticsFormat",
    "Input",
    "JunctionDeviation",
    "MachineFile",
    "MaxJumps",
    "Passes",
    "PlannerName",
    "PlannerOption",
    "ProgramOptions",
    "ReadOptions",
    "Report",
    "SkipBlocks",
    "StageOptions",
    "Start",
    "TimeLaw",
    "TimeLawOption",
    "Verify",
    "Window",
    "parse_defines",
    "parse_start",
]


class TimeLaw(StrEnum):
    """Velocity profiles (SoftMotion §6.2.8)."""

    TRAPEZOID = "trapezoid"
    SIGMOID = "sigmoid"
    PARABOLIC = "parabolic"


class PlannerName(StrEnum):
    """Planners of the velocity (docs/planning.md)."""

    SOFTMOTION = "softmotion"
    LOOK_AHEAD = "look-ahead"
    JERK = "jerk"
    TIME_OPTIMAL = "time-optimal"


class Report(StrEnum):
    """How diagnostics are written to standard error."""

    TEXT = "text"
    JSON = "json"


Input = Annotated[Path, typer.Argument(metavar="QUEUE|PROGRAM", help="An OutQueue (.ncq) or a part program.")]
MachineFile = Annotated[
    Path | None,
    typer.Option(
        "--machine", "-m", metavar="FILE", help="Machine file; default: a machine without limits of travel."
    ),
]
Start = Annotated[
    str | None,
    typer.Option("--start", metavar="X0,Y0,..", help="Position before the first block; default: 0."),
]
Define = Annotated[
    list[str] | None, typer.Option("--define", metavar="NAME=VALUE", help="A variable $NAME$; repeatable.")
]
SkipBlocks = Annotated[bool, typer.Option("--skip-blocks", help="Leave out blocks that start with '/'.")]
MaxJumps = Annotated[
    int | None,
    typer.Option(
        "--max-jumps", metavar="N", min=1, help="Jumps (G20) until a loop counts as endless; default: 10000."
    ),
]
AngleTolerance = Annotated[
    float | None,
    typer.Option(
        "--angle-tolerance",
        metavar="DEG",
        min=0.0,
        max=180.0,
        help="Bend up to which the path does not stop.",
    ),
]
TimeLawOption = Annotated[
    TimeLaw | None, typer.Option("--time-law", help="Velocity profile; default: the machine's.")
]
PlannerOption = Annotated[
    PlannerName | None, typer.Option("--planner", help="How velocities are planned; default: look-ahead.")
]
Window = Annotated[
    int | None,
    typer.Option("--window", metavar="N", min=0, help="Segments looked ahead, 0 for all; default: 30000."),
]
JunctionDeviation = Annotated[
    float | None,
    typer.Option(
        "--junction-deviation", metavar="MM", min=1e-6, max=10.0, help="How far a corner may be rounded."
    ),
]
Passes = Annotated[
    str | None,
    typer.Option(
        "--passes",
        "-p",
        metavar="SPEC",
        help="Path passes, e.g. tool-radius{radius=3},fit-arcs{tolerance=0.005}.",
    ),
]
Verify = Annotated[bool, typer.Option("--verify", help="Check the toolpath after every stage.")]
DiagnosticsFormat = Annotated[Report, typer.Option("--diagnostics", help="Diagnostics as text or JSON.")]
CycleTime = Annotated[
    int | None,
    typer.Option("--cycle-us", metavar="US", min=100, max=100_000, help="Default: the machine's cycle."),
]


@dataclass(frozen=True)
class ReadOptions:
    """Options that act while a program is read, as they came from the command line."""

    start: Start = None
    define: Define = None
    skip_blocks: SkipBlocks = False
    max_jumps: MaxJumps = None

    def decoding(self, machine: Machine) -> DecodeOptions:
        """The options of the decoder; raises UsageError."""
        from nccompile.decoder import DecodeOptions

        return DecodeOptions(
            start=parse_start(self.start),
            defines=parse_defines(self.define),
            skip_blocks=self.skip_blocks,
            max_switches=machine.path.max_switches,
            max_jumps=DecodeOptions.max_jumps if self.max_jumps is None else self.max_jumps,
        )

    def resolve(self, machine: Machine) -> Options:
        """The options of a compilation; raises UsageError."""
        from nccompile.toolchain import Options

        return Options(machine, self.decoding(machine))

    @property
    def given(self) -> list[str]:
        """The options in use, as they are spelt."""
        return ["--" + name.replace("_", "-") for name, value in vars(self).items() if value]


@dataclass(frozen=True)
class ProgramOptions(ReadOptions):
    """Options that act while a program is compiled; `verify` is one only of commands that check the stages."""

    angle_tolerance: AngleTolerance = None
    time_law: TimeLawOption = None
    verify: bool = False
    planner: PlannerOption = None
    window: Window = None
    junction_deviation: JunctionDeviation = None
    passes: Passes = None

    def resolve(self, machine: Machine) -> Options:
        """The options of a compilation; raises UsageError."""
        from nccompile.passes.pipeline import Pipeline
        from nccompile.passes.velocity import LOOK_AHEAD, WINDOW
        from nccompile.toolchain import Options

        passes = Pipeline()
        if self.passes:
            from nccompile.passes.option import parse

            passes = parse(self.passes)
        return Options(
            machine, self.decoding(machine), self.angle_tolerance, self.time_law, self.verify,
            self.planner or LOOK_AHEAD, WINDOW if self.window is None else self.window or None,
            self.junction_deviation, passes=passes,
        )  # fmt: skip


@dataclass(frozen=True)
class StageOptions(ProgramOptions):
    """The same with `--verify`."""

    verify: Verify = False


def parse_start(text: str | None) -> dict[str, float]:
    """`X0,Y10.5` as positions by axis letter; raises UsageError."""
    from nccompile.toolpath import AXIS_LETTERS

    start: dict[str, float] = {}
    for part in (text or "").split(",") if text else []:
        word = part.strip().upper()
        if word[:1] not in tuple(AXIS_LETTERS) or word[:1] in start:
            raise UsageError(f"--start {text}: {part!r} is not an axis letter with a number, as in X0,Y10.5")
        start[word[0]] = _number(word[1:].removeprefix("="), f"--start {text}")
    return start


def parse_defines(texts: Sequence[str] | None) -> dict[str, float]:
    """`NAME=VALUE` texts as values by name; raises UsageError."""
    values: dict[str, float] = {}
    for text in texts or ():
        name, equals, value = text.partition("=")
        name = name.strip().strip("$")
        if not equals or not name:
            raise UsageError(f"--define {text}: write NAME=VALUE")
        values[name] = _number(value, f"--define {text}")
    return values


def _number(text: str, where: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not isfinite(value):
        raise UsageError(f"{where}: {text!r} is not a number")
    return value
