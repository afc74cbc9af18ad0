"""Stages that run beside each other: an iterator whose items are made ahead by a thread of its own.

The order of items, and so every result, is that of the iterator.  What gains is whatever leaves the interpreter:
kernels, checksums, files.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable
from queue import Full, Queue
from threading import Event, Thread
from typing import TypeVar

__all__ = ["ahead"]

T = TypeVar("T")

_PATIENCE = 0.05
"""Seconds after which a thread that waits for room looks whether anybody still wants its items."""


def ahead(items: Iterable[T], depth: int = 2) -> Generator[T, None, None]:
    """Hands items on, at most `depth` of which wait; what the iterator raises is raised here.

    The thread starts with the first item that is asked for and ends with this generator.
    """
    waiting: Queue[tuple[bool, T | BaseException | None]] = Queue(depth)
    unwanted = Event()

    def put(is_item: bool, item: T | BaseException | None) -> bool:
        while not unwanted.is_set():
            try:
                waiting.put((is_item, item), timeout=_PATIENCE)
            except Full:
                continue
            return True
        return False

    def work() -> None:
        try:
            for item in items:
                if not put(True, item):
                    return
            put(False, None)
        except BaseException as error:
            put(False, error)

    Thread(target=work, daemon=True).start()
    try:
        while True:
            is_item, item = waiting.get()
            if is_item:
                yield item  # type: ignore[misc]  # an item, as the flag says
            elif item is None:
                return
            else:
                raise item  # type: ignore[misc]
    finally:
        unwanted.set()
