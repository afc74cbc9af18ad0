"""Every subcommand on sound input: data on stdout, exit code 0."""

from __future__ import annotations

import csv
import io
import json
import re
from pathlib import Path

import numpy as np
import pytest

from nccompile.backend import ncq
from nccompile.codes import PAGES
from nccompile.toolpath import Toolpath
from tests.cli.conftest import SAMPLES, Command


def test_compile_writes_a_queue_beside_the_program(command: Command, program: Path) -> None:
    result = command("compile", program, "--verify")
    queue = ncq.read(program.with_suffix(".ncq")).check()
    assert (result.code, result.err) == (0, "")
    assert result.out.startswith(f"{program.with_suffix('.ncq')}: 5 segments")
    assert queue.meta.provenance.source == "part.nc"
    assert queue.total.m_functions == (8,)


def test_compile_reads_standard_input(command: Command, program: Path, tmp_path: Path) -> None:
    command("compile", program, "-o", "file.ncq")
    result = command("compile", "-", "-o", "stdin.ncq", stdin=program.read_bytes())
    assert result.code == 0
    assert ncq.read(tmp_path / "stdin.ncq").total == ncq.read(tmp_path / "file.ncq").total


def test_equal_programs_give_equal_bytes(command: Command, program: Path, tmp_path: Path) -> None:
    command("compile", program, "-o", "one.ncq")
    command("compile", program, "-o", "two.ncq")
    assert (tmp_path / "one.ncq").read_bytes() == (tmp_path / "two.ncq").read_bytes()


def test_compile_options(command: Command, tmp_path: Path) -> None:
    source = tmp_path / "p.nc"
    source.write_text("% p\nN10 G1 X$width$ F10\n/N20 G1 Y5\nN30 G1 X100\n")
    options = ["--define", "width=30", "--start", "X-5,Y1.5", "--skip-blocks", "--time-law", "sigmoid"]
    assert command("compile", source, *options, "--angle-tolerance", "12").code == 0
    queue = ncq.read(tmp_path / "p.ncq").check()
    chunk = Toolpath.join(list(queue.chunks()))
    assert queue.meta.start == (-5.0, 1.5, 0.0)
    assert chunk.target[:, 0].tolist() == [30.0, 100.0]
    assert queue.meta.provenance.time_law == "sigmoid"
    assert queue.meta.provenance.angle_tolerance == 12.0


def test_compile_report(command: Command, program: Path, tmp_path: Path) -> None:
    assert command("compile", program, "--report", "report.json").code == 0
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["errors"] == 0
    assert report["queue"]["totals"]["segments"] == 5


def test_diagnostics_as_json(command: Command, tmp_path: Path) -> None:
    (tmp_path / "bad.nc").write_text("% bad\nN10 G1 X1.2.3\n")
    result = command("compile", "bad.nc", "--diagnostics", "json")
    (found,) = json.loads(result.err)
    assert result.code == 1
    assert (found["severity"], found["line"], found["file"]) == ("error", 2, "bad.nc")


def test_info(command: Command, queue: Path) -> None:
    text = command("info", queue)
    content = json.loads(command("info", queue, "--json").out)
    assert "M functions  M8" in text.out
    assert content["totals"]["switches"] == 1
    assert content["source"]["name"] == "part.nc"


@pytest.mark.parametrize("form", ["text", "jsonl", "csv"])
def test_dump_of_a_program_is_that_of_its_queue(
    command: Command, program: Path, queue: Path, form: str
) -> None:
    of_queue = command("dump", queue, "--format", form)
    assert of_queue.code == 0
    assert command("dump", program, "--format", form).out == of_queue.out


def test_dump_stages(command: Command, program: Path) -> None:
    decoded = [
        json.loads(line)
        for line in _lines(command("dump", program, "--format", "jsonl", "--stage", "decoded").out)
    ]
    planned = [json.loads(line) for line in _lines(command("dump", program, "--format", "jsonl").out)]
    assert [row["kind"] for row in decoded] == ["positioning", "line", "arc", "m_function", "line"]
    assert "v_end" not in decoded[0]
    assert [row["end"] for row in planned] == [row["end"] for row in decoded]
    assert all("v_end" in row for row in planned)


def test_dump_as_csv(command: Command, program: Path) -> None:
    rows = list(csv.DictReader(io.StringIO(command("dump", program, "--format", "csv").out)))
    assert [float(row["end_X"]) for row in rows] == [10.0, 20.0, 20.0, 20.0, 0.0]
    assert [row["kind"] for row in rows][:2] == ["positioning", "line"]


def _lines(text: str) -> list[str]:
    return text.splitlines()


