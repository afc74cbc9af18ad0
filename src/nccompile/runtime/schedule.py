"""Commands at times: stops, overrides and acknowledges that a run gets from a script.

2.5s override=0.5        at the first cycle at or after 2.5 s
3 slow_stop=on           seconds are the unit; on, off, true, false, 1, 0
800ms vel_mode=sigmoid
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from nccompile.errors import UsageError
from nccompile.kernels.timelaw import LAW_NAMES
from nccompile.runtime.interpolator import OVERRIDE_MAX, OVERRIDE_MIN, Inputs

__all__ = ["Command", "Schedule", "parse_command"]

_TIME_MAX = 1e9
_FLAGS = (
    "slow_stop", "emergency_stop", "quick_stop", "wait_at_next_stop", "single_step", "ack_m", "abort",
)  # fmt: skip
_NUMBERS = {
    "override": (OVERRIDE_MIN, OVERRIDE_MAX, ""),
    "quick_deceleration": (1e-3, 1e9, " mm/s²"),
    "last_way_pos": (-1e12, 1e12, " mm"),
}
_ON_OFF = {"on": True, "true": True, "1": True, "off": False, "false": False, "0": False}
_MODES = {spelling: law for law, name in enumerate(LAW_NAMES) for spelling in (name, str(law))}
_SHAPE = re.compile(r"\s*([0-9.]+(?:[eE][-+]?[0-9]+)?)\s*(s|ms)?\s+([A-Za-z_]+)\s*=\s*(\S+)\s*")


@dataclass(frozen=True, slots=True)
class Command:
    """Sets one input of the interpolator at the first cycle at or after `time` [s]."""

    time: float
    name: str
    value: bool | float | int


def parse_command(text: str, *, two_way: bool = False) -> Command:
    """The command that a text like "2.5s override=0.5" means.

    two_way: overrides may be negative or 0.  Raises: UsageError.
    """
    match = _SHAPE.fullmatch(text)
    if match is None:
        raise UsageError(
            f'"{text}" is not a command; expected TIME INPUT=VALUE, for example "2.5s override=0.5"'
        )
    time = _number(text, match[1], 0.0, _TIME_MAX, " seconds") * (1e-3 if match[2] == "ms" else 1.0)
    name, value = match[3].lower(), match[4].lower()
    if name in _FLAGS:
        return Command(time, name, bool(_choice(text, value, _ON_OFF)))
    if name == "vel_mode":
        return Command(time, name, int(_choice(text, value, _MODES)))
    if name in _NUMBERS:
        low, high, unit = _NUMBERS[name]
        low = -high if two_way and name == "override" else low
        return Command(time, name, _number(text, value, low, high, unit))
    known = ", ".join((*_FLAGS, "vel_mode", *_NUMBERS))
    raise UsageError(f'"{name}" in "{text}" is not an input of the interpolator; the inputs are {known}')


def _choice(text: str, value: str, known: dict[str, bool] | dict[str, int]) -> bool | int:
    if value not in known:
        raise UsageError(f'"{value}" in "{text}" is not one of {", ".join(known)}')
    return known[value]


def _number(text: str, value: str, low: float, high: float, unit: str) -> float:
    try:
        number = float(value)
    except ValueError:
        number = float("nan")
    if not low <= number <= high:
        raise UsageError(f'"{value}" in "{text}" is not a number from {low:g} to {high:g}{unit}')
    return number


class Schedule:
    """Commands in the order of their times; equal times keep their order."""

    def __init__(self, commands: Iterable[Command] = ()) -> None:
        self._commands = sorted(commands, key=lambda c: c.time)
        self._next = 0

    @property
    def is_done(self) -> bool:
        """Whether no command is left."""
        return self._next == len(self._commands)

    def cycles_until_next(self, now: int, cycle: float) -> int | None:
        """Cycles that may run before the next command has to be taken, or None if there is none."""
        if self.is_done:
            return None
        return max(0, _first_cycle(self._commands[self._next].time, cycle) - now)

    def take(self, now: int, cycle: float, inputs: Inputs) -> list[Command]:
        """Sets the inputs whose time has come at cycle number `now`; returns those commands."""
        taken: list[Command] = []
        while not self.is_done and _first_cycle(self._commands[self._next].time, cycle) <= now:
            command = self._commands[self._next]
            setattr(inputs, command.name, command.value)
            taken.append(command)
            self._next += 1
        return taken


def _first_cycle(time: float, cycle: float) -> int:
    """The first cycle at or after a time; a time that is a whole number of cycles but for rounding is one."""
    cycles = time / cycle
    nearest = round(cycles)
    return nearest if abs(cycles - nearest) < 1e-6 else int(cycles) + 1
