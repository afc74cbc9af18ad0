"""From a drawing in memory, or rows of pieces, to a program and its toolpath, as the command does it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import ezdxf.filemanagement
import numpy as np

from nccompile.backend.din66025 import ProgramFormat, program_text
from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostics
from nccompile.importers.dxf.convert import ConvertOptions, Result, convert
from nccompile.importers.dxf.job import Job
from nccompile.importers.dxf.pieces import Pieces, Row
from nccompile.importers.dxf.read import Drawing, ReadOptions, read_drawing
from nccompile.source import Source
from nccompile.toolpath import Toolpath
from nccompile.toolpath.verify import verify

TOLERANCE = 0.005


class Made(NamedTuple):
    """What came of a drawing; `text` of the first program."""

    drawing: Drawing | None
    result: Result
    text: str
    found: Diagnostics


def new_drawing(version: str = "R2010", units: int = 4) -> Any:
    """An empty ezdxf drawing."""
    doc: Any = ezdxf.filemanagement.new(version)
    if version != "R12":
        doc.header["$INSUNITS"] = units
    return doc


def machine(
    doc: Any, folder: Path, job: Job | None = None, reading: ReadOptions | None = None, **converting: Any
) -> Made:
    """Saves a drawing and imports it."""
    place = folder / "drawing.dxf"
    doc.saveas(place)
    return machine_file(place, job, reading, **converting)


def machine_file(
    place: Path, job: Job | None = None, reading: ReadOptions | None = None, **converting: Any
) -> Made:
    """Imports a drawing with half the tolerance in either step, as the command does."""
    found = Diagnostics()
    drawing = read_drawing(place, reading or ReadOptions(tolerance=TOLERANCE / 2), found)
    if drawing is None:
        return Made(None, Result(), "", found)
    options = ConvertOptions(tolerance=TOLERANCE / 2, **converting)
    result = convert(drawing, job or Job(), options, found, "drawing.dxf")
    return Made(drawing, result, text_of(result, 0) if result.programs else "", found)


def text_of(result: Result, number: int) -> str:
    """The text of one of the programs."""
    program = result.programs[number]
    form = ProgramFormat(tolerance=TOLERANCE / 2, head=program.head, notes=program.moves.notes)
    return "".join(program_text(program.moves.chunks(), form))


def compiled(text: str) -> tuple[Toolpath, Diagnostics]:
    """The toolpath of a program by our own front end, verified, and what it found."""
    found = Diagnostics()
    path = Toolpath.join(list(decode(Source("program.nc", text), DecodeOptions(), found)))
    verify(path)
    return path, found


def pieces_of(rows: list[Row]) -> Pieces:
    """Loose pieces on layer 0, each an entity of its own."""
    return Pieces.from_rows(rows, 0, 7, np.arange(len(rows)))


def codes(made: Made) -> dict[str, int]:
    """How often each code was found."""
    return dict(made.found.counts)
