"""Reading: entities, blocks, layers, units, damaged and strange files."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nccompile.diagnostics import Severity
from nccompile.importers.dxf import document
from nccompile.importers.dxf.pieces import PieceKind
from nccompile.importers.dxf.read import ReadOptions
from nccompile.toolpath import Kind
from tests.importers.workshop import Made, codes, compiled, machine, machine_file, new_drawing


def drawing_of(
    draw: Callable[[Any], Any], folder: Path, reading: ReadOptions | None = None, **converting: Any
) -> Made:
    doc = new_drawing()
    draw(doc.modelspace())
    return machine(doc, folder, reading=reading, **converting)


def only_piece(made: Made) -> tuple[int, np.ndarray[Any, Any]]:
    assert made.drawing is not None
    assert len(made.drawing.pieces) == 1
    return int(made.drawing.pieces.kind[0]), made.drawing.pieces.p[0]


def test_arc_seen_from_below_bends_the_right_way(tmp_path: Path) -> None:
    made = drawing_of(lambda m: m.add_arc((10, 5), 4, 0, 90, dxfattribs={"extrusion": (0, 0, -1)}), tmp_path)

    kind, p = only_piece(made)

    assert kind == PieceKind.ARC
    assert p[:5] == pytest.approx([-10, 5, 4, pi, -pi / 2])  # from (-14, 5) clockwise to (-10, 9)


@pytest.mark.parametrize("bulge", [0.5, -0.5, 1.0, -2.0])
def test_bulge_is_the_tangent_of_a_quarter_of_the_sweep(bulge: float, tmp_path: Path) -> None:
    made = drawing_of(lambda m: m.add_lwpolyline([(0, 0, bulge), (10, 0, 0)], format="xyb"), tmp_path)

    kind, p = only_piece(made)

    assert kind == PieceKind.ARC
    assert np.tan(p[4] / 4) == pytest.approx(bulge)
    assert p[0] == pytest.approx(5.0)


@pytest.mark.parametrize(
    ("x", "y", "kind"), [(2, 2, PieceKind.ARC), (-2, 2, PieceKind.ARC), (2, 1, PieceKind.ELLIPSE)]
)
def test_arcs_in_blocks_stay_arcs_under_uniform_scale_and_mirror(
    x: float, y: float, kind: PieceKind, tmp_path: Path
) -> None:
    doc = new_drawing()
    doc.blocks.new("B").add_arc((1, 0), 3, 20, 110)
    doc.modelspace().add_blockref("B", (5, 5), {"xscale": x, "yscale": y, "rotation": 30})

    got, p = only_piece(machine(doc, tmp_path))

    assert got == kind
    assert p[2] == pytest.approx(6.0)


def test_quadratic_spline_is_a_cubic_exactly(tmp_path: Path) -> None:
    made = drawing_of(lambda m: m.add_open_spline([(0, 0), (6, 12), (12, 0)], degree=2), tmp_path)

    kind, p = only_piece(made)

    assert kind == PieceKind.CUBIC
    assert p[:4] == pytest.approx([4, 8, 8, 8])


def test_ellipse_is_written_as_an_ellipse(tmp_path: Path) -> None:
    made = drawing_of(lambda m: m.add_ellipse((0, 0), (20, 0), 0.5, 0, pi / 2), tmp_path)

    assert "G9 X0 Y10" in made.text or "G8 X20 Y0" in made.text


def test_inch_drawings_are_scaled(tmp_path: Path) -> None:
    doc = new_drawing(units=1)
    doc.modelspace().add_line((0, 0), (2, 0))

    assert "X50.8" in machine(doc, tmp_path).text


def test_drawings_without_unit_are_taken_as_mm_and_said_so(tmp_path: Path) -> None:
    doc = new_drawing("R12")
    doc.modelspace().add_line((0, 0), (2, 1))

    made = machine(doc, tmp_path)

    assert codes(made) == {"NC603": 1}
    assert "2 by 1 units are taken as mm" in next(iter(made.found)).message
    assert codes(machine(doc, tmp_path, reading=ReadOptions(units="inch"))) == {}
    asked = machine(doc, tmp_path, reading=ReadOptions(ask_units=lambda width, height: "inch"))
    assert "X50.8" in asked.text


def test_hidden_layers_are_left_out_and_said_so(tmp_path: Path) -> None:
    doc = new_drawing()
    doc.layers.add("OFF").off()
    doc.layers.add("COLD").freeze()
    doc.layers.add("AIDS").dxf.plot = 0
    for name in ("OFF", "COLD", "AIDS", "Defpoints", "CUT"):
        doc.modelspace().add_line((0, 0), (10, len(name)), {"layer": name})

    made = machine(doc, tmp_path)

    assert made.drawing is not None
    assert set(made.drawing.hidden) == {"OFF", "COLD", "AIDS", "Defpoints"}
    assert set(made.result.layers) == {"CUT"}
    assert codes(made) == {"NC606": 4}
    only = machine(doc, tmp_path, reading=ReadOptions(layers=("off",)))
    assert set(only.result.layers) == {"OFF"}


def test_block_content_on_layer_0_takes_layer_and_colour_of_its_insert(tmp_path: Path) -> None:
    doc = new_drawing()
    doc.layers.add("CUT", color=3)
    block = doc.blocks.new("B")
    block.add_line((0, 0), (5, 0))
    block.add_line((0, 1), (5, 1), {"layer": "OWN", "color": 0})
    doc.modelspace().add_blockref("B", (0, 0), {"layer": "CUT", "color": 6})

    made = machine(doc, tmp_path)

    assert made.drawing is not None
    names = [made.drawing.layers[i] for i in made.drawing.pieces.layer]
    assert names == ["CUT", "OWN"]
    assert made.drawing.pieces.color.tolist() == [3, 6]


def test_what_is_left_out_is_counted_and_named(tmp_path: Path) -> None:
    def draw(m: Any) -> None:
        m.add_line((0, 0, 0), (1, 1, 5))
        m.add_3dface([(0, 0, 0), (1, 0, 0), (1, 1, 1), (0, 1, 1)])
        m.add_text("hello")
        m.add_blockref("MISSING", (0, 0))
        m.add_circle((0, 0), 5, {"extrusion": (1, 0, 1)})
        m.add_line((0, 0), (10, 0))

    made = drawing_of(draw, tmp_path)

    assert made.drawing is not None
    assert sum(made.drawing.left.values()) == 5
    assert codes(made) == {"NC605": 5}


def test_blocks_that_contain_themselves_end(tmp_path: Path) -> None:
    doc = new_drawing()
    block = doc.blocks.new("R")
    block.add_blockref("R", (1, 0))
    block.add_line((0, 0), (10, 0))
    doc.modelspace().add_blockref("R", (0, 0))

    made = machine(doc, tmp_path)

    assert made.drawing is not None
    assert len(made.drawing.pieces) == 1
    assert codes(made) == {"NC605": 1}


def test_texts_and_hatches_on_request(tmp_path: Path) -> None:
    def draw(m: Any) -> None:
        m.add_text("Ho", height=10)
        m.add_mtext("two\nlines", {"char_height": 5, "insert": (0, -20)})
        hatch = m.add_hatch()
        hatch.paths.add_polyline_path([(40, 0, 1), (60, 0, 1)], is_closed=True)
        hatch.paths.add_edge_path().add_ellipse((80, 0), (10, 0), 0.5, 0, 360)

    assert codes(drawing_of(draw, tmp_path)) == {"NC605": 3, "NC604": 1}
    made = drawing_of(draw, tmp_path, ReadOptions(texts=True, hatches=True))

    assert made.drawing is not None
    assert made.drawing.taken == {"TEXT": 1, "MTEXT": 1, "HATCH": 1}
    assert all(paths.closed.all() for paths in made.result.paths)
    letters = {"H": 1, "o": 2} | {"t": 1, "w": 1, "l": 1, "i": 2, "n": 1, "e": 2, "s": 1}  # outlines of each
    assert len(made.result.paths[0]) == sum(letters[c] for c in "Hotwolines") + 2


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "the file is empty"),
        (b"AC1032" + bytes(100), "this is a DWG drawing"),
        (b"%!PS-Adobe", "this is not a DXF drawing"),
        (bytes(range(256)) * 20, "this is not a DXF drawing"),
        (b"  0\nSECTION\n  2\nHEADER\n", "nothing to machine: it is empty"),
    ],
)
def test_files_that_are_no_drawings(content: bytes, message: str, tmp_path: Path) -> None:
    place = tmp_path / "file.dxf"
    place.write_bytes(content)

    made = machine_file(place)

    assert made.drawing is None
    assert message in " ".join(d.message for d in made.found if d.severity is Severity.ERROR)


def damaged(folder: Path, change: Callable[[str], str]) -> Made:
    doc = new_drawing()
    for k in range(20):
        doc.modelspace().add_line((k, 0), (k, 10))
    doc.saveas(folder / "sound.dxf")
    place = folder / "damaged.dxf"
    place.write_text(change((folder / "sound.dxf").read_text()))
    return machine_file(place)


def test_cut_off_drawings_give_what_they_have(tmp_path: Path) -> None:
    made = damaged(tmp_path, lambda text: text[: text.rindex("AcDbLine") - 400])

    assert made.drawing is not None
    assert 10 < made.drawing.taken["LINE"] < 20
    assert "NC602" in codes(made)


def test_lines_that_are_no_tags_are_passed_over(tmp_path: Path) -> None:
    made = damaged(tmp_path, lambda text: text.replace("AcDbLine\n", "AcDbLine\nrubbish\n", 1))

    assert made.drawing is not None
    assert made.drawing.taken["LINE"] >= 18
    assert "NC602" in codes(made)


def test_only_three_dimensional_drawings_say_so(tmp_path: Path) -> None:
    made = drawing_of(lambda m: m.add_line((0, 0, 0), (0, 0, 9)), tmp_path)

    assert made.drawing is None
    assert codes(made) == {"NC604": 1, "NC605": 1}


def test_far_away_drawings_are_machined_and_said_so(tmp_path: Path) -> None:
    far = 5.3e8
    made = drawing_of(lambda m: m.add_circle((far, far), 10), tmp_path)

    path, found = compiled(made.text)

    assert codes(made) == {"NC611": 1}
    assert not found.counts
    assert path.length[path.kind == Kind.ARC].sum() == pytest.approx(20 * pi, abs=1e-5)
    moved = drawing_of(lambda m: m.add_circle((far, far), 10), tmp_path, origin="lower-left")
    assert abs(moved.result.programs[0].moves.at[0]) <= 20.0


def test_large_drawings_are_streamed_alike(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    doc = new_drawing()
    block = doc.blocks.new("B")
    block.add_circle((0, 0), 3)
    doc.layers.add("OFF").off()
    for k in range(30):
        doc.modelspace().add_polyline2d([(k, 0, 0.3), (k, 10, 0), (k + 5, 3, 0)], format="xyb", close=True)
        doc.modelspace().add_line((k, 50), (k + 1, 60), {"layer": "OFF"})
        doc.modelspace().add_blockref("B", (k * 10, 80))

    whole = machine(doc, tmp_path)
    monkeypatch.setattr(document, "LARGE", 1000)
    streamed = machine(doc, tmp_path)

    assert streamed.text == whole.text
    assert codes(streamed) == codes(whole)
