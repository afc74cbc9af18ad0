"""Planner `jerk`: the third-order plan along the path, rows cut where the jerk changes.

    in    decoded chunks
    out   planned chunks with a_end and jerk: |acceleration| and |jerk| inside the row's own, the acceleration
          continuous, also over junctions, and 0 at stops; constant jerk in every row

         v |        ______ row's velocity         A march forward (`kernels.jerk_march`) rises below all caps
           |     .-'      `-.___ junction's       as fast as A and J let it, one backward does the same from the
           |   .'           .   `-._              end, `kernels.jerk_join` takes the lower of both and joins them
           |_-'              .      `-._          by arcs.  Where both touch a cap with a = 0 the plan before and
           +----- settled ----+--------------     behind do not know of each other: there it may be cut.

The path is planned in blocks of rows, each as if it ended at rest, and put out up to the last place that is
settled so.  The blocks depend on the path only, so the result does not depend on chunks.  A window lowers
velocities that cannot be braked within it before, wherever that is.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from nccompile.errors import InvalidToolpath
from nccompile.kernels.jerk_join import JOINED, join
from nccompile.kernels.jerk_limits import jerk_limits, rest_caps
from nccompile.kernels.jerk_march import PIECES, march
from nccompile.passes.velocity.cuts import cut_at_bends
from nccompile.passes.velocity.limits import limited, unfinished
from nccompile.passes.velocity.parts import Parts, parted
from nccompile.passes.velocity.settings import PlanSettings
from nccompile.toolpath.columns import Floats, Ints, Kind, Toolpath
from nccompile.toolpath.lengths import path_lengths

__all__ = ["JerkPlanner", "profile"]

_BLOCK = 8192
"""Rows that are planned at a time; twice as many where nothing settles."""

_S_PARTS = 64
"""Parts of a row with an S-profile: they stay within 0.02 % of the profile's travel."""

_UNBOUND = 1e12
"""Path jerk where no axis limits it [mm/s³]."""


@dataclass
class JerkPlanner:
    """The window of the planner: holds the rows back that are not settled."""

    settings: PlanSettings
    _held: list[Toolpath] = field(default_factory=list, init=False)
    _before: float = field(default=0.0, init=False)  # of the first segment held, what is out already
    _rows: int = field(default=0, init=False)  # rows held
    _block: int = field(default_factory=lambda: _BLOCK, init=False)
    _v_before: float = field(default=0.0, init=False)
    _known: int = field(default=0, init=False)  # rows held at whose end the last plan came to rest
    _out: int = field(default=0, init=False)  # rows put out

    def feed(self, chunk: Toolpath) -> Iterator[Toolpath]:
        """Takes the next chunk; yields what it settles."""
        chunk = cut_at_bends(_without_profiles(chunk), self.settings)
        self._held.append(chunk)
        self._rows += len(chunk)
        while self._rows > self._block:
            yield from self._settle(self._block)

    def finish(self) -> Iterator[Toolpath]:
        """The rest of the path, which ends at rest."""
        if self._rows or (self._held and self._out == 0):
            yield from self._settle(self._rows)

    @property
    def _window(self) -> int:
        """Rows within which any velocity can be braked to rest, 0 for no such rule; a block is always at hand."""
        return 0 if self.settings.window is None else max(self.settings.window, _BLOCK)

    def _settle(self, rows: int) -> Iterator[Toolpath]:
        """Plans the first `rows` rows held; yields those of them that are settled."""
        held = Toolpath.join(self._held)
        self._held = [held]
        complete = rows == len(held)
        path, jerk = _limited(held.rows(0, rows), self.settings, self._before)
        plan = _planned(path, jerk, self._v_before, self._window, complete=complete)
        if plan is None:  # never seen: what was settled before cannot be run on from; the end before can
            rows, complete = self._known, True
            path, jerk = path.rows(0, rows), jerk[:rows]
            plan = _planned(path, jerk, self._v_before, 0, complete=True)
        if plan is None:
            raise InvalidToolpath(f"no third-order plan from row {self._out} at {self._v_before!r} mm/s")
        if plan.rows == 0 and not complete:
            self._block *= 2
            return
        self._block = _BLOCK
        self._known = rows - plan.rows
        self._held = [held.rows(plan.rows, len(held))]
        self._rows -= plan.rows
        self._before = unfinished(path.rows(0, plan.rows), self._before)
        out = _cut(path.rows(0, plan.rows), jerk, plan).replace(first=self._out)
        assert out.v_end is not None
        self._v_before = float(out.v_end[-1]) if len(out) else 0.0
        self._out += len(out)
        yield out


@dataclass(frozen=True)
class _Plan:
    """Parts of the moving rows among `rows` settled ones: row i4 (m,), ends (m, 3): place in the row, v, a."""

    rows: int
    row: Ints
    ends: Floats


def _without_profiles(path: Toolpath) -> Toolpath:
    """S-profiles as straight parts through their places: a row with a profile cannot be cut where the jerk changes."""
    bits = path.profile & 0x7FFF
    if not bits.any():
        return path
    row = np.repeat(np.arange(len(path), dtype=np.int32), np.where(bits != 0, _S_PARTS, 1))
    first = np.searchsorted(row, np.arange(len(path)))
    part = np.arange(len(row)) - first[row]
    parts = np.where(bits != 0, _S_PARTS, 1)[row]
    p1 = (part + 1) / parts
    out = parted(path, Parts(row, part / parts, p1))
    w, starts, target = p1**3 * (10.0 + p1 * (6.0 * p1 - 15.0)), path.starts(), out.target.copy()
    for axis in range(len(path.axes)):
        at = np.flatnonzero(((bits[row] >> axis) & 1 == 1) & (p1 < 1.0))
        target[at, axis] = starts[row[at], axis] + (path.target - starts)[row[at], axis] * w[at]
    out = out.replace(target=target, profile=out.profile & 0x8000)
    return out.replace(length=np.where(bits[row] != 0, path_lengths(out), out.length))


