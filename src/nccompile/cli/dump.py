"""`nccompile dump`: the segments of a toolpath, one a line."""

from __future__ import annotations

import csv
import json
import sys
from collections.abc import Iterable, Iterator
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nccompile.cli.options import DiagnosticsFormat, Input, MachineFile, ProgramOptions, Report, StageOptions
from nccompile.errors import UsageError

if TYPE_CHECKING:
    from nccompile.machine.model import Machine
    from nccompile.toolpath import Toolpath

__all__ = ["dump"]


class Form(StrEnum):
    """Output forms: the toolpath's text form, JSON objects by line, CSV."""

    TEXT = "text"
    JSONL = "jsonl"
    CSV = "csv"


class Stage(StrEnum):
    """After which stage: as decoded, behind the path passes, or with velocities."""

    DECODED = "decoded"
    PASSES = "passes"
    PLANNED = "planned"


def dump(
    path: Input,
    machine: MachineFile = None,
    form: Annotated[Form, typer.Option("--format", help="Form of the output.")] = Form.TEXT,
    stage: Annotated[
        Stage | None, typer.Option("--stage", help="Stage of a program; default: planned.")
    ] = None,
    diagnostics: DiagnosticsFormat = Report.TEXT,
    *,
    chosen: StageOptions,
) -> None:
    """Print the segments of an OutQueue or program."""
    from nccompile.cli.inputs import machine_of
    from nccompile.toolpath.text import format_toolpaths

    chunks = _chunks(path, machine_of(machine), chosen, stage, diagnostics)
    if form is Form.TEXT:
        sys.stdout.writelines(line + "\n" for line in format_toolpaths(chunks))
    elif form is Form.JSONL:
        _write_jsonl(chunks)
    else:
        _write_csv(chunks)


def _chunks(
    path: Path, machine: Machine, options: ProgramOptions, stage: Stage | None, form: Report
) -> Iterable[Toolpath]:
    from nccompile.cli.inputs import compiled, open_job
    from nccompile.cli.queues import is_queue
    from nccompile.toolchain import Compilation

    if stage not in (Stage.DECODED, Stage.PASSES):
        return open_job(path, machine, options, form).chunks()
    if is_queue(path):
        raise UsageError(f"{path} is an OutQueue: it holds the planned stage only")
    wanted = Compilation.decoded if stage is Stage.DECODED else Compilation.passed
    return compiled(path, machine, options, form, wanted)[1]


def _write_jsonl(chunks: Iterable[Toolpath]) -> None:
    from nccompile.toolpath.rows import rows

    for row in rows(chunks):
        sys.stdout.write(json.dumps(row, ensure_ascii=False) + "\n")


def _write_csv(chunks: Iterable[Toolpath]) -> None:
    """One line a segment: the plain columns; curves and events are in the other forms."""
    writer = csv.writer(sys.stdout, lineterminator="\n")
    for at, row in enumerate(_csv_rows(chunks)):
        if at == 0:
            writer.writerow(row)
        writer.writerow(row.values())


def _csv_rows(chunks: Iterable[Toolpath]) -> Iterator[dict[str, object]]:
    from nccompile.toolpath.rows import rows

    for row in rows(chunks):
        plain: dict[str, object] = {name: row[name] for name in ("index", "line", "kind")}
        for side in ("start", "end"):
            plain |= {f"{side}_{axis}": repr(value) for axis, value in row[side].items()}
        plain |= {name: repr(row[name]) for name in ("length", "feed")}
        plain |= {name: repr(row.get(name, 0.0)) for name in ("accel", "decel")}
        if "v_end" in row:
            plain["v_end"] = repr(row["v_end"])
        yield plain
