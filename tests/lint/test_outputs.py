"""Forms of the findings, the commands `lint` and `fmt`, and the generated pages."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest

from nccompile.diagnostics import render, to_json
from nccompile.lint.engine import Report
from nccompile.lint.output import FORMATS
from nccompile.lint.registry import RULES
from tests.cli.conftest import Command, command  # noqa: F401 - the fixture
from tests.lint.programs import ROOT, checked
from tools import rule_pages

TEXT = "% a\nn10 g1 x1 f20\nN10 G1 X2 F20 (100%, done: ä)\nN20 G1 X3,5\n"


@pytest.fixture
def report() -> Report:
    return checked(TEXT)


def test_text_is_rendered_as_compile_does(report: Report) -> None:
    expected = "".join(render(found, report.source) + "\n" for found in report.ordered())
    assert FORMATS["text"]([report]) == expected
    assert "N20 G1 X3,5\n  |          ^\n" in expected


def test_json_is_that_of_compile(report: Report) -> None:
    assert FORMATS["json"]([report]) == to_json(report.diagnostics) + "\n"


def test_github_commands_are_escaped(report: Report) -> None:
    lines = FORMATS["github"]([report]).splitlines()
    assert "::error file=a.nc,line=4,col=10,endColumn=10,title=NC001::" in "\n".join(lines)
    assert any(
        line.startswith("::notice file=a.nc,line=2,col=1,endColumn=13,title=NC054::") for line in lines
    )
    assert len(lines) == len(report.ordered())


def test_sarif_has_what_the_standard_requires(report: Report) -> None:
    """SARIF 2.1.0: §3.13 log, §3.14 run, §3.18 tool, §3.27 result, §3.30 region, §3.55 fix, §3.57 replacement."""
    log: dict[str, Any] = json.loads(FORMATS["sarif"]([report, checked("% b\nN10 G1 X1 F20")]))
    assert log["version"] == "2.1.0"
    (run,) = log["runs"]
    rules = run["tool"]["driver"]["rules"]
    assert run["tool"]["driver"]["name"] == "nccompile"
    assert run["columnKind"] == "unicodeCodePoints"
    assert len({rule["id"] for rule in rules}) == len(rules)
    for rule in rules:
        assert all(rule[key]["text"] for key in ("shortDescription", "fullDescription", "help"))
        assert rule["defaultConfiguration"]["level"] in {"error", "warning", "note"}
    assert len(run["results"]) == len(report.ordered())
    for result, found in zip(run["results"], report.ordered(), strict=True):
        assert rules[result["ruleIndex"]]["id"] == result["ruleId"] == found.code
        assert result["level"] in {"error", "warning", "note"}
        assert found.message in result["message"]["text"]
        (location,) = result["locations"]
        region = location["physicalLocation"]["region"]
        assert (region["startLine"], region["startColumn"], region["endColumn"]) == (
            found.span.line, found.span.column, found.span.end,
        )  # fmt: skip
        assert location["physicalLocation"]["artifactLocation"]["uri"] == "a.nc"
    fixes = [result["fixes"] for result in run["results"] if "fixes" in result]
    assert len(fixes) == len(report.fixes)
    replacement = fixes[0][0]["artifactChanges"][0]["replacements"][0]
    assert replacement == {
        "deletedRegion": {"startLine": 2, "startColumn": 1, "endColumn": 2}, "insertedContent": {"text": "N"},
    }  # fmt: skip


def test_lint_command(command: Command, tmp_path: Path) -> None:  # noqa: F811
    (tmp_path / "good.nc").write_text("% a\nN10 G0 X1\n")
    (tmp_path / "noted.nc").write_text("% a\nN10 G1 X1 F20\nN10 G1 X2 F20\n")
    (tmp_path / "wrong.nc").write_text("% a\nN10 G7\n")
    (tmp_path / "readme.txt").write_text("no program")
    assert command("lint", "good.nc") == (0, "", "")
    code, out, err = command("lint", "noted.nc")
    assert (code, err) == (0, "noted.nc: 0 errors, 1 warning, 1 note\n")
    assert "warning[NC052]" in out
    assert command("lint", "noted.nc", "--strict").code == 1
    assert command("lint", "noted.nc", "--strict", "--ignore", "NC052").code == 0
    assert command("lint", "noted.nc", "--select", "NC151").out.count("[NC") == 1
    everything = command("lint", tmp_path, "--format", "json")
    assert everything.code == 1
    assert [Path(row["file"]).name for row in json.loads(everything.out)] == [
        "noted.nc",
        "noted.nc",
        "wrong.nc",
    ]
    assert "       1  NC052  " in command("lint", "noted.nc", "--statistics").out


def test_a_file_without_a_block_reads_as_compile_says(command: Command, tmp_path: Path) -> None:  # noqa: F811
    for text in ("", "\n \n", "% a\n", "% größe\n(N10 G1 X5)\n/\n"):
        (tmp_path / "empty.nc").write_text(text)
        short, whole = command("lint", "empty.nc"), command("lint", "empty.nc", "--format", "json")
        assert short.code == whole.code == 1
        assert short.err == whole.err == "empty.nc: 1 error\n"
        assert short.out == command("compile", "empty.nc").err.replace(short.err, "")


def test_warnings_of_a_file_without_a_block_can_be_ignored(command: Command, tmp_path: Path) -> None:  # noqa: F811
    (tmp_path / "a.nc").write_text("% a\n%\n")
    assert "warning[NC008]" in command("lint", "a.nc").out
    assert "NC008" not in command("lint", "a.nc", "--ignore", "NC008").out


def test_lint_command_fixes_files_and_streams(command: Command, tmp_path: Path) -> None:  # noqa: F811
    path = tmp_path / "a.nc"
    path.write_bytes(b"% \xe4\r\nn10 g1 x1 f20\r\n")
    code, out, err = command("lint", "--fix", path)
    assert (code, path.read_bytes()) == (0, b"% \xe4\r\nN10 G1 X1 F20\r\n")
    assert "1 finding fixed" in err
    assert "NC056" in out
    code, out, err = command("lint", "--fix", "-", stdin=b"% a\nn10 g1 x1 f20\nN20 G7\n")
    assert code == 1
    assert out == "% a\nN10 G1 X1 F20\nN20 G7\n"
    assert "error[NC102]" in err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("lint", "missing.nc"), "missing.nc cannot be read"),
        (("lint", "queue.nc"), "queue.nc is an OutQueue"),
        (("lint", "-", "--select", "E501"), "--select: there is no code E501"),
        (("lint", "missing.nc", "--ignore", "NC05,NC999"), "--ignore: there is no code NC999"),
        (("lint", "/dev/zero"), "/dev/zero is a device"),
        (("lint", "--fix", "pipe.nc"), "pipe.nc is no file that could be changed"),
        (("lint", "-", "--limit", "-1"), "--limit"),
        (("lint",), "Missing argument"),
        (("fmt", "missing.nc"), "missing.nc cannot be read"),
        (("fmt", "/dev/zero"), "/dev/zero is no file that could be changed"),
        (("fmt", "binary.nc"), "binary.nc is not a text file"),
        (("fmt", "pipe.nc"), "pipe.nc is no file that could be changed"),
    ],
)
def test_wrong_use_is_refused(
    command: Command,  # noqa: F811
    tmp_path: Path,
    arguments: tuple[str, ...],
    message: str,
) -> None:
    (tmp_path / "queue.nc").write_bytes(b"PK\x03\x04")
    (tmp_path / "binary.nc").write_bytes(b"% a\nn10 g1 x1\n\x01")
    os.mkfifo(tmp_path / "pipe.nc")
    code, out, err = command(*arguments)
    assert (code, out) == (2, "")
    assert message in err


def test_folders_and_names_given_twice(command: Command, tmp_path: Path) -> None:  # noqa: F811
    (tmp_path / "a.nc").write_text("% a\nN10 G7\n")
    (tmp_path / "empty").mkdir()
    assert command("lint", "a.nc", "./a.nc", tmp_path / "empty").out.count("error[NC102]") == 1
    assert command("lint", "empty") == (0, "", "empty: no programs (.cnc .din .iso .nc) in this folder\n")
    assert command("lint", "-", "-", stdin=b"% a\nN10 G7\n").out.count("error[NC102]") == 1


@pytest.mark.parametrize("text", ["[lint]\nselct = []\n", "[lint\n", "\xff", "[lint]\nignore = ['E1']\n"])
@pytest.mark.parametrize("program", ["", "% a\nN10 G1 X1 F20\n"])
def test_wrong_settings_end_both_commands(
    command: Command,  # noqa: F811
    tmp_path: Path,
    text: str,
    program: str,
) -> None:
    (tmp_path / "nccompile.toml").write_text(text, encoding="latin-1")
    (tmp_path / "a.nc").write_text(program)
    for name in ("lint", "fmt"):
        code, out, err = command(name, "a.nc")
        assert (code, out) == (2, "")
        assert "nccompile.toml: " in err
        assert len(err.splitlines()) == 1


def test_fmt_command(command: Command, tmp_path: Path) -> None:  # noqa: F811
    path = tmp_path / "a.nc"
    path.write_text("% a\nn5 g1 x1 f20\n")
    assert command("fmt", path, "--check").code == 1
    assert path.read_text() == "% a\nn5 g1 x1 f20\n"
    assert command("fmt", path).code == 0
    assert path.read_text() == "% a\nN5 G1 X1 F20\n"
    assert command("fmt", path, "--check") == (0, "", "")
    (tmp_path / "nccompile.toml").write_text("[format]\nstep = 3\n")
    assert command("fmt", path, "--renumber").code == 0
    assert path.read_text() == "% a\nN3 G1 X1 F20\n"
    assert command("fmt", "-", "--renumber", "--step", "7", stdin=b"g1 x1").out == "N7 G1 X1\n"


def test_explain_prints_the_pages_of_rules(command: Command) -> None:  # noqa: F811
    out = command("explain", "nc151").out
    assert out.startswith("NC151: A feed that holds already\n")
    assert "    N20 G1 X2 F20\n" in out


def test_generated_pages_are_current() -> None:
    """If this fails run `make docs`."""
    assert rule_pages.MODULE.read_text(encoding="utf-8") == rule_pages.module_text()
    wanted = rule_pages.documents()
    there = {path.name: path.read_text(encoding="utf-8") for path in rule_pages.FOLDER.glob("*.md")}
    assert sorted(there) == sorted(wanted)
    assert there == wanted


def test_every_rule_is_in_a_file_of_its_own() -> None:
    files = {path.stem for path in (ROOT / "src/nccompile/lint/rules").glob("*.py")} - {"__init__"}
    assert files == {rule.name.replace("-", "_") for rule in RULES}
