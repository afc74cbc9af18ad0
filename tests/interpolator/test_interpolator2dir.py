"""Both directions (SoftMotion §6.2.10): the same path back and forth, inside the acceleration of its segments."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.backend.samples import sample
from nccompile.errors import UsageError
from nccompile.machine.model import default_machine
from nccompile.passes.velocity import PlanSettings, plan
from nccompile.runtime.interpolator2dir import Direction, Interpolator2Dir
from nccompile.toolpath.columns import Kind, Toolpath
from tests.velocity.random_paths import Builder, paths

AXES = ("X", "Y", "Z", "A")
CYCLE = 1e-3


def planned(path: Toolpath) -> Toolpath:
    return Toolpath.join(list(plan([path], PlanSettings.from_machine(default_machine(), AXES))))


def winding() -> Toolpath:
    build = Builder()
    build.line(30, 0.0, 80, 800, 800)
    build.arc(8.0, 2.0, 0.0, 60, 800, 800)
    build.line(20, 0.1, 90, 800, 800)
    return planned(build.path())


def test_forward_it_is_the_interpolator_after_the_rate_has_come_up() -> None:
    path = winding()
    both = Interpolator2Dir(path, CYCLE)
    mine = []
    while not both.at_end:
        mine.append(both.advance().copy())
    reference = np.concatenate([block.position for block in sample([path], CYCLE)])
    assert np.allclose(mine[-1], reference[-1], atol=1e-9)
    assert abs(len(mine) - len(reference)) <= 60  # the rate's 50 ms
    assert both.direction is Direction.STANDSTILL


def test_there_and_back_again_on_the_same_path() -> None:
    path = winding()
    both = Interpolator2Dir(path, CYCLE)
    there = [both.advance().copy() for _ in range(600)]
    both.override = -0.7
    back = [both.advance().copy() for _ in range(4000)]
    assert both.at_start
    assert both.direction is Direction.STANDSTILL
    assert np.allclose(back[-1], path.start, atol=1e-9)
    for point in back[200:800:50]:  # on the path that was run before
        assert min(np.linalg.norm(np.array(there) - point, axis=1)) < 0.1
    both.override = 1.0
    for _ in range(4000):
        both.advance()
    assert both.at_end
    assert np.allclose(both.set_position, path.target[-1], atol=1e-9)


@settings(max_examples=20, deadline=None)
@given(
    paths(stops=False, most=8),
    st.lists(st.tuples(st.integers(1, 300), st.floats(-2.0, 2.0)), min_size=1, max_size=6),
)
def test_axes_keep_their_limits(path: Toolpath, changes: list[tuple[int, float]]) -> None:
    axes = default_machine().axes
    both = Interpolator2Dir(planned(path), CYCLE)
    position = []
    for wait, override in changes:
        both.override = override
        position += [both.advance().copy() for _ in range(wait)]
    v = np.diff(np.array(position), axis=0) / CYCLE
    for column, letter in enumerate(AXES):
        axis = axes[letter]
        assert np.abs(v[:, column]).max(initial=0.0) <= axis.velocity * (1 + 1e-6)
        dv = np.abs(np.diff(v[:, column])).max(initial=0.0)
        assert dv <= 1.05 * axis.acceleration * CYCLE + axis.velocity_step + 1e-6 * axis.velocity


def test_paths_with_jumps_are_refused() -> None:
    build = Builder()
    build.line(10, 0.0, 50)
    build.still(Kind.M_FUNCTION, number=3)
    with pytest.raises(UsageError, match="both directions"):
        Interpolator2Dir(planned(build.path()), CYCLE)
