"""Text to set positions, through every stage: what `compile`, `sample` and `run` promise together."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.backend import ncq
from nccompile.backend.samples import SampleBlock, sample
from nccompile.machine.model import Machine, default_machine, load
from nccompile.runtime.report import RunReport
from nccompile.runtime.task import CyclicTask, Options
from nccompile.runtime.trace import Cycles
from nccompile.source import Source
from nccompile.toolchain import Compilation
from nccompile.toolchain import Options as CompileOptions
from nccompile.toolpath import EventKind, Floats, Kind, Toolpath
from tests.spine.programs import programs

ROOT = Path(__file__).parents[2]
GENERIC = default_machine()


class Keep:
    """A trace that keeps the set positions of the cycles in which the interpolator ran."""

    def __init__(self) -> None:
        self.blocks: list[Floats] = []

    def begin(self, axes: tuple[str, ...], cycle_us: int) -> None:
        self.axes = axes

    def write(self, cycles: Cycles) -> None:
        if not cycles.gap:
            self.blocks.append(cycles.setpoints.copy())


def compiled(source: Source, machine: Machine, law: str | None = None) -> list[Toolpath]:
    job = Compilation(source, CompileOptions(machine, time_law=law, verify=True))
    chunks = list(job.planned())
    assert [d for d in job.diagnostics if d.severity == "error"] == []
    return chunks


def sampled(chunks: list[Toolpath], cycle: float, law: int) -> SampleBlock:
    blocks = list(sample(chunks, cycle, law))
    return SampleBlock(*(np.concatenate(column) for column in zip(*blocks, strict=True)))


def ran(chunks: list[Toolpath], machine: Machine, law: int) -> tuple[RunReport, Floats]:
    keep = Keep()
    report = CyclicTask(chunks, machine, Options(vel_mode=law), trace=keep).run()
    return report, np.vstack(keep.blocks)


def check(source: Source, machine: Machine, law: str = "trapezoid") -> None:
    """Compiles with --verify, samples and runs; compares, and looks at every cycle."""
    chunks = compiled(source, machine, law)
    whole = Toolpath.join(chunks)
    mode = ["trapezoid", "sigmoid"].index(law)
    samples = sampled(chunks, machine.cycle, mode)
    report, setpoints = ran(chunks, machine, mode)
    assert report.faults == []
    assert setpoints.shape == samples.position.shape
    assert np.abs(setpoints - samples.position).max() <= 1e-9
    assert np.abs(samples.position[-1] - whole.end).max() <= 1e-9
    steps = np.abs(np.diff(samples.position, axis=0))
    jumps = (whole.kind == Kind.SET_POSITION).any()
    for column, letter in enumerate(whole.axes):
        axis = machine.axes[letter]
        if not jumps:
            assert steps[:, column].max(initial=0.0) <= axis.velocity * machine.cycle * (1 + 1e-6)
    assert switched_in_order(whole, samples)


def switched_in_order(path: Toolpath, samples: SampleBlock) -> bool:
    """Every switch point of the path fired, in order."""
    switches = path.events.number[path.events.kind == EventKind.SWITCH]
    return bool(np.array_equal(samples.fired[:, 1], switches))


@settings(max_examples=25, deadline=None)
@given(programs(), st.sampled_from(["trapezoid", "sigmoid"]))
def test_random_programs_from_text_to_drives(text: str, law: str) -> None:
    check(Source("random.nc", text), GENERIC, law)


@pytest.mark.parametrize("path", sorted((ROOT / "samples").glob("*.nc")), ids=lambda p: p.stem)
def test_samples_from_text_to_drives(path: Path) -> None:
    check(Source.read(path), load(ROOT / "samples" / "mill3.toml"))


@settings(max_examples=10, deadline=None)
@given(programs(most=8))
def test_a_queue_file_holds_the_plan_and_has_the_same_bytes_each_time(
    tmp_path_factory: pytest.TempPathFactory, text: str
) -> None:
    folder = tmp_path_factory.mktemp("queues")
    for name in ("a.ncq", "b.ncq"):
        job = Compilation(Source("p.nc", text), CompileOptions(GENERIC))
        assert job.write(folder / name) is not None
    assert (folder / "a.ncq").read_bytes() == (folder / "b.ncq").read_bytes()
    queue = ncq.read(folder / "a.ncq")
    mine = Toolpath.join(compiled(Source("p.nc", text), GENERIC))
    stored = Toolpath.join(list(queue.chunks()))
    for name in (
        "kind",
        "target",
        "length",
        "feed",
        "v_limit",
        "v_junction",
        "v_end",
        "accel",
        "decel",
        "line",
    ):
        assert np.array_equal(getattr(mine, name), getattr(stored, name)), name


def test_a_switch_fires_in_the_cycle_that_reaches_its_position() -> None:
    # SoftMotion §3.2.1: switch 2 off at X40 Y25, a quarter of the way
    text = "% s\nN80 H2 L0 G1 X20 Y20 F50 E500 E-500\nN100 G1 X100 Y40 H-2 O0.25\n"
    samples = sampled(compiled(Source("s.nc", text), GENERIC), 1e-3, 0)
    on = (samples.switches & 2).astype(bool)
    cycle = int(np.flatnonzero(on[:-1] & ~on[1:])[0]) + 1
    way = np.hypot(samples.position[:, 0] - 20, samples.position[:, 1] - 20)
    quarter = np.hypot(20, 5)
    assert way[cycle] >= quarter - 1e-9
    assert way[cycle - 1] < quarter
