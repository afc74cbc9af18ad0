"""The front end on a program of a million lines: by stage on one core, and the whole command.

    python -m benchmarks.bench_front_end [FILE]

The program is of the kind of `finish` of the peers' comparison (short lines in three axes, N on every line, F
now and then), or FILE.  Figures a core are by processor time, which other jobs disturb less.  Kernels are warm:
compiled before, as in every run but the first on a computer.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from math import cos, sin
from pathlib import Path
from time import perf_counter, process_time

from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostics
from nccompile.kernels import use
from nccompile.parser import scanner
from nccompile.source import LargeSource, Source
from nccompile.toolpath import ADDITIONAL

LINES = 1_000_000
REPEATS = 5


def finishing(lines: int) -> str:
    """Passes over a free-form surface."""
    rows = ["% finish", "N10 G90", "N20 G0 Z25. F166.667 E2000 E-2000", "N30 G1 Z3.426 F13.333"]
    for number in range(4, lines):
        along, across = divmod(number, 500)
        x = across * 0.6 if along % 2 else 300.0 - across * 0.6
        z = 5.0 + 3.0 * sin(0.02 * x) * cos(0.03 * along)
        turn = f" Y{0.2 * along:.3f} F80." if across == 0 else ""
        rows.append(f"N{10 * number} G1 X{x:.3f}{turn} Z{z:.3f}")
    return "\n".join(rows) + "\n"


def main(given: Path | None = None) -> None:
    """Prints lines a second of each stage and the figures of whole compilations."""
    use(compiled=True)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "program.nc"
        file.write_text(finishing(LINES) if given is None else given.read_text())
        lines = file.read_bytes().count(b"\n")
        for name, stage in (
            ("survey", _survey),
            ("survey and scan", _scan),
            ("survey, scan and decode", _decode),
        ):
            seconds = min(_timed(stage, file) for _ in range(REPEATS))
            print(f"{name}: {lines / seconds / 1e6:.1f} million lines/s on a core ({seconds * 1e3:.0f} ms)")
        for _ in range(2):
            _whole(file)  # the first one leaves the machine code behind
        runs = [_whole(file) for _ in range(REPEATS)]
        wall, busy, memory = min(runs)
        print(
            f"nccompile compile, {lines:,} lines: {wall:.2f} s wall, {busy:.2f} s of processor time, {memory} MB"
        )


def _timed(stage: Callable[[LargeSource], None], file: Path) -> float:
    source = Source.read(file)
    assert isinstance(source, LargeSource)
    begin = process_time()
    stage(source)
    return process_time() - begin


def _survey(source: LargeSource) -> None:
    scanner.survey(source, ADDITIONAL)


def _scan(source: LargeSource) -> None:
    _survey(source)
    for _ in scanner.tables(source):
        pass


def _decode(source: LargeSource) -> None:
    for _ in decode(source, DecodeOptions(), Diagnostics()):
        pass


def _whole(file: Path) -> tuple[float, float, int]:
    """Wall time [s], processor time [s] and peak memory [MB] of one command."""
    command = [sys.executable, "-m", "nccompile", "compile", str(file), "-o", str(file.with_suffix(".ncq"))]
    begin = perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    assert status == 0
    return perf_counter() - begin, usage.ru_utime + usage.ru_stime, usage.ru_maxrss // 1024


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
