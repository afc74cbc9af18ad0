"""Toolpaths written as DIN 66025 programs and read again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import shapely

from nccompile.backend.din66025 import ProgramFormat, program_text
from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostics
from nccompile.geometry.sampling import sample_curves
from nccompile.importers.dxf.assemble import Moves
from nccompile.importers.dxf.pieces import Pieces, arc_row, cubic_row
from nccompile.source import Source
from nccompile.toolpath import Kind, Toolpath
from nccompile.toolpath.verify import verify

SAMPLES = sorted((Path(__file__).parents[2] / "samples").glob("*.nc"))


def decoded(text: str) -> tuple[Toolpath, Diagnostics]:
    found = Diagnostics()
    path = Toolpath.join(list(decode(Source("p", text), DecodeOptions(), found)))
    verify(path)
    return path, found


def written(path: Toolpath, **form: int) -> str:
    return "".join(program_text([path], ProgramFormat(**form)))  # type: ignore[arg-type]


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda p: p.stem)
def test_what_is_written_is_read_as_the_same_path(sample: Path) -> None:
    path, _ = decoded(sample.read_text())
    idle = (path.kind == Kind.POSITIONING) & (path.length == 0.0)  # is not written

    again, found = decoded(written(path, decimals=6))

    cubic = path.kind == Kind.POLYNOMIAL
    assert not found.counts
    assert again.end == pytest.approx(path.end, abs=1e-6)
    assert again.length.sum() == pytest.approx(path.length.sum(), abs=0.02)
    assert again.events.number.tolist() == path.events.number.tolist()
    if not cubic.any():
        assert again.kind.tolist() == path.kind[~idle].tolist()
        assert again.target == pytest.approx(path.target[~idle], abs=1e-6)
        assert again.feed[again.kind != 0] == pytest.approx(path.feed[path.kind != 0])
        assert again.mark.tolist() == path.mark[~idle].tolist()


@pytest.mark.parametrize("decimals", [2, 3, 4, 6])
@pytest.mark.parametrize("sweep", [1e-4, 0.01, -1.0, 3.0, -3.1416, 4.0, -6.0, 6.28])
@pytest.mark.parametrize("radius", [0.05, 3.0, 250.0, 40_000.0])
def test_arcs_stay_arcs_after_rounding(radius: float, sweep: float, decimals: int) -> None:
    moves = Moves()
    arc = Pieces.from_rows([arc_row(12.345678 + 6.54321j, radius, 0.7, sweep)])
    moves.rapid(complex(arc.start[0]), 0.0)
    moves.follow(arc, 0.0, 10.0)
    path = Toolpath.join(list(moves.chunks()))

    again, found = decoded(written(path, decimals=decimals))

    assert not found.counts
    for i in np.flatnonzero(again.curve >= 0).tolist():
        row = again.curves.parameters[again.curve[i]]
        points = sample_curves(np.array([Kind.ARC], np.uint8), row[None, :], np.linspace(0, 1, 50))[0, :, :2]
        off = np.abs(np.hypot(points[:, 0] - 12.345678, points[:, 1] - 6.54321) - radius)
        assert off.max() <= 2 * 10.0**-decimals
    assert again.end == pytest.approx(path.end, abs=10.0**-decimals)


def test_cubics_become_arcs_within_the_tolerance() -> None:
    moves = Moves()
    cubic = Pieces.from_rows([cubic_row(0j, 40 + 60j, 60 - 60j, 100 + 0j)])
    moves.follow(cubic, 0.0, 10.0)
    path = Toolpath.join(list(moves.chunks()))

    again, found = decoded("".join(program_text([path], ProgramFormat(tolerance=0.01))))

    t = np.linspace(0, 1, 2000)
    z = 3 * (1 - t) ** 2 * t * (40 + 60j) + 3 * (1 - t) * t**2 * (60 - 60j) + t**3 * 100
    assert not found.counts
    assert set(again.kind.tolist()) <= {Kind.LINE, Kind.ARC}
    arcs = again.curves.parameters
    points = sample_curves(np.full(len(arcs), Kind.ARC, np.uint8), arcs, np.linspace(0, 1, 9))[
        :, :, :2
    ].reshape(-1, 2)
    off = shapely.distance(shapely.points(points), shapely.LineString(np.column_stack([z.real, z.imag])))
    assert off.max() < 0.0101
    assert again.length.sum() == pytest.approx(path.length.sum(), rel=1e-5)


def test_comments_cannot_end_early() -> None:
    form = ProgramFormat(name="A(b)\n%", head=("a (nested) comment\nof two lines",))

    lines = list(program_text([Toolpath.empty()], form))

    assert lines == ["% A[b] %\n", "(a [nested] comment of two lines)\n"]
