"""Reading lines: words, numbers, comments, line ends, and what is refused."""

from __future__ import annotations

import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nccompile.diagnostics import Diagnostics
from nccompile.parser import MAX_LINE, MAX_UNREADABLE, Block, Variable, parse, read_header
from nccompile.source import Source


def read(text: str) -> tuple[list[Block], list[str]]:
    diagnostics = Diagnostics()
    blocks = list(parse(Source("a.nc", text), diagnostics))
    return blocks, [found.code for found in diagnostics]


def block_of(line: str) -> Block:
    blocks, codes = read("% a\n" + line)
    assert codes == []
    return blocks[0]


@pytest.mark.parametrize(
    "line", ["N10 G1 X-1.5 F20", "N10G1X-1.5F20", "n010 g01 x-1.50 f+20.", "N10\tG1\fX-01.5  F20  "]
)
def test_spellings_of_a_block(line: str) -> None:
    block = block_of(line)
    assert block.number is not None
    assert block.number.value == 10
    assert [(word.letter, word.value) for word in block.words] == [("G", 1), ("X", -1.5), ("F", 20)]


@pytest.mark.parametrize("number", ["5.", ".5", "+.5", "-0", "007", "-00.250", "123456789.987654321"])
def test_a_number_is_exactly_the_float_of_its_text(number: str) -> None:
    word = block_of(f"G1 X{number}").words[1]
    assert word.value == float(number)
    assert word.number == number


@given(st.floats(-1e6, 1e6).map(lambda v: f"{v:.6f}"))
def test_numbers_come_back_to_the_bit(number: str) -> None:
    assert block_of(f"X{number}").words[0].value == float(number)


@pytest.mark.parametrize("number", ["1.2.3", "--5", "+-5", ".", "-", "1e-05", "2E+10", "1,5", "5-"])
def test_what_is_not_a_number_is_one_error(number: str) -> None:
    blocks, codes = read(f"% a\nN10 G1 X{number}\nN20 G1 Y1")
    assert len(codes) == 1
    assert [block.sound for block in blocks] == [False, True]
    assert blocks[0].number is not None
    assert blocks[0].number.value == 10


def test_places_count_from_one_and_hold_after_tabs_and_comments() -> None:
    block = block_of("\t/N10 (move) G1\tX$a.b[1]$ (end)  ")
    assert block.skip
    assert block.span.column == 2
    assert (block.line, block.end) == (2, 32)
    assert block.number is not None
    assert [block.number.column, *(word.column for word in block.words)] == [3, 14, 17]
    assert block.words[1].value == Variable("a.b[1]")
    assert [(comment.text, comment.column) for comment in block.comments] == [("move", 7), ("end", 27)]
    assert block.words[1].span.end == 17 + len("X$a.b[1]$")


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("last", ["", "end"])
def test_line_ends(end: str, last: str) -> None:
    blocks, codes = read(end.join(["% a", "N10 G1 X1", "", "N20 X2"]) + (end if last else ""))
    assert codes == []
    assert [block.line for block in blocks] == [2, 4]


def test_byte_order_mark_and_end_of_file_mark() -> None:
    source = Source.from_bytes("a.nc", b"\xef\xbb\xbf% a\r\nN10 G1 X1\r\n\x1a")
    diagnostics = Diagnostics()
    assert len(list(parse(source, diagnostics))) == 1
    assert list(diagnostics) == []


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("% part 7 (rev B)\nX1", "part 7"),
        ("%\tname\t", "name"),
        ("%", ""),
        ("\n(first)\n%late\nX1", "late"),
        ("X1\n% a", None),
    ],
)
def test_header(text: str, name: str | None) -> None:
    header = read_header(Source("a.nc", text))
    assert (None if header is None else header.name) == name


def test_a_last_percent_warns_and_a_second_program_is_an_error() -> None:
    for text, errors in (("% a\nN10 X1\n%\n (end)\n\x1a", 0), ("% a\nN10 X1\n% b\nN10 X2", 1)):
        diagnostics = Diagnostics()
        blocks = list(parse(Source("a.nc", text), diagnostics))
        assert len(blocks) == 1
        assert [found.code for found in diagnostics] == ["NC008"]
        assert diagnostics.errors == errors


@pytest.mark.parametrize("text", ["", "\n\n", "% only", "% a\n(comment)\n"])
def test_no_program(text: str) -> None:
    assert read(text)[1] == ["NC012"]
    assert set(read(text + "\n%")[1]) == {"NC012"} | ({"NC008"} if "%" in text else set())


@pytest.mark.parametrize(
    "data",
    [b"\x00" * 1000, b"PK\x03\x04" + bytes(range(256)) * 20, b"% a\nN10 X1\x00\n", "% a\n".encode("utf-16")],
)
def test_binary_is_said_once(data: bytes) -> None:
    diagnostics = Diagnostics()
    assert list(parse(Source.from_bytes("a.nc", data), diagnostics)) == []
    assert [found.code for found in diagnostics] == ["NC010"]


@pytest.mark.parametrize(
    "line", ["X1 " * 3_500_000, "(" * 10_000_000, "9" * 10_000_000, " " * 10_000_000 + "X"]
)
def test_a_line_of_ten_megabytes_is_refused_at_once(line: str) -> None:
    began = time.perf_counter()
    blocks, codes = read(f"% a\n{line}\nN20 X1")
    assert time.perf_counter() - began < 5.0
    assert codes == ["NC011"]
    assert len(blocks) == 2


def test_the_longest_line_is_read() -> None:
    line = ("X1 " * (MAX_LINE // 3)).strip()
    assert len(block_of(line).words) == MAX_LINE // 3


def test_reading_stops_after_too_many_unreadable_lines() -> None:
    diagnostics = Diagnostics()
    blocks = list(parse(Source("a.nc", "% a\n" + "Dear sir,\n" * 100_000), diagnostics))
    assert len(blocks) == MAX_UNREADABLE
    assert diagnostics.counts == {"NC002": MAX_UNREADABLE, "NC014": 1}
