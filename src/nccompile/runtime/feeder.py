"""The slow task: refills the ring buffer from the chunks of a queue (SoftMotion §3.1, §11.7.2)."""

from __future__ import annotations

from collections.abc import Iterator
from threading import Event, Thread

from nccompile.runtime.ring import RingBuffer
from nccompile.toolpath.columns import Toolpath

__all__ = ["Feeder"]

_SLICE = 256
"""Rows that the thread pushes at a time: the cyclic task gets its turn in between."""


class Feeder:
    """Pulls planned chunks and pushes their rows.

    chunks: the rest of the path after `first`; low_water: the buffer is refilled when it holds fewer rows.
    In virtual time the cyclic task calls `fill`; in real time `start` does it in a thread of its own.
    """

    def __init__(self, first: Toolpath, chunks: Iterator[Toolpath], ring: RingBuffer, low_water: int) -> None:
        self._chunks, self._chunk, self._at = chunks, first, 0
        self._ring = ring
        self._low_water = min(low_water, ring.capacity)
        self._thread: Thread | None = None
        self._stop = Event()
        self._error: BaseException | None = None

    @property
    def is_done(self) -> bool:
        """Whether the whole path has been pushed."""
        return self._ring.end_of_list

    def fill(self, rows: int | None = None) -> int:
        """Pushes until the buffer is full, the path ends or `rows` were pushed; returns how many were."""
        pushed = 0
        while not self.is_done and (rows is None or pushed < rows):
            if self._at >= len(self._chunk):
                following = next(self._chunks, None)
                if following is None:
                    self._ring.close()
                    break
                self._chunk, self._at = following, 0
                continue
            limit = None if rows is None else rows - pushed
            taken = self._ring.push(self._chunk, self._at, limit)
            self._at += taken
            pushed += taken
            if taken == 0:
                break
        return pushed

    def refill(self) -> None:
        """`fill` if fewer rows than the low water mark are left."""
        if not self.is_done and self._ring.count < self._low_water:
            self.fill()

    def start(self, pause: float) -> None:
        """Fills the buffer, then keeps it filled from a thread that looks every `pause` seconds."""
        self.fill()
        self._thread = Thread(target=self._run, args=(pause,), name="nccompile-feeder", daemon=True)
        self._thread.start()

    def _run(self, pause: float) -> None:
        try:
            while not self._stop.is_set() and not self.is_done:
                if self._ring.count < self._low_water:
                    while not self._stop.is_set() and self.fill(_SLICE):
                        pass
                self._stop.wait(pause)
        except BaseException as error:  # the cyclic task raises it in `check`
            self._error = error

    def check(self) -> None:
        """Raises what ended the thread, if anything did."""
        if self._error is not None:
            raise self._error

    def stop(self) -> None:
        """Ends the thread and waits for it."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join()
