"""Path passes on the command line: -p, --print-after, --time-passes, --report, dump and plot."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from nccompile.backend import ncq
from nccompile.cli.app import run
from nccompile.toolpath import Toolpath

PROGRAM = (
    "% t\nN1 G0 X10 F50 E500 E-500 D1\nN2 G42\nN3 G1 X20\nN4 G1 Y10\nN5 G1 X10\nN6 G1 Y0\nN7 G40\nN8 G0 X0\n"
)


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "t.nc"
    path.write_text(PROGRAM)
    return path


def test_g41_without_its_pass_is_told_how_to_turn_it_on(
    program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["compile", str(program)]) == 0
    assert "turn it on with -p tool-radius" in capsys.readouterr().err
    assert run(["compile", str(program), "-p", "tool-radius", "--verify"]) == 0
    assert "NC301" not in capsys.readouterr().err
    path = Toolpath.join(list(ncq.read(program.with_suffix(".ncq")).chunks()))
    assert path.target[:, 1].max() == pytest.approx(11.0)


def test_times_reports_and_prints(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    report = program.with_name("r.json")
    passes = "tool-radius{corner=line},fit-arcs"
    options = ["--report", str(report), "--time-passes", "--print-after", "tool-radius"]
    assert run(["compile", str(program), "-p", passes, *options]) == 0
    said = capsys.readouterr().err
    assert "line 21.0 -1.0 0.0" in said
    first, second = json.loads(report.read_text())["passes"]
    assert (first["name"], first["segments_in"]) == ("tool-radius", 6)
    assert first["segments_out"] == second["segments_in"] > 6
    assert f"6 -> {first['segments_out']} segments" in said
    assert second["deviation"] <= 0.005


def test_a_gouge_is_an_error_and_leaves_no_queue(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program.write_text(PROGRAM.replace("G42", "G41"))
    assert run(["compile", str(program), "-p", "tool-radius{radius=6}"]) == 1
    assert "error[NC302]: the tool would cut" in capsys.readouterr().err
    assert not program.with_suffix(".ncq").exists()


def test_mistakes_in_the_specification(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["compile", str(program), "-p", "tol-radius"]) == 2
    assert "did you mean tool-radius" in capsys.readouterr().err
    assert run(["compile", str(program), "-p", "split{segment=99}"]) == 2
    assert not program.with_suffix(".ncq").exists()
    assert run(["compile", str(program), "-p", "fit-arcs", "--print-after", "flatten"]) == 2


def test_correction_and_smoothing_on_one_stretch_leave_no_queue(
    program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program.write_text(PROGRAM.replace("N4 G1 Y10", "N4 G51\nN5 G1 Y10"))
    assert run(["compile", str(program), "-p", "tool-radius,smooth-corners"]) == 1
    said = capsys.readouterr().err
    assert "error[NC304]: tool-radius and smooth-corners both act from here on" in said
    assert "N5 G1 Y10" in said
    assert not program.with_suffix(".ncq").exists()
    assert run(["compile", str(program), "-p", "tool-radius"]) == 0


def test_a_matrix_may_have_blanks_and_semicolons(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    spec = "transform{matrix=0 -1 0; 1 0 0; 0 0 1}"
    assert run(["dump", str(program), "--stage", "passes", "-p", spec]) == 0
    assert "line 0.0 20.0 0.0" in capsys.readouterr().out.replace("-0.0", "0.0")


def test_dump_and_plot_show_the_passes(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["dump", str(program), "--stage", "passes", "-p", "tool-radius"]) == 0
    assert "arc 21.0 0.0 0.0" in capsys.readouterr().out
    for name, passes in (("a.svg", []), ("b.svg", ["-p", "tool-radius"])):
        assert run(["plot", str(program), "-o", str(program.with_name(name)), *passes]) == 0
    assert program.with_name("a.svg").read_bytes() != program.with_name("b.svg").read_bytes()
