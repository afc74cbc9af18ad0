"""`compile`, `lint` and the language server say the same of every bad program, byte for byte."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

import pytest

from nccompile.cli.app import run
from nccompile.codes import PAGES
from nccompile.lint.pages import sheet_of
from nccompile.lint.registry import RULES
from nccompile.source import Source
from tests.lint.programs import SAMPLES
from tests.lsp.client import Json, serving, uri_of

_BY_RULES = {rule.code for rule in RULES}


def written(folder: Path, texts: Iterable[bytes]) -> list[Path]:
    """Programs as files of a folder; each text once."""
    folder.mkdir()
    paths = []
    for at, data in enumerate(dict.fromkeys(texts)):
        paths.append(folder / f"{at:03}.nc")
        paths[-1].write_bytes(data)
    return paths


def of_the_front_end(findings: list[Json]) -> list[Json]:
    """The findings that are not those of rules, which `lint` alone has."""
    return [row for row in findings if row["code"] not in _BY_RULES]


def by_file(findings: list[Json]) -> dict[str, list[Json]]:
    found: dict[str, list[Json]] = defaultdict(list)
    for row in findings:
        found[row["file"]].append(row)
    return found


def test_the_server_says_what_lint_prints(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    of_rules = [text.encode() for rule in RULES for text in (*sheet_of(rule).bad, *sheet_of(rule).okay)]
    of_pages = [text.encode() for page in PAGES.values() for text in (page.bad, page.good)]
    paths = written(tmp_path / "all", [path.read_bytes() for path in SAMPLES] + of_rules + of_pages)
    assert len(paths) > 150
    run(["lint", *map(str, paths)])
    printed = capsys.readouterr().out
    with serving() as client:
        for path in paths:
            client.open(uri_of(path), Source.from_bytes(str(path), path.read_bytes()).text)
        shown = [found["data"]["rendered"] for path in paths for found in client.checked(uri_of(path))]
    assert "".join(text + "\n" for text in shown) == printed


def test_compile_says_what_lint_says(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    of_pages = [page.bad.encode() for page in PAGES.values() if page.bad and page.code not in _BY_RULES]
    paths = written(tmp_path / "all", [path.read_bytes() for path in SAMPLES] + of_pages)
    run(["lint", *map(str, paths), "--format", "json"])
    by_lint = by_file(json.loads(capsys.readouterr().out))
    said = 0
    for path in paths:
        run(["compile", str(path), "-o", str(tmp_path / "queue"), "--diagnostics", "json"])
        by_compile = of_the_front_end(json.loads(capsys.readouterr().err))
        assert by_compile == of_the_front_end(by_lint[str(path)])
        said += len(by_compile)
    assert said > 100
