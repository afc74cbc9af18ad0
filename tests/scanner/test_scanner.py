"""The scanner against the grammar: the same words from the same bytes, for every input."""

from __future__ import annotations

import re

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from nccompile.decoder import DecodeOptions
from nccompile.decoder.din66025 import axes_of
from nccompile.parser import Block, Header, scanner
from nccompile.parser.lines import read_by_grammar
from nccompile.source import Source
from tests.scanner.routes import large

ODD = [
    "+.5",
    "-0",
    "5.",
    "-.5",
    "+0.",
    "007",
    "00000000000000000000000001.5",
    "0." + "0" * 30 + "1",
    ".1" * 1,
]
NUMBERS = st.one_of(
    st.sampled_from(ODD),
    st.from_regex(r"\A[+-]?(?:[0-9]{1,21}\.?[0-9]{0,21}|\.[0-9]{1,25})\Z"),
    st.floats(-1e6, 1e6).map(lambda x: f"{x:.17g}").filter(lambda text: "e" not in text),
    st.decimals(-9999, 9999, places=3).map(str),
    st.sampled_from(
        ["", "1.2.3", "-", "None", "$a$", "1e-05", "1E-20", "1E-200", "1e+5", "+-1", "1,5", "..", "."]
    ),
)
LETTERS = st.sampled_from("NGXYZFEIJRABMHgxyznefE")
BLANKS = st.sampled_from(
    ["", "", " ", " ", "  ", "\t", "\f", "\v ", "(c)", " (ä€) ", "()", "(", ")", "(()", "/", "%", "$", ";"]
)
LINES = st.lists(st.tuples(BLANKS, LETTERS, NUMBERS).map("".join), max_size=7).map("".join)
ENDS = st.sampled_from(["\n", "\n", "\r\n", "\r", "\n\n", "\r\n\r"])
TEXTS = st.lists(st.tuples(LINES, ENDS).map("".join), max_size=8).map("".join)
ANY = st.text("NGX1.5-+eE$(%/) \n\r\t\f0", max_size=60)


def scanned(data: bytes, part: int) -> dict[int, list[tuple[str, float, int]] | None]:
    """By line: the words of plain blocks as (letter, value, byte column), None for blocks that are not plain."""
    found: dict[int, list[tuple[str, float, int]] | None] = {}
    source = large(data, part)
    for table in scanner.tables(source):
        for b in range(table.blocks):
            words = range(int(table.block_word[b]), int(table.block_word[b + 1]))
            begin = int(table.block_begin[b])
            found[int(table.block_line[b])] = (
                [
                    (chr(table.letter[w]), float(table.value[w]), int(table.place[w]) - begin + 1)
                    for w in words
                ]
                if table.plain[b]
                else None
            )
            assert table.text(b) == source.line(int(table.block_line[b]))
    return found


def check(text: str, part: int) -> int:
    """Compares all lines of a text with the grammar; returns how many were plain."""
    found = scanned(text.encode(), part)
    for number, line in enumerate(Source("a", text).lines, 1):
        node = read_by_grammar(number, line)
        words = found.get(number, [])
        if words is None:
            continue
        if not words:
            assert node is None or (
                isinstance(node, Block) and node.sound and not (node.words or node.number)
            )
            continue
        assert isinstance(node, Block)
        assert node.sound
        expected = ([] if node.number is None else [node.number]) + list(node.words)
        assert [(w.letter, repr(w.value)) for w in expected] == [(w[0], repr(w[1])) for w in words]
        if line.isascii():
            assert [w.column for w in expected] == [w[2] for w in words]
    return sum(1 for words in found.values() if words)


@settings(max_examples=400, deadline=None)
@given(st.one_of(TEXTS, ANY), st.sampled_from([1, 2, 3, 7, 64, 1 << 20]))
@example("N1G1X1E-05\nX1E-5\nX1E-005\nX1e+05 Y2\nX1.e-05", 1 << 20)
@example("X9007199254740993\nX0.1234567890123456789\nX-0\nX123456789012345678901234567890", 5)
@example("N10N20\nN1.5\nX1N1\n(a)N1(b)X1(c)\nX1(a(b)\nX1)\nX 1", 4)
def test_plain_blocks_are_those_of_the_grammar(text: str, part: int) -> None:
    check(text, part)


@pytest.mark.parametrize(
    "line",
    ["N10 G1 X1.5 Y-2 F20", "g1x+.5y-0z5.", "N0010G01X00.50E100 E-200", "(a)N1 (b) X1(c)", "X0.30000000000000004",
     "\tX1\f", "X12345678901234567890", "N1", "X1E200", "X1E-5"],
)  # fmt: skip
def test_legal_spellings_are_plain(line: str) -> None:
    assert check(line, 1 << 20) == 1


@pytest.mark.parametrize("tables", [(3, 2, 1), (1, 1, 1), (5, 40, 2)])
@settings(max_examples=40, deadline=None)
@given(text=TEXTS)
def test_small_tables_change_nothing_but_how_much_is_plain(text: str, tables: tuple[int, int, int]) -> None:
    with pytest.MonkeyPatch.context() as patch:
        for name, size in zip(("_WORDS", "_BLOCKS", "_HARD"), tables, strict=True):
            patch.setattr(scanner, name, size)
        check(text, 1 << 20)


_CONTROL = re.compile(r"[\x00-\x08\x0e-\x1f\x7f]")
_JUMP = re.compile(r"[Gg](?:0*20(?![0-9])|\$)")
SURVEYED = st.lists(
    st.sampled_from(["A1", "b-2", "C$x$", "$A1$", "(A1)", "((U1)", "%P A1", " %A1", "W.5", "A", "(", ")", "$",
    "G20", "G020",
                     "G200", "g$i$", "(G20)", "G2", "X1", " ", "\n", "\n", "\t", "Q+1", "é", "\f%A1", "00", "20",
                     "\x07"])
).map("".join)  # fmt: skip


@settings(max_examples=300, deadline=None)
@given(SURVEYED, st.sampled_from([1, 5, 1 << 20]))
def test_the_survey_finds_what_the_patterns_find(text: str, part: int) -> None:
    seen = scanner.survey(large(text.encode(), part), "ABCPQUVW")
    control = _CONTROL.search(text)
    assert seen.control == (-1 if control is None else len(text[: control.start()].encode()))
    if control is None:
        assert "".join(sorted(seen.letters)) == "".join(axes_of(text, DecodeOptions())[3:])
        assert seen.jumps == bool(_JUMP.search(text))


def test_a_header_is_no_plain_block() -> None:
    assert scanned(b"% part\nN1 G1", 1 << 20) == {1: None, 2: [("N", 1.0, 1), ("G", 1.0, 4)]}
    assert isinstance(read_by_grammar(1, "% part"), Header)
