"""The stages in plain order, from program text to OutQueue; reading this file is reading the product.

    source -> decode -> passes -> check_marks, check_axes, check_travel -> plan -> write | run | sample | plot

Every stage is a generator over chunks: a program of any length passes through in bounded memory, and
whoever pulls at the end (a file, a cyclic task, a plot) drives the ones before it.  Findings in the user's
program are collected in `Diagnostics`; a program with errors leaves no file and is not run.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

from nccompile.backend import ncq
from nccompile.decoder import Decoded, DecodeOptions, decode
from nccompile.diagnostics import Diagnostics, Severity
from nccompile.machine.limits import check_axes, check_travel
from nccompile.machine.model import Machine
from nccompile.passes.check_marks import check_marks
from nccompile.passes.pipeline import Pipeline
from nccompile.passes.velocity import LOOK_AHEAD, SOFTMOTION, TIME_OPTIMAL, WINDOW, PlanSettings
from nccompile.source import LargeSource, Source
from nccompile.threads import ahead
from nccompile.toolpath import Toolpath
from nccompile.toolpath.verify import verify_chain

if TYPE_CHECKING:
    from nccompile.passes.velocity.losses import Losses

__all__ = ["Compilation", "Given", "JobTime", "Options", "machine_digest"]


@dataclass(frozen=True)
class Options:
    """What a compilation needs besides the program.

    decoder: start position, variables, skipped blocks, jump limit;  angle_tolerance [deg] and time_law: those
    of the machine if None;  verify: check the invariants of the toolpath after every stage;  planner: one of
    `PLANNERS`, window: rows it looks ahead, None for all, junction_deviation [mm] (`PlanSettings`);  losses: gather
    where the time goes;  passes: path passes between decoding and planning;  print_after: name of a pass, and what
    takes the chunks it makes;  measure: whether passes measure their deviation.
    """

    machine: Machine
    decoder: DecodeOptions = field(default_factory=DecodeOptions)
    angle_tolerance: float | None = None
    time_law: str | None = None
    verify: bool = False
    planner: str = LOOK_AHEAD
    window: int | None = WINDOW
    junction_deviation: float | None = None
    losses: bool = False
    passes: Pipeline = field(default_factory=Pipeline)
    print_after: tuple[str, Callable[[Toolpath], None]] | None = None
    measure: bool = False


@dataclass(frozen=True)
class Given:
    """A toolpath as programmed that comes from elsewhere: from a drawing, or decoded before.

    axes: those of its chunks;  chunks: at least one, from the start at each call.
    """

    axes: tuple[str, ...]
    chunks: Callable[[], Iterator[Toolpath]]

    def __iter__(self) -> Iterator[Toolpath]:
        return self.chunks()


@dataclass
class JobTime:
    """Adds up the time of planned chunks on their way."""

    seconds: float = 0.0
    losses: Losses | None = None
    _velocity: float = 0.0

    def along(self, chunks: Iterable[Toolpath]) -> Iterator[Toolpath]:
        """Hands chunks on and counts their time at override 1; M functions count as acknowledged at once."""
        from nccompile.passes.velocity.planner import row_times  # noqa: PLC0415 - as in `planned`

        for chunk in chunks:
            if len(chunk):
                if self.losses is not None:
                    self.losses.add(chunk, self._velocity)
                assert chunk.v_end is not None
                self.seconds += float(row_times(chunk, self._velocity).sum())
                self._velocity = float(chunk.v_end[-1])
            yield chunk


class Compilation:
    """One program on its way through the stages; `diagnostics` and `time` fill while its chunks are pulled."""

    def __init__(
        self,
        source: Source,
        options: Options,
        wanted: Callable[[], bool] | None = None,
        given: Given | None = None,
    ) -> None:
        """`wanted` is asked between jumps of the program; if it says no, decoding ends with `Cancelled`.

        given: what is compiled instead of decoding the source.
        """
        self.source = source
        self._wanted = wanted
        self._given = given
        self.options = options
        self.diagnostics = Diagnostics()
        self.time = JobTime()

    @property
    def time_law(self) -> str:
        """The velocity profile that is planned."""
        if self.options.planner == TIME_OPTIMAL:
            return "trapezoid"  # it uses all of the acceleration: another law would exceed it
        return self.options.time_law or self.options.machine.path.time_law

    @property
    def angle_tolerance(self) -> float:
        """The bend up to which the path does not stop [deg]."""
        given = self.options.angle_tolerance
        return self.options.machine.path.angle_tolerance if given is None else given

    def decoded(self) -> Iterator[Toolpath]:
        """The toolpath as programmed, without velocities, checked against axes and travel of the machine."""
        return self._checked(self._verified(self._program()))

    def passed(self) -> Iterator[Toolpath]:
        """The toolpath behind the path passes, without velocities, checked as `decoded`."""
        return self._checked(self._passed(self._program()))

    def planned(self) -> Iterator[Toolpath]:
        """The toolpath with its velocities; pulling it counts its time."""
        # The linter plans nothing and starts without the planner.
        from nccompile.passes.velocity.excess import check_excess  # noqa: PLC0415
        from nccompile.passes.velocity.losses import Losses  # noqa: PLC0415
        from nccompile.passes.velocity.planner import plan  # noqa: PLC0415

        program = self._program()
        settings = PlanSettings.from_machine(
            self.options.machine,
            program.axes,
            angle_tolerance_deg=self.angle_tolerance,
            time_law=self.time_law,
            planner=self.options.planner,
            window=self.options.window,
            junction_deviation=self.options.junction_deviation,
        )
        self.time.losses = Losses(settings) if self.options.losses else None
        planned = plan(self._checked(self._passed(program)), settings)
        if settings.planner == SOFTMOTION:
            planned = check_excess(planned, settings, self.source, self.diagnostics)
        return self.time.along(self._verified(planned))

    def write(self, path: Path) -> ncq.Meta | None:
        """Writes the OutQueue; no file is left, and None returned, if the program has errors."""
        if isinstance(self.source, LargeSource):
            self.source.hash_ahead()
        chunks = self.planned()
        if isinstance(self.source, LargeSource):
            chunks = ahead(chunks)  # the next chunks are made while this one is written
        return ncq.write(
            path,
            chunks,
            self.provenance(),
            job_time=lambda: self.time.seconds,
            keep=lambda: not self.diagnostics.errors,
        )

    def provenance(self) -> ncq.Provenance:
        """What the queue says of its origin; names go without folders."""
        return ncq.Provenance(
            source=PurePath(self.source.name).name,
            source_sha256=self.source.sha256,
            machine=self.options.machine.name,
            machine_sha256=machine_digest(self.options.machine),
            angle_tolerance=self.angle_tolerance,
            time_law=self.time_law,
        )

    def _program(self) -> Decoded | Given:
        if self._given is not None:
            return self._given
        return decode(self.source, self.options.decoder, self.diagnostics, self._wanted)

    def _verified(self, chunks: Iterable[Toolpath]) -> Iterator[Toolpath]:
        return verify_chain(chunks) if self.options.verify else iter(chunks)

    def _passed(self, program: Iterable[Toolpath]) -> Iterator[Toolpath]:
        """The program behind all passes, each verified and printed if that was asked for."""
        options = self.options
        return options.passes.run(
            self._verified(program), feed=options.machine.path.feed, diagnose=self._diagnose,
            after=self._behind, measure=options.measure,
        )  # fmt: skip

    def _behind(self, name: str, chunks: Iterator[Toolpath]) -> Iterator[Toolpath]:
        wanted = self.options.print_after
        for chunk in self._verified(chunks):
            if wanted is not None and wanted[0] == name:
                wanted[1](chunk)
            yield chunk

    def _diagnose(self, code: str, severity: Severity, message: str, line: int, help: str) -> None:
        self.diagnostics.report_line(code, severity, message, self.source, line, help)

    def _checked(self, chunks: Iterable[Toolpath]) -> Iterator[Toolpath]:
        for chunk in check_marks(chunks, self.source, self.diagnostics):
            check_axes(chunk, self.options.machine, self.source, self.diagnostics)
            check_travel(chunk, self.options.machine, self.source, self.diagnostics)
            yield chunk


def machine_digest(machine: Machine) -> str:
    """SHA-256 of what a machine says beyond the defaults, whatever its file looks like (order, comments)."""
    content = machine.model_dump(mode="json", by_alias=True, exclude_defaults=True)
    return hashlib.sha256(json.dumps(content, sort_keys=True, separators=(",", ":")).encode()).hexdigest()
