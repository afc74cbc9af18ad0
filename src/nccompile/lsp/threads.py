"""Work in a thread, awaited.

asyncio's `run_in_executor` ties two futures and their callbacks into a ring that holds the result until garbage is
collected; here that would be the analysis of every version of a large program.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Any, ParamSpec, TypeVar

__all__ = ["Worker"]

P = ParamSpec("P")
R = TypeVar("R")


class Worker:
    """A thread that does one thing after the other."""

    def __init__(self, name: str) -> None:
        self._pool = ThreadPoolExecutor(1, thread_name_prefix=name)

    async def run(self, function: Callable[P, R], *arguments: P.args, **named: P.kwargs) -> R:
        """What a function gives or raises; given up, it is not begun any more, but if begun goes on to its end."""
        loop = asyncio.get_running_loop()
        answer: asyncio.Future[R] = loop.create_future()
        job = self._pool.submit(_work, loop, [answer], lambda: function(*arguments, **named))
        try:
            return await answer
        except asyncio.CancelledError:
            job.cancel()
            raise
        finally:
            del answer  # an exception holds this frame, and the future the exception

    def start(self, function: Callable[P, object], *arguments: P.args, **named: P.kwargs) -> None:
        """Has something done that nobody waits for."""
        with suppress(RuntimeError):  # after the end nothing has to be done any more
            self._pool.submit(function, *arguments, **named)

    def finish(self) -> None:
        """Ends the thread when all is done that was asked for."""
        self._pool.shutdown(wait=False)

    def shut_down(self) -> None:
        """Gives up what has not begun."""
        self._pool.shutdown(wait=False, cancel_futures=True)


def _work(loop: asyncio.AbstractEventLoop, held: list[asyncio.Future[R]], function: Callable[[], R]) -> None:
    """Does a job; its future is taken out of `held`, which the pool's frames keep."""
    answer = held.pop()
    try:
        _tell(loop, _give, answer, function())
    except BaseException as error:
        _tell(loop, _fail, answer, error)
    finally:
        del answer


def _tell(loop: asyncio.AbstractEventLoop, tell: Callable[..., None], *what: Any) -> None:
    if not loop.is_closed():
        loop.call_soon_threadsafe(tell, *what)


def _give(answer: asyncio.Future[R], result: R) -> None:
    if not answer.done():
        answer.set_result(result)


def _fail(answer: asyncio.Future[R], error: BaseException) -> None:
    if not answer.done():
        answer.set_exception(error)
