"""A scripted editor: speaks JSON-RPC with `nccompile lsp` over its standard input and output."""

from __future__ import annotations

import json
import queue
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, cast

Json = dict[str, Any]

PATIENCE = 60.0
"""Time after which an answer counts as missing [s]; a loaded machine is slow."""


class Failed(Exception):
    """The server answered with an error; `code` of JSON-RPC."""

    def __init__(self, error: Json) -> None:
        super().__init__(error["message"])
        self.code: int = error["code"]


class Client:
    """One server process."""

    def __init__(self, encodings: list[str] | None = None) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "nccompile", "lsp"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        )  # fmt: skip
        self.incoming: queue.Queue[Json] = queue.Queue()
        self.notifications: list[Json] = []
        self.answers: dict[int, Json] = {}
        self.asked: dict[int, str] = {}
        self.versions: dict[str, int] = {}
        self.texts: dict[str, str] = {}
        self.last_id = 0
        self.said: deque[str] = deque(maxlen=50)
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._listener.start()
        self._reader.start()
        general = {} if encodings is None else {"positionEncodings": encodings}
        capabilities = {
            "general": general,
            "workspace": {"didChangeWatchedFiles": {"dynamicRegistration": True}},
        }
        self.capabilities: Json = self.request(
            "initialize", {"processId": None, "rootUri": None, "capabilities": capabilities}
        )["capabilities"]
        self.notify("initialized", {})

    def _read(self) -> None:
        stream = self.process.stdout
        assert stream is not None
        while True:
            length = 0
            while (header := stream.readline()) not in {b"\r\n", b""}:
                if header.lower().startswith(b"content-length:"):
                    length = int(header.split(b":")[1])
            if not length:
                return
            self.incoming.put(json.loads(stream.read(length)))

    def _listen(self) -> None:
        """Takes what the server logs: a full pipe would stop it."""
        stream = self.process.stderr
        assert stream is not None
        for line in stream:
            self.said.append(line.decode())

    def join(self) -> None:
        """Waits for the ends of what the server wrote."""
        for thread in (self._reader, self._listener):
            thread.join(PATIENCE)

    def send(self, message: Json) -> None:
        stream = self.process.stdin
        assert stream is not None
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        stream.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        stream.flush()

    def notify(self, method: str, params: Any) -> None:
        self.send({"method": method, "params": params})

    def start(self, method: str, params: Any) -> int:
        self.last_id += 1
        self.asked[self.last_id] = method
        self.send({"id": self.last_id, "method": method, "params": params})
        return self.last_id

    def finish(self, number: int) -> Any:
        message = self.wait(lambda: self.answers.get(number))
        if "error" in message:
            raise Failed(message["error"])
        return message["result"]

    def request(self, method: str, params: Any) -> Any:
        return self.finish(self.start(method, params))

    def wait(self, found: Callable[[], Any]) -> Any:
        """Handles messages until `found` gives something."""
        until = time.monotonic() + PATIENCE
        while (value := found()) is None:
            message = self._next(until)
            if "method" in message and "id" in message:
                self.send({"id": message["id"], "result": None})
                self.notifications.append(message)
            elif "method" in message:
                self.notifications.append(message)
            else:
                self.answers[message["id"]] = message
        return value

    def _next(self, until: float) -> Json:
        """The next message; fails with what the server said if it has ended or keeps silent."""
        while True:
            try:
                return self.incoming.get(timeout=0.5)
            except queue.Empty:
                code = self.process.poll()
                if code is None and time.monotonic() < until:
                    continue
                if code is not None:
                    self._listener.join(PATIENCE)
                open_ones = [f"{n} {m}" for n, m in self.asked.items() if n not in self.answers]
                state = f"keeps silent of {open_ones}" if code is None else f"ended with code {code}"
                raise AssertionError(f"the server {state}: {''.join(self.said)}") from None

    def open(self, uri: str, text: str) -> None:
        self.versions[uri], self.texts[uri] = 1, text
        item = {"uri": uri, "languageId": "din66025", "version": 1, "text": text}
        self.notify("textDocument/didOpen", {"textDocument": item})

    def change(self, uri: str, *changes: Json) -> None:
        self.versions[uri] += 1
        document = {"uri": uri, "version": self.versions[uri]}
        self.notify("textDocument/didChange", {"textDocument": document, "contentChanges": list(changes)})

    def close(self, uri: str) -> None:
        self.notify("textDocument/didClose", {"textDocument": {"uri": uri}})

    def checked(self, uri: str) -> list[Json]:
        """The complete findings of the newest version."""

        def complete() -> list[Json] | None:
            done = [
                message["params"]
                for message in self.notifications
                if message["method"] == "nccompile/checked"
                and message["params"]["uri"] == uri
                and message["params"]["version"] == self.versions[uri]
            ]
            return self.published(uri) if done else None

        return cast(list[Json], self.wait(complete))

    def published(self, uri: str) -> list[Json]:
        """The findings that were published last."""
        shown = [
            message["params"]["diagnostics"]
            for message in self.notifications
            if message["method"] == "textDocument/publishDiagnostics" and message["params"]["uri"] == uri
        ]
        return cast(list[Json], shown[-1]) if shown else []

    def forget(self, uri: str) -> None:
        """Drops what was said of a document."""
        self.notifications = [m for m in self.notifications if m["params"].get("uri") != uri]

    def at(self, method: str, uri: str, line: int, character: int, **more: Any) -> Any:
        place = {"line": line, "character": character}
        return self.request(method, {"textDocument": {"uri": uri}, "position": place, **more})

    def of(self, method: str, uri: str, **more: Any) -> Any:
        return self.request(method, {"textDocument": {"uri": uri}, **more})


def span(line: int, start: int, end: int, last: int | None = None) -> Json:
    return {
        "start": {"line": line, "character": start},
        "end": {"line": line if last is None else last, "character": end},
    }


@contextmanager
def serving(encodings: list[str] | None = None) -> Iterator[Client]:
    """A server that is ended as an editor does, and must leave with code 0."""
    client = Client(encodings)
    try:
        yield client
        client.request("shutdown", None)
        client.notify("exit", None)
        assert client.process.wait(PATIENCE) == 0
    finally:
        client.process.kill()
        client.process.wait()
        client.join()
        for stream in (client.process.stdin, client.process.stdout, client.process.stderr):
            assert stream is not None
            stream.close()


def uri_of(path: Path) -> str:
    return path.as_uri()
