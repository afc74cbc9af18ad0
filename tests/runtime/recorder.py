"""Runs for the tests: machines with small limits, and a trace that keeps every cycle."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from nccompile.machine.model import Machine, parse
from nccompile.runtime.report import RunReport
from nccompile.runtime.schedule import parse_command
from nccompile.runtime.task import CyclicTask, Options
from nccompile.runtime.trace import Cycles
from nccompile.toolpath.columns import Floats, Toolpath

AXIS = """
[axes.{letter}]
velocity = {velocity}
acceleration = {acceleration}
velocity_step = {step}
following_error = {error}
lag = {lag}
"""


def machine(
    axes: str = "XYZ",
    velocity: float = 200.0,
    acceleration: float = 2000.0,
    step: float = 5.0,
    error: float = 2.0,
    lag: float = 0.004,
    more: str = "",
    axis_more: str = "",
    cycle_us: int = 1000,
) -> Machine:
    """A machine with the same limits on all axes; `axis_more` goes into the last axis, `more` to the end."""
    sections = "".join(
        AXIS.format(letter=a, velocity=velocity, acceleration=acceleration, step=step, error=error, lag=lag)
        for a in axes
    )
    return parse(
        f'[machine]\nname = "test"\ncycle_us = {cycle_us}\n[path]\nquick_deceleration = 1500\n'
        + sections + axis_more + "\n" + more,
        "test.toml",
    )  # fmt: skip


class Recorder:
    """A trace in memory."""

    def __init__(self) -> None:
        self.parts: list[Cycles] = []
        self.axes: tuple[str, ...] = ()

    def begin(self, axes: tuple[str, ...], cycle_us: int) -> None:
        self.axes = axes

    def write(self, cycles: Cycles) -> None:
        assert cycles.first == sum(len(p.velocity) for p in self.parts)
        copies = (np.array(column) for column in cycles[1:-1])
        self.parts.append(Cycles(cycles.first, *copies, cycles.gap))  # type: ignore[call-arg, arg-type]

    def column(self, name: str) -> Floats:
        return np.concatenate([getattr(p, name) for p in self.parts])

    @property
    def gap(self) -> npt.NDArray[np.bool_]:
        return np.concatenate([np.full(len(p.velocity), p.gap) for p in self.parts])


def run(
    chunks: Iterable[Toolpath], on: Machine | None = None, *commands: str, options: Options | None = None
) -> tuple[RunReport, Recorder]:
    """A run with its trace."""
    chosen = options or Options(commands=[parse_command(text) for text in commands])
    trace = Recorder()
    return CyclicTask(chunks, on or machine(), chosen, trace=trace).run(), trace
