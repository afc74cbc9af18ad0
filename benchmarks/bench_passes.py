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
from nccompile.passes.pipeline import parse
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
