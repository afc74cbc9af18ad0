"""Both directions (SoftMotion §6.2.10): the same path back and forth, inside the limits, for every planner."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.backend.samples import sample
from nccompile.kernels.interpolator import JUMPED
from nccompile.machine.model import default_machine
from nccompile.passes.velocity import JERK, LOOK_AHEAD, TIME_OPTIMAL, PlanSettings
from nccompile.passes.velocity.planner import plan
from nccompile.runtime.backwards import backward
from nccompile.runtime.interpolator import Status
from nccompile.runtime.interpolator2dir import Direction, Interpolator2Dir
from nccompile.toolpath.columns import EventKind, Floats, Kind, Toolpath
from nccompile.toolpath.verify import verify
from tests.interpolator.third_order import plans
from tests.velocity.random_paths import Builder, paths

AXES = ("X", "Y", "Z", "A")
CYCLE = 1e-3
PLANNERS = [LOOK_AHEAD, JERK, TIME_OPTIMAL]


def planned(path: Toolpath, planner: str = LOOK_AHEAD) -> Toolpath:
    settings = PlanSettings.from_machine(default_machine(), AXES, planner=planner)
    return Toolpath.join(list(plan([path], settings)))


def winding(planner: str) -> Toolpath:
    build = Builder()
    build.line(30, 0.0, 80, 800, 800)
    build.arc(8.0, 2.0, 0.0, 60, 800, 800)
    build.line(20, 0.1, 90, 800, 800)
    return planned(build.path(), planner)


def advance(both: Interpolator2Dir, cycles: int) -> Floats:
    """Set positions of cycles, called one by one."""
    return np.array([both.advance(1).position[0].copy() for _ in range(cycles)])


@pytest.mark.parametrize("planner", PLANNERS)
def test_forward_it_is_the_interpolator_to_the_bit(planner: str) -> None:
    path = winding(planner)
    reference = np.concatenate([block.position for block in sample([path], CYCLE)])
    both = Interpolator2Dir(path, CYCLE)
    assert np.array_equal(advance(both, len(reference)), reference)
    assert both.outputs.done


@pytest.mark.parametrize("planner", PLANNERS)
def test_there_and_back_again_on_the_same_path(planner: str) -> None:
    path = winding(planner)
    both = Interpolator2Dir(path, CYCLE)
    there = advance(both, 600)
    directions = [both.direction]
    both.inputs.override = -0.7
    back = advance(both, 100)
    assert [*directions, both.direction] == [Direction.POSITIVE, Direction.NEGATIVE]
    back = np.vstack([back, advance(both, 4000)])
    assert both.at_start
    assert both.direction is Direction.STANDSTILL
    assert both.outputs.status is Status.WAIT
    assert np.allclose(back[-1], path.start, atol=1e-12)
    finest = np.concatenate([block.position for block in sample([path], 1e-4)])
    for point in back[:900:50]:
        assert min(np.linalg.norm(finest - point, axis=1)) < 0.02
    assert there[:5] == pytest.approx(finest[:50:10], abs=1e-9)
    both.inputs.override = 1.0
    advance(both, 4000)
    assert both.outputs.done
    assert np.array_equal(both.outputs.set_position, path.target[-1])


@settings(max_examples=10, deadline=None)
@given(paths(stops=False, most=6), st.sampled_from(PLANNERS))
def test_the_backward_path_of_the_backward_path_is_the_path(path: Toolpath, planner: str) -> None:
    there = planned(path, planner)
    back = backward(there)
    verify(back)
    again = backward(back)
    for name in (
        "kind",
        "length",
        "feed",
        "accel",
        "decel",
        "v_limit",
        "v_end",
        "v_junction",
        "line",
        "profile",
    ):
        assert np.array_equal(getattr(again, name), getattr(there, name)), name
    assert np.allclose(again.target, there.target, atol=1e-12)
    if there.a_end is not None:
        assert again.a_end is not None
        assert np.array_equal(again.a_end, there.a_end)
    times = [sum(len(b.t) for b in sample([chunk], CYCLE)) for chunk in (there, back)]
    assert abs(times[0] - times[1]) <= 1


CHANGES = st.lists(
    st.tuples(st.integers(1, 300), st.sampled_from([-2.0, -1.0, -0.3, 0.0, 0.4, 1.0, 1.5])),
    min_size=1,
    max_size=6,
)


@settings(max_examples=10, deadline=None)
@given(paths(stops=False, most=8), st.sampled_from(PLANNERS), CHANGES)
def test_axes_keep_their_limits(path: Toolpath, planner: str, changes: list[tuple[int, float]]) -> None:
    axes = default_machine().axes
    both = Interpolator2Dir(planned(path, planner), CYCLE)
    position = []
    for wait, override in changes:
        both.inputs.override = override
        position.append(advance(both, wait))
    v = np.diff(np.vstack(position), axis=0) / CYCLE
    for column, letter in enumerate(AXES):
        axis = axes[letter]
        assert np.abs(v[:, column]).max(initial=0.0) <= axis.velocity * (1 + 1e-6)
        dv = np.abs(np.diff(v[:, column])).max(initial=0.0)
        assert dv <= 1.05 * axis.acceleration * CYCLE + axis.velocity_step + 1e-6 * axis.velocity


@settings(max_examples=8, deadline=None)
@given(plans(), CHANGES)
def test_the_path_keeps_its_jerk(path: Toolpath, changes: list[tuple[int, float]]) -> None:
    both = Interpolator2Dir(path, CYCLE)
    position = [path.start[None, :]] * 3
    for wait, override in changes:
        both.inputs.override = override
        position.append(advance(both, wait))
    s = np.vstack(position) @ (np.array([1.0, 0.5, 0.0]) / np.sqrt(1.25))
    assert np.abs(np.diff(s, 2)).max() <= 1000.0 * (1 + 1e-6) * CYCLE**2 + 1e-12
    assert np.abs(np.diff(s, 3)).max() <= 20_000.0 * (1 + 1e-6) * CYCLE**3 + 1e-12


def test_m_functions_wait_forwards_and_are_passed_backwards_and_jumps_jump_back() -> None:
    build = Builder()
    build.line(10, 0.0, 50)
    build.still(Kind.M_FUNCTION, number=3)
    build.jump(5.0)
    build.line(10, 0.0, 50)
    path = planned(build.path())
    both = Interpolator2Dir(path, CYCLE)
    advance(both, 1000)
    assert both.outputs.m == 3
    both.inputs.ack_m = True
    reasons = [both.advance(1).reason for _ in range(200)]
    assert reasons.count(JUMPED) == 1
    both.inputs.ack_m, both.inputs.override = False, -1.0
    reasons = [both.advance(1).reason for _ in range(2000)]
    assert reasons.count(JUMPED) == 1
    assert both.at_start
    both.inputs.override = 1.0
    advance(both, 1000)
    assert both.outputs.m == 3


def test_switch_points_are_undone_backwards() -> None:
    build = Builder()
    build.line(20, 0.0, 50)
    path = planned(build.path())
    events = type(path.events).from_rows([(0, int(EventKind.SWITCH), 2, 0.25, 0.0, 0.0, -1)])
    both = Interpolator2Dir(path.replace(events=events), CYCLE)
    advance(both, 300)
    assert both.outputs.switches == 2
    both.inputs.override = -1.0
    advance(both, 1000)
    assert (both.at_start, both.outputs.switches, both.outputs.last_switch) == (True, 0, -2)
