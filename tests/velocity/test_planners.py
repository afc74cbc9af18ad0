"""The planners by name: the manual's rules, junction deviation against peers' rules, windows, machine limits."""

from __future__ import annotations

from dataclasses import replace
from math import inf, isclose, radians, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.kernels.corners import CIRCLE
from nccompile.machine.limits import AxisLimits
from nccompile.machine.model import default_machine
from nccompile.passes.velocity import SOFTMOTION, PlanSettings
from nccompile.passes.velocity.planner import Planner, plan, row_times
from nccompile.toolpath.columns import Toolpath
from tests.velocity.peers import Moves, finishing, grbl, klipper, least, linuxcnc
from tests.velocity.random_paths import Builder, cut, paths

AXES = ("X", "Y", "Z", "A")
ACCEL = 1000.0


def job_time(path: Toolpath, options: PlanSettings) -> float:
    return float(row_times(Toolpath.join(list(plan(cut(path, 4096), options))), 0.0).sum())


def equal_limits(path: Toolpath, per_axis: bool) -> PlanSettings:
    """The limits of the comparison in docs/planning.md: 1000 mm/s², deviation 0.01 mm, no other rule."""
    k = len(path.axes)
    free, bound = np.full(k, inf), np.full(k, ACCEL if per_axis else inf)
    path_accel = 1e6 if per_axis else ACCEL
    limits = AxisLimits(np.full(k, 166.667), bound, free, free)
    return PlanSettings(
        limits,
        25.0,
        path_accel,
        path_accel,
        radians(180),
        1e-3,
        0,
        junction_deviation=0.01,
        rapid_stops=False,
    )


def test_klippers_rule_gives_klippers_time() -> None:
    moves = finishing(passes=4)
    path = moves.toolpath()
    rule = replace(
        equal_limits(path, per_axis=False),
        junction_rule=CIRCLE, junction_deviation=25.0 * (sqrt(2.0) - 1.0) / ACCEL,
    )  # fmt: skip
    assert isclose(job_time(path, rule), klipper(moves, ACCEL, 5.0), rel_tol=1e-9)


def test_our_corner_rule_loses_less_time_than_every_peers() -> None:
    moves = finishing(passes=6)
    path = moves.toolpath()
    ours = job_time(path, equal_limits(path, per_axis=True)) - moves.time_at_feed
    peers = (klipper(moves, ACCEL, 5.0), grbl(moves, ACCEL, 0.01), linuxcnc(moves, ACCEL, 0.005))
    assert 0.0 < ours < min(peers) - moves.time_at_feed
    assert ours < 1.1 * (least(moves, ACCEL, 0.01) - moves.time_at_feed)


def test_a_parabola_through_a_square_corner() -> None:
    # X brakes while Y accelerates: v T = v²/a, the middle is v T sqrt(2) / 8 off the corner
    corner = Moves(np.array([[50.0, 0, 0], [0, 50.0, 0]]), np.full(2, 100.0), np.zeros(2, bool))
    path = corner.toolpath()
    chunk = Toolpath.join(list(plan([path], equal_limits(path, per_axis=True))))
    assert chunk.v_end is not None
    v = float(chunk.v_end[0])
    assert isclose(v * v / ACCEL * sqrt(2.0) / 8.0, 0.01, rel_tol=1e-9)


def test_softmotion_plans_by_the_manual_and_no_machine_limit() -> None:
    build = Builder()
    build.line(100, 0.0, 400, 9000, 9000)
    build.line(100, radians(19), 300, 9000, 9000)  # the axes' velocity step would not allow it
    build.arc(2.0, 3.0, 0.0, 300, 9000, 9000)  # nor their acceleration the arc
    build.line(100, radians(21), 300, 9000, 9000)
    options = PlanSettings.from_machine(default_machine(), AXES, planner=SOFTMOTION)
    whole = Toolpath.join(list(plan([build.path()], options)))
    assert whole.v_end is not None
    assert whole.v_end.tolist()[0] == 300.0
    assert whole.v_end.tolist()[2] == 0.0  # above the angle tolerance
    assert whole.accel.tolist() == [9000.0] * 4
    assert job_time(build.path(), options) < job_time(build.path(), replace(options, planner="look-ahead"))


@settings(max_examples=40, deadline=None)
@given(paths(most=40), st.sampled_from([1, 3, 100]))
def test_a_larger_window_is_never_slower_and_chunks_do_not_matter(path: Toolpath, size: int) -> None:
    options = PlanSettings.from_machine(default_machine(), AXES)
    before = None
    for window in (1, 2, 5, 100, 30_000, None):
        narrow = replace(options, window=window)
        chunks: list[Toolpath] = []
        planner = Planner(narrow)
        for chunk in cut(path, size):
            chunks += planner.feed(chunk)
        chunks += planner.finish()
        small = Toolpath.join(chunks)
        whole = Toolpath.join(list(plan([path], narrow)))
        assert small.v_end is not None
        assert whole.v_end is not None
        assert np.array_equal(small.v_end, whole.v_end)
        if before is not None:
            assert (small.v_end >= before).all()
        before = small.v_end


def test_a_window_commits_rows_as_soon_as_it_is_full() -> None:
    build = Builder()
    for _ in range(300):
        build.line(0.5, 0.0, 300, 2000, 5)
    planner = Planner(replace(PlanSettings.from_machine(default_machine(), AXES), window=10))
    out = [len(done) for chunk in cut(build.path(), 50) for done in planner.feed(chunk)]
    assert out[0] == pytest.approx(40, abs=2)
    assert all(n == 50 for n in out[1:])
