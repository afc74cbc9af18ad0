"""One who types: random edits, undo, pastes, requests, some of them cancelled, in one document of a server."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

from nccompile.decoder import DecodeOptions
from nccompile.diagnostics import render
from nccompile.lint.config import Config, config_for
from nccompile.lint.engine import lint
from nccompile.lsp.text import split
from nccompile.machine.model import default_machine, load
from nccompile.source import Source
from nccompile.toolchain import Options
from tests.lsp.client import Client, Failed, Json, span

__all__ = ["Writer", "place", "taken", "without_data"]

PIECES = [
    "N10 G1 X1 F20\n", "G2 X5 Y5 I2 J2\n", "g0x1", "\n", "\r\n", "\r", "(note", ")", "% b\n", "X1,5",
    "N20 G20 L10 K$a$\n", "N10 G36 O$a$ D2\n", "N30 G37 O$a$ D-1\n", "\U0001f600", "ä", " ", "\t",
    "G41 D3\n", "G40\n", "M8\n", "/", "\x0c", "$", "1e-05", "G91\n", "G90\n", "N5 G0 X500\n", "(nc: ignore)",
]  # fmt: skip

REFUSALS = {-32800, -32801, -32803}
"""Cancelled, edited meanwhile, cannot be done: what a request that races with edits may be answered with."""


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


def offset(text: str, at: Json) -> int:
    """The offset of a position, in UTF-16."""
    lines, ends = split(text)
    before = sum(len(lines[row]) + len(ends[row]) for row in range(at["line"]))
    units = lines[at["line"]].encode("utf-16-le")[: 2 * at["character"]]
    return before + len(units.decode("utf-16-le"))


def taken(text: str, edits: list[Json]) -> str:
    """A text with edits that the server proposes; they lie one behind the other."""
    for edit in reversed(edits):
        begin, end = (offset(text, edit["range"][key]) for key in ("start", "end"))
        text = text[:begin] + edit["newText"] + text[end:]
    return text


def is_inside_end(text: str, at: int) -> bool:
    """Whether an offset lies between a CR and its LF, where no position is."""
    return 0 < at < len(text) and text[at - 1 : at + 1] == "\r\n"


class Writer:
    """Keeps the text of a document as a plain string beside the server's lines."""

    def __init__(self, client: Client, uri: str, text: str, seed: int, path: Path | None = None) -> None:
        self.client, self.uri, self.text, self.path = client, uri, text, path
        self.random = random.Random(seed)
        self.past: list[str] = []
        self.refused: set[int] = set()
        client.open(uri, text)

    def become(self, new: str) -> None:
        """Makes the text another one by one incremental change, as short as can be."""
        old = self.text
        short = min(len(old), len(new))
        begin = next((at for at in range(short) if old[at] != new[at]), short)
        same = next((at for at in range(short - begin) if old[-1 - at] != new[-1 - at]), short - begin)
        end = len(old) - same
        while is_inside_end(old, begin):
            begin -= 1
        while is_inside_end(old, end):
            end += 1
        inserted = new[begin : len(new) - (len(old) - end)]
        change = {"range": {"start": place(old, begin), "end": place(old, end)}, "text": inserted}
        self.past.append(old)
        self.text = new
        self.client.change(self.uri, change)

    def replace(self, begin: int, end: int, new: str) -> None:
        """Replaces some of the text."""
        self.become(self.text[:begin] + new + self.text[end:])

    def whole(self, text: str) -> None:
        """Sends a whole new text."""
        self.past.append(self.text)
        self.text = text
        self.client.change(self.uri, {"text": text})

    def step(self, paste: int = 400) -> None:
        """One random edit; a paste has up to `paste` lines."""
        dice = self.random.random()
        size = len(self.text)
        at = self.random.randint(0, size)
        if dice < 0.6:
            self.replace(at, at, self.random.choice(PIECES))
        elif dice < 0.82:
            self.replace(at, min(size, at + self.random.randint(1, 12)), "")
        elif dice < 0.89 and self.past:
            self.become(self.past.pop())
        elif dice < 0.92 and self.past:
            self.whole(self.past.pop())
        elif dice < 0.95:
            rows = self.random.randint(paste // 2, paste)
            self.replace(at, at, "".join(self.random.choice(PIECES[:2]) for _ in range(rows)))
        else:
            self.whole(self.text[: size // 2])

    def ask(self) -> None:
        """Requests of all kinds in one go, some cancelled, with an edit before the answers are read."""
        line = self.random.randint(0, self.text.count("\n"))
        here = {"position": {"line": line, "character": self.random.randint(0, 8)}}
        area = {"range": span(line, 0, 0, line + 20)}
        asked: list[tuple[str, Json]] = [
            ("hover", here), ("completion", here), ("definition", here), ("rename", {**here, "newName": "7"}),
            ("references", {**here, "context": {"includeDeclaration": True}}), ("inlayHint", area),
            ("codeAction", {**area, "context": {"diagnostics": []}}), ("codeLens", {}), ("documentSymbol", {}),
            ("foldingRange", {}), ("semanticTokens/full", {}),
            ("semanticTokens/full/delta", {"previousResultId": "1"}),
        ]  # fmt: skip
        numbers = []
        for method, params in self.random.sample(asked, 5):
            params = {"textDocument": {"uri": self.uri}, **params}
            numbers.append(self.client.start("textDocument/" + method, params))
            if self.random.random() < 0.3:
                self.client.notify("$/cancelRequest", {"id": numbers[-1]})
        if self.random.random() < 0.7:
            self.step(50)
        for number in numbers:
            try:
                self.client.finish(number)
            except Failed as error:
                if error.code not in REFUSALS:
                    raise
                self.refused.add(error.code)

    def accept(self) -> None:
        """Has the text formatted or its blocks numbered anew, and takes what the server proposes."""
        if self.random.random() < 0.5:
            edits = self.client.of(
                "textDocument/formatting", self.uri, options={"tabSize": 1, "insertSpaces": True}
            )
        else:
            only = {"diagnostics": [], "only": [self.random.choice(["source.fixAll", "source.renumber"])]}
            (action,) = self.client.of("textDocument/codeAction", self.uri, range=span(0, 0, 0), context=only)
            try:
                edits = self.client.request("codeAction/resolve", action)["edit"]["changes"][self.uri]
            except Failed as error:
                if error.code not in REFUSALS:
                    raise
                return
        self.become(taken(self.text, edits))

    def reopen(self) -> None:
        """Closes the document and opens it again."""
        self.client.close(self.uri)
        self.client.forget(self.uri)
        self.client.open(self.uri, self.text)

    def expected(self) -> list[str]:
        """What `nccompile lint` prints of the text, under the settings of its folder."""
        config = Config() if self.path is None else config_for(self.path)
        machine = default_machine() if config.machine is None else load(config.machine)
        options = Options(machine, DecodeOptions(max_switches=machine.path.max_switches))
        source = Source(self.uri if self.path is None else str(self.path), self.text)
        return [render(found, source) for found in lint(source, options, config).ordered()]

    def shown(self) -> list[str]:
        """What the server says of the newest text, as `lint` prints it."""
        return [found["data"]["rendered"] for found in self.client.checked(self.uri)]


def without_data(found: list[Json]) -> list[Any]:
    """Findings without the text that `lint` prints, which names the file."""
    return [{key: value for key, value in row.items() if key != "data"} for row in found]
