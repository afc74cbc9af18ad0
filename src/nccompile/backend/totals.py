"""Totals of a toolpath, gathered chunk by chunk: lengths, time, box, switches and M functions."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from nccompile.machine.extents import extents
from nccompile.toolpath import EventKind, Floats, Kind, Toolpath

__all__ = ["Totals", "TotalsGatherer"]


@dataclass(frozen=True, slots=True)
class Totals:
    """What a queue amounts to.

    length, rapid_length: path length of all segments, and of the rapid moves among them [mm];
    job_time: at override 1, dwells included, M functions acknowledged at once [s];
    box: least and greatest position an axis, bulges of curves included [mm or deg];
    switches: number of switch points;  m_functions: the M numbers in use, ascending.
    """

    segments: int
    length: float
    rapid_length: float
    job_time: float
    box: dict[str, tuple[float, float]]
    switches: int
    m_functions: tuple[int, ...]


@dataclass
class TotalsGatherer:
    """Adds up chunks, row after row, so that the result does not depend on the chunk size."""

    segments: int = 0
    switches: int = 0
    length: float = 0.0
    rapid_length: float = 0.0
    numbers: set[int] = field(default_factory=set)
    box: dict[str, tuple[float, float]] = field(default_factory=dict)

    def add(self, chunk: Toolpath) -> None:
        """Counts one chunk in."""
        self.segments += len(chunk)
        self.length = _add_up(self.length, chunk.length)
        self.rapid_length = _add_up(self.rapid_length, chunk.length[chunk.kind == Kind.POSITIONING])
        low, high = extents(chunk)
        box = np.vstack([chunk.start, low]).min(axis=0), np.vstack([chunk.start, high]).max(axis=0)
        for axis, least, greatest in zip(chunk.axes, box[0].tolist(), box[1].tolist(), strict=True):
            old = self.box.get(axis, (least, greatest))
            self.box[axis] = (min(old[0], least), max(old[1], greatest))
        self.switches += int(np.count_nonzero(chunk.events.kind == EventKind.SWITCH))
        self.numbers |= set(chunk.events.number[chunk.events.kind == EventKind.M_FUNCTION].tolist())

    def totals(self, job_time: float) -> Totals:
        """The totals of all chunks counted so far; job_time [s]."""
        return Totals(
            segments=self.segments,
            length=self.length,
            rapid_length=self.rapid_length,
            job_time=job_time,
            box=dict(self.box),
            switches=self.switches,
            m_functions=tuple(sorted(self.numbers)),
        )


def _add_up(total: float, values: Floats) -> float:
    """total + values[0] + values[1] + ... in this order."""
    return float(np.cumsum(np.concatenate([[total], values]))[-1])
