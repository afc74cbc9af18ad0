"""Machine files: the samples hold together, and each thing that can be wrong is said in one line."""

from __future__ import annotations

from pathlib import Path

import pytest

from nccompile.errors import MachineError
from nccompile.machine.model import default_machine, load, parse
from nccompile.toolpath.columns import AXIS_LETTERS

SAMPLES = Path(__file__).parents[2] / "samples"
MILL = (SAMPLES / "mill3.toml").read_text("utf-8")


def test_the_mill_reads_as_written() -> None:
    machine = load(SAMPLES / "mill3.toml")
    assert (machine.name, machine.cycle_us, machine.cycle) == ("mill3", 1000, 0.001)
    assert list(machine.axes) == ["X", "Y", "Z"]
    x = machine.axes["X"]
    assert (x.kind, x.min, x.max, x.velocity, x.acceleration) == ("linear", -1500, 1500, 250, 2500)
    assert (x.velocity_step, x.rapid, x.following_error, x.lag) == (8, 200, 2, 0.004)
    assert (machine.path.feed, machine.path.acceleration, machine.path.time_law) == (20, 1500, "trapezoid")
    assert (machine.queue, machine.low_water) == (4096, 2048)


def test_the_plotter_reads_as_written() -> None:
    machine = load(str(SAMPLES / "plotter2.toml"))
    assert machine.path.time_law == "sigmoid"
    assert machine.kinematics.offset == {"X": 210, "Y": 148.5}
    assert (machine.axes["X"].low, machine.axes["X"].high) == (0, 420)
    assert (machine.queue, machine.low_water) == (1024, 512)  # low_water left out: half the queue


def test_the_built_in_machine_has_all_axes_and_no_travel_limits() -> None:
    machine = default_machine()
    assert list(machine.axes) == list(AXIS_LETTERS)
    assert [letter for letter, axis in machine.axes.items() if axis.kind == "rotary"] == ["A", "B", "C"]
    assert {(axis.low, axis.high) for axis in machine.axes.values()} == {(float("-inf"), float("inf"))}
    assert machine.path.acceleration == machine.path.deceleration == 100  # SoftMotion §6.6


