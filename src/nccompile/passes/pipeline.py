"""Path passes one behind the other.

    decoded ──> pass 1 ──> pass 2 ──> ... ──> velocity planning
                  │          │
                  └ verify, print, time: the callbacks of `Pipeline.run`

It knows no pass: a compilation without `-p` does not load them.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from nccompile.passes.base import Context, Diagnose, Pass, Report
from nccompile.passes.check_marks import CORNERS, check_together
from nccompile.toolpath.columns import Toolpath

__all__ = ["Pipeline", "acts_everywhere"]

Print = Callable[[str, Iterator[Toolpath]], Iterator[Toolpath]]


@dataclass
class Pipeline:
    """Passes in running order, and what they reported.

    passes: as `option.parse` puts them together;  reports: one a pass, filled by `run`.
    """

    passes: tuple[Pass, ...] = ()
    reports: list[Report] = field(default_factory=list)

    def run(
        self, chunks: Iterable[Toolpath], *, feed: float = 0.0, diagnose: Diagnose | None = None,
        after: Print | None = None, measure: bool = True,
    ) -> Iterator[Toolpath]:  # fmt: skip
        """The path after all passes.

        Args:     feed: where the program says none [mm/s];  diagnose: takes findings;
                  after: wraps the chunks behind each pass, called with its name (to verify or print them).
        """
        self.reports[:] = [Report(p.name) for p in self.passes]
        stream: Iterator[Toolpath] = iter(chunks)
        clock = _Clock()
        corners = {p.name: acts_everywhere(self.passes, p.name) for p in self.passes if p.name in CORNERS}
        for p, report in zip(self.passes, self.reports, strict=True):
            context = Context(report, feed, diagnose, measure)
            if p.name == "tool-radius" and corners:
                stream = check_together(stream, acts_everywhere(self.passes, p.name), corners, context.find)
            stream = clock.timed(report, p.apply(clock.outside(report, stream), context))
            if after is not None:
                stream = after(p.name, stream)
        yield from stream


class _Clock:
    """Time spent inside each pass: generators of several passes interleave, so time is counted a pull at a time."""

    def timed(self, report: Report, chunks: Iterator[Toolpath]) -> Iterator[Toolpath]:
        """Counts what a pass needs for each of its chunks."""
        while True:
            begin = time.perf_counter()
            chunk = next(chunks, None)
            report.seconds += time.perf_counter() - begin
            if chunk is None:
                return
            yield chunk

    def outside(self, report: Report, chunks: Iterator[Toolpath]) -> Iterator[Toolpath]:
        """Takes off what the stages before a pass need."""
        while True:
            begin = time.perf_counter()
            chunk = next(chunks, None)
            report.seconds -= time.perf_counter() - begin
            if chunk is None:
                return
            yield chunk


def acts_everywhere(passes: Sequence[Pass], name: str) -> bool:
    """Whether the pass of a name is there and acts on the whole path."""
    return any(p.name == name and bool(getattr(p, "everywhere", False)) for p in passes)
