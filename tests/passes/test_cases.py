"""Every `*.case` below this folder and every example in the docstring of a pass; `make accept` rewrites the files."""

from __future__ import annotations

import importlib
import os
from pathlib import Path

import pytest

from nccompile.passes.option import ORDER
from tests.passes.cases import Case, agree, examples_in, run_case

HERE = Path(__file__).parent
FILES = sorted(HERE.glob("*/*.case"))
EXAMPLES = [
    pytest.param(case, id=f"{kind.name}-{number}")
    for kind in ORDER
    for number, case in enumerate(examples_in(importlib.import_module(kind.__module__).__doc__), 1)
]
ACCEPT = bool(os.environ.get("NCCOMPILE_ACCEPT"))


def check(case: Case) -> None:
    got = run_case(case)
    assert agree(got, case.wanted), got
    assert run_case(case, 1) == got
    assert run_case(case, 3) == got


@pytest.mark.parametrize("file", FILES, ids=lambda file: f"{file.parent.name}/{file.stem}")
def test_case(file: Path) -> None:
    case = Case.parse(file.read_text())
    if ACCEPT:
        file.write_text(case.with_wanted(run_case(case)))
        case = Case.parse(file.read_text())
    check(case)


@pytest.mark.parametrize("case", EXAMPLES)
def test_example_of_the_docstring(case: Case) -> None:
    check(case)


@pytest.mark.parametrize("kind", ORDER, ids=lambda kind: kind.name)
def test_every_pass_has_an_example_and_a_case(kind: type) -> None:
    module = kind.__module__.rpartition(".")[2]
    assert examples_in(importlib.import_module(kind.__module__).__doc__)
    assert list((HERE / module).glob("*.case"))


def test_a_case_without_its_parts_is_refused() -> None:
    with pytest.raises(ValueError, match="--- out"):
        Case.parse("-p compress\n--- in\n% t\n")
