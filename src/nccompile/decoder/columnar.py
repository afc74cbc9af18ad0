"""Runs of plain blocks by the kernel, with the modal state of the statement-wise decoder.

Modal, ChunkBuilder ──> state arrays ──> kernels.decode ──> state arrays ──> Modal, ChunkBuilder
"""

from __future__ import annotations

import numpy as np

from nccompile.decoder.core import LIMIT, Core
from nccompile.decoder.motion import Motion
from nccompile.geometry import Curve
from nccompile.geometry.arcs import TOLERANCES
from nccompile.kernels import decode as kernels
from nccompile.parser.scanner import Table
from nccompile.toolpath.columns import Kind, Plane

__all__ = ["Runs"]

_MOST_LEFT = 64
"""Blocks that are decoded one by one before a run is tried again, where runs have been empty."""

_ARC_PARAMETERS = 5


class Runs:
    """Decodes as many blocks of a table as the kernel can at once."""

    def __init__(self, core: Core, motion: Motion) -> None:
        self._core = core
        self._motion = motion
        self._numbers = np.zeros(kernels.NUMBERS)
        self._flags = np.zeros(kernels.FLAGS, np.int64)
        axes = len(core.axes)
        self._position, self._goal = np.zeros(axes), np.zeros(axes)
        self._arc = np.zeros(_ARC_PARAMETERS)
        self._column = np.full(128, -1, np.int64)
        for letter, at in core.index.items():
            self._column[ord(letter)] = at
        self._axis_bits = sum(1 << (ord(letter) - ord("A")) for letter in core.axes)
        self._left = 0
        self._leave = 0

    def run(self, table: Table, block: int, most: int | None = None) -> int:
        """Decodes blocks from `block` on, at most `most`; returns the first that must be decoded as a statement."""
        if self._left:
            self._left -= 1
            return block
        if not self._is_possible():
            return block
        self._enter()
        c = self._core.path.columns
        end = table.blocks if most is None else min(table.blocks, block + most)
        stop = kernels.decode(
            block, end, table.block_line, table.block_word, table.plain, table.letter, table.value,
            self._column, self._axis_bits, LIMIT, *TOLERANCES,
            self._numbers, self._flags, self._position, self._goal, self._arc,
            c.kind, c.target, c.curve, c.length, c.feed, c.accel, c.decel, c.radius, c.line, c.plane, c.parameters,
        )  # fmt: skip
        if stop > block:
            self._take_over()
            self._leave = 0
        else:
            self._leave = min(2 * self._leave + 1, _MOST_LEFT)
            self._left = self._leave
        return stop

    def _is_possible(self) -> bool:
        """Whether nothing is open that the next segment would end or take with it."""
        core, motion = self._core, self._motion
        core.path.reserve()
        return not (core.modal.profile or core.has_jump or motion.spline.is_open or motion.marks.waiting)

    def _enter(self) -> None:
        modal, path, numbers, flags = self._core.modal, self._core.path, self._numbers, self._flags
        numbers[: kernels.LEAVE_X] = modal.feed, modal.accel, modal.decel, modal.radius
        flags[kernels.DRIVE] = -1 if modal.drive is None else modal.drive
        flags[kernels.ABSOLUTE] = modal.absolute
        flags[kernels.CENTRE_ABSOLUTE] = modal.centre_absolute
        flags[kernels.NEEDS_FEED] = self._motion.warns_of_feed
        flags[kernels.LEAVING] = kernels.SAME
        flags[kernels.LAST_DRIVE] = -1
        flags[kernels.ROWS], flags[kernels.CURVES] = path.rows, path.curves
        self._position[:] = modal.position

    def _take_over(self) -> None:
        modal, path = self._core.modal, self._core.path
        modal.feed, modal.accel, modal.decel, modal.radius, x, y = self._numbers.tolist()
        drive, absolute, centre_absolute, _, leaving, last_drive, path.rows, path.curves = (
            self._flags.tolist()
        )
        modal.drive = None if drive < 0 else drive
        modal.absolute, modal.centre_absolute = bool(absolute), bool(centre_absolute)
        modal.position = self._position.tolist()
        if last_drive >= 0:
            path.last_drive = path.first + last_drive
        if leaving == kernels.FREE:
            modal.leaving = None
        elif leaving == kernels.ALONG:
            modal.leaving = (x, y)
        elif leaving == kernels.AROUND:
            parameters = path.columns.parameters[path.curves - 1, :_ARC_PARAMETERS].tolist()
            modal.leaving = Curve(Kind.ARC, Plane.XY, tuple(parameters))
