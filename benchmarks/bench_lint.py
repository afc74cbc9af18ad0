"""The linter: wall and processor time of whole processes."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter

from benchmarks.inputs import program

LINES = 100_000
RUNS = 5


def _lint(path: Path) -> tuple[float, float]:
    """Median wall and processor time of `nccompile lint`; the first run, which warms caches, does not count.

    Byte code is kept, as it is where the package is installed, whatever the environment says.
    """
    walls, works = [], []
    kept = {"PYTHONPYCACHEPREFIX": str(path.parent / "byte-code"), "PYTHONDONTWRITEBYTECODE": ""}
    for _ in range(RUNS + 1):
        begin, worked = perf_counter(), _children()
        subprocess.run(
            [sys.executable, "-m", "nccompile", "lint", str(path)],
            capture_output=True,
            check=False,
            env={**os.environ, **kept},
        )
        walls.append(perf_counter() - begin)
        works.append(_children() - worked)
    return median(walls[1:]), median(works[1:])


def _children() -> float:
    """Processor time of all processes that have ended [s]."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


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
        path.write_text("% a\n" + "(a comment, a whole line)\n" * LINES)
        print(_row(f"{LINES:,} comments", *_lint(path)))
        path.write_text("")
        print(_row("empty file", *_lint(path)))
        path.write_text("% a\n(a comment)\n")
        print(_row("a comment only", *_lint(path)))
