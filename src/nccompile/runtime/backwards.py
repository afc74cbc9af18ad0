"""The backward path of a planned path: what SMC_Interpolator2Dir_SlowTask makes (SoftMotion §6.2.10).

    row      0      1      2                    2'     1'     0'
    path  A ---> B ---> C ---> D       back  D ---> C ---> B ---> A

Row i of one is row n - 1 - i of the other.  The plan is the same motion in reversed time: velocities stay,
accelerations change their sign, so `accel` and `decel` change places.  Backwards nothing waits: M functions and
dwells take no time; a switch point is undone (H5 becomes H-5); a jump of the set position jumps back.
"""

from __future__ import annotations

import numpy as np

from nccompile.kernels.curve_parts import turn_round
from nccompile.kernels.interpolator import CONTINUES
from nccompile.toolpath.columns import Curves, EventKind, Events, Floats, Kind, Toolpath

__all__ = ["backward"]

_TAKEN = ("length", "feed", "radius", "line", "v_limit")


def backward(path: Toolpath) -> Toolpath:
    """The planned path, at hand as a whole, run from its end to its start."""
    n = len(path)
    back = np.arange(n)[::-1]
    old = path.curve[back]
    curved = np.flatnonzero(old >= 0)
    curve = np.full(n, -1, np.int32)
    curve[curved] = np.arange(len(curved), dtype=np.int32)
    kind = path.kind[back].copy()
    parameters = path.curves.parameters[old[curved]]
    turn_round(kind[curved], parameters)
    kind[kind == Kind.M_FUNCTION] = Kind.DWELL
    mark = np.uint16(1 << CONTINUES)
    inner = np.concatenate([[0], path.profile[:-1] & mark])[:n].astype(np.uint16)
    turned = path.replace(
        start=path.end, kind=kind, target=path.starts()[back], curve=curve,
        curves=Curves(path.curves.plane[old[curved]], parameters), events=_events(path),
        profile=((path.profile & ~mark) | inner)[back], mark=np.zeros(n, np.uint16), first=0,
        accel=path.decel[back], decel=path.accel[back], v_end=_before(path.v_end)[back],
        v_junction=_before(path.v_junction)[back], **{name: getattr(path, name)[back] for name in _TAKEN},
    )  # fmt: skip
    if path.a_end is not None and path.jerk is not None:
        turned = turned.replace(a_end=-_before(path.a_end)[back] + 0.0, jerk=path.jerk[back])
    return turned


def _before(column: Floats | None) -> Floats:
    """What the end of the row before has, for every row; 0 at the start of the path."""
    assert column is not None
    return np.concatenate([[0.0], column[:-1]])[: len(column)]


def _events(path: Toolpath) -> Events:
    """The events at their places seen from the other side; waits of no time."""
    e, n = path.events, len(path)
    rows = []
    for i in range(len(e)):
        segment = n - 1 - int(e.segment[i])
        if e.kind[i] == EventKind.SWITCH:
            place = 1.0 - float(e.position[i])
            rows.append((segment, int(EventKind.SWITCH), -int(e.number[i]), place, 0.0, 0.0, -1))
        else:
            rows.append((segment, int(EventKind.DWELL), 0, 0.0, 0.0, 0.0, -1))
    return Events.from_rows(rows)
