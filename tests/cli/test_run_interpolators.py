"""`nccompile run --interpolator`: both directions, and following a workpiece, as a user calls them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import Command

PROGRAM = """%
N10 G1 X40 Y0 F60
N20 M5
N30 G3 X60 Y20 I0 J20
N40 G92 X0 Y0
N50 G1 X0 Y30
"""
RISING = """%
N10 G1 X20 Y0 F50
N20 G3 X40 Y8.284271247 I0 J28.28427125
N30 G1 H2 L0.5 X60 Y28.284271247
"""


def trace(name: str = "trace.npz") -> dict[str, np.ndarray]:
    with np.load(name) as columns:
        return dict(columns)


@pytest.mark.parametrize(("planner", "turn"), [("look-ahead", 1.8), ("jerk", 1.8), ("time-optimal", 1.0)])
def test_a_hand_wheel_runs_the_path_back_and_on(command: Command, planner: str, turn: float) -> None:
    Path("part.nc").write_text(PROGRAM)
    Path("wheel.csv").write_text(f"seconds,override\n0,1\n{turn},-0.6\n{turn + 2.2},1.5\n")
    result = command(
        "run", "part.nc", "--planner", planner, "--interpolator", "two-way", "--override-profile", "wheel.csv",
        "--trace", "trace.npz", "--report", "report.json",
    )  # fmt: skip
    assert result.code == 0, result.err
    report = json.loads(Path("report.json").read_text())
    assert report["outcome"] == "finished"
    assert report["end_position"] == {"X": 0.0, "Y": 30.0, "Z": 0.0}
    assert [entry["number"] for entry in report["m_functions"]] == [5, 5]  # passed, run back over, passed
    way = trace()
    back = (way["t"] > turn + 0.8) & (way["t"] < turn + 2.1)
    assert (np.diff(way["set_X"][back]) <= 1e-12).all()
    assert max(axis["acceleration_ratio"] for axis in report["axes"]) <= 1.0


def test_a_wheel_that_stands_ends_the_run_with_a_warning(command: Command) -> None:
    Path("part.nc").write_text(PROGRAM)
    result = command("run", "part.nc", "--interpolator", "two-way", "--at", "0.3s override=-1")
    assert result.code == 0
    assert "not released: override" in result.err
    assert "path position at the end: X0.000000 Y0.000000 Z0.000000" in result.out


def test_the_other_axes_follow_the_workpiece(command: Command) -> None:
    Path("part.nc").write_text(RISING)
    Path("way.csv").write_text("0,-10\n0.5,-10\n0.501,20\n6,50\n")
    smooth = command("run", "part.nc", "--interpolator", "x", "--x-velocity", "20", "--trace", "trace.npz")
    assert smooth.code == 0, smooth.err
    way = trace()
    rising = (way["set_X"] >= 40.0) & (way["set_X"] <= 60.0)
    assert way["set_Y"][rising] == pytest.approx(way["set_X"][rising] - 31.715728753, abs=1e-6)
    assert way["switches"][-1] == 2
    assert way["v"].max() == pytest.approx(20.0 * np.sqrt(2.0), rel=1e-6)
    result = command("run", "part.nc", "--interpolator", "x", "--x-profile", "way.csv", "--x-offset", "10")
    assert result.code == 1  # a jump is more than the drives can do
    assert "NC701" in result.err


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--interpolator", "x"], "--x-velocity or --x-profile"),
        (["--x-velocity", "5"], "with --interpolator x only"),
        (["--interpolator", "x", "--x-velocity", "-5"], "it is above 0"),
        (["--interpolator", "x", "--x-velocity", "5", "--override", "0.5"], "the workpiece is the clock"),
        (["--override", "-1"], "it goes from 0.01 to 10"),
        (["--at", "1s override=-1"], "not a number from 0.01 to 10"),
        (["--override-profile", "none.csv"], "cannot be read"),
        (["--override-profile", "bad.csv"], "bad.csv:3: the times do not rise"),
        (["--override-profile", "words.csv"], "words.csv:2: expected a time"),
        (["--override-profile", "empty.csv"], "holds no times"),
        (["--override-profile", "back.csv"], "overrides go from 0.01 to 10"),
    ],
)
def test_what_does_not_fit_together_is_refused(command: Command, options: list[str], said: str) -> None:
    Path("part.nc").write_text(RISING)
    Path("bad.csv").write_text("0,1\n1,1\n1,0.5\n")
    Path("words.csv").write_text("t,o\nfast,1\n")
    Path("empty.csv").write_text("t,o\n")
    Path("back.csv").write_text("0,-1\n")
    result = command("run", "part.nc", *options)
    assert result.code == 2
    assert said in result.err
