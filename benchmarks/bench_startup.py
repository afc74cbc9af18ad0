"""Start-up: wall time of whole processes, medians over runs."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter

from benchmarks.inputs import program

RUNS = 15


def _median(arguments: list[str], folder: Path) -> float:
    times = []
    for _ in range(RUNS):
        begin = perf_counter()
        subprocess.run(
            [sys.executable, "-m", "nccompile", *arguments], cwd=folder, check=True, stdout=subprocess.DEVNULL
        )
        times.append(perf_counter() - begin)
    return median(times)


def main() -> None:
    """Prints the medians."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "p.nc").write_text(program(100))
        for arguments in (
            ["--version"],
            ["--help"],
            ["compile", "p.nc"],
            ["info", "p.ncq"],
            ["run", "p.ncq"],
        ):
            seconds = _median(arguments, folder)
            print(f"startup   nccompile {' '.join(arguments):<14} {1000 * seconds:7.0f} ms, median of {RUNS}")
