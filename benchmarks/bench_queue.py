"""OutQueue files of a million segments: writing, opening, checking."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter

import numpy as np

from nccompile.backend import ncq
from nccompile.toolpath import CHUNK, Toolpath

CHUNKS = 245


def _chunks() -> Iterator[Toolpath]:
    ones = np.ones(CHUNK)
    target = np.random.default_rng(1).random((CHUNK, 3))
    start = np.zeros(3)
    for number in range(CHUNKS):
        yield Toolpath.empty().replace(
            start=start, first=number * CHUNK, kind=np.ones(CHUNK, np.uint8), target=target,
            curve=np.full(CHUNK, -1, np.int32), length=ones, feed=ones, accel=ones, decel=ones, radius=ones,
            mark=np.zeros(CHUNK, np.uint16), profile=np.zeros(CHUNK, np.uint16),
            line=np.arange(CHUNK, dtype=np.int32), v_limit=ones, v_junction=ones, v_end=ones,
        )  # fmt: skip
        start = target[-1]


def main() -> None:
    """Prints seconds for a file of a million segments."""
    origin = ncq.Provenance("bench.nc", "0" * 64, "bench", "0" * 64, 20.0, "trapezoid")
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "bench.ncq"
        begin = perf_counter()
        ncq.write(place, _chunks(), origin, lambda: 0.0)
        written = perf_counter()
        queue = ncq.read(place)
        opened = perf_counter()
        queue.check()
        checked = perf_counter()
        size = place.stat().st_size
    segments = CHUNKS * CHUNK
    print(f"queue     {segments} segments, {size / 1e6:.0f} MB, {size / segments:.1f} bytes a segment")
    print(f"queue     written in {written - begin:.2f} s, opened in {opened - written:.3f} s")
    print(f"queue     read and checked in {checked - opened:.2f} s")
