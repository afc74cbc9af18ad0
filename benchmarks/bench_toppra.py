"""Job time of `time-optimal` against toppra on a fine grid: programs with curves, and programs fitted with splines.

NCCOMPILE_BENCH_PROGRAMS names DIN 66025 programs, separated by colons; they are compared as they are and, if they
are lines only, behind fit-splines.  The first `ROWS` rows of each count; docs/planning.md has the limits.
"""

from __future__ import annotations

import os
from pathlib import Path
from time import process_time

from benchmarks.inputs import program
from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostics
from nccompile.kernels import use
from nccompile.passes.option import parse
from nccompile.source import Source
from nccompile.toolpath import Toolpath
from tests.velocity.toppra_oracle import compare

__all__ = ["main"]

ROWS = 1500
SPLINES = "fit-splines{tolerance=0.01}"


def main() -> None:
    """Prints one line a program."""
    use(compiled=True)
    texts = {"lines and arcs": program(1000)}
    for name in filter(None, os.environ.get("NCCOMPILE_BENCH_PROGRAMS", "").split(":")):
        texts[Path(name).name] = Path(name).read_text()
    print(
        f"toppra    {'program':<24} stretches unsolved  grid points        ours      toppra   excess    worst"
    )
    for name, text in texts.items():
        source = Source.from_bytes(name, text.encode())
        chunks = list(decode(source, DecodeOptions(), Diagnostics()))
        _row(name, Toolpath.join(chunks))
        _row(f"{name}, splined", Toolpath.join(list(parse(SPLINES).run(chunks, measure=False))))


def _row(name: str, path: Toolpath) -> None:
    begin = process_time()
    found = compare(path.rows(0, ROWS))
    if not found.solved:
        print(f"toppra    {name:<24} no stretch with a curve in it ({found.unsolved} not solved)")
        return
    print(
        f"toppra    {name:<24} {found.solved:9d} {found.unsolved:8d} {found.points:12d} {found.ours:11.4f} "
        f"{found.best:11.4f} {100 * found.excess:7.2f}% {100 * found.worst:7.2f}%   ({process_time() - begin:.1f} s)",
        flush=True,
    )
