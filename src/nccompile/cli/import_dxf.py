"""`nccompile import-dxf`: a drawing becomes part programs or queues (SoftMotion §3.3, "Import DXF file")."""

from __future__ import annotations

import sys
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nccompile.cli.options import DiagnosticsFormat, MachineFile, Report
from nccompile.errors import UsageError

if TYPE_CHECKING:
    from nccompile.importers.dxf.job import Job

__all__ = ["import_dxf"]


class Split(StrEnum):
    """What becomes a program of its own."""

    WHOLE = "whole"
    LAYERS = "layers"
    SEGMENTS = "segments"


class Units(StrEnum):
    """Units of drawings."""

    MM = "mm"
    CM = "cm"
    M = "m"
    UM = "um"
    INCH = "inch"
    FT = "ft"


def import_dxf(
    file: Annotated[Path, typer.Argument(metavar="FILE.dxf", help="The drawing.")],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="DIR", help="Folder of the programs; default: the drawing's."),
    ] = None,
    split: Annotated[
        Split, typer.Option("--split", help="One program, one a layer, or one a path.")
    ] = Split.WHOLE,
    name: Annotated[str | None, typer.Option("--name", help="Base name; default: the drawing's.")] = None,
    job: Annotated[
        Path | None,
        typer.Option("--job", "-j", metavar="FILE.toml", help="Machining data by layer or colour."),
    ] = None,
    units: Annotated[
        Units | None, typer.Option("--units", help="The drawing's unit, whatever it says.")
    ] = None,
    gap: Annotated[float, typer.Option("--gap", min=0.0, max=10.0, help="Gaps closed at most [mm].")] = 0.01,
    tolerance: Annotated[
        float, typer.Option("--tolerance", min=1e-5, max=1.0, help="Deviation of splines [mm].")
    ] = 0.005,
    decimals: Annotated[int, typer.Option("--decimals", min=2, max=6, help="Decimals of coordinates.")] = 4,
    layer: Annotated[
        list[str] | None, typer.Option("--layer", metavar="PATTERN", help="Only these layers; repeatable.")
    ] = None,
    text: Annotated[bool, typer.Option("--text", help="Engrave texts as outlines.")] = False,
    hatch: Annotated[bool, typer.Option("--hatch", help="Machine boundaries of hatches.")] = False,
    origin: Annotated[
        str, typer.Option("--origin", metavar="drawing|lower-left|X,Y", help="What becomes X0 Y0.")
    ] = "drawing",
    start: Annotated[
        str | None,
        typer.Option("--start", metavar="nearest|corner|longest|X,Y", help="Where contours begin."),
    ] = None,
    feed: Annotated[
        float | None, typer.Option("--feed", min=1e-3, help="Feed without a job file [mm/s]; default: 20.")
    ] = None,
    seed: Annotated[int, typer.Option("--seed", min=0, help="Of the search for short rapids.")] = 0,
    queue: Annotated[bool, typer.Option("--queue", help="Write OutQueues instead of programs.")] = False,
    machine: MachineFile = None,
    preview: Annotated[
        Path | None,
        typer.Option("--preview", metavar="FILE.png", help="Picture with order numbers and rapids."),
    ] = None,
    report: Annotated[
        Path | None, typer.Option("--report", metavar="FILE.json", help="Everything found, as JSON.")
    ] = None,
    diagnostics: DiagnosticsFormat = Report.TEXT,
) -> None:
    """Turn a DXF drawing into part programs, or with --queue into OutQueues."""
    from nccompile.cli.dxf_output import Import, run
    from nccompile.importers.dxf.convert import ConvertOptions
    from nccompile.importers.dxf.read import ReadOptions

    if machine is not None and not queue:
        raise UsageError("--machine goes with --queue: programs are written for any machine")
    reading = ReadOptions(
        units=units or "", tolerance=tolerance / 2, texts=text, hatches=hatch, layers=tuple(layer or ()),
        ask_units=_ask_units if sys.stdin.isatty() and sys.stderr.isatty() else None,
    )  # fmt: skip
    converting = ConvertOptions(
        split.value, gap, tolerance / 2, decimals, _origin(origin), cubics=queue, seed=seed
    )
    wanted = Import(file, output or file.parent, _base(name or file.stem), preview, report, queue, machine)
    run(wanted, _job(job, feed, start), reading, converting, diagnostics)


def _base(name: str) -> str:
    if Path(name).name != name or name in {"", ".", ".."}:
        raise UsageError(f"--name {name!r} must be a file name without folders")
    return name


def _origin(text: str) -> str | tuple[float, float]:
    if text in {"drawing", "lower-left"}:
        return text
    return _pair("--origin", text, "drawing, lower-left or X,Y")


def _pair(option: str, text: str, expected: str) -> tuple[float, float]:
    parts = text.split(",")
    try:
        x, y = (float(part) for part in parts)
    except ValueError:
        raise UsageError(f"{option} {text}: expected {expected}") from None
    if not max(abs(x), abs(y)) <= 1e9:
        raise UsageError(f"{option} {text}: expected {expected}")
    return x, y


def _job(path: Path | None, feed: float | None, start: str | None) -> Job:
    """The job of a file, or the default one: flat paths at Z0."""
    from nccompile.importers.dxf.job import Job, Operation, load_job

    if path is not None:
        if feed is not None or start is not None:
            raise UsageError("--feed and --start go without --job: the operations of the job file say both")
        return load_job(path)
    settings: dict[str, object] = {} if feed is None else {"feed": feed}
    if start is not None:
        named = start in {"nearest", "corner", "longest"}
        settings["start"] = start if named else _pair("--start", start, "nearest, corner, longest or X,Y")
    return Job(operation=(Operation.model_validate(settings),))


def _ask_units(width: float, height: float) -> str:
    """The user's answer to the question what a drawing without a unit was drawn in."""
    size = f"{width:.5g} by {height:.5g}"
    answer = ""
    while answer not in list(Units):
        answer = typer.prompt(
            f"The drawing names no unit and is {size} units large. Units", default="mm", err=True
        )
    return answer
