"""What `nccompile import-dxf` writes: programs or queues, preview, report, and what it says meanwhile."""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer

from nccompile.backend.din66025 import ProgramFormat, program_text
from nccompile.backend.files import replacing
from nccompile.cli.inputs import machine_of
from nccompile.cli.options import ProgramOptions, Report
from nccompile.cli.outputs import require_picture, write_json
from nccompile.cli.report import report as show
from nccompile.diagnostics import Diagnostics, to_json
from nccompile.errors import UsageError
from nccompile.importers.dxf.convert import ConvertOptions, NamedProgram, Result, convert
from nccompile.importers.dxf.job import Job
from nccompile.importers.dxf.read import Drawing, ReadOptions, read_drawing
from nccompile.source import Source
from nccompile.toolchain import Compilation, Given

__all__ = ["Import", "run"]

LONG = 1_000_000
"""Size [bytes] of drawings that get a progress display."""

Say = Callable[[str], None]


@dataclass(frozen=True)
class Import:
    """Where everything goes: the drawing, folder and base name of the programs, preview, report, machine file."""

    drawing: Path
    folder: Path
    base: str
    preview: Path | None
    report: Path | None
    queue: bool
    machine: Path | None

    def place(self, program: NamedProgram) -> Path:
        """The file of a program."""
        return self.folder / (self.base + program.suffix + (".ncq" if self.queue else ".nc"))


def run(wanted: Import, job: Job, reading: ReadOptions, converting: ConvertOptions, form: Report) -> None:
    """Imports the drawing; no program is left behind if there are errors."""
    found = Diagnostics()
    if wanted.preview is not None:
        require_picture(wanted.preview)
    if not wanted.drawing.is_file():
        what = "is not a file" if wanted.drawing.exists() else "is not there"
        raise UsageError(f"{wanted.drawing} {what}")
    with _progress(wanted.drawing) as say:
        drawing = read_drawing(
            wanted.drawing, reading, found, lambda count: say(f"reading: {count} entities")
        )
        result = Result()
        if drawing is not None:
            say("joining and ordering")
            result = convert(drawing, job, converting, found, str(wanted.drawing))
            say("writing")
            wanted.folder.mkdir(parents=True, exist_ok=True)
            if not found.errors:
                _write_all(wanted, result, converting, found)
    if wanted.report is not None:
        _write_report(wanted, drawing, result, found)
    show(found, Source(str(wanted.drawing), ""), form)
    if drawing is None or found.errors:
        raise typer.Exit(1)
    for line in _summary(wanted, result):
        print(line)


@contextmanager
def _progress(drawing: Path) -> Iterator[Say]:
    """What is being done, on a terminal and for large drawings only."""
    if not sys.stderr.isatty() or drawing.stat().st_size < LONG:
        yield lambda text: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("opening", total=None)
        yield lambda text: bar.update(task, description=text)


def _write_all(wanted: Import, result: Result, converting: ConvertOptions, found: Diagnostics) -> None:
    for program in result.programs:
        if wanted.queue:
            _write_queue(wanted, program, found)
            continue
        form = ProgramFormat(
            name=wanted.base + program.suffix, decimals=converting.decimals, tolerance=converting.tolerance,
            head=program.head, notes=program.moves.notes,
        )  # fmt: skip
        with replacing(wanted.place(program)) as (file, commit):
            for line in program_text(program.moves.chunks(), form):
                file.write(line.encode())
            commit()
    if wanted.preview is not None and len(result.programs):
        _draw(wanted.preview, wanted, result)


def _write_queue(wanted: Import, program: NamedProgram, found: Diagnostics) -> None:
    """Plans the toolpath and writes it as an OutQueue; findings about the machine are the import's."""
    options = ProgramOptions().resolve(machine_of(wanted.machine))
    with wanted.drawing.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    path = Given(("X", "Y", "Z"), program.moves.chunks)  # as it is, cubics included
    compilation = Compilation(Source(str(wanted.drawing), "", digest), options, given=path)
    compilation.write(wanted.place(program))
    for diagnostic in compilation.diagnostics:
        found.add(diagnostic)


def _draw(place: Path, wanted: Import, result: Result) -> None:
    from nccompile.view.dxf_preview import save_preview

    chunks = [chunk for program in result.programs for chunk in program.moves.chunks()]
    starts = [complex(z) for paths in result.paths for z in paths.pieces.start[paths.first[:-1]]]
    title = f"{wanted.drawing.name}: {len(starts)} paths, rapids {result.rapids:.1f} mm"
    save_preview(place, chunks, starts, title)


def _summary(wanted: Import, result: Result) -> list[str]:
    """A line a program, at most twenty, and the rapids."""
    lines = []
    for program in result.programs[:20]:
        cut = sum(float(chunk.length[chunk.kind != 0].sum()) for chunk in program.moves.chunks())
        lines.append(f"{wanted.place(program)}: {program.moves.rows} segments, {cut:.3f} mm of feed moves")
    if len(result.programs) > 20:
        lines.append(f"and {len(result.programs) - 20} programs more")
    count = sum(len(paths) for paths in result.paths)
    lines.append(f"{count} path{'s' * (count != 1)}, {result.rapids:.3f} mm of rapids between them")
    return lines


def _write_report(wanted: Import, drawing: Drawing | None, result: Result, found: Diagnostics) -> None:
    """Everything found, as JSON: unlike on the screen, every gap and double is listed."""
    content: dict[str, Any] = {"drawing": str(wanted.drawing), "errors": found.errors}
    if drawing is not None:
        low, high = drawing.extents
        content |= {
            "version": drawing.version,
            "units": drawing.units,
            "extents": {"X": [low.real, high.real], "Y": [low.imag, high.imag]},
            "taken": dict(sorted(drawing.taken.items())),
            "left_out": [
                {"entity": kind, "reason": why, "count": n} for (kind, why), n in sorted(drawing.left.items())
            ],
            "hidden_layers": {name: {"why": why, "entities": n} for name, (why, n) in drawing.hidden.items()},
            "layers": {name: {"paths": n, "length": length} for name, (n, length) in result.layers.items()},
            "places": [
                {
                    "code": p.code,
                    "X": p.at.real,
                    "Y": p.at.imag,
                    "size": p.size,
                    "layer": drawing.layers[p.layer],
                }
                for p in result.places
            ],
            "programs": [str(wanted.place(program)) for program in result.programs],
            "rapids": result.rapids,
        }
    content["diagnostics"] = json.loads(to_json(found))
    assert wanted.report is not None
    write_json(wanted.report, content)
