"""What only a process of its own shows: start-up, pipes that close, signals."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

NCCOMPILE = [sys.executable, "-m", "nccompile"]


def _long_program(path: Path, blocks: int) -> Path:
    lines = [f"N{n} G1 X{n % 100} Y{n % 7} F50" for n in range(blocks)]
    path.write_text("% long\n" + "\n".join(lines) + "\n")
    return path


def test_the_version_needs_no_command_line_library() -> None:
    """Below 100 ms means: nothing is loaded for it."""
    code = (
        "import sys; sys.argv = ['nccompile', '--version']\n"
        "from nccompile.cli.main import main; main()\n"
        "print(sorted({'typer', 'numpy', 'rich', 'lark', 'pydantic', 'numba'} & sys.modules.keys()))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    version, loaded = done.stdout.splitlines()
    assert version.startswith("nccompile ")
    assert loaded == "[]"


def test_compiling_a_small_program_loads_nothing_heavy(tmp_path: Path) -> None:
    program = _long_program(tmp_path / "p.nc", 100)
    code = (
        f"import sys; sys.argv = ['nccompile', 'compile', {str(program)!r}]\n"
        "from nccompile.cli.main import main\n"
        "try: main()\n"
        "except SystemExit as leaving: assert leaving.code == 0\n"
        "heavy = {'numba', 'scipy', 'matplotlib', 'shapely', 'ezdxf', 'rich'}\n"
        "print(sorted(heavy & sys.modules.keys()))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


@pytest.mark.parametrize("command", [["dump"], ["sample"]])
def test_a_reader_that_goes_is_no_error(tmp_path: Path, command: list[str]) -> None:
    program = _long_program(tmp_path / "p.nc", 3000)
    process = subprocess.Popen(
        [*NCCOMPILE, *command, str(program)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "NCCOMPILE_KERNELS": "python"},  # nothing to compile, nothing to say
    )
    assert process.stdout is not None
    assert process.stderr is not None
    assert process.stdout.readline() != ""
    process.stdout.close()
    said = process.stderr.read()
    assert (process.wait(timeout=60), said) == (0, "")


@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize(
    "arguments", [["--help"], ["lint", "--help"], ["machine", "check", "--help"], ["--version"]]
)
def test_nobody_need_read_help(arguments: list[str], unbuffered: str) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(
        [*NCCOMPILE, *arguments], stdout=writing, stderr=subprocess.PIPE, check=False,
        env={**os.environ, "PYTHONUNBUFFERED": unbuffered},
    )  # fmt: skip
    os.close(writing)
    assert (done.returncode, done.stderr) == (0, b"")


@pytest.mark.parametrize("arguments", ["dump p.nc", "lint p.nc", "--help", "--version"])
@pytest.mark.parametrize(("stdout", "code"), [(">&-", 0), ("> /dev/full", 2)])
def test_a_closed_or_full_standard_output(tmp_path: Path, arguments: str, stdout: str, code: int) -> None:
    (tmp_path / "p.nc").write_text("% p\nN10 G1 X1 F20\nN20 G1 X2 F20\n")
    line = f"{sys.executable} -m nccompile {arguments} {stdout}"
    done = subprocess.run(line, shell=True, cwd=tmp_path, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == code
    assert ("error: " in done.stderr) is (code == 2)
    assert "Traceback" not in done.stderr


def test_text_that_the_output_cannot_say(tmp_path: Path) -> None:
    (tmp_path / "größe.nc").write_text("% größe\nN10 G1 X1 F20 (€)\n", encoding="utf-8")
    done = subprocess.run(
        [*NCCOMPILE, "lint", "größe.nc"],
        cwd=tmp_path,
        capture_output=True,
        check=False,
        env={**os.environ, "PYTHONIOENCODING": "ascii"},
    )
    assert done.returncode == 0
    assert b"gr\\xf6\\xdfe.nc:2:16" in done.stdout


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interrupt_leaves_no_file(tmp_path: Path, number: signal.Signals, code: int) -> None:
    program = _long_program(tmp_path / "p.nc", 150_000)
    process = subprocess.Popen(
        [*NCCOMPILE, "compile", str(program)], cwd=tmp_path, stderr=subprocess.PIPE, text=True
    )
    deadline = time.monotonic() + 30
    while not list(tmp_path.glob(".p.ncq.*")) and time.monotonic() < deadline:
        time.sleep(0.01)
    process.send_signal(number)
    _, said = process.communicate(timeout=30)
    assert process.returncode == code
    assert "Traceback" not in said
    assert [path.name for path in tmp_path.iterdir()] == ["p.nc"]


def test_a_program_from_a_pipe_keeps_its_first_bytes(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.nc"
    os.mkfifo(pipe)
    process = subprocess.Popen(
        [*NCCOMPILE, "dump", "--format", "csv", str(pipe)], stdout=subprocess.PIPE, text=True
    )
    pipe.write_text("% pipe\nN10 G1 X7 F50\n")
    out, _ = process.communicate(timeout=60)
    assert process.returncode == 0
    assert "line,0.0,0.0,0.0,7.0,0.0,0.0" in out


def test_an_internal_error_is_one_line(tmp_path: Path) -> None:
    """A bug is reported in one line, and shows its traceback only when asked to."""
    program = _long_program(tmp_path / "p.nc", 1)
    code = (
        f"import sys; sys.argv = ['nccompile', 'compile', {str(program)!r}]\n"
        "import nccompile.toolchain as t\n"
        "def broken(*a, **k): raise ZeroDivisionError('planted')\n"
        "t.plan = t.decode = broken\n"
        "from nccompile.cli.main import main; main()"
    )
    for debug, tracebacks in (("", 0), ("1", 1)):
        done = subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True,
            text=True,
            check=False,
            env={**os.environ, "NCCOMPILE_DEBUG": debug},
        )
        assert done.returncode == 3
        assert done.stderr.count("Traceback") == tracebacks
        assert done.stderr.splitlines()[-1].startswith("internal error: ZeroDivisionError")
    assert [path.name for path in tmp_path.iterdir()] == ["p.nc"]
