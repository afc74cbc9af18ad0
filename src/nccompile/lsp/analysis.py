"""What is known of one version of a document: findings, fixes, toolpath, and times if it was planned."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from nccompile.decoder import DecodeOptions
from nccompile.errors import Cancelled, NccompileError
from nccompile.lint.config import Config
from nccompile.lint.engine import Report, lint
from nccompile.lint.program import Program
from nccompile.machine.model import Machine
from nccompile.parser import ReadSource
from nccompile.passes.velocity.planner import row_times
from nccompile.toolchain import Compilation, Given, Options
from nccompile.toolpath import Toolpath
from nccompile.toolpath.columns import Floats, Ints

__all__ = ["Analysis", "Settings", "Times", "analyse", "timed"]


Places: TypeAlias = npt.NDArray[np.intp]


@dataclass(frozen=True)
class Settings:
    """What a program is checked against."""

    config: Config
    machine: Machine

    @property
    def options(self) -> Options:
        """As the command line makes them."""
        return Options(self.machine, DecodeOptions(max_switches=self.machine.path.max_switches))


@dataclass(frozen=True)
class Times:
    """The planned time of every segment [s], shape (n,), and their source lines, shape (n,)."""

    seconds: Floats
    lines: Ints

    @property
    def total(self) -> float:
        """The time of the whole path [s]; M functions count as acknowledged at once."""
        return float(self.seconds.sum())


@dataclass
class Analysis:
    """One version, checked; `times` comes later, and only if the program has no errors."""

    version: int
    report: Report
    settings: Settings
    times: Times | None = None

    @property
    def program(self) -> Program:
        """The program as the rules saw it."""
        return self.report.program

    @property
    def is_sound(self) -> bool:
        """Whether its toolpath can be used."""
        return not self.report.diagnostics.errors

    @cached_property
    def path(self) -> Toolpath:
        """The toolpath as decoded."""
        return self.program.path

    @cached_property
    def distance_modes(self) -> list[tuple[int, int]]:
        """(line, G code) of every G90 and G91 in written order."""
        program = self.program
        return [(program.blocks[at].line, code) for at, code in program.instructions(90, 91)]

    @cached_property
    def _first_passes(self) -> tuple[Places, Places, Places]:
        """The source lines that have segments, rising, and begin and end of the segments of their first pass."""
        lines = self.path.line
        begins = np.flatnonzero(np.diff(lines, prepend=-1))
        ends = np.append(begins[1:], np.intp(len(lines)))
        found, first = np.unique(lines[begins].astype(np.intp), return_index=True)
        return found, begins[first], ends[first]

    def rows(self, line: int) -> range:
        """The segments of a source line, from 1: those of its first pass if it runs several times."""
        lines, begins, ends = self._first_passes
        at = int(np.searchsorted(lines, line))
        return range(int(begins[at]), int(ends[at])) if at < len(lines) and lines[at] == line else range(0)


def analyse(source: ReadSource, version: int, settings: Settings, wanted: Callable[[], bool]) -> Analysis:
    """Checks one version; raises Cancelled if it is not wanted any more."""
    report = lint(source, settings.options, settings.config, wanted=wanted)
    return Analysis(version, report, settings)


def timed(analysis: Analysis, wanted: Callable[[], bool]) -> Times | None:
    """The times of a checked program; None if it has errors or cannot be planned.  Raises Cancelled."""
    program = analysis.program
    if not analysis.is_sound or not program.chunks:
        return None
    path = Given(program.chunks[0].axes, lambda: iter(program.chunks))
    compilation = Compilation(program.source, analysis.settings.options, wanted, path)
    seconds, lines = [], []
    velocity = 0.0
    try:
        for chunk in compilation.planned():
            if not wanted():
                raise Cancelled
            if len(chunk) and chunk.v_end is not None:
                seconds.append(row_times(chunk, velocity))
                lines.append(chunk.line)
                velocity = float(chunk.v_end[-1])
    except NccompileError:
        return None  # the command line says why; an editor without times is still an editor
    if not seconds:
        return None
    return Times(np.concatenate(seconds), np.concatenate(lines))
