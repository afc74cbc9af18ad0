"""Bad input: one screen of text, the documented exit code, no traceback, no output file, no hang."""

from __future__ import annotations

import os
import random
from pathlib import Path

import pytest

from tests.cli.conftest import SAMPLES, Command, Result

SCREEN = 25


def _assert_refused(result: Result, code: int, folder: Path, kept: set[str]) -> None:
    lines = (result.out + result.err).splitlines()
    assert result.code == code, result.err
    assert 0 < len(lines) < SCREEN, result.err
    assert all(len(line) <= 1000 for line in lines)
    assert "Traceback" not in result.err
    assert {path.name for path in folder.iterdir()} == kept


PROGRAMS = {
    "empty": b"",
    "blank": b"\n\n   \n",
    "header only": b"% name\n",
    "binary": random.Random(1).randbytes(4096),
    "picture": b"\x89PNG\r\n\x1a\n" + bytes(100),
    "a line of 10 MB": b"% p\nN10 G1 " + b"X1" * 5_000_000 + b"\n",
    "10 MB of letters": b"A" * 10_000_000,
    "unknown letters": b"% p\n" + b"".join(b"N%d \xc3\xa4 ?10 &\n" % i for i in range(500)),
    "missing values": b"% p\nN10 G1 X Y10\n",
    "malformed number": b"% p\nN10 G1 X1.2.3\n",
    "huge number": b"% p\nN10 G1 X" + b"9" * 400 + b"\n",
    "nested comment": b"% p\nN10 (a (b) c) G1 X10\n",
    "open comment": b"% p\nN10 (a G1 X10\n",
    "jump to nowhere": b"% p\nN10 G36 D1\nN20 G1 X10\nN30 G20 L77\n",
    "endless loop": b"% p\nN10 G36 D1\nN20 G1 X10\nN30 G1 X0\nN40 G20 L20\n",
    "endless loop without motion": b"% p\nN10 G36 D1\nN20 G20 L10\n",
    "zero feed": b"% p\nN10 G1 X10 F0\n",
    "negative feed": b"% p\nN10 G1 X10 F-5\n",
    "undefined variable": b"% p\nN10 G1 X$width$\n",
    "unknown instruction": b"% p\nN10 G77 X10\n",
    "UTF-16": "% p\nN10 G1 X10\n".encode("utf-16"),
}


@pytest.mark.parametrize("name", PROGRAMS)
def test_programs_with_errors(command: Command, tmp_path: Path, name: str) -> None:
    (tmp_path / "p.nc").write_bytes(PROGRAMS[name])
    _assert_refused(command("compile", "p.nc"), 1, tmp_path, {"p.nc"})


@pytest.mark.parametrize("name", ["empty", "binary", "malformed number", "endless loop"])
@pytest.mark.parametrize(
    "arguments", [["run", "--trace", "t.csv"], ["sample", "-o", "s.csv"], ["plot", "-o", "p.png"], ["dump"]]
)
def test_programs_with_errors_are_not_used(
    command: Command, tmp_path: Path, name: str, arguments: list[str]
) -> None:
    (tmp_path / "p.nc").write_bytes(PROGRAMS[name])
    _assert_refused(command(arguments[0], "p.nc", *arguments[1:]), 1, tmp_path, {"p.nc"})


def test_an_impossible_arc_becomes_a_line(command: Command, tmp_path: Path) -> None:
    (tmp_path / "p.nc").write_text("% p\nN10 G2 X10 Y0 I3 J0 F10\n")
    result = command("compile", "p.nc")
    assert result.code == 0
    assert "NC2" in result.err


def test_a_path_outside_the_travel(command: Command, tmp_path: Path) -> None:
    (tmp_path / "p.nc").write_text("% p\nN10 G0 X9999\n")
    result = command("compile", "p.nc", "-m", SAMPLES / "mill3.toml")
    _assert_refused(result, 1, tmp_path, {"p.nc"})
    assert "NC402" in result.err


