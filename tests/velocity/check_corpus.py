"""What must hold for every planner (`must_hold`), on every .nc program of folders.

python -m tests.velocity.check_corpus [--seconds S] FOLDER|FILE..      job time of a program that is sampled, default 60

Plans whole programs with every planner and window, and samples them at 1 ms and, a tenth as long, at 0.1 ms.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import replace
from itertools import pairwise

import numpy as np

from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostics
from nccompile.kernels import use
from nccompile.machine.model import default_machine
from nccompile.passes.velocity import PLANNERS, PlanSettings
from nccompile.passes.velocity.planner import plan, row_times
from nccompile.source import Source
from nccompile.toolpath.columns import Toolpath
from tests.corpus import programs
from tests.velocity.must_hold import NEVER_SLOWER, broken_limits, times_by_window

__all__ = ["main"]


def _first(path: Toolpath, settings: PlanSettings, seconds: float) -> Toolpath:
    """The rows of the first seconds of a path."""
    quick = replace(settings, planner="look-ahead", window=None)
    whole = Toolpath.join(list(plan([path], quick)))
    line_ends = np.searchsorted(np.cumsum(row_times(whole, 0.0)), seconds)
    if line_ends >= len(whole):
        return path
    line = int(whole.line[line_ends])
    return path.rows(0, max(1, int(np.argmax(path.line >= line))))


def _check(path: Toolpath, settings: PlanSettings, seconds: float) -> list[str]:
    found = []
    chunks = [path.rows(at, at + 4096) for at in range(0, len(path), 4096)]
    times = times_by_window(chunks, settings)
    if any(large > small * NEVER_SLOWER for small, large in pairwise(times)):
        found.append(f"a larger window is slower: {times}")
    for cycle, part in ((1e-3, seconds), (1e-4, 0.1 * seconds)):
        found += broken_limits([_first(path, settings, part)], settings, cycle)
    return found


def main(arguments: list[str]) -> int:
    """Prints a line for every program and planner; returns 1 if anything is broken."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("places", nargs="+")
    given = parser.parse_args(arguments)
    use(compiled=True)
    failed = 0
    for file in programs(given.places):
        path = Toolpath.join(list(decode(Source.read(file), DecodeOptions(), Diagnostics())))
        for planner in PLANNERS:
            begin = time.process_time()
            settings = PlanSettings.from_machine(default_machine(), path.axes, planner=planner)
            found = _check(path, settings, given.seconds)
            failed += bool(found)
            verdict = "; ".join(found) or "ok"
            print(f"{file.name:24} {planner:13} {time.process_time() - begin:6.1f} s  {verdict}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
