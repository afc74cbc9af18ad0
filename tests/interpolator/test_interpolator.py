"""The interpolator block: equality with the sampler, every input of SoftMotion §6.2.8, limits in every cycle."""

from __future__ import annotations

from collections.abc import Sequence
from math import isclose

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile import kernels
from nccompile.backend.samples import SampleBlock, sample
from nccompile.kernels.interpolator import NEED_DATA
from nccompile.machine.model import default_machine
from nccompile.passes.velocity import PlanSettings
from nccompile.passes.velocity.planner import plan, row_times
from nccompile.runtime.interpolator import Interpolator, Status
from nccompile.runtime.ring import RingBuffer
from nccompile.toolpath.columns import Floats, Kind, Toolpath
from tests.velocity.random_paths import Builder, cut, paths

AXES = ("X", "Y", "Z", "A")
CYCLE = 1e-3


def planned(path: Toolpath, law: str = "trapezoid", size: int = 10_000) -> list[Toolpath]:
    options = PlanSettings.from_machine(default_machine(), AXES, time_law=law)
    return list(plan(cut(path, size), options))


def sampled(chunks: Sequence[Toolpath], cycle: float = CYCLE, law: int = 0) -> SampleBlock:
    blocks = list(sample(chunks, cycle, law))
    return SampleBlock(*(np.concatenate(column) for column in zip(*blocks, strict=True)))


def block(chunks: Sequence[Toolpath], cycle: float = CYCLE) -> Interpolator:
    ring = RingBuffer(AXES, max(1, sum(len(c) for c in chunks)))
    for chunk in chunks:
        assert ring.push(chunk) == len(chunk)
    ring.close()
    return Interpolator(ring, chunks[0].start, cycle)


def straight(length: float = 100.0, f: float = 50.0, a: float = 200.0, pieces: int = 1) -> list[Toolpath]:
    build = Builder()
    for _ in range(pieces):
        build.line(length / pieces, 0.0, f, a, a)
    return planned(build.path())


def run(ipo: Interpolator, n: int) -> tuple[Floats, Floats]:
    """Positions and velocities of n cycles, called one by one as a cyclic task does."""
    position, velocity = [], []
    for _ in range(n):
        burst = ipo.advance(1, patient=False)
        assert len(burst) == 1
        position.append(burst.position[0].copy())
        velocity.append(float(burst.velocity[0]))
    return np.array(position), np.array(velocity)


def to_the_end(ipo: Interpolator) -> tuple[Floats, Floats]:
    position, velocity = [], []
    for _ in range(200_000):
        burst = ipo.advance(500)
        position.append(burst.position.copy())
        velocity.append(burst.velocity.copy())
        if ipo.outputs.done:
            return np.vstack(position), np.concatenate(velocity)
        ipo.inputs.ack_m = ipo.outputs.m != 0
    raise AssertionError("the path never ends")


# --- equality -------------------------------------------------------------------------------------------


@settings(max_examples=40, deadline=None)
@given(paths(most=15), st.integers(1, 40), st.integers(1, 6), st.sampled_from([1e-3, 4e-3, 0.05]))
def test_any_burst_and_queue_size_gives_the_bits_of_the_sampler(
    path: Toolpath, n: int, room: int, cycle: float
) -> None:
    chunks = planned(path)
    reference = sampled(chunks, cycle)
    whole = Toolpath.join(chunks)
    ring = RingBuffer(AXES, 12)  # the look-ahead of the longest path here fits
    ipo = Interpolator(ring, whole.start, cycle)
    at, position, velocity = 0, [], []
    for _ in range(2_000_000):
        if at < len(whole):
            at += ring.push(whole.rows(at, at + room))
            if at == len(whole):
                ring.close()
        ipo.inputs.ack_m = True
        burst = ipo.advance(n, patient=ring.free > 0)
        position.append(burst.position.copy())
        velocity.append(burst.velocity.copy())
        if ipo.outputs.done:
            break
    assert np.array_equal(np.vstack(position), reference.position)
    assert np.array_equal(np.concatenate(velocity), reference.velocity)


