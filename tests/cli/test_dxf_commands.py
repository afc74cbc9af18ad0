"""`import-dxf` and `export-dxf` as a user runs them."""

from __future__ import annotations

import io
import json
import sys
from pathlib import Path

import pytest
from ezdxf.entities.lwpolyline import LWPolyline
from ezdxf.filemanagement import readfile

from nccompile.cli import dxf_output
from tests.cli.conftest import SAMPLES, Command
from tests.importers.workshop import new_drawing


@pytest.fixture
def part(tmp_path: Path) -> Path:
    """A drawing of two layers: a plate with a hole, and a stray line."""
    doc = new_drawing()
    doc.modelspace().add_lwpolyline(
        [(0, 0), (60, 0), (60, 40), (0, 40)], close=True, dxfattribs={"layer": "CUT"}
    )
    doc.modelspace().add_circle((30, 20), 8, {"layer": "CUT"})
    doc.modelspace().add_line((5, 5), (20, 10), {"layer": "ENGRAVE ü"})
    doc.saveas(tmp_path / "part.dxf")
    return tmp_path / "part.dxf"


def test_a_drawing_becomes_a_program_without_options(command: Command, part: Path) -> None:
    result = command("import-dxf", part)

    text = part.with_suffix(".nc").read_text()
    assert result.code == 0
    assert not result.err
    assert "3 paths" in result.out
    assert text.splitlines()[:3] == [
        "% part",
        "(from part.dxf, DXF R2010, drawn in mm; written in mm, mm/s)",
        "(drawing X0.0000 to 60.0000, Y0.0000 to 40.0000 mm)",
    ]
    assert "(layer CUT: 2 paths, 250.265 mm)" in text
    assert text.index(" I") < text.index("X60")  # the hole before the plate
    assert command("compile", part.with_suffix(".nc")).err == ""


@pytest.mark.parametrize(
    ("split", "names"),
    [
        ("whole", ["base.nc"]),
        ("layers", ["base_CUT.nc", "base_ENGRAVE_ü.nc"]),
        ("segments", ["base_0001.nc", "base_0002.nc", "base_0003.nc"]),
    ],
)
def test_one_program_a_file_a_layer_or_a_path(
    split: str, names: list[str], command: Command, part: Path, tmp_path: Path
) -> None:
    result = command("import-dxf", part, "-o", tmp_path / "out", "--split", split, "--name", "base")

    assert result.code == 0
    assert sorted(place.name for place in (tmp_path / "out").iterdir()) == names
    for name in names:
        assert command("compile", tmp_path / "out" / name).code == 0


@pytest.mark.parametrize(
    "arguments",
    [[], ["--split", "layers"], ["--split", "segments"], ["--job", SAMPLES / "plate.job.toml"]],
    ids=["default", "layers", "segments", "job"],
)
def test_lint_finds_nothing_in_programs_of_a_sound_drawing(
    arguments: list[str | Path], command: Command, tmp_path: Path
) -> None:
    assert command("import-dxf", SAMPLES / "plate.dxf", "-o", tmp_path / "out", *arguments).code == 0

    assert command("lint", tmp_path / "out") == (0, "", "")


def test_a_queue_keeps_cubics(command: Command, tmp_path: Path) -> None:
    doc = new_drawing()
    doc.modelspace().add_open_spline([(0, 0), (10, 20), (20, -20), (30, 0)])
    doc.saveas(tmp_path / "curve.dxf")

    assert command("import-dxf", tmp_path / "curve.dxf", "--queue").code == 0
    dump = command("dump", tmp_path / "curve.ncq", "--format", "jsonl")

    kinds = [json.loads(line)["kind"] for line in dump.out.splitlines()]
    assert kinds == ["polynomial", "positioning"]  # the curve, and back to the origin


def test_travel_of_the_machine_is_checked_for_queues(command: Command, tmp_path: Path) -> None:
    doc = new_drawing()
    doc.modelspace().add_line((0, 0), (9000, 0))
    doc.saveas(tmp_path / "long.dxf")

    result = command("import-dxf", tmp_path / "long.dxf", "--queue", "-m", SAMPLES / "mill3.toml")

    assert result.code == 1
    assert "NC402" in result.err
    assert not (tmp_path / "long.ncq").exists()