def _limited(path: Toolpath, settings: PlanSettings, before: float) -> tuple[Toolpath, Floats]:
    """The chunk with its limits, and the greatest path jerk of its rows."""
    path, _ = limited(path, settings, before)
    assert path.v_limit is not None
    assert path.v_junction is not None
    v_limit, accel, decel = path.v_limit.copy(), path.accel.copy(), path.decel.copy()
    jerk = np.full(len(path), _UNBOUND)
    if settings.limits.jerk is not None:
        jerk_limits(
            path.kind, path.starts(), path.target, path.curve, path.curves.plane, path.curves.parameters,
            path.length, path.profile, settings.limits.jerk, accel, decel, v_limit, jerk,
        )  # fmt: skip
    return path.replace(v_limit=v_limit, accel=accel, decel=decel), jerk


def _planned(path: Toolpath, jerk: Floats, v_before: float, window: int, *, complete: bool) -> _Plan | None:
    """The plan of a chunk that ends at rest; None if there is none from v_before."""
    assert path.v_limit is not None
    assert path.v_junction is not None
    moving = np.flatnonzero((path.length > 0.0) & (path.kind < Kind.SET_POSITION))
    if not len(moving):
        rows = len(path) if complete or v_before == 0.0 else 0
        return _Plan(rows, np.empty(0, np.int32), np.empty((0, 3)))
    length, decel, j = path.length[moving], path.decel[moving], jerk[moving]
    top = np.minimum(path.feed, path.v_limit)
    node = np.minimum(path.v_junction[moving], np.minimum.reduceat(top, moving))  # with rows without length
    top = top[moving]
    node[:-1] = np.minimum(node[:-1], top[1:])
    node[-1] = 0.0
    if window:
        rest_caps(length, decel, j, window, node)
    found = profile(length, top, node, path.accel[moving], decel, j, v_before)
    if found is None:
        return None
    row, ends, settled = found
    if complete:
        return _Plan(len(path), moving[row].astype(np.int32), ends)
    count = int(np.searchsorted(row, settled))
    rows = int(moving[settled]) if settled else 0
    return _Plan(rows, moving[row[:count]].astype(np.int32), ends[:count])


def profile(
    length: Floats,
    top: Floats,
    node: Floats,
    accel: Floats,
    decel: Floats,
    jerk: Floats,
    v_before: float = 0.0,
) -> tuple[Ints, Floats, int] | None:
    """The third-order plan of rows that start at v_before without acceleration and end at rest.

    Args:     arrays of shape (n,), n > 0, all > 0 but `node`, the cap of the velocity behind each row, which is at
              most `top` of both rows and 0 behind the last.
    Returns:  row i4 (m,) and end (m, 3) of parts with a constant jerk: place in the row, velocity, acceleration;
              and the last row before which nothing depends on the end at rest.  None if v_before is too fast.
    """
    n = len(length)
    ahead = _march(length, top, node, accel, jerk, v_before)
    back = slice(None, None, -1)
    behind = _march(
        length[back].copy(), top[back].copy(), np.append(node[:-1][back], v_before), decel[back].copy(),
        jerk[back].copy(), 0.0,
    )  # fmt: skip
    first, row, ends = np.empty(n + 1, np.int32), np.empty(JOINED * n, np.int32), np.empty((JOINED * n, 3))
    count, settled = join(length, *ahead, *behind, first, row, ends)
    return None if settled < 0 else (row[:count], ends[:count], settled)


def _march(
    length: Floats, top: Floats, node: Floats, accel: Floats, jerk: Floats, v: float
) -> tuple[Ints, Floats, Floats, Floats]:
    n = len(length)
    first, pieces = np.empty(n + 1, np.int32), np.empty((PIECES * n, 4))
    entry, ramp = np.empty((n, 2)), np.empty(n)
    march(length, top, node, accel, jerk, v, first, pieces, entry, ramp)
    return first, pieces, entry, ramp


def _cut(path: Toolpath, jerk: Floats, plan: _Plan) -> Toolpath:
    """The rows cut where the plan says so, with their velocities and accelerations."""
    n = len(path)
    count = np.bincount(plan.row, minlength=n)
    row = np.repeat(np.arange(n, dtype=np.int32), np.maximum(count, 1))
    at = np.flatnonzero(count[row] > 0)  # parts that move
    p0, p1, v_end, a_end = np.zeros(len(row)), np.ones(len(row)), np.zeros(len(row)), np.zeros(len(row))
    p1[at] = plan.ends[:, 0] / path.length[plan.row]
    inner = np.flatnonzero(row[1:] == row[:-1])
    p0[inner + 1] = p1[inner]
    # Rows without length take over what the row before them ends with; stops end with 0 anyway.
    last = np.maximum.accumulate(np.where(count[row] > 0, np.arange(len(row)), -1))
    v_end[at], a_end[at] = plan.ends[:, 1], plan.ends[:, 2]
    out = parted(path, Parts(row, p0, p1))
    return out.replace(
        v_end=np.where(last >= 0, v_end[last], 0.0),
        a_end=np.where(last >= 0, a_end[last], 0.0),
        jerk=np.where(out.kind < Kind.SET_POSITION, jerk[row], 0.0),  # a dwell is run by its time
    )
