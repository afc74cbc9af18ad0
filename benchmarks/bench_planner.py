"""Velocity planning: job times against the rules of other controllers, segments a second, cycles a second.

NCCOMPILE_BENCH_PROGRAMS may name DIN 66025 programs, separated by colons; they are planned beside our own.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from math import inf, radians, sqrt
from pathlib import Path
from time import process_time

import numpy as np

from benchmarks.inputs import program
from nccompile.backend.samples import sample
from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostics
from nccompile.kernels import use
from nccompile.kernels.corners import CIRCLE
from nccompile.machine.limits import AxisLimits
from nccompile.machine.model import load
from nccompile.passes.velocity import JERK, LOOK_AHEAD, TIME_OPTIMAL, PlanSettings
from nccompile.passes.velocity.planner import plan, row_times
from nccompile.source import Source
from nccompile.toolpath import Toolpath
from tests.velocity.peers import Moves, finishing, grbl, klipper, least, linuxcnc

ACCEL, JERK_LIMIT, DEVIATION, RAPID = 1000.0, 50_000.0, 0.01, 166.667
SQUARE_CORNER = 5.0
PLANNERS = (LOOK_AHEAD, JERK, TIME_OPTIMAL)


def main() -> None:
    """Prints one line a measurement."""
    use(compiled=True)
    paths = {"finishing": finishing(passes=20).toolpath(), "lines and arcs": _decoded(program(20_000))}
    for name in filter(None, os.environ.get("NCCOMPILE_BENCH_PROGRAMS", "").split(":")):
        paths[Path(name).name] = _decoded(Path(name).read_text())
    for name, path in paths.items():
        _peers(name, path)
    for name, path in paths.items():
        _mill(name, path)
    _speeds(_decoded(program(100_000)))


def _decoded(text: str) -> Toolpath:
    """A program without its E words: the limits of the comparison count."""
    source = Source.from_bytes("bench.nc", text.encode())
    path = Toolpath.join(list(decode(source, DecodeOptions(), Diagnostics())))
    return path.replace(accel=np.zeros(len(path)), decel=np.zeros(len(path)))


def _equal(path: Toolpath, planner: str, scalar: bool = False) -> PlanSettings:
    """166.667 mm/s, 1000 mm/s², 50,000 mm/s³, 0.01 mm at corners; scalar: of the path, as Klipper has it."""
    k = len(path.axes)
    free = np.full(k, inf)
    bound = free if scalar else np.full(k, ACCEL)
    limits = AxisLimits(np.full(k, RAPID), bound, free, np.full(k, RAPID), np.full(k, JERK_LIMIT))
    along = ACCEL if scalar else 1e6
    return PlanSettings(
        limits, 25.0, along, along, radians(180), 1e-3, 0, planner=planner, junction_deviation=DEVIATION,
        rapid_stops=False,
    )  # fmt: skip


def _time(path: Toolpath, settings: PlanSettings) -> float:
    return float(row_times(Toolpath.join(list(plan([path], settings))), 0.0).sum())


def _peers(name: str, path: Toolpath) -> None:
    times = {planner: _time(path, _equal(path, planner)) for planner in PLANNERS}
    if (path.curve < 0).all():
        moves = Moves.of(path, RAPID)
        rule = replace(
            _equal(path, LOOK_AHEAD, scalar=True),
            junction_rule=CIRCLE, junction_deviation=SQUARE_CORNER**2 * (sqrt(2.0) - 1.0) / ACCEL,
        )  # fmt: skip
        times |= {
            "feed only": moves.time_at_feed,
            "Klipper's rule, ours": _time(path, rule),
            "Klipper's rule, oracle": klipper(moves, ACCEL, SQUARE_CORNER),
            "grbl's rule": grbl(moves, ACCEL, DEVIATION),
            "LinuxCNC's rule": linuxcnc(moves, ACCEL, 0.005),
            "bound for real axes": least(moves, ACCEL, DEVIATION),
            "no corner limit at all": _time(path, replace(_equal(path, LOOK_AHEAD), junction_deviation=None)),
        }
    for rule_name, seconds in sorted(times.items(), key=lambda item: item[1]):
        print(f"planner   {name:<20} equal limits {rule_name:<24} {seconds:10.3f} s")


def _mill(name: str, path: Toolpath) -> None:
    machine = load(Path(__file__).parent.parent / "samples" / "mill3.toml")
    for planner in PLANNERS:
        settings = PlanSettings.from_machine(machine, path.axes, planner=planner)
        print(f"planner   {name:<20} mill3        {planner:<24} {_time(path, settings):10.3f} s")


def _speeds(path: Toolpath) -> None:
    lines = path.replace(
        kind=np.minimum(path.kind, 1).astype(np.uint8), curve=np.full(len(path), -1, np.int32)
    )
    for name, part in (("lines", lines), ("lines and arcs", path)):
        chunks = [part.rows(at, at + 4096) for at in range(0, len(part), 4096)]
        for planner in PLANNERS:
            settings = _equal(part, planner)
            out: list[Toolpath] = list(plan(chunks[:2], settings))

            def run(chunks: list[Toolpath] = chunks, settings: PlanSettings = settings) -> int:
                nonlocal out
                out = list(plan(chunks, settings))
                return sum(len(chunk) for chunk in out)

            _rate(f"{planner}, {name}", run, "rows")
        cycles = list(plan(chunks, _equal(part, LOOK_AHEAD)))
        _rate(f"sample, {name}", lambda c=cycles: sum(len(b.t) for b in sample(c, 1e-4)), "cycles")  # type: ignore[misc]


def _rate(name: str, run: Callable[[], int], what: str) -> None:
    """The best of three runs by processor time, which other jobs do not change much."""
    rates = []
    for _ in range(3):
        begin = process_time()
        count = run()
        rates.append(count / (process_time() - begin))
    print(f"planner   {name:<30} {max(rates) / 1e6:8.2f} M {what}/s")
