"""The path passes in the order they run, and the `-p` option.

    -p "tool-radius{radius=3},smooth-corners{distance=0.5},fit-arcs{tolerance=0.005}"

    decoded ──> pass 1 ──> pass 2 ──> ... ──> velocity planning
                  │          │
                  └ verify, print, time: the callbacks of `Pipeline.run`

Running order (SoftMotion §3.1, architecture.md): frame transforms, tool radius correction, loop avoidance,
rounding or smoothing, tidying and fitting, flattening, feed limits.  A specification in another order is
refused, for each pass relies on what the ones before it leave; only compress may stand anywhere.  Tool radius
correction and rounding or smoothing must not act on the same stretch (SoftMotion §3.6).
"""

from __future__ import annotations

import difflib
import re
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import MISSING, Field, dataclass, field, fields
from itertools import pairwise

from nccompile.errors import UsageError
from nccompile.passes.avoid_loops import AvoidLoops
from nccompile.passes.base import Context, Diagnose, Pass, Report
from nccompile.passes.check_marks import CORNERS, check_together
from nccompile.passes.compress import Compress
from nccompile.passes.fit_arcs import FitArcs
from nccompile.passes.fit_splines import FitSplines
from nccompile.passes.flatten import Flatten
from nccompile.passes.limit_arc_feed import LimitArcFeed
from nccompile.passes.move_start import MoveStart
from nccompile.passes.reverse import Reverse
from nccompile.passes.round_corners import RoundCorners
from nccompile.passes.smooth_corners import SmoothCorners
from nccompile.passes.split import Split
from nccompile.passes.tool_radius import ToolRadius
from nccompile.passes.transform import Transform
from nccompile.toolpath.columns import Toolpath

__all__ = ["ORDER", "REGISTRY", "Pipeline", "parse"]

ORDER: tuple[type[Pass], ...] = (
    Transform,
    Reverse,
    MoveStart,
    Split,
    Compress,
    ToolRadius,
    AvoidLoops,
    RoundCorners,
    SmoothCorners,
    FitArcs,
    FitSplines,
    Flatten,
    LimitArcFeed,
)
"""All passes in running order; a new pass is one line here."""

REGISTRY: dict[str, type[Pass]] = {kind.name: kind for kind in ORDER}

_EXCLUDES = (
    ("round-corners", "smooth-corners"),
    ("tool-radius", "round-corners"),
    ("tool-radius", "smooth-corners"),
)
"""Passes that cannot both act on the whole path: NC304 of `check_marks` finds stretches of the path."""

_REPEATABLE = ("transform", "split", "compress")
_PASS = re.compile(r"\s*(?P<name>[A-Za-z][\w-]*)\s*(?:\{(?P<body>[^{}]*)\})?\s*(?P<end>,|$)")

Print = Callable[[str, Iterator[Toolpath]], Iterator[Toolpath]]


@dataclass
class Pipeline:
    """Passes in running order, and what they reported.

    passes: checked by `__post_init__`, which raises UsageError;  reports: one a pass, filled by `run`.
    """

    passes: tuple[Pass, ...] = ()
    reports: list[Report] = field(default_factory=list)

    def __post_init__(self) -> None:
        names = [p.name for p in self.passes]
        rank = {kind.name: at for at, kind in enumerate(ORDER)}
        for one, two in pairwise(name for name in names if name != Compress.name):
            if rank[two] < rank[one]:
                right = ", ".join(sorted(dict.fromkeys(names), key=lambda name: rank[name]))
                raise UsageError(f"{two} must run before {one}; the order is {right}")
        for name in names:
            if names.count(name) > 1 and name not in _REPEATABLE:
                raise UsageError(f"{name} is named twice")
        for one, two in _EXCLUDES:
            if one in names and two in names and _whole(self.passes, one) and _whole(self.passes, two):
                raise UsageError(f"{one} and {two} cannot both act on the whole path")

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
        corners = {p.name: _whole(self.passes, p.name) for p in self.passes if p.name in CORNERS}
        for p, report in zip(self.passes, self.reports, strict=True):
            context = Context(report, feed, diagnose, measure)
            if p.name == ToolRadius.name and corners:
                stream = check_together(stream, _whole(self.passes, p.name), corners, context.find)
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


def _whole(passes: Sequence[Pass], name: str) -> bool:
    return any(p.name == name and bool(getattr(p, "everywhere", False)) for p in passes)


def parse(text: str) -> Pipeline:
    """The pipeline of a `-p` option.

    Raises:   UsageError: an unknown pass or parameter (with the nearest one), a value of the wrong type or out
              of bounds, a wrong order.
    """
    passes: list[Pass] = []
    at = 0
    while at < len(text) or (at and text[at - 1] == ","):
        match = _PASS.match(text, at)
        if match is None:
            raise UsageError(f"passes: cannot read {text[at:]!r}; write name{{parameter=value,...}},name,...")
        passes.append(_make(match["name"], match["body"] or ""))
        at = match.end()
    return Pipeline(tuple(passes))


def _make(name: str, body: str) -> Pass:
    kind = REGISTRY.get(name)
    if kind is None:
        raise UsageError(f"no pass {name!r}{_nearest(name, REGISTRY)}; passes are {', '.join(REGISTRY)}")
    known = {f.name.replace("_", "-"): f for f in fields(kind)}
    values: dict[str, object] = {}
    for part in filter(None, (p.strip() for p in body.split(","))):
        key, equals, value = (t.strip() for t in part.partition("="))
        key = key.replace("_", "-")
        if key not in known:
            have = f"it has {', '.join(known)}" if known else "it has none"
            raise UsageError(f"{name}: no parameter {key!r}{_nearest(key, known)}; {have}")
        if key.replace("-", "_") in values:
            raise UsageError(f"{name}: {key} is given twice")
        values[key.replace("-", "_")] = _value(f"{name}: {key}", known[key], value if equals else "true")
    for key, f in known.items():
        if f.default is MISSING and f.default_factory is MISSING and f.name not in values:
            raise UsageError(f"{name}: {key} is missing")
    try:
        return kind(**values)
    except UsageError as error:
        raise UsageError(f"{name}: {error}") from error


def _value(where: str, f: Field[object], text: str) -> object:
    kind = str(f.type)
    try:
        if kind == "bool":
            return {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}[
                text.lower()
            ]
        if kind == "int":
            return int(text)
        if kind == "float":
            return float(text)
    except (KeyError, ValueError):
        words = {"bool": "true or false", "int": "a whole number", "float": "a number"}
        raise UsageError(f"{where}={text!r} is not {words[kind]}") from None
    return text


def _nearest(word: str, known: Iterable[str]) -> str:
    found = difflib.get_close_matches(word.replace("_", "-"), list(known), 1, 0.5)
    return f" (did you mean {found[0]}?)" if found else ""