@settings(max_examples=8, deadline=None)
@given(paths(most=10), st.sampled_from([0, 1]))
def test_compiled_and_plain_samples_are_the_same_bits(path: Toolpath, law: int) -> None:
    chunks = planned(path, ["trapezoid", "sigmoid"][law])
    before = kernels.compiled()
    try:
        kernels.use(compiled=False)
        plain = sampled(chunks, 4e-3, law)
        kernels.use(compiled=True)
        machine = sampled(chunks, 4e-3, law)
    finally:
        kernels.use(compiled=before)
    for name in SampleBlock._fields:
        assert np.array_equal(getattr(plain, name), getattr(machine, name)), name


# --- promises in every cycle ----------------------------------------------------------------------------


@settings(max_examples=40, deadline=None)
@given(paths(stops=False, most=12), st.sampled_from(["trapezoid", "sigmoid"]), st.sampled_from([1e-3, 4e-3]))
def test_axes_stay_inside_their_limits(path: Toolpath, law: str, cycle: float) -> None:
    axes = default_machine().axes
    samples = sampled(planned(path, law), cycle, ["trapezoid", "sigmoid"].index(law))
    v = np.diff(samples.position, axis=0) / cycle
    dv = np.abs(np.diff(v, axis=0))
    for column, letter in enumerate(AXES):
        axis = axes[letter]
        slack = 1e-6 * axis.velocity
        assert np.abs(v[:, column]).max(initial=0.0) <= axis.velocity + slack
        assert dv[:, column].max(initial=0.0) <= axis.acceleration * cycle + axis.velocity_step + slack
    assert np.array_equal(samples.position[-1], path.target[-1])


@settings(max_examples=30, deadline=None)
@given(paths(most=12))
def test_time_is_the_sum_of_the_segments_to_one_cycle(path: Toolpath) -> None:
    chunks = planned(path)
    whole = Toolpath.join(chunks)
    total = float(row_times(whole, 0.0).sum())
    waits = int(np.isin(whole.kind, [Kind.M_FUNCTION, Kind.SET_POSITION]).sum())  # each ends its cycle
    for cycle in (1e-3, 7e-3):
        t = sampled(chunks, cycle).t[-1]
        assert total - 1e-9 <= t <= total + (1 + waits) * cycle + 1e-9


def test_velocity_times_cycle_adds_up_to_the_path_length() -> None:
    build = Builder()
    build.line(30, 0.0, 80)
    build.arc(10, 2.0, 0.1, 60)
    build.line(5, 2.0, 30)
    chunks = planned(build.path())
    samples = sampled(chunks)
    assert isclose(samples.velocity.sum() * CYCLE, Toolpath.join(chunks).length.sum(), rel_tol=1e-12)


# --- inputs ---------------------------------------------------------------------------------------------


def test_slow_stop_brakes_with_the_segment_and_goes_on_when_released() -> None:
    ipo = block(straight())
    run(ipo, 800)
    ipo.inputs.slow_stop = True
    position, velocity = run(ipo, 400)
    assert velocity[-1] == 0.0
    assert ipo.outputs.status is Status.WAIT
    assert np.diff(velocity).min() >= -200 * CYCLE * (1 + 1e-9)
    stop_time = int(np.flatnonzero(velocity == 0.0)[0]) * CYCLE
    assert isclose(stop_time, 50 / 200, abs_tol=2 * CYCLE)
    ipo.inputs.slow_stop = False
    rest, _ = to_the_end(ipo)
    assert rest[-1][0] == 100.0
    assert (np.diff(rest[:, 0]) >= 0).all()
    assert isclose(position[-1][0], rest[0][0], abs_tol=1e-3)


def test_slow_stop_brakes_over_several_segments() -> None:
    ipo = block(straight(pieces=200))
    run(ipo, 800)
    ipo.inputs.slow_stop = True
    _, velocity = run(ipo, 400)
    assert velocity[-1] == 0.0
    assert np.diff(velocity).min() >= -200 * CYCLE * (1 + 1e-9)
    ipo.inputs.slow_stop = False
    assert to_the_end(ipo)[0][-1][0] == 100.0


def test_quick_stop_uses_the_greater_deceleration() -> None:
    for quick, expected in ((1000.0, 1000.0), (10.0, 200.0)):
        ipo = block(straight())
        run(ipo, 800)
        ipo.inputs.quick_stop, ipo.inputs.quick_deceleration = True, quick
        _, velocity = run(ipo, 400)
        assert isclose(-np.diff(velocity).min() / CYCLE, expected, rel_tol=1e-6)


