"""The command line in this process: the same code as the `nccompile` command, without its start-up."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, TypeAlias

import pytest

from nccompile.cli.app import run

SAMPLES = Path(__file__).parents[2] / "samples"


class Result(NamedTuple):
    """What a command left behind."""

    code: int
    out: str
    err: str


Command: TypeAlias = Callable[..., Result]


@pytest.fixture
def command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Command:
    """Runs `nccompile` with arguments in an empty folder; `stdin` is what it reads there."""
    monkeypatch.chdir(tmp_path)

    def invoke(*arguments: str | Path, stdin: bytes = b"") -> Result:
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(stdin)))
        code = run([str(a) for a in arguments])
        captured = capsys.readouterr()
        return Result(code, captured.out, captured.err)

    return invoke


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """A program with a rapid, a line with a switch, an arc and an M function."""
    path = tmp_path / "part.nc"
    path.write_text(
        "% part\nN10 G0 X10\nN20 G1 X20 F50 E500 E-500 H2 O0.5\nN30 G3 X20 Y20 R10\nN40 M8\nN50 G1 X0\n"
    )
    return path


@pytest.fixture
def queue(command: Command, program: Path) -> Path:
    """That program as an OutQueue."""
    assert command("compile", program).code == 0
    return program.with_suffix(".ncq")
