"""Real time: absolute deadlines, and statistics of how well they were kept."""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from time import perf_counter, sleep

import numpy as np

__all__ = ["Clock", "Jitter", "undisturbed"]

_SPIN = 300e-6
"""Seconds before a deadline at which sleeping ends and spinning begins; sleep wakes up this late at worst."""

_BINS = 100_000
"""1 µs bins of the lateness histogram; the last one takes all that is 0.1 s late or more."""

_SWITCH_INTERVAL = 50e-6
"""Seconds after which Python takes the interpreter from a thread that works; 5 ms would cost cycles."""


@dataclass(frozen=True)
class Jitter:
    """How late set positions were handed out, µs; percentiles are good to 1 µs.

    overruns: cycles whose work was not done at their deadline, or for which the computer woke the task more
    than a cycle late; worst_cycle: number of the latest cycle.
    """

    cycles: int
    mean_us: float
    p50_us: float
    p99_us: float
    max_us: float
    overruns: int
    worst_cycle: int


class Clock:
    """Deadlines every `cycle` seconds, counted from `start`.

    After an overrun of more than a cycle the deadlines start anew: set positions that are late are not made
    up for in a rush, because an axis could not follow.
    """

    def __init__(self, cycle: float) -> None:
        self._cycle = cycle
        self._deadline = 0.0
        self._histogram = np.zeros(_BINS + 1, np.int64)
        self._sum = 0.0
        self._max = 0.0
        self._worst = 0
        self._count = 0
        self._overruns = 0

    def start(self) -> None:
        """The first deadline is one cycle from now."""
        self._deadline = perf_counter() + self._cycle

    def wait(self) -> None:
        """Waits for the next deadline and records how late it was met."""
        rest = self._deadline - perf_counter()
        if rest > _SPIN:
            sleep(rest - _SPIN)
        while (now := perf_counter()) < self._deadline:
            pass
        self._record(now - self._deadline)
        if rest <= 0.0 or now - self._deadline > self._cycle:
            self._overruns += 1
        self._deadline += self._cycle
        if now >= self._deadline:
            self._deadline = now + self._cycle

    def _record(self, late: float) -> None:
        late_us = late * 1e6
        self._histogram[min(int(late_us), _BINS)] += 1
        self._sum += late_us
        if late_us > self._max:
            self._max, self._worst = late_us, self._count
        self._count += 1

    def _percentile(self, share: float) -> float:
        """The upper edge of the bin in which `share` of all cycles is reached."""
        wanted = share * self._count
        at = int(np.searchsorted(np.cumsum(self._histogram), wanted))
        return min(at + 1.0, self._max)

    def statistics(self) -> Jitter:
        """What has been recorded so far."""
        count = max(1, self._count)
        return Jitter(
            self._count, self._sum / count, self._percentile(0.5), self._percentile(0.99), self._max,
            self._overruns, self._worst,
        )  # fmt: skip


@contextmanager
def undisturbed() -> Iterator[None]:
    """No garbage collection and short turns for other threads while real-time work goes on."""
    interval, collecting = sys.getswitchinterval(), gc.isenabled()
    sys.setswitchinterval(_SWITCH_INTERVAL)
    gc.disable()
    try:
        yield
    finally:
        sys.setswitchinterval(interval)
        if collecting:
            gc.enable()