def test_emergency_stop_holds_the_position_at_once() -> None:
    ipo = block(straight())
    position, _ = run(ipo, 800)
    ipo.inputs.emergency_stop = True
    held, velocity = run(ipo, 50)
    assert (held == position[-1]).all()
    assert (velocity == 0.0).all()
    ipo.inputs.emergency_stop = False
    assert to_the_end(ipo)[0][-1][0] == 100.0


def test_wait_at_next_stop_waits_only_where_the_path_stops() -> None:
    build = Builder()
    build.line(10, 0.0, 50)
    build.line(10, 0.0, 50)
    build.line(10, 1.5, 50)
    ipo = block(planned(build.path()))
    ipo.advance(1)
    run(ipo, 20)
    ipo.inputs.wait_at_next_stop = True
    position, _ = run(ipo, 3000)
    assert np.allclose(position[-1], [20, 0, 0, 0])
    assert ipo.outputs.status is Status.WAIT
    ipo.inputs.wait_at_next_stop = False
    assert np.array_equal(to_the_end(ipo)[0][-1], build.at)


def test_override_scales_the_command_and_waits_for_the_end_of_a_ramp() -> None:
    ipo = block(straight(200.0))
    run(ipo, 100)  # in the first ramp, which takes 250 cycles
    ipo.inputs.override = 0.5
    _, ramp = run(ipo, 140)
    assert (np.diff(ramp) > 0).all()  # the ramp goes on to the full velocity
    _, after = run(ipo, 300)
    assert isclose(after[-1], 25.0, rel_tol=1e-9)
    assert np.diff(after).min() >= -200 * CYCLE * (1 + 1e-9)
    ipo.inputs.override = 2.0
    _, faster = run(ipo, 600)
    assert isclose(faster[-1], 100.0, rel_tol=1e-9)
    ipo.inputs.override = 0.0  # acts as 0.01
    _, slow = run(ipo, 800)
    assert isclose(slow[-1], 0.5, rel_tol=1e-9)


@settings(max_examples=25, deadline=None)
@given(
    paths(stops=False, most=10), st.lists(st.tuples(st.integers(1, 400), st.floats(0.01, 3.0)), max_size=6)
)
def test_no_override_breaks_an_axis_limit(path: Toolpath, changes: list[tuple[int, float]]) -> None:
    axes = default_machine().axes
    ipo = block(planned(path))
    position = []
    for wait, override in changes:
        ipo.inputs.override = override
        position.append(run(ipo, wait)[0])
    ipo.inputs.override = 1.0
    position.append(to_the_end(ipo)[0])
    v = np.diff(np.vstack(position), axis=0) / CYCLE
    for column, letter in enumerate(AXES):
        axis = axes[letter]
        assert np.abs(v[:, column]).max(initial=0.0) <= axis.velocity * (1 + 1e-6)
        dv = np.abs(np.diff(v[:, column])).max(initial=0.0)
        assert dv <= axis.acceleration * CYCLE + axis.velocity_step + 1e-6 * axis.velocity


def test_single_step_stops_at_every_segment_for_one_cycle() -> None:
    ipo = block(straight(pieces=4))
    ipo.inputs.single_step = True
    position, velocity = to_the_end(ipo)
    waits = position[1:][(velocity[1:] == 0.0)]
    assert [w[0] for w in waits[:4]] == pytest.approx([25.0, 50.0, 75.0, 100.0])
    assert position[-1][0] == 100.0


def test_abort_gives_the_path_up() -> None:
    ipo = block(straight())
    run(ipo, 300)
    ipo.inputs.abort = True
    run(ipo, 1)
    assert ipo.outputs.done
    assert not ipo.outputs.working
    assert ipo.outputs.source_line == -1