def test_report_and_preview(command: Command, part: Path, tmp_path: Path) -> None:
    result = command(
        "import-dxf",
        part,
        "--report",
        tmp_path / "r.json",
        "--preview",
        tmp_path / "p.png",
        "--origin",
        "10,5",
    )

    report = json.loads((tmp_path / "r.json").read_text())
    assert result.code == 0
    assert report["layers"] == {"CUT": {"paths": 2, "length": pytest.approx(250.265, abs=1e-3)},
                                "ENGRAVE ü": {"paths": 1, "length": pytest.approx(15.811, abs=1e-3)}}  # fmt: skip
    assert report["taken"] == {"CIRCLE": 1, "LINE": 1, "LWPOLYLINE": 1}
    assert (tmp_path / "p.png").read_bytes()[:4] == b"\x89PNG"


class Terminal(io.StringIO):
    """Standard error that is a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(("long", "shown"), [(0, True), (1_000_000, False)])
def test_long_imports_show_their_progress(
    long: int, shown: bool, command: Command, part: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    terminal = Terminal()
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr(dxf_output, "LONG", long)

    result = command("import-dxf", part)

    assert result.code == 0
    assert ("writing" in terminal.getvalue()) == shown


def test_a_broken_drawing_leaves_no_program(command: Command, tmp_path: Path) -> None:
    (tmp_path / "bad.dxf").write_bytes(b"nonsense")

    result = command("import-dxf", tmp_path / "bad.dxf")

    assert result.code == 1
    assert "NC601" in result.err
    assert [place.name for place in tmp_path.iterdir()] == ["bad.dxf"]


@pytest.mark.parametrize(
    "arguments",
    [
        ["missing.dxf"],
        ["part.dxf", "--origin", "here"],
        ["part.dxf", "--start", "1"],
        ["part.dxf", "--name", "a/b"],
        ["part.dxf", "--job", "missing.toml"],
        ["part.dxf", "-m", "mill.toml"],
        ["part.dxf", "--preview", "p.gif"],
        ["part.dxf", "--units", "furlong"],
    ],
)
def test_wrong_usage_is_one_line_and_exit_code_2(arguments: list[str], command: Command, part: Path) -> None:
    result = command("import-dxf", *arguments)

    assert result.code == 2
    assert "Traceback" not in result.err
    assert not part.with_suffix(".nc").exists()


def test_a_program_exported_and_imported_again(command: Command, part: Path, tmp_path: Path) -> None:
    assert command("import-dxf", part).code == 0

    exported = command("export-dxf", part.with_suffix(".nc"), "-o", tmp_path / "again.dxf")
    imported = command("import-dxf", tmp_path / "again.dxf")

    blocks = [
        [line for line in (tmp_path / name).read_text().splitlines() if line.startswith("N")]
        for name in ("part.nc", "again.nc")
    ]
    assert exported.code == imported.code == 0
    assert blocks[0] == blocks[1]


def test_the_path_before_and_behind_the_passes(command: Command, tmp_path: Path) -> None:
    (tmp_path / "p.nc").write_text(
        "% p\nN10 G0 X-10 Y0\nN20 G41 D2\nN30 G1 X0 F20\nN40 G1 X30\nN50 G1 Y30\nN60 G40\nN70 G1 Y40\n"
    )

    result = command("export-dxf", tmp_path / "p.nc", "-p", "tool-radius")

    space = readfile(str(tmp_path / "p.dxf")).modelspace()
    layers = {entity.dxf.layer for entity in space}
    behind = space.query('LWPOLYLINE[layer=="NC_FEED_PASSES"]')
    points = [
        point for entity in behind if isinstance(entity, LWPolyline) for point in entity.get_points("xy")
    ]
    assert result.code == 0
    assert {"NC_FEED", "NC_FEED_PASSES"} <= layers
    assert any(abs(x - 28) < 1e-6 for x, _ in points)


def test_queues_are_exported_too(command: Command, part: Path, tmp_path: Path) -> None:
    assert command("import-dxf", part, "--queue").code == 0

    result = command("export-dxf", part.with_suffix(".ncq"), "-o", tmp_path / "q.dxf")

    assert result.code == 0
    assert (tmp_path / "q.dxf").exists()
