"""Old analyses are free at once: the server looks for garbage only when nobody types."""

from __future__ import annotations

import asyncio
import gc
from collections.abc import Iterator

import pytest

from nccompile.lsp.analysis import Analysis
from nccompile.lsp.document import Document
from nccompile.lsp.session import Session

URI = "untitled:a"


@pytest.fixture
def _without_collection() -> Iterator[None]:
    gc.collect()
    yield
    gc.enable()  # the session turned it off


async def _edits() -> list[int]:
    """The versions whose analyses are still there after some edits, of which every second one was planned."""
    session = Session(lambda document, complete: None, pytest.fail, lambda document, seconds: None)
    document = Document(URI, 1, "% a\nN10 G1 X1 F20\n", "utf-16")
    session.open(document)
    for at in range(6):
        document.edit((1, 0), (1, 0), "(new)\n")
        document.version += 1
        session.changed(document)
        if at % 2:
            await session.analysis(URI, with_times=True)
    await session.analysis(URI, with_times=True)
    await asyncio.sleep(0)
    left = [one.version for one in gc.get_objects() if isinstance(one, Analysis)]
    session.shut_down()
    return left


@pytest.mark.usefixtures("_without_collection")
def test_only_the_newest_analysis_is_kept() -> None:
    assert asyncio.run(_edits()) == [7]
