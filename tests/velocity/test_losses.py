"""The time report: it adds up to the job time, names axes and lines, and does not depend on chunks."""

from __future__ import annotations

from math import cos, isclose, radians
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.machine.model import default_machine
from nccompile.passes.velocity import PlanSettings
from nccompile.passes.velocity.losses import Losses
from nccompile.passes.velocity.planner import plan, row_times
from nccompile.source import Source
from nccompile.toolchain import Compilation, Options
from nccompile.toolpath.columns import Kind, Toolpath
from tests.velocity.random_paths import Builder, cut, paths

AXES = ("X", "Y", "Z", "A")


def losses(path: Toolpath, planner: str, size: int = 4096) -> tuple[Losses, float]:
    options = PlanSettings.from_machine(default_machine(), AXES, planner=planner)
    report, before, total = Losses(options), 0.0, 0.0
    for chunk in plan(cut(path, size), options):
        report.add(chunk, before)
        total += float(row_times(chunk, before).sum())
        assert chunk.v_end is not None
        before = float(chunk.v_end[-1])
    return report, total


@settings(max_examples=30, deadline=None)
@given(paths(most=15), st.sampled_from(["look-ahead", "jerk", "softmotion"]))
def test_the_parts_add_up_to_the_job_time(path: Toolpath, planner: str) -> None:
    report, total = losses(path, planner)
    assert isclose(report.job_time, total, rel_tol=1e-6, abs_tol=1e-4)
    assert len(report.places) <= 10
    other, _ = losses(path, planner, size=3)
    assert isclose(other.job_time, report.job_time, rel_tol=1e-9)
    assert isclose(other.corners, report.corners, rel_tol=1e-9, abs_tol=1e-9)


def test_axes_and_lines_are_named() -> None:
    build = Builder()
    build.line(300, 0.0, 900, 5000, 5000)  # X can do 500
    build.line(100, 0.0, 50, 5000, 5000, da=0.0)
    build.line(100, radians(60), 50, 5000, 5000)  # a stop between lines 2 and 3
    build.still(Kind.DWELL, seconds=0.5)
    report, _ = losses(build.path(), "look-ahead")
    assert report.limits == {"X": pytest.approx(300 / 500 - 300 / 900)}
    third = 100 / 50 - 100 / (500 / cos(radians(30)))  # Y alone would allow so much at 60 degrees
    assert report.feed == pytest.approx(100 / 50 - 100 / 500 + third)
    assert report.waits == pytest.approx(0.5)
    assert report.corners > 0.0
    assert report.places[0].line == 1
    assert report.as_dict()["slowest"][0]["cause"] == "X"


def test_softmotion_reports_what_the_machine_cannot_do(tmp_path: Path) -> None:
    program = tmp_path / "fast.nc"
    program.write_text("% FAST\nN10 G1 X100 F900 E9000 E-9000\nN20 G1 X200 Y20 F40\nN30 G1 Y100\n")
    for planner, lines in (("softmotion", [2, 3, 4]), ("look-ahead", [])):
        options = Options(default_machine(), planner=planner, losses=True)
        compilation = Compilation(Source.read(program), options)
        assert list(compilation.planned())
        assert [d.span.line for d in compilation.diagnostics if d.code == "NC501"] == lines
        assert compilation.time.losses is not None
        assert isclose(compilation.time.losses.job_time, compilation.time.seconds, rel_tol=1e-9)
