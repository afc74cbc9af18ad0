"""Following X (SoftMotion §6.7): the other axes are where the path is at the workpiece's X."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from nccompile.errors import UsageError
from nccompile.machine.model import default_machine
from nccompile.passes.velocity import PlanSettings
from nccompile.passes.velocity.planner import plan
from nccompile.runtime.x_interpolator import XInterpolator
from nccompile.toolpath.columns import Toolpath
from tests.velocity.random_paths import Builder

AXES = ("X", "Y", "Z", "A")


def planned(build: Builder) -> Toolpath:
    return Toolpath.join(list(plan([build.path()], PlanSettings.from_machine(default_machine(), AXES))))


def test_y_follows_lines_and_arcs() -> None:
    build = Builder()
    build.line(10 * sqrt(2.0), pi / 4, 50)
    build.switch(3, 0.5)
    build.arc(10.0, -pi / 4, 0.0, 50)  # bends back to X
    build.line(10.0, 0.0, 50)
    follow = XInterpolator(planned(build), offset=1.0)
    top = 10.0 + 10.0 * (1 - sqrt(0.5))
    for x, y in ((0.0, 0.0), (2.0, 2.0), (7.5, 7.5), (10.0, 10.0), (10.0 + 10 * sqrt(0.5), top), (20.0, top)):
        assert np.allclose(follow.advance(x - 1.0)[:2], (x, y), atol=1e-9)
        assert (follow.switches == 4) == (x >= 5.0)
    arc_x = 13.0
    again = XInterpolator(planned(build))
    y = 10.0 - 10 * sqrt(0.5) + sqrt(100.0 - (10.0 + 10 * sqrt(0.5) - arc_x) ** 2)
    assert again.advance(arc_x)[1] == pytest.approx(y, abs=1e-9)
    assert again.source_line == 2
    assert again.way_pos == pytest.approx(
        10 * sqrt(2.0) + 10.0 * (pi / 4 - np.arcsin((10 + 10 * sqrt(0.5) - arc_x) / 10))
    )
    end = again.advance(100.0)
    assert again.done
    assert np.array_equal(end, build.at)


def test_a_workpiece_that_goes_back_holds_the_position() -> None:
    build = Builder()
    build.line(50.0, 0.5, 50)
    follow = XInterpolator(planned(build))
    held = follow.advance(20.0).copy()
    assert np.array_equal(follow.advance(10.0), held)


def test_paths_that_turn_back_in_x_are_refused() -> None:
    build = Builder()
    build.line(10.0, 0.0, 50)
    build.line(10.0, 2.0, 50)
    with pytest.raises(UsageError, match="source line 2"):
        XInterpolator(planned(build))
    with pytest.raises(UsageError, match="direction"):
        XInterpolator(planned(build), direction=0)
