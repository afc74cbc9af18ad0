"""Limits of turns of the machine file: corner angle in all axes, centripetal acceleration and its jump."""

from __future__ import annotations

from dataclasses import replace
from math import inf, isclose, pi, radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.machine.model import default_machine, parse
from nccompile.passes.velocity import LOOK_AHEAD, TIME_OPTIMAL, PlanSettings
from nccompile.passes.velocity.planner import plan
from nccompile.toolpath.columns import Floats, Toolpath
from tests.velocity.random_paths import Builder, paths

AXES = ("X", "Y", "Z", "A")
GENERIC = PlanSettings.from_machine(default_machine(), AXES)


def planned(path: Toolpath, options: PlanSettings) -> Toolpath:
    return Toolpath.join(list(plan([path], options)))


def test_the_corner_angle_counts_all_axes() -> None:
    # straight on in X-Y-Z, but the rotary axis begins to turn: 45 degrees in all four axes
    build = Builder()
    build.line(10, 0.0, 20)
    build.line(10, 0.0, 20, da=10.0)
    for angle, stops in ((44.9, True), (45.1, False), (180.0, False)):
        options = replace(GENERIC, corner_angle=radians(angle), angle_tolerance=pi)
        v_end = planned(build.path(), options).v_end
        assert v_end is not None
        assert bool(v_end[0] == 0.0) is stops


@pytest.mark.parametrize("planner", [LOOK_AHEAD, TIME_OPTIMAL])
def test_centripetal_acceleration_of_an_arc_and_its_jump(planner: str) -> None:
    build = Builder()
    build.line(200, 0.0, 300, 4000, 4000)
    build.arc(10.0, pi, 0.0, 300, 4000, 4000)
    build.line(200, 0.0, 300, 4000, 4000)
    options = replace(GENERIC, planner=planner, centripetal=1000.0, centripetal_jump=250.0)
    whole = planned(build.path(), options)
    assert whole.v_end is not None
    assert whole.v_limit is not None
    arc = np.flatnonzero(whole.curve >= 0)
    assert isclose(float(whole.v_limit[arc].max()) ** 2 / 10.0, 1000.0, rel_tol=1e-9)
    for row in (arc[0] - 1, arc[-1]):  # where a line meets the arc
        assert isclose(float(whole.v_end[row]) ** 2 / 10.0, 250.0, rel_tol=1e-6)


def _centripetal(path: Toolpath, options: PlanSettings) -> Floats:
    """v² / r of arcs at their ends, planned."""
    whole = planned(path, options)
    assert whole.v_end is not None
    arcs = np.flatnonzero(whole.curve >= 0)
    radius = whole.curves.parameters[whole.curve[arcs], 2]
    before = np.concatenate([[0.0], whole.v_end])[arcs]
    out: Floats = np.maximum(before, whole.v_end[arcs]) ** 2 / radius
    return out


@settings(max_examples=25, deadline=None)
@given(paths(most=10), st.floats(1.0, 2000.0), st.sampled_from([LOOK_AHEAD, TIME_OPTIMAL]))
def test_no_arc_exceeds_the_centripetal_acceleration(path: Toolpath, limit: float, planner: str) -> None:
    options = replace(GENERIC, planner=planner, centripetal=limit)
    assert (_centripetal(path, options) <= limit * (1 + 1e-9)).all()


def test_the_machine_file_names_them() -> None:
    text = """
[machine]
name = "m"
[path]
corner_angle = 30
centripetal_acceleration = 800
centripetal_jump = 200
[axes.X]
velocity = 100
acceleration = 1000
velocity_step = 1
"""
    options = PlanSettings.from_machine(parse(text, "m.toml"), ("X",))
    assert isclose(options.corner_angle, radians(30))
    assert (options.centripetal, options.centripetal_jump) == (800.0, 200.0)
    assert options.limits_turns
    assert (GENERIC.centripetal, GENERIC.centripetal_jump, GENERIC.limits_turns) == (inf, inf, False)
