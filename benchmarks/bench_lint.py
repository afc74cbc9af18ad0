"""The linter and the language server: wall time of whole processes, and of an edit in a large document."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter

from benchmarks.inputs import program
from tests.lsp.client import Client, Json

LINES = 100_000
LARGE = 50_000
EDITS = 40
RUNS = 5


def _lint(path: Path) -> float:
    """The median wall time of `nccompile lint`; the first run, which warms caches, does not count."""
    times = []
    for _ in range(RUNS + 1):
        begin = perf_counter()
        subprocess.run(
            [sys.executable, "-m", "nccompile", "lint", str(path)], capture_output=True, check=False
        )
        times.append(perf_counter() - begin)
    return median(times[1:])


def _news(client: Client, seen: int) -> Callable[[], bool | None]:
    return lambda: True if len(client.notifications) > seen else None


def _edits(text: str) -> tuple[list[float], float]:
    """Seconds from an edit to the findings of its line, and to all findings after the last one."""
    client = Client()
    uri = "untitled:large"
    client.open(uri, text)
    client.checked(uri)
    times = []
    for at in range(EDITS):
        line = 1000 + at * 1000
        place = {"line": line, "character": 0}
        change: Json = {"range": {"start": place, "end": place}, "text": "X1,5 "}
        seen = len(client.notifications)
        begin = perf_counter()
        client.change(uri, change)
        client.wait(_news(client, seen))
        times.append(perf_counter() - begin)
        client.change(uri, {"range": {"start": place, "end": {"line": line, "character": 5}}, "text": ""})
        client.checked(uri)
    top = {"line": 1, "character": 0}
    begin = perf_counter()
    client.change(uri, {"range": {"start": top, "end": top}, "text": "(a new line moves all others)\n"})
    client.checked(uri)
    whole = perf_counter() - begin
    client.request("shutdown", None)
    client.notify("exit", None)
    client.process.wait()
    return times, whole


def main() -> None:
    """Prints the times."""
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "p.nc"
        path.write_text(program(LINES))
        print(f"lint      {LINES:,} lines, whole process     {_lint(path):7.2f} s, median of {RUNS}")
        path.write_text("")
        print(f"lint      empty file, whole process       {1000 * _lint(path):6.0f} ms, median of {RUNS}")
    times, whole = _edits(program(LARGE))
    times.sort()
    print(
        f"lsp       an edit in {LARGE:,} lines to its finding {1000 * median(times):6.1f} ms in the median, "
        f"{1000 * times[-1]:.1f} ms at worst of {EDITS}; all findings after a new first line in {whole:.2f} s"
    )