def test_m_function_waits_for_its_acknowledge() -> None:
    build = Builder()
    build.line(10, 0.0, 50)
    build.still(Kind.M_FUNCTION, number=10, seconds=2.5)
    build.line(10, 0.0, 50)
    ipo = block(planned(build.path()))
    run(ipo, 2000)
    assert (ipo.outputs.m, ipo.outputs.m_k) == (10, 2.5)
    assert ipo.outputs.status is Status.WAIT
    assert ipo.outputs.set_position[0] == 10.0
    ipo.inputs.ack_m = True
    run(ipo, 1)
    ipo.inputs.ack_m = False
    assert ipo.outputs.m == 0
    assert to_the_end(ipo)[0][-1][0] == 20.0


def test_outputs_tangent_way_and_switches() -> None:
    build = Builder()
    build.line(40, 0.5, 50)
    build.switch(3, 0.25)
    build.switch(32, 0.5)
    build.switch(-3, 0.75)
    ipo = block(planned(build.path()))
    seen: dict[int, float] = {}
    for _ in range(5000):
        ipo.inputs.last_way_pos = ipo.outputs.way_pos
        run(ipo, 1)
        seen.setdefault(ipo.outputs.switches, ipo.outputs.way_pos)
        if ipo.outputs.working and ipo.outputs.velocity > 0 and ipo.outputs.status is Status.CONSTANT:
            assert ipo.outputs.tangent == pytest.approx((np.cos(0.5), np.sin(0.5), 0.0))
        if ipo.outputs.done:
            break
    assert isclose(ipo.outputs.way_pos, 40.0, rel_tol=1e-12)
    assert ipo.outputs.last_switch == -3
    assert ipo.outputs.tangent == (0.0, 0.0, 0.0)
    assert list(seen) == [0, 4, 4 + 2**31, 2**31]
    reached = list(seen.values())[1:]
    for way, programmed in zip(reached, (10.0, 20.0, 30.0), strict=True):
        assert programmed - 1e-9 <= way <= programmed + 50 * CYCLE * 1.01


def test_data_underrun_brakes_and_resumes() -> None:
    chunks = straight(pieces=100)
    whole = Toolpath.join(chunks)
    ring = RingBuffer(AXES, 200)
    ring.push(whole.rows(0, 30))
    ipo = Interpolator(ring, whole.start, CYCLE)
    assert ipo.advance(4096).reason == NEED_DATA  # patient: stops in time, without braking
    _, velocity = run(ipo, 1500)
    assert velocity[-1] == 0.0
    assert ipo.outputs.underrun
    assert ipo.outputs.set_position[0] == pytest.approx(30.0)
    assert np.diff(velocity).min() >= -200 * CYCLE * (1 + 1e-9)
    ring.push(whole.rows(30, 100))
    ring.close()
    position, _ = to_the_end(ipo)
    assert position[-1][0] == 100.0
    assert not ipo.outputs.underrun


def test_rows_that_come_while_braking_lift_the_velocity_again() -> None:
    whole = Toolpath.join(straight(pieces=100))
    ring = RingBuffer(AXES, 200)
    ring.push(whole.rows(0, 30))
    ipo = Interpolator(ring, whole.start, CYCLE)
    _, velocity = run(ipo, 650)
    assert 0 < velocity[-1] < 45
    ring.push(whole.rows(30, 100))
    ring.close()
    _, after = run(ipo, 300)
    assert isclose(after[-1], 50.0, rel_tol=1e-9)
    assert np.abs(np.diff(after)).max() <= 200 * CYCLE * (1 + 1e-6)


def test_g92_in_a_row_is_put_out_for_one_cycle_each() -> None:
    # SoftMotion §3.2: a G1 without motion between two G92 makes the first one visible
    build = Builder()
    build.line(10, 0.0, 50)
    build.jump(100.0)
    build.line(0.0, 0.0, 50)
    build.jump(-50.0)
    samples = sampled(planned(build.path()))
    x = [float(v) for v in samples.position[:, 0]]
    assert x[-1] == 60.0
    assert x.count(110.0) == 1
    assert x.index(110.0) < x.index(60.0)


def test_a_snapshot_brings_everything_back() -> None:
    build = Builder()
    build.line(10, 0.0, 50)
    build.switch(1, 0.5)
    build.arc(5.0, 3.0, 0.2, 40)
    ipo = block(planned(build.path()))
    ipo.advance(100)
    saved = ipo.snapshot()
    first = ipo.advance(300).position.copy()
    ipo.restore(saved)
    assert np.array_equal(ipo.advance(300).position, first)
