"""Small planned toolpaths for the tests of the runtime."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nccompile.toolpath.columns import Curves, Events, Floats, Kind, Toolpath


def planned(
    targets: Sequence[Sequence[float]] | Floats,
    start: Sequence[float] | None = None,
    kind: Kind = Kind.LINE,
    feed: float = 50.0,
    accel: float = 1000.0,
    events: Sequence[tuple[int, int, int, float, float, float, int]] = (),
    axes: tuple[str, ...] = ("X", "Y", "Z"),
    kinds: Sequence[Kind] | None = None,
    first_line: int = 1,
    names: tuple[str, ...] = (),
) -> Toolpath:
    """A path of straight segments that stops at the end of each."""
    target = np.array(targets, np.float64).reshape(-1, len(axes))
    n = len(target)
    begin = np.zeros(len(axes)) if start is None else np.array(start, np.float64)
    column = np.array([kind] * n if kinds is None else kinds, np.uint8)
    legs = np.diff(np.vstack([begin, target]), axis=0)
    length = np.where(column <= Kind.POLYNOMIAL, np.sqrt((legs**2).sum(axis=1)), 0.0)
    return Toolpath(
        axes=axes,
        start=begin,
        kind=column,
        target=target,
        curve=np.full(n, -1, np.int32),
        length=length,
        feed=np.full(n, feed),
        accel=np.full(n, accel),
        decel=np.full(n, accel),
        mark=np.zeros(n, np.uint16),
        radius=np.zeros(n),
        profile=np.zeros(n, np.uint16),
        line=np.arange(first_line, first_line + n, dtype=np.int32),
        curves=Curves.empty(),
        events=Events.from_rows(list(events)),
        v_limit=np.full(n, 1000.0),
        v_junction=np.zeros(n),
        v_end=np.zeros(n),
        names=names,
    )