def test_sample_goes_to_stdout_or_into_a_file(command: Command, queue: Path, tmp_path: Path) -> None:
    text = command("sample", queue, "--cycle-us", "2000").out
    command("sample", queue, "--cycle-us", "2000", "-o", "s.csv")
    command("sample", queue, "--cycle-us", "2000", "-o", "s.npz")
    assert (tmp_path / "s.csv").read_text() == text
    rows = list(csv.DictReader(io.StringIO(text)))
    with np.load(tmp_path / "s.npz") as table:
        assert [float(row["X"]) for row in rows] == table["X"].tolist()
        assert [int(row["line"]) for row in rows] == table["line"].tolist()
    assert float(rows[-1]["X"]) == 0.0


def test_run_sets_the_positions_of_sample(command: Command, queue: Path, tmp_path: Path) -> None:
    assert command("run", queue, "--trace", "t.npz").code == 0
    command("sample", queue, "-o", "s.npz")
    with np.load(tmp_path / "t.npz") as trace, np.load(tmp_path / "s.npz") as samples:
        for axis in "XYZ":
            assert np.array_equal(trace[f"set_{axis}"], samples[axis])


def test_run_reports_on_one_screen(command: Command, program: Path, tmp_path: Path) -> None:
    result = command("run", program, "--report", "run.json", "--m-delay", "0.25", "--override", "2")
    report = json.loads((tmp_path / "run.json").read_text())
    assert (result.code, result.err) == (0, "")
    assert len(result.out.splitlines()) < 25
    assert "finished" in result.out
    assert "M8 at" in result.out
    assert report["m_functions"][0]["waited"] == pytest.approx(0.25, abs=0.0021)
    assert report["end_position"] == {"X": 0.0, "Y": 20.0, "Z": 0.0}


def test_run_with_commands_at_times(command: Command, program: Path) -> None:
    result = command("run", program, "--at", "0.1 abort=on")
    assert result.code == 0
    assert "aborted after 0.1" in result.out


def test_an_m_function_nobody_acknowledges_ends_the_run(command: Command, program: Path) -> None:
    result = command("run", program, "--m-delay", "never")
    assert result.code == 1
    assert "NC706" in result.err


def test_run_in_another_cycle(command: Command, queue: Path) -> None:
    assert "cycles of 4000 us" in command("run", queue, "--cycle-us", "4000").out


def test_run_says_when_the_machine_is_another_one(command: Command, queue: Path) -> None:
    result = command("run", queue, "-m", SAMPLES / "mill3.toml")
    assert result.code == 0
    assert "planned for generic" in result.err


def test_run_in_real_time(command: Command, tmp_path: Path) -> None:
    (tmp_path / "short.nc").write_text("% short\nN10 G1 X2 F40 E2000 E-2000\n")
    result = command("run", "short.nc", "--realtime", "--cycle-us", "5000")
    assert result.code == 0
    assert "jitter: mean" in result.out


@pytest.mark.parametrize("suffix", ["png", "svg", "pdf"])
def test_plot(command: Command, queue: Path, tmp_path: Path, suffix: str) -> None:
    result = command("plot", queue, "-o", f"part.{suffix}")
    start = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}[suffix]
    assert result.code == 0
    assert (tmp_path / f"part.{suffix}").read_bytes().startswith(start)


def test_explain(command: Command) -> None:
    code = next(iter(PAGES))
    assert command("explain", code.lower()).out.startswith(f"{code}: ")
    assert len(command("explain").out.splitlines()) == len(PAGES)


def test_machine_check(command: Command) -> None:
    result = command("machine", "check", SAMPLES / "mill3.toml")
    assert result.code == 0
    assert "mill3, 3 axes" in result.out


@pytest.mark.parametrize("arguments", [["--help"], ["compile", "--help"], ["machine", "check", "--help"]])
def test_help(command: Command, arguments: list[str]) -> None:
    assert command(*arguments).code == 0


@pytest.mark.parametrize("name", ["dump", "plot", "run", "sample"])
def test_commands_share_the_options_of_programs(command: Command, name: str) -> None:
    def options(of: str) -> set[str]:
        return set(re.findall(r"--[a-z-]+", command(of, "--help").out))

    alone = {"--output", "--report", "--print-after", "--time-passes", "--verify"}
    assert options("compile") - alone <= options(name)


def test_a_program_from_a_pipe_is_read_once(command: Command, program: Path, tmp_path: Path) -> None:
    """Drawings of both stages need the program twice."""
    text = program.read_bytes()
    result = command("export-dxf", "-", "-o", "a.dxf", "-p", "fit-arcs", stdin=text)
    assert result.code == 0
    assert command("export-dxf", program, "-o", "b.dxf", "-p", "fit-arcs").out[6:] == result.out[6:]
    assert command("plot", "-", "-o", "a.png", "-p", "fit-arcs", stdin=text).code == 0
