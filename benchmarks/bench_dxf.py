"""DXF import: joining, whole imports, rapids, and random drawings against independent samplers.

`python -m benchmarks dxf` takes a hundred random drawings, about a minute; `python -m benchmarks.bench_dxf 1000` a
thousand, five minutes.
"""

from __future__ import annotations

import json
import resource
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter

import numpy as np

from nccompile.backend.din66025 import ProgramFormat, program_text
from nccompile.diagnostics import Diagnostics
from nccompile.importers.dxf.convert import ConvertOptions, convert
from nccompile.importers.dxf.job import Job
from nccompile.importers.dxf.join import Paths, join_pieces
from nccompile.importers.dxf.order import StartPoint, order_paths, rapid_length
from nccompile.importers.dxf.pieces import Pieces, arc_row
from nccompile.importers.dxf.read import ReadOptions, read_drawing
from tests.importers.drawings import distance, drawn_lines, machined_lines, random_drawing
from tests.importers.workshop import TOLERANCE, compiled, machine

LINES = 100_000
RANDOM = 100
SAMPLING = 0.002


def loose_lines(count: int) -> Pieces:
    """Squares of loose lines in random order and direction."""
    random = np.random.default_rng(1)
    side = int(np.sqrt(count / 4))
    number = random.permutation(count)
    x, y = (number // 4) % side * 3.0, (number // 4) // side * 3.0
    corner = np.array([0, 2, 2 + 2j, 2j, 0])
    a, b = x + 1j * y + corner[number % 4], x + 1j * y + corner[number % 4 + 1]
    turned = random.random(count) < 0.5
    table = np.zeros((count, 12))
    for column, z in ((1, np.where(turned, b, a)), (3, np.where(turned, a, b))):
        table[:, column], table[:, column + 1] = z.real, z.imag
    return Pieces.from_rows(table, 0, 7, np.arange(count))


def text_drawing(count: int) -> Iterator[str]:
    """The same lines as the text of a drawing, piece by piece."""
    yield "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n"
    lines = loose_lines(count)
    for k, (a, b) in enumerate(zip(lines.start.tolist(), lines.end.tolist(), strict=True)):
        yield (
            f"  0\nLINE\n  5\n{k + 256:X}\n100\nAcDbEntity\n  8\nCUT\n100\nAcDbLine\n"
            f" 10\n{a.real:.6f}\n 20\n{a.imag:.6f}\n 30\n0.0\n 11\n{b.real:.6f}\n 21\n{b.imag:.6f}\n 31\n0.0\n"
        )
    yield "0\nENDSEC\n0\nEOF\n"


def join() -> None:
    """Joining alone."""
    pieces = loose_lines(LINES)
    group = np.zeros(LINES, np.int64)
    begin = perf_counter()
    paths, _ = join_pieces(pieces, group, 0.01)
    print(
        f"join {LINES} loose lines        {perf_counter() - begin:6.2f} s   {len(paths)} paths (target 3 s)"
    )


def whole(count: int) -> None:
    """A drawing of loose lines from file to program, by stage."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "lines.dxf"
        with place.open("w") as file:
            file.writelines(text_drawing(count))
        found = Diagnostics()
        times = [perf_counter()]
        drawing = read_drawing(place, ReadOptions(), found)
        assert drawing is not None
        times.append(perf_counter())
        result = convert(drawing, Job(), ConvertOptions(), found, "lines.dxf")
        times.append(perf_counter())
        size = sum(len(line) for line in program_text(result.programs[0].moves.chunks(), ProgramFormat()))
        times.append(perf_counter())
        read, made, wrote = np.diff(times)
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        print(
            f"{count} lines, {place.stat().st_size / 1e6:.0f} MB: read {read:.1f} s, join and order {made:.1f} s, "
            f"write {wrote:.1f} s ({size / 1e6:.0f} MB), peak memory {peak:.0f} MB"
        )


def tours() -> None:
    """Rapids against the best tours known for the bundled sets."""
    known = json.loads((Path(__file__).parents[1] / "tests" / "importers" / "tours.json").read_text())
    for name, tour in known.items():
        n = len(tour["points"])
        pieces = Pieces.from_rows([arc_row(complex(*p), 1e-6, 0.0, 2 * np.pi) for p in tour["points"]])
        paths = Paths(pieces, np.arange(n + 1), np.ones(n, bool), np.zeros(n, np.int64))
        begin = perf_counter()
        done = order_paths(paths, np.full(n, -1), np.zeros(n, bool), StartPoint(), 0j, 0)
        ratio = rapid_length(done, 0j) / tour["best"]
        print(
            f"rapids {name:14s}         {ratio:6.3f} of the best known (target 1.25), {perf_counter() - begin:.2f} s"
        )


def random_drawings(count: int) -> int:
    """Random drawings: the machined set against the drawn one, and the program against our front end."""
    worst, bad = 0.0, 0
    begin = perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(count):
            doc = random_drawing(seed)
            made = machine(doc, Path(folder))
            drawn, machined = drawn_lines(doc), machined_lines(made.text)
            if not drawn and not machined:
                continue
            off = max(distance(drawn, machined), distance(machined, drawn))
            worst = max(worst, off)
            if off > TOLERANCE + SAMPLING or compiled(made.text)[1].counts:
                bad += 1
                print(f"drawing {seed} is {off:.4f} mm off")
    print(
        f"{count} random drawings: {bad} off by more than {TOLERANCE} mm, worst {worst:.4f} mm "
        f"(samplers {SAMPLING} mm), {perf_counter() - begin:.0f} s"
    )
    return bad


def main(count: int = RANDOM) -> None:
    """Runs all of them."""
    join()
    tours()
    whole(LINES)
    random_drawings(count)


if __name__ == "__main__":
    main(*(int(argument) for argument in sys.argv[1:]))
