"""The same findings as `compile`, selection, settings and silencing comments."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings

from nccompile.codes import PAGES
from nccompile.diagnostics import render
from nccompile.errors import UsageError
from nccompile.lint.config import Config, config_for, parse_config
from nccompile.lint.engine import lint
from nccompile.lint.registry import RULES
from nccompile.source import Source
from nccompile.toolchain import Compilation
from tests.lint.programs import OPTIONS, SAMPLES, checked, codes, programs, read

RULE_CODES = {rule.code for rule in RULES}
TEXTS = [page.bad for page in PAGES.values() if page.bad] + [
    page.good for page in PAGES.values() if page.good
]


def compiled(source: Source) -> list[str]:
    compilation = Compilation(source, OPTIONS)
    for _ in compilation.planned():
        pass
    return [render(found, source) for found in compilation.diagnostics]


def linted(source: Source) -> list[str]:
    report = lint(source, OPTIONS, Config())
    return [render(found, source) for found in report.ordered() if found.code not in RULE_CODES]


@pytest.mark.parametrize("path", SAMPLES, ids=lambda path: path.stem)
def test_samples_give_what_compile_gives_byte_for_byte(path: Path) -> None:
    assert linted(read(path)) == compiled(read(path))


def test_pages_give_what_compile_gives_byte_for_byte() -> None:
    for text in TEXTS:
        source = Source("a.nc", text)
        assert linted(source) == compiled(source)


@settings(max_examples=40, deadline=None)
@given(programs)
def test_random_programs_give_what_compile_gives(text: str) -> None:
    source = Source("a.nc", text)
    assert linted(source) == compiled(source)


@pytest.mark.parametrize("path", SAMPLES, ids=lambda path: path.stem)
def test_large_programs_are_decoded_in_columns_with_the_same_findings(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nccompile.lint.program.STREAMED", 0)
    assert linted(read(path)) == compiled(read(path))


@pytest.mark.parametrize("text", ["\ufeff% a\nN10 G1 X1 F20", "% \ud800\nN10 G1 X1 F20"])
def test_text_that_has_no_bytes_is_decoded_too(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("nccompile.lint.program.STREAMED", 0)
    assert linted(Source("a.nc", text)) == compiled(Source("a.nc", text))


def test_past_the_limit_findings_are_counted_as_compile_does() -> None:
    text = "% a\nN10 G1 F20\n" + "\n".join(f"N{n} X{n} K1" for n in range(20, 50))
    report = checked(text, Config(), limit=None)
    assert len([d for d in report.ordered() if d.code == "NC105"]) == 20
    assert report.diagnostics.counts["NC105"] == 30
    assert len([d for d in checked(text).ordered() if d.code == "NC105"]) == 30


def test_many_notes_of_a_kind_become_one_that_counts_them() -> None:
    text = "% a\nN10 G1 X1 F20\n" + "\n".join(f"N{n} G1 X{n} F20" for n in range(20, 40))
    (note,) = checked(text, Config(), limit=None).ordered()
    assert note.message == "the feed is 20 since line 2; 19 more like this, the last in line 22"
    report = checked(text, Config(), limit=None)
    assert report.closing == "0 errors, 20 notes (19 more of the same kinds, --limit 0 shows them)"
    assert len(report.fixes[note].edits) == 20
    assert report.fixes[note].title == "Remove F20, and 19 more"
    assert len(checked(text, Config(), limit=7).ordered()) == 7
    assert len(checked(text, Config(), limit=0).ordered()) == 20


def test_silenced_notes_do_not_count() -> None:
    blocks = [f"N{n} G1 X{n} F20 (nc: ignore)" for n in range(20, 40)]
    text = "% a\nN10 G1 X1 F20\n" + "\n".join([*blocks, "N50 G1 X50 F20"])
    (note,) = checked(text, Config(), limit=None).ordered()
    assert (note.message, note.span.line) == ("the feed is 20 since line 2", 23)


TWO = "% a\nN10 G1 X1 F20\nN10 G1 X2 F20"


def test_codes_are_selected_by_their_first_characters() -> None:
    assert codes(TWO, Config()) == ["NC052", "NC151"]
    assert codes(TWO, Config(select=("NC1",))) == ["NC151"]
    assert codes(TWO, Config(ignore=("NC1",))) == ["NC052"]
    assert codes(TWO, Config(select=("NC151",), ignore=("NC1",))) == ["NC151"]
    assert codes(TWO, Config(ignore=("NC15",), extend_select=("NC151",))) == ["NC052", "NC151"]


def test_rules_that_are_off_come_by_their_full_code() -> None:
    text = "% a\nN10 G1 X1 Y1 F20\nN20 G1 X2 Y1"
    assert codes(text, Config(select=("NC",))) == []
    assert codes(text, Config(extend_select=("NC153",))) == ["NC153"]


def test_errors_cannot_be_hidden() -> None:
    assert codes("% a\nN10 G7 (nc: ignore)", Config(ignore=("NC",))) == ["NC102"]


@pytest.mark.parametrize(
    ("text", "left"),
    [
        ("% a\nN10 G1 X1 F20\nN10 G1 X2 F20 (nc: ignore)", []),
        ("% a\nN10 G1 X1 F20\nN10 G1 X2 F20 (nc: ignore[NC151])", ["NC052"]),
        ("% a\nN10 G1 X1 F20\nN10 G1 X2 F20 (NC: Ignore[nc05, nc151])", []),
        ("% a\nN10 G1 X1 F20\n(nc: ignore[NC052])\nN10 G1 X2 F20", ["NC151"]),
        ("% a\n(nc: ignore-file[NC052])\nN10 G1 X1 F20\nN10 G1 X2 F20", ["NC151"]),
        ("% a\nN10 G1 X1 F20 (nc: ignore)\nN10 G1 X2 F20", ["NC052", "NC151"]),
    ],
)
def test_comments_silence(text: str, left: list[str]) -> None:
    assert codes(text, Config()) == left


def test_settings_come_from_the_nearest_file(tmp_path: Path) -> None:
    inner = tmp_path / "jobs" / "today"
    inner.mkdir(parents=True)
    (tmp_path / "pyproject.toml").write_text('[tool.nccompile.lint]\nignore = ["NC05"]\n')
    assert config_for(inner / "a.nc").ignore == ("NC05",)
    (tmp_path / "jobs" / "pyproject.toml").write_text('[project]\nname = "other"\n')
    assert config_for(inner / "a.nc").ignore == ("NC05",)
    (tmp_path / "jobs" / "nccompile.toml").write_text(
        'machine = "mill.toml"\n[lint]\nmin-segment = 0.01\n[format]\nstep = 5\n'
    )
    found = config_for(inner / "a.nc")
    assert (found.ignore, found.min_segment, found.step) == ((), 0.01, 5)
    assert found.machine == tmp_path / "jobs" / "mill.toml"
    assert config_for(Path("/a.nc")) == Config()


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({"lnit": {}}, "did you mean lint?"),
        ({"lint": {"selct": []}}, "unknown key lint.selct; did you mean select?"),
        ({"lint": []}, "[lint] must be a section"),
        ({"lint": {"ignore": "NC1"}}, "must be a list of codes"),
        ({"lint": {"ignore": ["X1"]}}, "lint.ignore: there is no code X1"),
        ({"lint": {"select": ["NC999"]}}, "lint.select: there is no code NC999"),
        ({"lint": {"select": [""]}}, "there is no code ''"),
        ({"lint": {"min-segment": -1}}, "must be a length in mm"),
        ({"lint": {"acknowledged-m": [3, True]}}, "must be a list of whole numbers"),
        ({"lint": {"acknowledged-m": 3}}, "must be a list of whole numbers"),
        ({"format": {"step": 0}}, "from 1 to 1000"),
        ({"machine": 1}, "must be the name of a file"),
    ],
)
def test_wrong_settings_are_refused_with_the_key(table: dict[str, object], message: str) -> None:
    with pytest.raises(UsageError) as refused:
        parse_config(table, "nccompile.toml", Path())
    assert message in str(refused.value)
    assert "nccompile.toml" in str(refused.value)


def test_a_section_that_is_none_is_refused(tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_text("[tool]\nnccompile = 3\n")
    with pytest.raises(UsageError, match="must be a section"):
        config_for(tmp_path / "a.nc")


def test_a_settings_file_that_is_not_toml_is_refused(tmp_path: Path) -> None:
    (tmp_path / "nccompile.toml").write_text("[lint\n")
    with pytest.raises(UsageError, match="cannot be read"):
        config_for(tmp_path / "a.nc")
