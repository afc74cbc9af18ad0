"""Offline samples: the set positions of a planned path, cycle by cycle, without a drive.

The same kernel runs here and in the cyclic task, M functions are acknowledged in the cycle after they are
reached, nothing is stopped and the override is 1: what `run` commands on healthy drives, to the bit.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from nccompile.kernels import interpolator as k
from nccompile.kernels.stepper import BURST, Stepper
from nccompile.kernels.timelaw import TRAPEZOID
from nccompile.toolpath.columns import Floats, Toolpath

__all__ = ["SampleBlock", "quick_decelerations", "rows_of", "sample"]


class SampleBlock(NamedTuple):
    """m consecutive cycles.

    t f8 (m,) [s], 0 for the first cycle of the path; position f8 (m, axes); velocity f8 (m,) path velocity
    over the last cycle [mm/s]; line i4 (m,) source line; status u1 (m,) SMC_INT_STATUS; switches u4 (m,)
    switch word; fired i8 (r, 3): cycle in this block, switch number, source line.
    """

    t: Floats
    position: Floats
    velocity: Floats
    line: npt.NDArray[np.int32]
    status: npt.NDArray[np.uint8]
    switches: npt.NDArray[np.uint32]
    fired: npt.NDArray[np.int64]


def rows_of(path: Toolpath, acceleration: Floats | None = None) -> k.Rows:
    """A planned path as the rows of the interpolator (shares the arrays).

    acceleration: of the axes, Shape (k,) [mm/s²], see `quick_decelerations`.
    """
    assert path.v_limit is not None
    assert path.v_junction is not None
    assert path.v_end is not None
    none = np.zeros(len(path))
    a_end = none if path.a_end is None else path.a_end
    jerk = none if path.jerk is None else path.jerk
    e = path.events
    borders = np.searchsorted(e.segment, np.arange(len(path) + 1)).astype(np.int32)
    return k.Rows(
        path.kind, path.starts(), path.target, path.curve, path.curves.plane, path.curves.parameters,
        path.length, path.feed, path.v_limit, path.v_junction, path.v_end, a_end, path.accel, path.decel,
        quick_decelerations(path, acceleration, 0, len(path)), jerk, path.profile, path.line, borders[:-1],
        borders[1:], e.kind, e.number, e.position, e.k, np.empty(len(path)),
    )  # fmt: skip


def quick_decelerations(path: Toolpath, acceleration: Floats | None, begin: int, end: int) -> Floats:
    """Shape (end - begin,): the greatest deceleration of a quick stop on the rows [mm/s²].

    On straight rows what the accelerations of the axes, Shape (k,), allow along them; on curves, where a part of them
    is needed to turn, the planned deceleration.  Without accelerations there is no bound.
    """
    if acceleration is None:
        return np.full(end - begin, np.inf)
    length, decel = path.length[begin:end], path.decel[begin:end]
    start = np.vstack([path.start if begin == 0 else path.target[begin - 1], path.target[begin : end - 1]])
    way = np.abs(path.target[begin:end] - start[: end - begin])
    with np.errstate(divide="ignore", invalid="ignore"):
        allowed = np.where(way > 0.0, acceleration * length[:, None] / way, np.inf).min(axis=1)
    straight = (path.curve[begin:end] < 0) & ((path.profile[begin:end] & 0x7FFF) == 0) & (length > 0.0)
    return np.where(straight, allowed, decel)


def sample(chunks: Iterable[Toolpath], cycle: float, law: int = TRAPEZOID) -> Iterator[SampleBlock]:
    """Samples a planned path every `cycle` seconds; the last block ends at the end of the path, at rest."""
    supply = iter(chunks)
    window = next(supply, None)
    if window is None:
        return
    stepper = Stepper(window.start)
    inputs = k.Inputs(k.GO, 0.0, 1.0, law, 0, 0, 1, 1, cycle)
    rows, head, version, complete = rows_of(window), 0, 0, False
    cycles = 0
    while True:
        burst = stepper.run(
            rows, head, len(window), complete=complete, version=version, inputs=inputs, n=BURST
        )
        head += burst.dropped
        if len(burst):
            t = np.arange(cycles, cycles + len(burst), dtype=np.float64) * cycle
            cycles += len(burst)
            yield SampleBlock(
                t, burst.position.copy(), burst.velocity.copy(), burst.line.copy(), burst.status.copy(),
                burst.switches.copy(), burst.log.copy(),
            )  # fmt: skip
        if burst.reason == k.FINISHED:
            return
        if burst.reason == k.NEED_DATA:
            more = next(supply, None)
            complete = more is None
            if more is not None:
                window = Toolpath.join([window.rows(head, len(window)), more])
                rows, head = rows_of(window), 0
            version += 1
