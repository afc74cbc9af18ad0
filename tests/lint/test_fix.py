"""Fixes and the formatter keep the toolpath to the bit, and come to an end."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nccompile.codes import PAGES
from nccompile.diagnostics import Diagnostics
from nccompile.errors import UsageError
from nccompile.lint.base import Edit, Fix
from nccompile.lint.engine import Report, lint
from nccompile.lint.fix import apply_fixes
from nccompile.lint.fmt import format_text, renumbered
from nccompile.lint.remedies import REMEDIES
from nccompile.lint.rewrite import apply_edits, encoding_of, same_path, split_lines
from nccompile.parser import parse
from nccompile.source import Source
from nccompile.toolchain import Compilation
from nccompile.toolpath import Toolpath
from tests.lint.programs import (
    EVERY_RULE,
    OPTIONS,
    SAMPLES,
    checked,
    codes,
    programs,
    programs_with_jumps,
    read,
)


def path_of(text: str) -> list[Toolpath]:
    return list(Compilation(Source("a.nc", text), OPTIONS).decoded())


def errors_of(text: str) -> list[str]:
    compilation = Compilation(Source("a.nc", text), OPTIONS)
    for _ in compilation.decoded():
        pass
    return [found.code for found in compilation.diagnostics if found.severity == "error"]


def keeps_the_path(before: str, after: str) -> bool:
    """Whether the paths are the same, and their source lines too but for lines put before the program."""
    added = len(split_lines(after)) - len(split_lines(before))
    return same_path(path_of(before), path_of(after), shift=added)


def fixed(text: str) -> str:
    return apply_fixes(Source("a.nc", text), OPTIONS, EVERY_RULE).text


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("% a\nn10g1x1  f20", "% a\nN10 G1 X1 F20"),
        ("% a\nN10 G1 X1 F20\nN20 F20. G1 X2\nN30 G1 X3 F30", "% a\nN10 G1 X1 F20\nN20 G1 X2\nN30 G1 X3 F30"),
        ("% a\nN10 G1\x0cX1\vF20", "% a\nN10 G1 X1 F20"),
        ("% a\r\nN10 G1 X1 F20\r\n/N20 (end)\r\n", "% a\r\nN10 G1 X1 F20\r\nN20 (end)\r\n"),
        ("% a\nN10 G1 X1 Y2 F20\nN20 G1X2Y2\nN30 G1 X3 Y2", "% a\nN10 G1 X1 Y2 F20\nN20 G1 X2\nN30 G1 X3"),
        ("(cut)\r\nN10 G1 X1 F20", "% a\r\n(cut)\r\nN10 G1 X1 F20"),
        ("% a\nN10 GNone X1 R2 F20", "% a\nN10 X1 F20"),
        ("I1 J1", "% a\nN10"),
        ("% a\nN10 G1 X1 F20\nG1 X2", "% a\nN10 G1 X1 F20\nN20 G1 X2"),
        ("G1 X1 F20\n/G1 X2\n", "% a\nN10 G1 X1 F20\n/N20 G1 X2\n"),
        (
            "% a\nN5 G36 O$n$ D2\nN7 G1 X1 F20\nN6 G1 X0\nN8 G37 O$n$ D-1\nN9 G20 L7 K$n$",
            "% a\nN10 G36 O$n$ D2\nN20 G1 X1 F20\nN30 G1 X0\nN40 G37 O$n$ D-1\nN50 G20 L20 K$n$",
        ),
        ("% a\nN10 G1 X1 F20\nN10 G1 X2\nN30 G20 L10 K0", "% a\nN10 G1 X1 F20\nN10 G1 X2\nN30 G20 L10 K0"),
        ("% a\nN10 G91\nN20 G1 X1 Y1 F20\nN30 G1 X1 Y2", "% a\nN10 G91\nN20 G1 X1 Y1 F20\nN30 G1 X1 Y2"),
    ],
)
def test_fixes(before: str, after: str) -> None:
    assert fixed(before) == after


@pytest.mark.parametrize("code", REMEDIES)
def test_findings_of_compile_with_a_fix(code: str) -> None:
    text = PAGES[code].bad
    assert code in codes(text)
    after = fixed(text)
    assert code not in codes(after)
    assert keeps_the_path(text, after)


@settings(max_examples=60, deadline=None)
@given(programs)
def test_fixes_keep_the_path_and_a_second_run_changes_nothing(text: str) -> None:
    once = fixed(text)
    assert keeps_the_path(text, once)
    assert errors_of(once) == errors_of(text)
    assert fixed(once) == once


@pytest.mark.parametrize("path", SAMPLES, ids=lambda path: path.stem)
def test_fixes_keep_the_path_of_samples(path: Path) -> None:
    source = read(path)
    assert keeps_the_path(source.text, fixed(source.text))


def test_a_fix_that_would_change_the_path_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    text = "% a\nN10 G1 X1 F20\nN20 G1 X2 F20"
    honest = lint

    def wrong(source: Source, *arguments: object, **options: object) -> Report:
        report: Report = honest(source, *arguments, **options)  # type: ignore[arg-type]
        report.fixes = {found: Fix("Break it", (Edit(3, 9, 10, "7"),)) for found in report.fixes}
        return report

    monkeypatch.setattr("nccompile.lint.fix.lint", wrong)
    result = apply_fixes(Source("a.nc", text), OPTIONS, EVERY_RULE)
    assert result.text == text
    assert result.applied == 0
    assert codes(result.text) == ["NC151"]


def test_paths_differ_if_one_bit_does() -> None:
    one, other = path_of("% a\nN10 G1 X1 F20"), path_of("% a\nN10 G1 X1.0000000000000002 F20")
    assert same_path(one, path_of("% a\nN10 G1 X1 F20"))
    assert not same_path(one, other)
    moved = path_of("% a\n\nN10 G1 X1 F20")
    assert not same_path(one, moved)
    assert same_path(one, moved, lines=False)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("%  a\nn10g01x1  y2(rough)", "%  a\nN10 G01 X1 Y2 (rough)\n"),
        ("% a  \n\n / n10  x$w$y1 \n\n\n", "% a\n\n/N10 X$w$ Y1\n"),
        ("% a\r\nN10 G1 X1,5\r\n  (note)\r\n", "% a\r\nN10 G1 X1,5\r\n(note)\r\n"),
        ("% a\nn10 g1 x1\n% b\nn20 g1 x2\n", "% a\nN10 G1 X1\n% b\nn20 g1 x2\n"),
        ("% a\nn10 g1 x1\n\x1a", "% a\nN10 G1 X1\n\x1a"),
        ("% a\r\nn10 g1 x1\x1a\r\n\x1a", "% a\r\nN10 G1 X1\r\n\x1a"),
        ("% a\nn10 g1 x1\x00", "% a\nn10 g1 x1\x00"),
        ("% a\n\tn10\tg1 (\tx )  x1 \n", "% a\nN10 G1 (\tx ) X1\n"),
        ("", ""),
        ("\n\n", ""),
        ("% a\rN10 G1 X1\r", "% a\rN10 G1 X1\r"),
        ("% a\nN10 G1 X1\r\nN20 X2\n", "% a\nN10 G1 X1\nN20 X2\n"),
    ],
)
def test_layout(before: str, after: str) -> None:
    assert format_text(Source("a.nc", before)) == after


@settings(max_examples=80, deadline=None)
@given(programs)
def test_layout_keeps_the_words_and_is_stable(text: str) -> None:
    once = format_text(Source("a.nc", text))
    assert format_text(Source("a.nc", once)) == once
    assert same_path(path_of(text), path_of(once))
    words = [[(w.letter, w.number) for w in b.words] for b in parse(Source("a", text), Diagnostics())]
    assert [[(w.letter, w.number) for w in b.words] for b in parse(Source("a", once), Diagnostics())] == words


LOOP = "% a\nN5 G36 O$n$ D2\n(part)\n N7 G1 X1 F20\nG1 X0\nN8 G37 O$n$ D-1\n/N9G20L7K$n$\n"


def test_renumbering_lets_jumps_follow() -> None:
    new = renumbered(Source("a.nc", LOOP), 10).text
    assert (
        new == "% a\nN10 G36 O$n$ D2\n(part)\n N20 G1 X1 F20\nN30 G1 X0\nN40 G37 O$n$ D-1\n/N50G20L20K$n$\n"
    )
    assert same_path(path_of(LOOP), path_of(new))
    assert checked(new).diagnostics.counts["NC053"] == 0


@given(st.integers(1, 1000))
def test_any_step(step: int) -> None:
    new = renumbered(Source("a.nc", LOOP), step).text
    assert renumbered(Source("a.nc", new), step).text == new
    assert same_path(path_of(LOOP), path_of(new))


@settings(max_examples=80, deadline=None)
@given(programs_with_jumps(), st.integers(1, 20))
def test_renumbering_keeps_the_path_of_any_jumps(text: str, step: int) -> None:
    new = renumbered(Source("a.nc", text), step).text
    assert same_path(path_of(text), path_of(new))
    assert errors_of(new) == errors_of(text)
    numbers = [
        block.number for block in parse(Source("a.nc", new), Diagnostics()) if block.words or block.number
    ]
    assert [n.text for n in numbers if n] == [f"N{step * at}" for at in range(1, len(numbers) + 1)]
    assert renumbered(Source("a.nc", new), step).text == new
    laid_out = format_text(Source("a.nc", new))
    assert same_path(path_of(text), path_of(laid_out))
    assert format_text(Source("a.nc", laid_out)) == laid_out


def test_comments_before_the_first_word_stay_before_it() -> None:
    assert (
        renumbered(Source("a.nc", "% a\n(x) G1 X1\n/(y) G1 X2"), 10).text
        == "% a\nN10 (x) G1 X1\n/N20 (y) G1 X2"
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("% a\nN10 G1 X1\nN20 G20 L$a$", "a.nc:3: the target L$a$ of this jump is a variable"),
        ("% a\nN10 G1 X1\nN20 G20 L15", "is missing or there twice"),
        ("% a\nN10 G1 X1\nN10 G1 X2\nN20 G20 L10", "is missing or there twice"),
        ("% a\nN10 G1 X1,5", "a.nc:2: cannot be read"),
    ],
)
def test_what_cannot_be_numbered_is_refused(text: str, message: str) -> None:
    with pytest.raises(UsageError) as refused:
        renumbered(Source("a.nc", text), 10)
    assert message in str(refused.value)


@given(st.text("a\n\r(", max_size=12))
def test_lines_and_their_ends_make_the_text(text: str) -> None:
    lines = split_lines(text)
    assert "".join(line + end for line, end in lines) == text
    assert [line for line, _ in lines] == Source("a", text).lines


def test_edits_act_from_right_to_left() -> None:
    text = "abcdef\r\nxy"
    assert (
        apply_edits(text, [Edit(1, 2, 3, "--"), Edit(1, 5, 5, "!"), Edit(2, 3, 3, "z")]) == "a--cd!ef\r\nxyz"
    )


@pytest.mark.parametrize("data", [b"% a", b"\xef\xbb\xbf% \xc3\xa4", b"% \xe4"])
def test_bytes_come_back(data: bytes) -> None:
    assert encoding_of(data).encode(Source.from_bytes("a", data).text) == data
