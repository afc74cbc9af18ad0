"""What a run did: peaks against limits, end position, switches, M functions, faults, jitter."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from nccompile.diagnostics import Diagnostics
from nccompile.machine.limits import limits
from nccompile.machine.model import Machine
from nccompile.runtime.clock import Jitter
from nccompile.toolpath.columns import Floats

__all__ = ["AxisReport", "FaultEntry", "Log", "MEntry", "Monitor", "RunReport", "SwitchEntry"]

LOGGED = 100_000
"""Entries that a log keeps; later ones are only counted, so that memory stays bounded."""

T = TypeVar("T")


class SwitchEntry(NamedTuple):
    """A switch was passed: time [s], number (> 0 on, < 0 off), source line, path position [mm or deg]."""

    time: float
    number: int
    line: int
    position: tuple[float, ...]


class MEntry(NamedTuple):
    """An M function was reached: time [s], number, its words K, L, O, source line, seconds until acknowledged."""

    time: float
    number: int
    k: float
    l: float  # noqa: E741 - the word letter of the language
    o: str
    line: int
    waited: float


class FaultEntry(NamedTuple):
    """A drive faulted: time [s], axis letter, what was exceeded, value, limit [mm or deg, s], source line."""

    time: float
    axis: str
    code: str
    value: float
    limit: float
    line: int


@dataclass
class Log(Generic[T]):
    """The first entries of something, and how many there were."""

    entries: list[T] = field(default_factory=list)
    count: int = 0

    def add(self, entry: T) -> None:
        """Records an entry, or only counts it if the log is full."""
        self.count += 1
        if len(self.entries) < LOGGED:
            self.entries.append(entry)


@dataclass(frozen=True)
class AxisReport:
    """One axis: peaks of the set positions' differences against the limits, in mm (or deg) and seconds.

    The acceleration limit is that of the drive: acceleration + velocity_step / cycle (a junction's jump of
    velocity falls into one cycle).  A ratio above 1 is a limit exceeded.
    """

    axis: str
    unit: str
    peak_velocity: float
    velocity_limit: float
    velocity_ratio: float
    peak_acceleration: float
    acceleration_limit: float
    acceleration_ratio: float
    max_following_error: float
    end_position: float


@dataclass
class RunReport:
    """The result of a run.

    outcome: "finished", "aborted" (input abort), "stopped" (a stop that nothing releases, an M function that
    nothing acknowledges) or "fault";  cycles, job_time [s]: until the end, standstills included;
    end_position: path position by axis letter;  faults, switches, m_functions: logs in order of time;
    underruns: cycles in which the interpolator braked or waited for data;  jitter: real time only.
    """

    machine: str
    cycle: float
    outcome: str = "finished"
    cycles: int = 0
    axes: list[AxisReport] = field(default_factory=list)
    end_position: dict[str, float] = field(default_factory=dict)
    switches: Log[SwitchEntry] = field(default_factory=Log)
    m_functions: Log[MEntry] = field(default_factory=Log)
    faults: list[FaultEntry] = field(default_factory=list)
    underruns: int = 0
    jitter: Jitter | None = None
    diagnostics: Diagnostics = field(default_factory=Diagnostics)

    @property
    def job_time(self) -> float:
        """Time from the first to the last cycle [s]."""
        return max(0, self.cycles - 1) * self.cycle

    def to_json(self) -> str:
        """The report as a JSON object; keys are the attributes' names."""
        return json.dumps(
            {
                "machine": self.machine,
                "outcome": self.outcome,
                "cycle": self.cycle,
                "cycles": self.cycles,
                "job_time": self.job_time,
                "axes": [asdict(axis) for axis in self.axes],
                "end_position": self.end_position,
                "switch_count": self.switches.count,
                "switches": [entry._asdict() for entry in self.switches.entries],
                "m_count": self.m_functions.count,
                "m_functions": [entry._asdict() for entry in self.m_functions.entries],
                "faults": [entry._asdict() for entry in self.faults],
                "underruns": self.underruns,
                "jitter": None if self.jitter is None else asdict(self.jitter),
            },
            indent=1,
            ensure_ascii=False,
        )


class Monitor:
    """Peaks of velocity, acceleration and following error of all axes, from what the drives are sent."""

    def __init__(self, machine: Machine, axes: tuple[str, ...]) -> None:
        self._machine, self._axes = machine, axes
        self._last: Floats | None = None
        self._last_velocity = np.zeros(len(axes))
        self._velocity = np.zeros(len(axes))
        self._step = np.zeros(len(axes))
        self._error = np.zeros(len(axes))

    def start(self, position: Floats) -> None:
        """Says where the axes stand, Shape (axes,), at rest."""
        self._last = position.copy()
        self._last_velocity[:] = 0.0

    @property
    def velocity(self) -> Floats:
        """Set velocity over the last cycle, Shape (axes,) [mm/s]."""
        return self._last_velocity.copy()

    def watch(self, setpoints: Floats, actual: Floats) -> None:
        """Takes set and actual positions, Shape (m, axes), of the next m cycles."""
        assert self._last is not None
        if not len(setpoints):
            return
        velocity = np.diff(setpoints, axis=0, prepend=self._last[None, :]) / self._machine.cycle
        steps = np.diff(velocity, axis=0, prepend=self._last_velocity[None, :])
        np.maximum(self._velocity, np.abs(velocity).max(axis=0), out=self._velocity)
        np.maximum(self._step, np.abs(steps).max(axis=0), out=self._step)
        np.maximum(self._error, np.abs(setpoints - actual).max(axis=0), out=self._error)
        self._last = setpoints[-1].copy()
        self._last_velocity = velocity[-1].copy()

    def reports(self) -> list[AxisReport]:
        """The peaks against the limits of the machine."""
        assert self._last is not None
        at, cycle = limits(self._machine, self._axes), self._machine.cycle
        rows = []
        for i, letter in enumerate(self._axes):
            acceleration = float(at.acceleration[i] + at.velocity_step[i] / cycle)
            peak = float(self._step[i] / cycle)
            rows.append(
                AxisReport(
                    letter,
                    self._machine.axes[letter].unit,
                    float(self._velocity[i]),
                    float(at.velocity[i]),
                    float(self._velocity[i] / at.velocity[i]),
                    peak,
                    acceleration,
                    peak / acceleration,
                    float(self._error[i]),
                    float(self._last[i]),
                )
            )
        return rows
