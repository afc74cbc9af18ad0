"""The machined set equals the drawn one: random drawings against samplers that share no code with the importer.

`python -m benchmarks.bench_dxf 1000` runs the same on a thousand drawings.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.importers.drawings import distance, drawn_lines, machined_lines, random_drawing
from tests.importers.workshop import TOLERANCE, compiled, machine, machine_file

SAMPLING = 0.002  # chord heights of both samplers


@pytest.mark.parametrize("seed", range(24))
def test_machined_set_is_the_drawn_set(seed: int, tmp_path: Path) -> None:
    doc = random_drawing(seed)
    made = machine(doc, tmp_path)

    drawn, machined = drawn_lines(doc), machined_lines(made.text)

    assert distance(drawn, machined) < TOLERANCE + SAMPLING
    assert distance(machined, drawn) < TOLERANCE + SAMPLING


@pytest.mark.parametrize("seed", range(24, 40))
def test_programs_compile_without_a_finding(seed: int, tmp_path: Path) -> None:
    made = machine(random_drawing(seed), tmp_path)

    path, found = compiled(made.text)

    assert not found.counts
    assert len(path) == made.result.programs[0].moves.rows


def test_binary_and_text_drawings_are_alike(tmp_path: Path) -> None:
    doc = random_drawing(3)
    doc.saveas(tmp_path / "binary.dxf", fmt="bin")

    assert machine_file(tmp_path / "binary.dxf").text == machine(doc, tmp_path).text.replace(
        "drawing.dxf", "binary.dxf"
    )
