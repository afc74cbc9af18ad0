"""What every path pass is: parameters, a stream of chunks in, a stream of chunks out, and a report.

    chunks ──> apply ──> chunks'          the result does not depend on how the path is cut into chunks
                 └────> Context.report    segments in and out, largest deviation, findings

A pass acts inside the regions that marks of the program open (a start mark acts from the start of its
segment, a stop mark to the end of its segment) or, with `everywhere`, on the whole path.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, fields
from typing import Any, ClassVar, TypeAlias

import numpy as np
import numpy.typing as npt

from nccompile.diagnostics import Severity
from nccompile.errors import UsageError
from nccompile.toolpath.columns import CHUNK, Toolpath

__all__ = ["Context", "Diagnose", "Flags", "Pass", "Report", "bounded", "gather", "region"]

Flags: TypeAlias = npt.NDArray[np.bool_]

Diagnose: TypeAlias = Callable[[str, Severity, str, int, str], None]


@dataclass
class Report:
    """What a pass did: segments in and out, largest deviation of its path from the one before [mm], time [s].

    deviation: measured on samples of both paths by `passes.measure`, None if nobody asked for it; where a pass moves
    the path on purpose (a transform), from the path moved exactly;  counts: what else is worth telling, by name.
    """

    name: str
    segments_in: int = 0
    segments_out: int = 0
    deviation: float | None = None
    seconds: float = 0.0
    counts: Counter[str] = field(default_factory=Counter)

    def deviate(self, distance: float) -> None:
        """Takes note of a measured deviation [mm]."""
        self.deviation = distance if self.deviation is None else max(self.deviation, distance)

    def as_dict(self) -> dict[str, Any]:
        """The report for JSON."""
        return {
            "name": self.name,
            "segments_in": self.segments_in,
            "segments_out": self.segments_out,
            "deviation": self.deviation,
            "seconds": round(self.seconds, 6),
            "counts": dict(sorted(self.counts.items())),
        }


@dataclass
class Context:
    """What a pass gets besides the path.

    feed: the feed where the program says none [mm/s], 0: unknown;  diagnose: takes a finding as (code,
    severity, message, source line, help);  measure: whether deviations are measured.
    """

    report: Report
    feed: float = 0.0
    diagnose: Diagnose | None = None
    measure: bool = True

    def find(self, code: str, severity: Severity, message: str, line: int, help: str = "") -> None:
        """Reports a finding at a source line."""
        self.report.counts[code] += 1
        if self.diagnose is not None:
            self.diagnose(code, severity, message, line, help)


@dataclass(frozen=True)
class Pass(ABC):
    """A path pass.  Subclasses are frozen dataclasses whose fields are the parameters of the `-p` option."""

    name: ClassVar[str]

    @abstractmethod
    def rewrite(self, chunks: Iterator[Toolpath], context: Context) -> Iterator[Toolpath]:
        """The rewritten path; `apply` numbers its chunks and cuts them to size."""

    def apply(self, chunks: Iterable[Toolpath], context: Context | None = None) -> Iterator[Toolpath]:
        """Runs the pass over a path.

        Returns:  chunks of at most CHUNK segments, numbered; an empty path stays one empty chunk.
        """
        context = Context(Report(self.name)) if context is None else context
        report = context.report
        if context.measure:
            report.deviate(0.0)
        first = 0
        last: Toolpath | None = None

        def counted() -> Iterator[Toolpath]:
            for chunk in chunks:
                report.segments_in += len(chunk)
                yield chunk

        for whole in self.rewrite(counted(), context):
            last = whole
            for at in range(0, len(whole), CHUNK):
                part = whole.rows(at, at + CHUNK) if len(whole) > CHUNK else whole
                yield part.replace(first=first)
                first += len(part)
        report.segments_out = first
        if first == 0 and last is not None:
            yield last.replace(first=0)


def bounded(name: str, value: float, low: float, high: float, unit: str) -> None:
    """Checks a parameter; raises UsageError with its name, bounds and unit."""
    if not low <= value <= high:
        raise UsageError(f"{name}={value:g} is out of bounds: {low:g} to {high:g} {unit}".rstrip())


def parameters_of(kind: type[Pass]) -> list[str]:
    """The parameter names of a pass, as the `-p` option spells them."""
    return [f.name.replace("_", "-") for f in fields(kind)]


def gather(chunks: Iterable[Toolpath], least: int = CHUNK) -> Iterator[Toolpath]:
    """The same path in chunks of at least `least` segments (but the last): many tiny ones are joined at once."""
    held: list[Toolpath] = []
    count = 0
    for chunk in chunks:
        held.append(chunk)
        count += len(chunk)
        if count >= least:
            yield Toolpath.join(held)
            held, count = [], 0
    if held:
        yield Toolpath.join(held)


def region(path: Toolpath, start: int, stop: int, inside: bool) -> tuple[Flags, bool]:
    """Which segments lie in a region.

    Args:     start, stop: mark bits that open and close it;  inside: whether it is open before the first row.
    Returns:  Shape (n,), and whether the region is open after the last row.

    Row i is inside if the last start at or before it came after the last stop before it.
    """
    n = len(path)
    rows = np.arange(n)
    opened = np.maximum.accumulate(np.where(path.mark & start, rows, -1 if inside else -2))
    closed = np.maximum.accumulate(np.where(path.mark & stop, rows, -2))
    before = np.concatenate([[-2], closed[:-1]]) if n else closed
    flags: Flags = opened > before
    after = bool(opened[-1] > closed[-1]) if n else inside
    return flags, after
