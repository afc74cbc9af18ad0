"""Every planner on random paths: see `must_hold`."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.machine.model import default_machine
from nccompile.passes.velocity import PLANNERS, PlanSettings
from nccompile.toolpath.columns import Kind, Toolpath
from tests.velocity.must_hold import NEVER_SLOWER, broken_limits, off_the_path, times_by_window
from tests.velocity.random_paths import Builder, cut, paths

AXES = ("X", "Y", "Z", "A")
GENERIC = {name: PlanSettings.from_machine(default_machine(), AXES, planner=name) for name in PLANNERS}


def brisk(most: int, *, stops: bool = True) -> st.SearchStrategy[Toolpath]:
    """Random paths that do not last long: sampling is what takes the time here."""
    return paths(most=most, stops=stops).map(
        lambda p: p.replace(feed=np.maximum(p.feed, 150.0), accel=np.maximum(p.accel, 1000.0))
    )


@pytest.mark.parametrize("planner", PLANNERS)
@settings(max_examples=20, deadline=None)
@given(path=brisk(8), size=st.sampled_from([1, 3, 100]))
def test_limits_end_and_time_at_a_cycle_of_a_millisecond(planner: str, path: Toolpath, size: int) -> None:
    assert broken_limits(cut(path, size), GENERIC[planner], 1e-3) == []


@pytest.mark.parametrize("planner", PLANNERS)
@settings(max_examples=3, deadline=None)
@given(path=brisk(2))
def test_the_same_at_a_tenth_of_it(planner: str, path: Toolpath) -> None:
    assert broken_limits([path], GENERIC[planner], 1e-4) == []


@pytest.mark.parametrize("planner", PLANNERS)
@settings(max_examples=10, deadline=None)
@given(path=brisk(25), size=st.sampled_from([1, 4, 100]))
def test_a_larger_window_is_never_slower(planner: str, path: Toolpath, size: int) -> None:
    times = times_by_window(cut(path, size), GENERIC[planner])
    assert all(large <= small * NEVER_SLOWER for small, large in pairwise(times)), times


@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize(
    "lengths", [(1.0, 0.0, 1.0), (5.0, 0.0, 1.0, 0.0), (0.0, 0.3, 0.0, 0.0, 5.0, 0.0, 0.3)]
)
def test_a_window_that_ends_at_rows_without_length_loses_no_time(
    planner: str, lengths: tuple[float, ...]
) -> None:
    builder = Builder()
    for length in lengths:
        builder.line(length, 0.0, 150.0, 1000.0, 1000.0)
    for size in (1, 2):
        times = times_by_window(cut(builder.path(), size), GENERIC[planner])
        assert all(large <= small * NEVER_SLOWER for small, large in pairwise(times)), times


@pytest.mark.parametrize("planner", PLANNERS)
@settings(max_examples=8, deadline=None)
@given(path=brisk(6, stops=False))
def test_set_positions_lie_on_the_path(planner: str, path: Toolpath) -> None:
    assert off_the_path(path, GENERIC[planner], 1e-3) < 1e-9


@pytest.mark.parametrize("planner", PLANNERS)
def test_blocks_without_a_way_and_dwells_between_motions(planner: str) -> None:
    build = Builder()
    for turn in (0.0, 0.05, 0.0):
        build.line(10.0, turn, 150.0, 1000.0, 1000.0)
        build.line(0.0, 0.0, 150.0, 1000.0, 1000.0)  # passed through at full velocity
        build.line(0.02, 0.0, 150.0, 1000.0, 1000.0)
    build.still(Kind.DWELL, seconds=0.5)
    build.line(10.0, 0.0, 150.0, 1000.0, 1000.0)
    assert broken_limits([build.path()], GENERIC[planner], 1e-3) == []
