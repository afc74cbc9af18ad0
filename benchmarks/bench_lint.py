"""The linter and the language server: wall time of whole processes, and of an edit in a large document."""

from __future__ import annotations

import resource
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


def _lint(path: Path) -> tuple[float, float]:
    """Median wall and processor time of `nccompile lint`; the first run, which warms caches, does not count."""
    walls, works = [], []
    for _ in range(RUNS + 1):
        begin, worked = perf_counter(), _children()
        subprocess.run(
            [sys.executable, "-m", "nccompile", "lint", str(path)], capture_output=True, check=False
        )
        walls.append(perf_counter() - begin)
        works.append(_children() - worked)
    return median(walls[1:]), median(works[1:])


def _children() -> float:
    """Processor time of all processes that have ended [s]."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


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


def _row(what: str, wall: float, work: float) -> str:
    return (
        f"lint      {what}, whole process: {wall:.2f} s, of it {work:.2f} s processor time, median of {RUNS}"
    )


def main() -> None:
    """Prints the times."""
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "p.nc"
        path.write_text(program(LINES))
        print(_row(f"{LINES:,} lines", *_lint(path)))
        path.write_text("")
        print(_row("empty file", *_lint(path)))
    times, whole = _edits(program(LARGE))
    times.sort()
    print(
        f"lsp       an edit in {LARGE:,} lines to its finding {1000 * median(times):6.1f} ms in the median, "
        f"{1000 * times[-1]:.1f} ms at worst of {EDITS}; all findings after a new first line in {whole:.2f} s"
    )
