"""What a worker gave is free as soon as nobody wants it, without a search for garbage."""

from __future__ import annotations

import asyncio
import gc
import threading
import weakref
from collections.abc import Iterator
from contextlib import suppress
from typing import TypeVar

import pytest

from nccompile.lsp.threads import Worker

R = TypeVar("R", "Result", "Refusal")


class Result:
    """Something that weak references can watch."""


class Refusal(Exception):
    """What a job may raise."""


@pytest.fixture
def worker() -> Iterator[Worker]:
    gc.collect()
    gc.disable()
    worker = Worker("test")
    yield worker
    worker.shut_down()
    gc.enable()


def test_results_and_errors_leave_no_ring(worker: Worker) -> None:
    watched: list[weakref.ref[Result | Refusal]] = []

    def made(kind: type[R]) -> R:
        one = kind()
        watched.append(weakref.ref(one))
        return one

    def refuse() -> None:
        raise made(Refusal)

    async def both() -> None:
        assert isinstance(await worker.run(made, Result), Result)
        with suppress(Refusal):
            await worker.run(refuse)

    asyncio.run(both())
    asyncio.run(worker.run(int))  # the thread forgets a job when it takes the next
    assert [one() for one in watched] == [None, None]


def test_a_job_that_is_given_up_is_not_begun(worker: Worker) -> None:
    done: list[str] = []
    hold = threading.Event()

    async def session() -> None:
        first = asyncio.create_task(worker.run(hold.wait))
        second = asyncio.create_task(worker.run(done.append, "second"))
        await asyncio.sleep(0.01)
        second.cancel()
        with pytest.raises(asyncio.CancelledError):
            await second
        hold.set()
        await first
        await worker.run(done.append, "third")

    asyncio.run(session())
    assert done == ["third"]
