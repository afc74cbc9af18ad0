"""Trace files: one row a cycle, as CSV or as npz.

    t, set_X.., act_X.., v, line, status, switches, gap

t [s]; set and actual axis positions [mm or deg]; v path velocity [mm/s]; source line; SMC_INT_STATUS; switch
word; gap 1 while the axes bridge a jump on their own (`runtime.bridge`) and the interpolator waits.  Numbers
are written so that they read back to the same bits; equal runs give equal bytes.  CSV is written as it comes,
npz is collected in memory: 8 (2 axes + 2) + 10 bytes a cycle.  The file takes its name when it is whole.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from nccompile.backend.files import replacing
from nccompile.errors import UsageError
from nccompile.toolpath.columns import Floats
from nccompile.units import MICROSECONDS

__all__ = ["CsvTrace", "Cycles", "NpzTrace", "Trace", "open_trace"]

_MILLION = 1_000_000


class Cycles(NamedTuple):
    """m consecutive cycles: `first` is the number of the first, arrays as in the module's docstring."""

    first: int
    setpoints: Floats
    actual: Floats
    velocity: Floats
    line: npt.NDArray[np.int32]
    status: npt.NDArray[np.uint8]
    switches: npt.NDArray[np.uint32]
    gap: bool

    def leading(self, m: int) -> Cycles:
        """The first m of them."""
        return Cycles(
            self.first, self.setpoints[:m], self.actual[:m], self.velocity[:m], self.line[:m], self.status[:m],
            self.switches[:m], self.gap,
        )  # fmt: skip


class Trace(Protocol):
    """Takes the cycles of a run in order."""

    def begin(self, axes: tuple[str, ...], cycle_us: int) -> None:
        """Says which axes the cycles have; called once before the first `write`."""

    def write(self, cycles: Cycles) -> None:
        """Takes m cycles; the arrays are only valid during the call."""


@contextmanager
def open_trace(path: Path) -> Iterator[Trace]:
    """A trace file by its suffix, .csv or .npz; it appears under `path` when the block ends without error.

    Raises: UsageError for another suffix, or if the file cannot be written.
    """
    kind = path.suffix.lower()
    if kind not in (".csv", ".npz"):
        raise UsageError(f"{path}: a trace is .csv or .npz")
    with replacing(path) as (file, commit):
        trace: CsvTrace | NpzTrace = CsvTrace(file) if kind == ".csv" else NpzTrace(file)
        yield trace
        trace.finish()
        commit()


class CsvTrace:
    """Writes a CSV trace to a binary file as it comes."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._cycle_us = 0

    def begin(self, axes: tuple[str, ...], cycle_us: int) -> None:
        """Writes the header line."""
        self._cycle_us = cycle_us
        names = ["t", *(f"set_{a}" for a in axes), *(f"act_{a}" for a in axes)]
        self._file.write(",".join([*names, "v", "line", "status", "switches", "gap"]).encode() + b"\n")

    def write(self, cycles: Cycles) -> None:
        """Writes one line a cycle."""
        m = len(cycles.velocity)
        columns: list[Any] = [map(self._time, range(cycles.first, cycles.first + m))]
        for table in (cycles.setpoints, cycles.actual):
            columns += [map(repr, table[:, axis].tolist()) for axis in range(table.shape[1])]
        columns.append(map(repr, cycles.velocity.tolist()))
        columns += [map(str, c.tolist()) for c in (cycles.line, cycles.status, cycles.switches)]
        gap = str(int(cycles.gap))
        lines = [",".join(row) + f",{gap}\n" for row in zip(*columns, strict=True)]
        self._file.write("".join(lines).encode())

    def _time(self, cycle: int) -> str:
        """Seconds of a cycle, exact to the microsecond whatever the length of the run."""
        seconds, rest = divmod(cycle * self._cycle_us, _MILLION)
        return f"{seconds}.{rest:06d}"

    def finish(self) -> None:
        """Nothing is left to write."""


class NpzTrace:
    """Collects the columns and writes them to a binary file as npz."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._axes: tuple[str, ...] = ()
        self._cycle_us = 0
        self._parts: list[dict[str, npt.NDArray[Any]]] = []

    def begin(self, axes: tuple[str, ...], cycle_us: int) -> None:
        """Keeps the axes for the names of the columns."""
        self._axes, self._cycle_us = axes, cycle_us

    def write(self, cycles: Cycles) -> None:
        """Keeps a copy of the cycles."""
        m = len(cycles.velocity)
        part: dict[str, npt.NDArray[Any]] = {
            "t": np.arange(cycles.first, cycles.first + m) * self._cycle_us * MICROSECONDS
        }
        for prefix, table in (("set", cycles.setpoints), ("act", cycles.actual)):
            part |= {f"{prefix}_{a}": table[:, i].copy() for i, a in enumerate(self._axes)}
        part |= {"v": cycles.velocity.copy(), "line": cycles.line.copy(), "status": cycles.status.copy()}
        part |= {"switches": cycles.switches.copy(), "gap": np.full(m, cycles.gap, np.uint8)}
        self._parts.append(part)

    def finish(self) -> None:
        """Writes the file; zip members carry a fixed date, so the bytes depend on the run alone."""
        names = list(self._parts[0]) if self._parts else []
        columns: dict[str, Any] = {n: np.concatenate([p[n] for p in self._parts]) for n in names}
        np.savez(self._file, **columns)
