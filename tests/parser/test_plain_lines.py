"""Plain lines are read without the grammar: the same nodes, line by line."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nccompile.diagnostics import Diagnostics
from nccompile.parser import ReadSource, parse, read_line
from nccompile.parser.lines import commented_block, plain_block, plain_header, read_by_grammar
from nccompile.source import Source

LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabnxyz"
NUMBERS = st.one_of(
    st.from_regex(r"\A[+-]?(?:[0-9]{1,19}\.?[0-9]{0,19}|\.[0-9]{1,9})\Z"),
    st.floats(allow_nan=False, allow_infinity=False).map(str),
    st.sampled_from(["", "1.2.3", "-", "None", "$a$", "1e-05", "1E-20", "+-1"]),
)
WORDS = st.tuples(st.sampled_from(LETTERS), NUMBERS).map("".join)
LINES = st.lists(WORDS, max_size=6).flatmap(
    lambda words: st.sampled_from([" ", " ", " ", "", "  ", "\t", " (c) "]).map(
        lambda blank: blank.join(words)
    )
)


@given(st.integers(1, 10**6), LINES)
def test_plain_blocks_equal_those_of_the_grammar(line: int, text: str) -> None:
    block = plain_block(line, text)
    if block is not None:
        assert block == read_by_grammar(line, text)


@given(st.integers(1, 10**6), LINES, st.text("(a ä1\t)", max_size=5), st.sampled_from(["", " ", "  ", "\t"]))
def test_blocks_with_a_comment_equal_those_of_the_grammar(
    line: int, text: str, said: str, blank: str
) -> None:
    whole = f"{text}{blank}({said})"
    block = commented_block(line, whole)
    if block is not None:
        assert block == read_by_grammar(line, whole)


@pytest.mark.parametrize("text", ["(a)", " (a)", "N10 (a)", "N10 G1 X1 F20 (a b)", "G1(a)", "n5 g1 x-.5  ()"])
def test_common_lines_with_a_comment_are_plain(text: str) -> None:
    assert commented_block(7, text) == read_by_grammar(7, text)


@given(st.integers(1, 99), st.text("% aB_.-1(\t", max_size=6))
def test_plain_headers_equal_those_of_the_grammar(line: int, text: str) -> None:
    header = plain_header(line, "%" + text)
    if header is not None:
        assert header == read_by_grammar(line, "%" + text)


@given(st.integers(1, 99), st.text("NGXYF0123456789.-+ ()", max_size=24))
def test_so_do_those_of_any_text(line: int, text: str) -> None:
    assert read_line(line, text) == read_by_grammar(line, text)


def test_the_common_line_is_plain() -> None:
    block = plain_block(3, "N30 G1 X-1.5 Y.5 F20")
    assert block is not None
    assert [(word.letter, word.value, word.column) for word in block.words] == [
        ("G", 1.0, 5), ("X", -1.5, 8), ("Y", 0.5, 14), ("F", 20.0, 18),
    ]  # fmt: skip


def test_lines_that_were_read_before_give_the_same_blocks_and_findings() -> None:
    text = "% a\n\nN10 G1 X1 F20\nN20 G1 X1,5\n(note)\nN30 G1 X\n% b\nN40"
    source = Source("a.nc", text)
    nodes = [read_line(at, line) for at, line in enumerate(source.lines, 1)]
    fresh, again = Diagnostics(), Diagnostics()
    expected = list(parse(source, fresh))
    assert list(parse(ReadSource("a.nc", text, nodes=nodes), again)) == expected
    assert list(again) == list(fresh)
    assert fresh.errors == 3
