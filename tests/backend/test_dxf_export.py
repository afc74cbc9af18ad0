"""Export as DXF: every segment is its entity; import of the export of an import gives the same program."""

from __future__ import annotations

import io
from pathlib import Path

import ezdxf.filemanagement
import numpy as np
import pytest

from nccompile.backend.dxf import DxfExport
from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostics
from nccompile.importers.dxf.job import Job
from nccompile.source import Source
from nccompile.toolpath import Kind, Toolpath
from tests.importers.drawings import WORD, distance, drawn_lines, machined_lines, random_drawing
from tests.importers.workshop import Made, compiled, machine, machine_file, new_drawing

PROGRAM = """% EVERYTHING
N10 G0 X10 Y10
N20 G1 X30 F20 H1 O0.5
N30 G2 X40 Y20 I0 J10
N40 G3 X40 Y20 I5 J0
N50 G8 X60 Y20 I10 J0 K0 R0.5
N60 G9 X60 Y20 I-10 J0 K0 R0.5
N70 G5 X70 Y25
N80 G5 X80 Y15
N90 G6 X100 Y15 I90 J40
N100 G2 X110 Y5 Z-3 I0 J-10
N110 M10
N120 G1 X120 Z0
"""


def exported(path: Toolpath, folder: Path, suffix: str = "") -> Path:
    drawing = DxfExport()
    drawing.add([path], suffix)
    text = io.StringIO()
    drawing.write(text)
    place = folder / "exported.dxf"
    place.write_text(text.getvalue())
    return place


def assert_same_program(a: Made, b: Made) -> None:
    """Equal in every word but the last digits of I and J, which stand for a nanometre here and there."""
    blocks = [[line for line in made.text.splitlines() if line.startswith("N")] for made in (a, b)]
    words = [[WORD.findall(block) for block in program] for program in blocks]
    assert [[letter for letter, _ in block] for block in words[0]] == [
        [letter for letter, _ in block] for block in words[1]
    ]
    for one, other in zip(words[0], words[1], strict=True):
        for (letter, x), (_, y) in zip(one, other, strict=True):
            slack = 4e-6 if letter in "IJ" else 1e-8 if letter in "KR" else 0.0
            off = abs(float(x) - float(y))
            off = min(off % 180, -off % 180) if letter == "K" else off  # the axis of an ellipse has no sense
            assert off <= slack, (one, other)


def test_every_segment_is_the_entity_that_it_is(tmp_path: Path) -> None:
    path = Toolpath.join(list(decode(Source("p", PROGRAM), DecodeOptions(), Diagnostics())))

    doc = ezdxf.filemanagement.readfile(str(exported(path, tmp_path)))

    kinds = [entity.dxftype() for entity in doc.modelspace()]
    layers = {entity.dxf.layer for entity in doc.modelspace()}
    assert kinds == ["LINE", "POINT", "LWPOLYLINE", "CIRCLE", "ELLIPSE", "ELLIPSE", "SPLINE", "SPLINE", "SPLINE",
                     "POLYLINE", "POINT", "LINE"]  # fmt: skip
    assert layers == {"NC_RAPID", "NC_FEED", "NC_SWITCH"}
    assert doc.header["$INSUNITS"] == 4


def test_the_export_lies_where_the_path_does(tmp_path: Path) -> None:
    flat = PROGRAM.replace(" Z-3", "").replace(" Z0", "")
    path = Toolpath.join(list(decode(Source("p", flat), DecodeOptions(), Diagnostics())))
    doc = ezdxf.filemanagement.readfile(str(exported(path, tmp_path)))
    for entity in list(doc.modelspace()):
        if entity.dxf.layer != "NC_FEED":
            doc.modelspace().delete_entity(entity)

    drawn = drawn_lines(doc)

    known = machined_lines(
        "\n".join(block for block in flat.splitlines() if "G5" not in block and "G6" not in block)
    )
    corners = np.concatenate(drawn)
    assert corners.min(axis=0) == pytest.approx([10.0, 5.0], abs=0.01)
    assert distance(known[:5], drawn) < 0.002
    lengths = sum(np.hypot(*np.diff(line, axis=0).T).sum() for line in drawn)
    assert lengths == pytest.approx(path.length[path.kind != Kind.POSITIONING].sum(), rel=1e-4)


def again(made: Made, folder: Path) -> Made:
    """The import of the export of an import."""
    return machine_file(exported(compiled(made.text)[0], folder))


@pytest.mark.parametrize("seed", range(100, 116))
def test_import_of_the_export_of_an_import_is_the_same_program(seed: int, tmp_path: Path) -> None:
    made = machine(random_drawing(seed), tmp_path)

    assert_same_program(again(made, tmp_path), made)


def test_a_grid_of_holes_survives_though_many_tours_are_equally_short(tmp_path: Path) -> None:
    doc = new_drawing()
    for x in range(6):
        for y in range(6):
            doc.modelspace().add_circle((10 * x, 10 * y), 3)
    made = machine(doc, tmp_path, Job())

    assert_same_program(again(made, tmp_path), made)
