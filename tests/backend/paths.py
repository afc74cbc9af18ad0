"""Small planned toolpaths for the tests of the backends."""

from __future__ import annotations

from dataclasses import fields
from math import pi

import numpy as np

from nccompile.backend.ncq import Provenance
from nccompile.toolpath import Curves, EventKind, Events, Floats, Kind, Plane, Toolpath

PROVENANCE = Provenance("part.nc", "0" * 64, "mill3", "1" * 64, 1.0, "trapezoid")


def planned(
    kinds: list[int],
    targets: list[list[float]],
    curves: Curves | None = None,
    events: Events | None = None,
    start: Floats | None = None,
    names: tuple[str, ...] = (),
) -> Toolpath:
    """A planned chunk on X, Y, Z whose velocity columns are constants (no dynamics are tested with it)."""
    n = len(kinds)
    kind = np.array(kinds, np.uint8)
    curved = (kind >= Kind.ARC) & (kind <= Kind.POLYNOMIAL)
    curve = np.where(curved, np.cumsum(curved) - 1, -1).astype(np.int32)
    ones = np.ones(n)
    return Toolpath(
        axes=("X", "Y", "Z"),
        start=np.zeros(3) if start is None else start,
        kind=kind,
        target=np.array(targets, float).reshape(n, 3),
        curve=curve,
        length=ones * (kind < Kind.SET_POSITION),
        feed=20 * ones, accel=500 * ones, decel=400 * ones,
        mark=np.zeros(n, np.uint16), radius=0 * ones, profile=np.zeros(n, np.uint16),
        line=np.arange(1, n + 1, dtype=np.int32),
        curves=curves or Curves.empty(),
        events=events or Events.empty(),
        v_limit=30 * ones, v_junction=0 * ones, v_end=0 * ones,
        names=names,
    )  # fmt: skip


def small() -> Toolpath:
    """A rapid, a line with a switch, a half circle that bulges to X = 11.5, a dwell and an M function."""
    curves = Curves.from_rows([(Plane.XY, (10.5, 0.0, 1.0, -pi / 2, pi))])
    events = Events.from_rows(
        [
            (1, EventKind.SWITCH, 3, 0.25, 0.0, 0.0, -1),
            (3, EventKind.DWELL, 0, 0.0, 0.5, 0.0, -1),
            (4, EventKind.M_FUNCTION, 8, 0.0, 1.5, 0.0, 0),
        ]
    )
    targets = [[10.0, 0, 0], [10.5, -1, 0], [10.5, 1, 0], [10.5, 1, 0], [10.5, 1, 0]]
    kinds = [Kind.POSITIONING, Kind.LINE, Kind.ARC, Kind.DWELL, Kind.M_FUNCTION]
    return planned([int(k) for k in kinds], targets, curves, events, names=("tool",))


def same(one: Toolpath, other: Toolpath) -> bool:
    """Whether two chunks agree in every column, to the bit."""
    plain = {f.name for f in fields(Toolpath)} - {"axes", "curves", "events", "first", "names"}
    if one.is_third_order != other.is_third_order:
        return False
    plain -= set() if one.is_third_order else {"a_end", "jerk"}
    pairs = [(getattr(one, n), getattr(other, n)) for n in sorted(plain)]
    pairs += [(getattr(one.curves, n), getattr(other.curves, n)) for n in ("plane", "parameters")]
    events = ("segment", "kind", "number", "position", "k", "l", "o")
    pairs += [(getattr(one.events, n), getattr(other.events, n)) for n in events]
    return (
        all(np.array_equal(a, b) and a.dtype == b.dtype for a, b in pairs)
        and one.axes == other.axes
        and one.names == other.names
        and one.first == other.first
    )