@pytest.mark.parametrize("name", ["compile", "info", "dump", "sample", "run", "plot"])
@pytest.mark.parametrize("path", ["missing.nc", "missing.ncq", ".", "no/such/folder/part.nc"])
def test_paths_that_cannot_be_read(command: Command, tmp_path: Path, name: str, path: str) -> None:
    _assert_refused(command(name, path), 2, tmp_path, set())


def test_a_program_is_no_queue(command: Command, program: Path, tmp_path: Path) -> None:
    result = command("info", program)
    _assert_refused(result, 2, tmp_path, {"part.nc"})
    assert "compile it first" in result.err


def test_a_queue_is_no_program(command: Command, queue: Path, tmp_path: Path) -> None:
    _assert_refused(command("compile", queue), 2, tmp_path, {"part.nc", "part.ncq"})
    renamed = queue.rename(tmp_path / "renamed.nc")
    _assert_refused(command("compile", renamed), 2, tmp_path, {"part.nc", "renamed.nc"})


@pytest.mark.parametrize("name", ["info", "dump", "sample", "run", "plot"])
@pytest.mark.parametrize("damage", ["garbage", "empty", "truncated", "flipped"])
def test_damaged_queues(command: Command, queue: Path, tmp_path: Path, name: str, damage: str) -> None:
    sound = queue.read_bytes()
    flipped = bytearray(sound)
    flipped[len(sound) // 3] ^= 4
    content = {"garbage": b"not a zip", "empty": b"", "truncated": sound[:-40], "flipped": bytes(flipped)}
    queue.write_bytes(content[damage])
    result = command(name, queue)
    _assert_refused(result, 2, tmp_path, {"part.nc", "part.ncq"})
    assert "not a sound OutQueue" in result.err


def test_options_of_programs_are_refused_for_queues(command: Command, queue: Path) -> None:
    result = command("run", queue, "--time-law", "sigmoid")
    assert result.code == 2
    assert "--time-law" in result.err


@pytest.mark.parametrize(
    "arguments",
    [
        ["--start", "10"],
        ["--start", "X1,X2"],
        ["--start", "Xa"],
        ["--start", "Xnan"],
        ["--define", "width"],
        ["--define", "width=wide"],
        ["--define", "width=inf"],
        ["--angle-tolerance", "-1"],
        ["--time-law", "cubic"],
        ["--max-jumps", "0"],
        ["--no-such-option"],
        ["-o", "."],
        ["-o", "no/such/folder/p.ncq"],
        ["-m", "missing.toml"],
        ["-m", "part.nc"],
    ],
)
def test_wrong_options(command: Command, program: Path, tmp_path: Path, arguments: list[str]) -> None:
    _assert_refused(command("compile", program, *arguments), 2, tmp_path, {"part.nc"})


@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "--override", "0"],
        ["run", "--override", "nan"],
        ["run", "--m-delay", "soon"],
        ["run", "--m-delay", "-1"],
        ["run", "--at", "now stop"],
        ["run", "--at", "1 brake=on"],
        ["run", "--trace", "t.txt"],
        ["run", "--trace", "no/such/folder/t.csv"],
        ["run", "--cycle-us", "5"],
        ["sample", "-o", "s.txt"],
        ["sample", "--cycle-us", "5"],
        ["plot", "-o", "p.txt"],
        ["dump", "--format", "xml"],
    ],
)
def test_wrong_options_of_a_run(command: Command, queue: Path, tmp_path: Path, arguments: list[str]) -> None:
    result = command(arguments[0], queue, *arguments[1:])
    _assert_refused(result, 2, tmp_path, {"part.nc", "part.ncq"})


def test_a_machine_without_the_axis(command: Command, tmp_path: Path) -> None:
    (tmp_path / "p.nc").write_text("% p\nN10 G1 W10 F10\n")
    result = command("compile", "p.nc", "-m", SAMPLES / "mill3.toml")
    _assert_refused(result, 1, tmp_path, {"p.nc"})


