"""Axis states, the clock's statistics, the slow task."""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterator

import numpy as np
import pytest

from nccompile.errors import QueueError, RuntimeFault
from nccompile.runtime import clock as clock_module
from nccompile.runtime.axes import AxisGroup, AxisState
from nccompile.runtime.clock import Clock, undisturbed
from nccompile.runtime.drives.protocol import FaultCode
from nccompile.runtime.feeder import Feeder
from nccompile.runtime.ring import RingBuffer
from nccompile.toolpath.columns import Toolpath
from tests.runtime.paths import planned


def test_axis_states_follow_power_motion_and_faults() -> None:
    group = AxisGroup("XY")
    x, y = group.axes
    with pytest.raises(RuntimeFault, match="axis X cannot go to synchronized_motion without power"):
        group.enter(AxisState.SYNCHRONIZED_MOTION)
    group.power(True)
    assert x.state is AxisState.STANDSTILL
    group.enter(AxisState.SYNCHRONIZED_MOTION)
    group.update(np.array([1.0, 2.0]), np.array([0.5, 2.5]), np.array([3.0, -4.0]))
    assert (x.set_position, x.following_error, y.following_error, y.set_velocity) == (1.0, 0.5, -0.5, -4.0)
    group.fail(1, FaultCode.TRAVEL)
    assert (x.state, y.state, y.error) == (AxisState.STOPPING, AxisState.ERRORSTOP, FaultCode.TRAVEL)
    group.enter(AxisState.STANDSTILL)
    assert (x.state, y.state) == (AxisState.STANDSTILL, AxisState.ERRORSTOP)  # a fault stays
    group.power(False)
    assert (y.state, y.error) == (AxisState.POWER_OFF, None)


class FakeTime:
    """Time that passes only when somebody sleeps, looks at it or works."""

    def __init__(self) -> None:
        self.now = 100.0

    def perf_counter(self) -> float:
        self.now += 1e-6
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds + 50e-6


def test_the_clock_keeps_deadlines_and_counts_overruns(monkeypatch: pytest.MonkeyPatch) -> None:
    time = FakeTime()
    monkeypatch.setattr(clock_module, "perf_counter", time.perf_counter)
    monkeypatch.setattr(clock_module, "sleep", time.sleep)
    clock = Clock(0.001)
    clock.start()
    first = time.now
    for _ in range(100):
        time.now += 300e-6  # work
        clock.wait()
    assert time.now - first == pytest.approx(0.1, abs=5e-6)  # absolute deadlines: nothing adds up
    assert clock.statistics().overruns == 0
    assert clock.statistics().max_us <= 2
    time.now += 0.0045  # a cycle that takes 4.5 cycles
    clock.wait()
    late = time.now
    clock.wait()
    after = clock.statistics()
    assert (after.cycles, after.overruns, after.worst_cycle) == (102, 1, 100)
    assert after.max_us == pytest.approx(3500, abs=5)
    assert after.p50_us <= 2
    assert time.now - late == pytest.approx(0.001, abs=5e-6)  # no rush to make up for it


def test_waking_up_a_cycle_late_is_an_overrun(monkeypatch: pytest.MonkeyPatch) -> None:
    time = FakeTime()
    monkeypatch.setattr(clock_module, "perf_counter", time.perf_counter)
    clock, late = Clock(0.001), iter([0.0, 0.0009, 0.0, 0.0025])

    def oversleep(seconds: float) -> None:
        time.now += seconds + 300e-6 + next(late)

    monkeypatch.setattr(clock_module, "sleep", oversleep)
    clock.start()
    for _ in range(5):  # 0.9 ms late leaves no time to sleep in the third cycle
        clock.wait()
    found = clock.statistics()
    assert (found.cycles, found.overruns, found.worst_cycle) == (5, 1, 4)


def test_percentiles_equal_those_of_the_list(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock(0.001)
    late_us = np.random.default_rng(5).exponential(40, 5000)
    for late in late_us:
        clock._record(late * 1e-6)
    found = clock.statistics()
    assert found.mean_us == pytest.approx(late_us.mean())
    assert found.max_us == pytest.approx(late_us.max())
    assert found.p50_us == pytest.approx(np.percentile(late_us, 50), abs=1.1)
    assert found.p99_us == pytest.approx(np.percentile(late_us, 99), abs=5)


def test_undisturbed_restores_what_it_changed() -> None:
    interval = sys.getswitchinterval()
    with undisturbed():
        assert not gc.isenabled()
        assert sys.getswitchinterval() < interval
    assert gc.isenabled()
    assert sys.getswitchinterval() == pytest.approx(interval)


def pieces(count: int, size: int) -> list[Toolpath]:
    path = planned(np.arange(3.0 * count * size).reshape(-1, 3))
    return [path.rows(i * size, (i + 1) * size) for i in range(count)]


def test_the_feeder_fills_refills_and_closes() -> None:
    ring, chunks = RingBuffer(("X", "Y", "Z"), 10), pieces(5, 7)
    feeder = Feeder(chunks[0], iter(chunks[1:]), ring, 4)
    assert feeder.fill() == 10
    ring.drop(6)
    feeder.refill()
    assert ring.count == 4  # not below the low water mark yet
    ring.drop(1)
    feeder.refill()
    assert ring.count == 10
    lines = []
    while not (feeder.is_done and ring.count == 0):
        view = ring.view()
        lines += view.rows.line[view.head : view.tail].tolist()
        ring.drop(ring.count)
        feeder.refill()
    assert lines == list(range(8, 36))


def test_the_feeding_thread_hands_over_every_row_in_order() -> None:
    ring, chunks = RingBuffer(("X", "Y", "Z"), 10), pieces(60, 7)
    feeder = Feeder(chunks[0], iter(chunks[1:]), ring, 8)
    feeder.start(pause=1e-4)
    lines: list[int] = []
    while not (feeder.is_done and ring.count == 0):
        feeder.check()
        view = ring.view()
        take = min(3, view.tail - view.head)
        lines += view.rows.line[view.head : view.head + take].tolist()
        ring.drop(take)
    feeder.stop()
    assert lines == list(range(1, 421))


def test_what_breaks_the_feeding_thread_is_raised_by_check() -> None:
    def broken() -> Iterator[Toolpath]:
        yield pieces(1, 7)[0]
        raise QueueError("chunk 2 is damaged")

    ring, supply = RingBuffer(("X", "Y", "Z"), 4), broken()
    feeder = Feeder(next(supply), supply, ring, 4)
    feeder.start(pause=1e-4)
    ring.drop(4)
    assert feeder._thread is not None
    feeder._thread.join(timeout=10)
    with pytest.raises(QueueError, match="chunk 2 is damaged"):
        feeder.check()
    feeder.stop()
