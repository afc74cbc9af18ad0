"""The cyclic task: cycles a second in virtual time, one step of the interpolator, jitter in real time."""

from __future__ import annotations

import gc
import tracemalloc
from time import perf_counter, process_time, thread_time

import numpy as np

from benchmarks.inputs import program
from nccompile.backend.samples import sample
from nccompile.kernels import use
from nccompile.machine.model import default_machine
from nccompile.passes.velocity import PLANNERS
from nccompile.runtime.interpolator import Interpolator
from nccompile.runtime.ring import RingBuffer
from nccompile.runtime.task import CyclicTask
from nccompile.runtime.task import Options as RunOptions
from nccompile.source import Source
from nccompile.toolchain import Compilation, Options
from nccompile.toolpath import Toolpath

BLOCKS = 20_000


def _planned(blocks: int, planner: str = "look-ahead") -> list[Toolpath]:
    options = Options(default_machine(), planner=planner)
    return list(Compilation(Source("bench.nc", program(blocks)), options).planned())


def _sampling(planner: str) -> None:
    """Offline samples of a plan, processor time, best of three."""
    chunks = _planned(6000, planner)
    for cycle in (1e-3, 1e-4):
        rates = []
        for _ in range(3):
            begin = process_time()
            cycles = sum(len(block.t) for block in sample(chunks, cycle))
            rates.append(cycles / (process_time() - begin))
        print(f"runtime   sample, {planner}, {cycle * 1e3:g} ms: {max(rates) / 1e6:.1f} M cycles/s")


def _steps(planner: str) -> None:
    """Single steps of the interpolator: time each, and memory that stays."""
    path = Toolpath.join(_planned(2000, planner))
    ring = RingBuffer(path.axes, 1000)
    at, spent, taken = ring.push(path), [], []
    block = Interpolator(ring, path.start, 1e-3)
    block.advance(1, patient=False)
    gc.disable()
    while not block.outputs.done:
        if at < len(path) and ring.free > 256:
            at += ring.push(path, at, 256)
            if at == len(path):
                ring.close()
        wall, begin = perf_counter(), thread_time()
        block.advance(1, patient=False)
        taken.append(thread_time() - begin)
        spent.append(perf_counter() - wall)
    gc.enable()
    for what, seconds in (("processor", taken), ("wall", spent)):
        us = 1e6 * np.array(seconds)
        print(
            f"runtime   step, {planner}, {what} time of {len(us)}: {us.mean():.1f} us mean, "
            f"{np.median(us):.1f} median, {np.percentile(us, 99.9):.0f} at 99.9 %"
        )


def _growth() -> None:
    """Memory that steps leave behind, after 1000 and after 11,000 of them."""
    path = Toolpath.join(_planned(2000, "jerk"))
    ring = RingBuffer(path.axes, len(path))
    ring.push(path)
    ring.close()
    block = Interpolator(ring, path.start, 1e-3)
    tracemalloc.start()
    held = []
    for steps in (1000, 10_000):
        for _ in range(steps):
            block.advance(1, patient=False)
        held.append(tracemalloc.get_traced_memory()[0])
    tracemalloc.stop()
    print(f"runtime   10,000 steps leave {held[1] - held[0]} bytes behind")


def main() -> None:
    """Prints microseconds a cycle: offline samples, runs with both kinds of kernels, real time."""
    machine = default_machine()
    for compiled, blocks in ((True, BLOCKS), (False, 500)):
        use(compiled=compiled)
        chunks = _planned(blocks)
        CyclicTask(_planned(100), machine).run()  # kernels are compiled or loaded here
        kind = "compiled" if compiled else "python"
        begin = perf_counter()
        cycles = sum(len(block.t) for block in sample(chunks, machine.cycle))
        _print(f"sample, {kind}", cycles, perf_counter() - begin)
        begin = perf_counter()
        report = CyclicTask(chunks, machine).run()
        _print(f"run, {kind}", report.cycles, perf_counter() - begin)
    use(compiled=True)
    for planner in PLANNERS:
        _sampling(planner)
        _steps(planner)
    _growth()
    jitter = CyclicTask(_planned(500), machine, RunOptions(realtime=True)).run().jitter
    assert jitter is not None
    print(
        f"runtime   real time, {jitter.cycles} cycles of {machine.cycle_us} us: late by {jitter.mean_us:.1f} us mean, "
        f"{jitter.p99_us:.0f} us at 99 %, {jitter.max_us:.0f} us at worst; {jitter.overruns} overruns"
    )


def _print(what: str, cycles: int, seconds: float) -> None:
    print(
        f"runtime   {what:<17} {cycles:>8} cycles in {seconds:6.2f} s, {1e6 * seconds / cycles:7.2f} us a cycle, "
        f"{cycles / seconds:>9.0f} a second"
    )
