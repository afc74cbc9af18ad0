"""The server's kernels: plain until a child has compiled them; the program that it compiles them with."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

from nccompile import kernels
from nccompile.lint.config import Config
from nccompile.lint.engine import lint
from nccompile.lsp.warming import Warming, program
from nccompile.source import Source
from nccompile.toolpath.columns import Kind
from tests.lint.programs import OPTIONS

VARIABLE = "NCCOMPILE_KERNELS"


@pytest.fixture
def _empty_cache(tmp_path: object, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("NCCOMPILE_CACHE", str(tmp_path))
    monkeypatch.delenv(VARIABLE, raising=False)
    kernels.machine_code.cache_clear()
    yield
    kernels.machine_code.cache_clear()


@pytest.mark.usefixtures("_empty_cache")
def test_kernels_are_plain_until_they_are_in_the_cache() -> None:
    Warming()
    assert os.environ.pop(VARIABLE) == "python"
    kernels.machine_code().mkdir(parents=True)
    (kernels.machine_code() / "language-server").touch()
    Warming()
    assert VARIABLE not in os.environ


@pytest.mark.usefixtures("_empty_cache")
def test_a_choice_of_the_user_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "numba")
    Warming()
    assert os.environ[VARIABLE] == "numba"


def test_the_program_has_every_kind_of_segment() -> None:
    report = lint(Source("all.nc", program(30)), OPTIONS, Config())
    assert {found.code for found in report.ordered()} <= {"NC051", "NC161"}  # no block numbers, still G91
    made = set(report.program.path.kind.tolist())
    assert made == {Kind.POSITIONING, Kind.LINE, Kind.ARC, Kind.ELLIPSE, Kind.POLYNOMIAL}
