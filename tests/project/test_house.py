"""The house rules that tools can check: sizes, documents that are named and there, packaged files."""

from __future__ import annotations

import ast
import re
import tomllib
from importlib import resources
from pathlib import Path

import pytest

from nccompile.codes import PAGES

ROOT = Path(__file__).parents[2]
SOURCES = sorted((ROOT / "src").rglob("*.py")) + sorted((ROOT / "grammars").glob("*.py"))
DOCUMENTS = sorted(ROOT.glob("*.md")) + sorted((ROOT / "docs").rglob("*.md"))

LONGEST_FILE = 400
LONGEST_FUNCTION = 40


def _name(path: Path) -> str:
    return str(path.relative_to(ROOT))


@pytest.mark.parametrize("path", [p for p in SOURCES if p.parent.name != "kernels"], ids=_name)
def test_files_are_short(path: Path) -> None:
    """Kernels are exempt (docs/decisions/005)."""
    assert len(path.read_text().splitlines()) <= LONGEST_FILE


@pytest.mark.parametrize("path", [p for p in SOURCES if p.parent.name != "kernels"], ids=_name)
def test_functions_are_short(path: Path) -> None:
    """Kernels are exempt (docs/decisions/005).  Signature and docstring do not count."""
    long = {}
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            body = node.body[1:] if ast.get_docstring(node) is not None else node.body
            lines = (node.end_lineno or 0) - body[0].lineno + 1 if body else 0
            if lines > LONGEST_FUNCTION:
                long[node.name] = lines
    assert long == {}


@pytest.mark.parametrize("path", DOCUMENTS, ids=_name)
def test_links_of_documents_lead_somewhere(path: Path) -> None:
    targets = re.findall(r"\]\(([^)#:]+)\)", path.read_text())
    assert [t for t in targets if not (path.parent / t).exists()] == []


def test_the_life_of_a_block_names_what_is_there() -> None:
    """docs/architecture.md: rows of files, each with functions and classes of it behind it."""
    text = (ROOT / "docs" / "architecture.md").read_text().partition("## The life of")[2]
    missing, source = [], ""
    for row in re.findall(r"^\| \d+ \|.*\| (.*) \|$", text, re.MULTILINE):
        for name in re.findall(r"`([^`]+)`", row):
            if "/" in name or name.endswith(".py"):
                place = ROOT / ("" if name.startswith("grammars") else "src/nccompile") / name
                source = place.read_text() if place.exists() else ""
                missing += [] if source else [name]
            elif not re.search(rf"\b(?:def|class) {name.split('.')[-1]}\b", source):
                missing.append(name)
    assert missing == []


def test_documents_that_the_sources_name_are_there() -> None:
    named = {
        (found, _name(path)) for path in SOURCES for found in re.findall(r"docs/[\w/.-]*\w", path.read_text())
    }
    missing = [
        (name, where)
        for name, where in sorted(named)
        if not (ROOT / name).exists() and not list(ROOT.glob(f"{name}*.md"))
    ]
    assert missing == []


def test_paths_that_documents_name_are_there() -> None:
    """`src/nccompile/...` and module paths such as `decoder/motion.py` in the documents must not go stale."""
    missing = []
    for path in DOCUMENTS:
        for name in re.findall(r"`([a-z_0-9]+/[\w/]+\.(?:py|lark|toml|nc))`", path.read_text()):
            places = [ROOT / name, ROOT / "src" / "nccompile" / name]
            if not any(place.exists() for place in places):
                missing.append((name, _name(path)))
    assert missing == []


def test_files_beside_the_code_are_packaged() -> None:
    assert resources.files("nccompile.grammars").joinpath("din66025.lark").is_file()
    assert resources.files("nccompile.grammars").joinpath("common.lark").is_file()
    assert resources.files("nccompile.machine").joinpath("generic.toml").is_file()
    assert resources.files("nccompile").joinpath("py.typed").is_file()


def test_every_package_is_in_the_wheel() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    there = {
        ".".join(path.parent.relative_to(ROOT / "src").parts)
        for path in (ROOT / "src" / "nccompile").rglob("__init__.py")
    }
    assert set(project["tool"]["setuptools"]["packages"]) == there | {"nccompile.grammars"}


def test_every_code_in_the_sources_has_a_page() -> None:
    used = {
        code
        for path in SOURCES
        if path.parent.name != "codes"
        for code in re.findall(r'"(NC\d{3})"', path.read_text())
    }
    assert used - PAGES.keys() == set()


def test_codes_are_in_order() -> None:
    assert list(PAGES) == sorted(PAGES)


def test_no_unfinished_places() -> None:
    words = re.compile("TO" + "DO|FIX" + "ME|XX" + "X")
    assert [_name(path) for path in SOURCES if words.search(path.read_text())] == []
