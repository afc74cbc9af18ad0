"""The samples, planned: names, kinds and lines to the letter, numbers to 1e-9 (docs/decisions/009).

`make accept` rewrites the files beside this one; a person reads the difference.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from nccompile.machine.model import load
from nccompile.source import Source
from nccompile.toolchain import Compilation, Options
from nccompile.toolpath import Toolpath
from nccompile.toolpath.text import format_toolpath
from tests.words import is_same

HERE = Path(__file__).parent
SAMPLES = HERE.parents[1] / "samples"
PROGRAMS = sorted(path.stem for path in SAMPLES.glob("*.nc"))
ACCEPT = bool(os.environ.get("NCCOMPILE_ACCEPT"))


def _planned(name: str) -> str:
    machine = load(SAMPLES / ("plotter2.toml" if name.startswith("plotter") else "mill3.toml"))
    compilation = Compilation(Source.read(SAMPLES / f"{name}.nc"), Options(machine, verify=True))
    path = Toolpath.join(list(compilation.planned()))
    assert list(compilation.diagnostics) == []
    return format_toolpath(path)


def _same(word: str, accepted: str) -> bool:
    return is_same(word, accepted, absolute=1e-9, relative=1e-9)


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_sample_is_planned_as_accepted(name: str) -> None:
    golden = HERE / f"{name}.txt"
    text = _planned(name)
    if ACCEPT:
        golden.write_text(text)
    lines, accepted = text.splitlines(), golden.read_text().splitlines()
    assert len(lines) == len(accepted)
    for number, (line, wanted) in enumerate(zip(lines, accepted, strict=True), 1):
        words, wanted_words = line.split(), wanted.split()
        assert len(words) == len(wanted_words), f"{golden.name}:{number}"
        assert all(map(_same, words, wanted_words)), f"{golden.name}:{number}: {line}"


def test_no_golden_file_is_left_over() -> None:
    assert {path.stem for path in HERE.glob("*.txt")} == set(PROGRAMS)
