"""Path passes on 100,000 chords of smooth closed contours: segments a second with warm kernels, and what is left.

The contour is that of many post-processors: r = 40 + 6 cos 5t + 2 cos 11t [mm] in chords of 0.05 to 0.3 mm,
rounded to 0.001 mm.  Processor time, so that other jobs on the machine do not count.
"""

from __future__ import annotations

import time
from collections import deque
from math import cos, sin

from nccompile import kernels
from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostics
from nccompile.passes.option import parse
from nccompile.source import Source

__all__ = ["main"]

CHORDS = 100_000

PASSES = (
    "compress",
    "fit-arcs",
    "fit-splines",
    "transform{rotate=30}",
    "avoid-loops{everywhere}",
    "tool-radius{radius=1,everywhere}",
    "smooth-corners{distance=0.1,everywhere,angle=0.5}",
)


def contour(chords: int) -> str:
    """The program."""
    lines = ["% smooth", "N1 G0 Z5 F50 E1000 E-1000"]
    t, turn, at = 0.0, 0, 0
    while len(lines) < chords:
        r = 40.0 + 6.0 * cos(5.0 * t) + 2.0 * cos(11.0 * t)
        x, y = 120.0 * (turn % 8) + r * cos(t), 120.0 * (turn // 8) + r * sin(t)
        lines.append(f"N{len(lines)} G{0 if t == 0.0 else 1} X{x:.3f} Y{y:.3f}")
        at += 1
        t += (0.05 + 0.125 * (1.0 + sin(0.01 * at))) / 42.0
        if t > 6.2:
            t, turn = 0.0, turn + 1
    return "\n".join(lines) + "\n"


def trochoid(chords: int) -> str:
    """One contour that crosses itself once a turn of 200 chords: x = 0.4 t - sin t, y = 1 - cos t [mm]."""
    lines = ["% trochoid", "N1 G1 X0 Y0 F50 E1000 E-1000"]
    for i in range(1, chords):
        t = 0.0314159 * i
        lines.append(f"G1 X{0.4 * t - sin(t):.4f} Y{1.0 - cos(t):.4f}")
    return "\n".join(lines) + "\n"


def growth() -> None:
    """How the time of loop avoidance grows with the length of one contour."""
    text, rates = "avoid-loops{everywhere}", []
    for count in (10_000, 100_000, 1_000_000):
        chunks = list(decode(Source("one.nc", trochoid(count)), DecodeOptions(), Diagnostics()))
        deque(parse(text).run(chunks, measure=False), maxlen=0)
        begin = time.process_time()
        deque(parse(text).run(chunks, measure=False), maxlen=0)
        rates.append(f"{count}: {1e6 * (time.process_time() - begin) / count:.2f} µs")
    print(f"  {text:50} a segment of one contour of {', '.join(rates)}")


def main() -> None:
    """Prints one line a pass."""
    source = Source("smooth.nc", contour(CHORDS))
    chunks = list(decode(source, DecodeOptions(), Diagnostics()))
    kernels.use(compiled=True)
    print(f"path passes, {sum(map(len, chunks))} segments, warm, without measuring deviations")
    for text in PASSES:
        times = []
        for _ in range(3):
            pipeline = parse(text)
            begin = time.process_time()
            out = sum(len(chunk) for chunk in pipeline.run(chunks, measure=False))
            times.append(time.process_time() - begin)
        measured = parse(text)
        deque(measured.run(chunks), maxlen=0)
        off = measured.reports[0].deviation
        said = "" if off is None else f", deviation {off:.4f} mm"
        rate = CHORDS / min(times) / 1e6
        print(f"  {text:50} {out:7} segments  {rate:8.3f} million a second{said}")
    growth()
