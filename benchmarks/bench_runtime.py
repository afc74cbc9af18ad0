"""The cyclic task: cycles a second in virtual time, jitter in real time."""

from __future__ import annotations

from time import perf_counter

from benchmarks.inputs import program
from nccompile.backend.samples import sample
from nccompile.kernels import use
from nccompile.machine.model import default_machine
from nccompile.runtime.task import CyclicTask
from nccompile.runtime.task import Options as RunOptions
from nccompile.source import Source
from nccompile.toolchain import Compilation, Options
from nccompile.toolpath import Toolpath

BLOCKS = 20_000


def _planned(blocks: int) -> list[Toolpath]:
    return list(Compilation(Source("bench.nc", program(blocks)), Options(default_machine())).planned())


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