@pytest.mark.parametrize("text", ["", "x = [", "[machine]\nname = 'm'\n", "[machine]\nnaem = 'm'\n"])
def test_machine_files_that_do_not_hold_together(command: Command, tmp_path: Path, text: str) -> None:
    (tmp_path / "m.toml").write_text(text)
    _assert_refused(command("machine", "check", "m.toml"), 2, tmp_path, {"m.toml"})


@pytest.mark.parametrize("arguments", [["explain", "NC999"], ["frobnicate"], ["--frobnicate"], ["compile"]])
def test_wrong_usage(command: Command, tmp_path: Path, arguments: list[str]) -> None:
    _assert_refused(command(*arguments), 2, tmp_path, set())


@pytest.mark.parametrize(
    "arguments",
    [
        ["compile", "/dev/zero", "-o", "p.ncq"],
        ["info", "/dev/zero"],
        ["dump", "/dev/zero"],
        ["machine", "check", "/dev/zero"],
        ["lint", "-", "-m", "/dev/zero"],
    ],
)
def test_devices_are_not_read(command: Command, tmp_path: Path, arguments: list[str]) -> None:
    """They have no end."""
    result = command(*arguments, stdin=b"% a\nN10 G1 X1 F20\n")
    _assert_refused(result, 2, tmp_path, set())
    assert "is a device" in result.err


@pytest.mark.parametrize(
    "arguments",
    [
        ["compile", "-o", "part.nc"],
        ["compile", "--report", "part.nc"],
        ["compile", "-m", "m.toml", "-o", "m.toml"],
        ["compile", "-o", "x.ncq", "--report", "./x.ncq"],
        ["compile", "-o", "-"],
        ["run", "--report", "part.nc"],
        ["run", "--trace", "t.csv", "--report", "t.csv"],
        ["export-dxf", "-o", "part.nc"],
        ["export-dxf", "-o", "link.nc"],
    ],
)
def test_outputs_are_neither_inputs_nor_each_other(
    command: Command, program: Path, tmp_path: Path, arguments: list[str]
) -> None:
    before = program.read_bytes()
    (tmp_path / "m.toml").write_bytes((SAMPLES / "mill3.toml").read_bytes())
    (tmp_path / "link.nc").symlink_to(program)
    result = command(arguments[0], program, *arguments[1:])
    _assert_refused(result, 2, tmp_path, {"part.nc", "m.toml", "link.nc"})
    assert program.read_bytes() == before


@pytest.mark.parametrize(
    "arguments",
    [
        ["compile", "--report", "r.json"],
        ["lint", "--format", "json"],
        ["lint", "--format", "sarif"],
        ["plot", "-o", "p.png"],
        ["fmt", "--check"],
    ],
)
def test_names_that_are_no_text(command: Command, tmp_path: Path, arguments: list[str]) -> None:
    path = tmp_path / os.fsdecode(b"b\xff.nc")
    path.write_text("% p\nN10 G1 X1 F20\n")
    result = command(arguments[0], path, *arguments[1:])
    assert (result.code, "internal error" in result.err) == (0, False)
    assert command("lint", path, "--format", "github").code == 0


@pytest.mark.parametrize("name", ["sample", "plot"])
def test_a_program_that_is_called_like_an_output(command: Command, tmp_path: Path, name: str) -> None:
    path = tmp_path / {"sample": "p.csv", "plot": "p.png"}[name]
    path.write_text("% p\nN10 G1 X1 F20\n")
    _assert_refused(command(name, path, "-o", path), 2, tmp_path, {path.name})


def test_standard_input_needs_an_output_name(command: Command, tmp_path: Path) -> None:
    _assert_refused(command("compile", "-", stdin=b"% p\nN10 G1 X1 F1\n"), 2, tmp_path, set())


def test_a_fault_of_a_drive(command: Command, tmp_path: Path) -> None:
    """A queue for a fast machine faults on one whose drives cannot follow."""
    (tmp_path / "p.nc").write_text("% p\nN10 G1 X400 F400 E5000 E-5000\n")
    assert command("compile", "p.nc").code == 0
    result = command("run", "p.ncq", "-m", SAMPLES / "mill3.toml")
    assert result.code == 1
    assert "fault" in result.out
    assert "Traceback" not in result.err
