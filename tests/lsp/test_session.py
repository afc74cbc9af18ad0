"""A long session: random edits, undo, huge pastes, unsaved files, cancelled requests.

After each stretch the findings equal those of a server that opens the same text fresh.
"""

from __future__ import annotations

import random
import time
from collections.abc import Callable
from typing import Any

import pytest

from nccompile.diagnostics import render
from nccompile.lint.config import Config
from nccompile.lint.engine import lint
from nccompile.lsp.text import split
from nccompile.source import Source
from tests.lint.programs import OPTIONS
from tests.lsp.client import Client, Failed, Json, serving, span

PIECES = [
    "N10 G1 X1 F20\n", "G2 X5 Y5 I2 J2\n", "g0x1", "\n", "\r\n", "\r", "(note", ")", "% b\n", "X1,5",
    "N20 G20 L10 K$a$\n", "N10 G36 O$a$ D2\n", "N30 G37 O$a$ D-1\n", "\U0001f600", "ä", " ", "\t",
    "G41 D3\n", "G40\n", "M8\n", "/", "\x0c", "$", "1e-05",
]  # fmt: skip


def place(text: str, offset: int) -> Json:
    """The position of an offset, in UTF-16; one inside a CR LF counts as before it."""
    lines, ends = split(text)
    for line, content in enumerate(lines):
        if offset <= len(content):
            return {"line": line, "character": len(content[:offset].encode("utf-16-le")) // 2}
        offset -= len(content) + len(ends[line] if line < len(ends) else "")
        if offset < 0:
            return {"line": line, "character": len(content.encode("utf-16-le")) // 2}
    return {"line": len(lines), "character": 0}


class Writer:
    """Keeps the text of a document as a plain string beside the server's lines."""

    def __init__(self, client: Client, uri: str, text: str, seed: int) -> None:
        self.client, self.uri, self.text = client, uri, text
        self.random = random.Random(seed)
        self.past: list[str] = []
        client.open(uri, text)

    def replace(self, begin: int, end: int, new: str) -> None:
        text = self.text
        while 0 < begin < len(text) and text[begin - 1 : begin + 1] == "\r\n":
            begin -= 1
        while 0 < end < len(text) and text[end - 1 : end + 1] == "\r\n":
            end += 1
        change = {"range": {"start": place(text, begin), "end": place(text, end)}, "text": new}
        self.past.append(text)
        self.text = text[:begin] + new + text[end:]
        self.client.change(self.uri, change)

    def whole(self, text: str) -> None:
        self.past.append(self.text)
        self.text = text
        self.client.change(self.uri, {"text": text})

    def step(self) -> None:
        dice = self.random.random()
        size = len(self.text)
        at = self.random.randint(0, size)
        if dice < 0.6:
            self.replace(at, at, self.random.choice(PIECES))
        elif dice < 0.85:
            self.replace(at, min(size, at + self.random.randint(1, 12)), "")
        elif dice < 0.92 and self.past:
            self.whole(self.past.pop())
        elif dice < 0.95:
            paste = "".join(self.random.choice(PIECES[:2]) for _ in range(400))
            self.replace(at, at, paste)
        else:
            self.whole(self.text[: size // 2])

    def expected(self) -> list[str]:
        source = Source(self.uri, self.text)
        return [render(found, source) for found in lint(source, OPTIONS, Config()).ordered()]

    def shown(self) -> list[str]:
        return [found["data"]["rendered"] for found in self.client.checked(self.uri)]


def without_data(found: list[Json]) -> list[Json]:
    return [{key: value for key, value in row.items() if key != "data"} for row in found]


@pytest.mark.parametrize("seed", [1, 2])
def test_findings_after_random_edits_are_those_of_a_fresh_start(seed: int) -> None:
    with serving() as client, serving() as fresh:
        writers = [
            Writer(client, f"untitled:{name}", "% a\nN10 G1 X1 F20\nN20 G1 X2\n", seed * 10 + at)
            for at, name in enumerate(("one", "two"))
        ]
        for stretch in range(6):
            for _ in range(12):
                for writer in writers:
                    writer.step()
            for writer in writers:
                assert writer.shown() == writer.expected()
                uri = f"untitled:fresh-{stretch}-{writer.uri}"
                fresh.open(uri, writer.text)
                assert without_data(fresh.checked(uri)) == without_data(client.checked(writer.uri))


def test_requests_race_with_edits_and_cancellation() -> None:
    with serving() as client:
        writer = Writer(client, "untitled:a", "% a\nN10 G1 X1 F20\n" * 50, 5)
        refused: list[int] = []
        for at in range(30):
            writer.step()
            document = {"textDocument": {"uri": writer.uri}}
            numbers = [
                client.start("textDocument/hover", {**document, "position": {"line": at, "character": 2}}),
                client.start("textDocument/inlayHint", {**document, "range": span(0, 0, 0, 9)}),
                client.start("textDocument/documentSymbol", document),
                client.start("textDocument/semanticTokens/full", document),
            ]
            if at % 3 == 0:
                client.notify("$/cancelRequest", {"id": numbers[0]})
            writer.step()
            for number in numbers:
                try:
                    client.finish(number)
                except Failed as error:
                    refused.append(error.code)
        assert set(refused) == {-32800, -32801}  # cancelled, and edited meanwhile
        assert writer.shown() == writer.expected()


LARGE = "% large\n" + "".join(
    f"N{n * 10} G1 X{n % 97}.{n % 7} Y{n % 89} Z-{n % 13}\n" for n in range(1, 50_001)
).replace("N10 G1", "N10 G1 F20")


def elapsed(what: Callable[[], Any]) -> float:
    begin = time.perf_counter()
    what()
    return time.perf_counter() - begin


def codes_shown(client: Client, uri: str) -> set[str]:
    return {found["code"] for found in client.published(uri)}


def test_edits_of_a_large_file_are_answered_at_once() -> None:
    """The bound is ten times the measured time (benchmarks/bench_lint.py), since tests share their computer."""
    with serving() as client:
        writer = Writer(client, "untitled:large", LARGE, 1)
        client.checked(writer.uri)
        seen = len(client.notifications)

        def edit() -> None:
            nonlocal seen
            at = writer.text.index("N250000 ") + 8
            writer.replace(at, at, "X1,5 ")
            client.wait(
                lambda: (
                    True if any(found["code"] == "NC001" for found in client.published(writer.uri)) else None
                )
            )
            seen = len(client.notifications)

        assert elapsed(edit) < 0.5
        assert len(client.notifications) == seen
        assert writer.shown() == writer.expected()
