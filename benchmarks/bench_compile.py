"""Compilation of large programs: lines a second by stage, bytes a segment."""

from __future__ import annotations

import tempfile
from pathlib import Path
from time import perf_counter

from benchmarks.inputs import program
from nccompile.diagnostics import Diagnostics
from nccompile.kernels import use
from nccompile.machine.model import default_machine
from nccompile.parser import parse
from nccompile.source import Source
from nccompile.toolchain import Compilation, Options

BLOCKS = 100_000


def main() -> None:
    """Prints lines a second of parsing, decoding, planning and writing; each row includes those above it."""
    use(compiled=True)
    options = Options(default_machine())
    for _ in Compilation(Source("warm.nc", program(2_000)), options).planned():
        pass  # kernels are compiled or loaded here
    source = Source.from_bytes("bench.nc", program(BLOCKS).encode())
    begin = perf_counter()
    blocks = sum(1 for _ in parse(source, Diagnostics()))
    _print("parse", blocks, perf_counter() - begin)
    for stage in ("decoded", "planned"):
        begin = perf_counter()
        segments = sum(len(chunk) for chunk in getattr(Compilation(source, options), stage)())
        _print(f"+ {stage}", segments, perf_counter() - begin)
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "bench.ncq"
        begin = perf_counter()
        Compilation(source, options).write(place)
        _print("+ written", segments, perf_counter() - begin)
        print(f"compile   {place.stat().st_size / segments:.1f} bytes a segment in the queue")


def _print(stage: str, count: int, seconds: float) -> None:
    print(f"compile   {stage:<10} {count:>8} in {seconds:6.2f} s, {count / seconds:>9.0f} a second")
