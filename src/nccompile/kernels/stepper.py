"""State and scratch arrays around `interpolator.advance`: what sampler and cyclic task both hold.

Rows and events are kept as distances from the head, because a ring buffer moves its rows between calls.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from nccompile.kernels import interpolator as k
from nccompile.kernels.curves import NODES

__all__ = ["BURST", "Burst", "Snapshot", "Stepper"]

BURST = 4096
"""Greatest number of cycles in one call."""

_LOG = 4096

Floats = npt.NDArray[np.float64]


class Burst(NamedTuple):
    """What a call put out, m cycles: views of arrays that the next call overwrites.

    position f8 (m, axes); velocity f8 (m,) path length per cycle time [mm/s]; line i4 (m,); status u1 (m,)
    SMC_INT_STATUS; switches u4 (m,) bit b for switch b + 1; log i8 (r, 3): cycle of this call, switch number,
    source line; reason: why it ended (`interpolator.RAN` ...); dropped: rows that are done.
    """

    position: Floats
    velocity: Floats
    line: npt.NDArray[np.int32]
    status: npt.NDArray[np.uint8]
    switches: npt.NDArray[np.uint32]
    log: npt.NDArray[np.int64]
    reason: int
    dropped: int

    def __len__(self) -> int:
        return len(self.velocity)


@dataclass(frozen=True)
class Snapshot:
    """A saved state of a `Stepper`."""

    f: Floats
    i: npt.NDArray[np.int64]
    here: Floats
    nodes_u: Floats
    nodes_s: Floats


class Stepper:
    """Runs `advance` over rows that somebody else supplies.

    start: Shape (axes,), the set position before the first row.
    """

    def __init__(self, start: Floats) -> None:
        axes = len(start)
        self.f = k.state_f()
        self.i = k.state_i()
        self.here = np.array(start, np.float64)
        self._nodes_u = np.zeros(NODES)
        self._nodes_s = np.zeros(NODES)
        self._position = np.zeros((BURST, axes))
        self._velocity = np.zeros(BURST)
        self._line = np.zeros(BURST, np.int32)
        self._status = np.zeros(BURST, np.uint8)
        self._switches = np.zeros(BURST, np.uint32)
        self._log = np.zeros((_LOG, 3), np.int64)
        self._version = -1
        self._settled = 0  # rows from the head on whose end velocity is final

    def run(
        self, rows: k.Rows, head: int, tail: int, *, complete: bool, version: int, inputs: k.Inputs, n: int
    ) -> Burst:
        """Runs up to n <= BURST cycles over rows head..tail-1.

        version: changes whenever rows were added or moved; complete: no row will follow.
        """
        i = self.i
        if version != self._version:
            self._version = version
            self._settled = k.limit_ends(rows, head, tail, int(complete), float(self.f[k.OVERRIDE]))
        override = self.f[k.OVERRIDE]
        done, reason, logged, dropped = k.advance(
            rows, head, tail, self._settled, int(complete), inputs, min(n, BURST), self.f, i,
            self._nodes_u, self._nodes_s, self.here, self._position, self._velocity, self._line, self._status,
            self._switches, self._log,
        )  # fmt: skip
        self._settled = max(0, self._settled - dropped)
        if self.f[k.OVERRIDE] != override:
            self._version = -1
        return Burst(
            self._position[:done], self._velocity[:done], self._line[:done], self._status[:done],
            self._switches[:done], self._log[:logged], reason, dropped,
        )  # fmt: skip

    def place(self, rows: k.Rows, row: int, s: float, inputs: k.Inputs) -> None:
        """Puts the path at rest at path length `s` of a row of a whole path; the next `run` starts there.

        Switch points before that place count as passed; what waits is left.
        """
        f, i = self.f, self.i
        k.limit_ends(rows, row, len(rows.kind), 1, float(f[k.OVERRIDE]))
        k.rest_at(rows, row, s, inputs, f, i, self._nodes_u, self._nodes_s)
        self._version = -1
        k.shift(rows, row, i, -1)

    def tangent(self, rows: k.Rows, head: int) -> tuple[float, float, float]:
        """Direction of the path in X, Y, Z at the present set position; zeros at rest (vecActTangent)."""
        if self.f[k.V] == 0.0 or self.i[k.RUNNING] == 0:
            return 0.0, 0.0, 0.0
        out, s = np.zeros(3), float(self.f[k.S])
        k.direction(
            rows, head + int(self.i[k.ROW]), s, self._nodes_u, self._nodes_s, int(self.i[k.NODES]), out
        )
        return float(out[0]), float(out[1]), float(out[2])

    def snapshot(self) -> Snapshot:
        """The state, to come back to."""
        return Snapshot(
            self.f.copy(),
            self.i.copy(),
            self.here.copy(),
            self._nodes_u.copy(),
            self._nodes_s.copy(),
        )

    def restore(self, saved: Snapshot) -> None:
        """Comes back to a snapshot; the caller takes back its drops."""
        self.f[:] = saved.f
        self.i[:] = saved.i
        self.here[:] = saved.here
        self._nodes_u[:] = saved.nodes_u
        self._nodes_s[:] = saved.nodes_s
        self._version = -1