def test_defaults_need_only_name_and_axes() -> None:
    machine = parse('[machine]\nname="m"\n[axes.A]\nvelocity=1\nacceleration=2\nvelocity_step=0\n', "m.toml")
    axis = machine.axes["A"]
    assert (axis.kind, axis.unit, axis.lag, axis.home) == ("rotary", "deg", 0.0, None)
    assert (machine.cycle_us, machine.path.acceleration, machine.path.angle_tolerance) == (1000, 100, 20)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "velocity = 250",
            "velocity = true",
            "axes.X.velocity: expected a number of mm/s or deg/s, greater than 0",
        ),
        ("velocity = 250", "velocity = -3", "at most 1000000, found -3"),
        ("velocity = 250", 'velocity = "fast"', 'found "fast"'),
        ("velocity = 250", "velocity = inf", "axes.X.velocity: expected a number"),
        ("velocity = 250", "velocity = nan", "found nan"),
        ("velocity = 250", "", "axes.X.velocity: missing; expected a number of mm/s or deg/s"),
        ("velocity = 250", "velocty = 250", "axes.X.velocty: unknown key; did you mean velocity?"),
        (
            "acceleration = 2500",
            "backlash = 1",
            "axes.X.backlash: unknown key; known keys: kind, min, max, velocity,",
        ),
        (
            "cycle_us = 1000",
            "cycle_us = 50",
            "machine.cycle_us: expected a whole number of µs, at least 100 and",
        ),
        ("cycle_us = 1000", "cycle_us = 1000.5", "at most 100000, found 1000.5"),
        ("[axes.Z]", "[axes.ZZ]", "axes.ZZ: axes are named by one letter of X Y Z A B C P Q U V W"),
        ("[axes.Z]", "[axxes.Z]", "axxes: unknown key; did you mean axes?"),
        ('type = "gantry"', 'type = "delta"', 'kinematics.type: expected "gantry", found "delta"'),
        (
            '"trapezoid"',
            '"square"',
            'path.time_law: expected "trapezoid", "sigmoid" or "parabolic", found "square"',
        ),
        (
            "lag = 0.005",
            "lag = 1",
            "axes.Z: lag must be less than following_error / velocity = 0.0133333 s, not 1",
        ),
        ("X = 0", "Q = 0", "kinematics.offset.Q: no such axis; the machine has X Y Z"),
        ("X = 0", 'X = "a"', 'kinematics.offset.X: expected a number of mm or deg, found "a"'),
        ("max = 1500", "max = -1500", "axes.X: min must be less than max, not -1500 and -1500"),
        ("rapid = 200", "rapid = 300", "axes.X: rapid must not exceed velocity, not 300 and 250"),
        ("rapid = 200", "home = 1501", "axes.X: home must lie in the travel -1500 to 1500, not 1501"),
        ('name = "mill3"', "name = 3", "machine.name: expected a text of 1 to 100 characters"),
        ('name = "mill3"', 'name = ""', "machine.name: expected a text of 1 to 100 characters"),
        ("queue = 4096", "queue = 100", "runtime: low_water must not exceed queue, not 2048 and 100"),
        ("queue = 4096", "queue = []", "runtime.queue: expected a whole number of segments, at least 2"),
        ("[axes.X]", "[axes.X", "m.toml:17:8: TOML syntax: expected ']' at the end of a table declaration"),
    ],
)
def test_each_error_names_file_key_and_expectation(old: str, new: str, said: str) -> None:
    assert old in MILL
    with pytest.raises(MachineError) as caught:
        parse(MILL.replace(old, new, 1), "m.toml")
    assert str(caught.value).startswith("m.toml:")
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "machine: missing; expected a section"),
        ("machine = 4", "machine: expected a section (a TOML table), found 4"),
        ('axes.X = 3\n[machine]\nname = "m"', "axes.X: expected a section (a TOML table), found 3"),
        ('axes = 3\n[machine]\nname = "m"', "axes: expected a section (a TOML table), found 3"),
        (
            '[axes]\n[machine]\nname = "m"',
            "axes: expected at least one section [axes.<letter>], found an empty table",
        ),
        ("a = [", "TOML syntax: invalid value at the end of the file"),
        ("a = " + "[" * 100_000, "values are nested too deeply"),
    ],
)
def test_files_that_are_no_machine_at_all(text: str, said: str) -> None:
    with pytest.raises(MachineError) as caught:
        parse(text, "m.toml")
    assert said in str(caught.value)
    assert len(str(caught.value)) < 500


def test_many_errors_are_cut_off() -> None:
    text = '[machine]\nname = "m"\n' + "".join(f"[axes.X{i}]\n" for i in range(30))
    with pytest.raises(MachineError) as caught:
        parse(text, "m.toml")
    lines = str(caught.value).splitlines()
    assert len(lines) == 11
    assert lines[-1] == "m.toml: and 80 more errors"


def test_unreadable_files(tmp_path: Path) -> None:
    with pytest.raises(MachineError, match=r"nowhere\.toml: cannot be read: No such file"):
        load(tmp_path / "nowhere.toml")
    with pytest.raises(MachineError, match="cannot be read"):
        load(tmp_path)
    binary = tmp_path / "binary.toml"
    binary.write_bytes(bytes(range(256)))
    with pytest.raises(MachineError, match=r"binary\.toml: not a machine file: it is not UTF-8 text"):
        load(binary)


def test_byte_order_mark_and_crlf_are_accepted(tmp_path: Path) -> None:
    file = tmp_path / "m.toml"
    file.write_bytes(b"\xef\xbb\xbf" + MILL.replace("\n", "\r\n").encode())
    assert load(file) == parse(MILL, "m.toml")
