"""The `-p` option: which passes there are, the order they run in, and the pipeline that a text asks for.

    -p "tool-radius{radius=3},smooth-corners{distance=0.5},fit-arcs{tolerance=0.005}"

Running order (SoftMotion §3.1, architecture.md): frame transforms, tool radius correction, loop avoidance,
rounding or smoothing, tidying and fitting, flattening, feed limits.  A specification in another order is
refused, for each pass relies on what the ones before it leave; only compress may stand anywhere.  Tool radius
correction and rounding or smoothing must not act on the same stretch (SoftMotion §3.6).

This module knows every pass, and loading them takes a while: only who reads a `-p` imports it.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Sequence
from dataclasses import MISSING, Field, fields
from itertools import pairwise

from nccompile.errors import UsageError
from nccompile.passes.avoid_loops import AvoidLoops
from nccompile.passes.base import Pass
from nccompile.passes.compress import Compress
from nccompile.passes.fit_arcs import FitArcs
from nccompile.passes.fit_splines import FitSplines
from nccompile.passes.flatten import Flatten
from nccompile.passes.limit_arc_feed import LimitArcFeed
from nccompile.passes.move_start import MoveStart
from nccompile.passes.pipeline import Pipeline, acts_everywhere
from nccompile.passes.reverse import Reverse
from nccompile.passes.round_corners import RoundCorners
from nccompile.passes.smooth_corners import SmoothCorners
from nccompile.passes.split import Split
from nccompile.passes.tool_radius import ToolRadius
from nccompile.passes.transform import Transform

__all__ = ["ORDER", "REGISTRY", "parse"]

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
    _check(passes)
    return Pipeline(tuple(passes))


def _check(passes: Sequence[Pass]) -> None:
    """Refuses a wrong order, and passes that do not go together."""
    names = [p.name for p in passes]
    rank = {kind.name: at for at, kind in enumerate(ORDER)}
    for one, two in pairwise(name for name in names if name != Compress.name):
        if rank[two] < rank[one]:
            right = ", ".join(sorted(dict.fromkeys(names), key=lambda name: rank[name]))
            raise UsageError(f"{two} must run before {one}; the order is {right}")
    for name in names:
        if names.count(name) > 1 and name not in _REPEATABLE:
            raise UsageError(f"{name} is named twice")
    for one, two in _EXCLUDES:
        if one in names and two in names and acts_everywhere(passes, one) and acts_everywhere(passes, two):
            raise UsageError(f"{one} and {two} cannot both act on the whole path")


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
